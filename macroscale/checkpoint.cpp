#include "macroscale/checkpoint.h"

#include <algorithm>
#include <array>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "macroscale/contact_points.h"
#include "macroscale/self_contact.h"

namespace heddle::macroscale {

namespace {

// One name a member. A member added to HistoryRow must be added here too: the size tells.
static_assert(sizeof(HistoryRow) == 35 * sizeof(double) + sizeof(std::optional<HeatRow>),
              "HistoryRow has changed: name its new members here");
template <class Row, class Visit>
void each_number(Row& r, const Visit& visit) {
  visit("time", r.time);
  visit("punch_displacement", r.punch_displacement);
  visit("punch_force", r.punch_force);
  visit("die_force", r.die_force);
  visit("binder_force", r.binder_force);
  visit("draw_in_max", r.draw_in_max);
  visit("shear_angle_max", r.shear_angle_max);
  visit("tow_strain_max", r.tow_strain_max);
  visit("newton_iterations", r.newton_iterations);
  visit("lag_iterations", r.lag_iterations);
  visit("folded_nodes", r.folded_nodes);
  visit("near_nodes", r.near_nodes);
  visit("self_crossings", r.self_crossings);
  visit("work_punch", r.work_punch);
  visit("work_binder", r.work_binder);
  visit("work_gravity", r.work_gravity);
  visit("energy_tow", r.energy_tow);
  visit("energy_shear", r.energy_shear);
  visit("energy_bending", r.energy_bending);
  visit("energy_twist", r.energy_twist);
  visit("energy_compaction", r.energy_compaction);
  visit("energy_kinetic", r.energy_kinetic);
  visit("energy_press", r.energy_press);
  visit("friction_punch", r.friction_punch);
  visit("friction_die", r.friction_die);
  visit("friction_binder", r.friction_binder);
  visit("friction_plies", r.friction_plies);
  visit("dissipation_shear_rate", r.dissipation_shear_rate);
  visit("dissipation_shear_hysteresis", r.dissipation_shear_hysteresis);
  visit("dissipation_tow_rate", r.dissipation_tow_rate);
  visit("dissipation_artefact", r.dissipation_artefact);
  visit("dissipation_numerical", r.dissipation_numerical);
  visit("ledger_residual", r.ledger_residual);
  visit("force_balance", r.force_balance);
  visit("friction_work_outside", r.friction_work_outside);
  visit("punch_deflection", r.punch_deflection);
  visit("binder_tilt", r.binder_tilt);
}

static_assert(sizeof(HeatRow) == 10 * sizeof(double), "HeatRow has changed: keep its new members");
template <class Row>
auto heat_members(Row& r) {
  return std::tie(r.time, r.mean_temperature, r.coldest_face, r.through_bottom, r.through_top, r.of_friction,
                  r.crystallised, r.frozen_faces, r.frozen_through, r.residual);
}

// Nothing is written of a run with one temperature.
void write_heat_rows(Hdf5Writer& file, const std::string& path, const std::vector<HeatRow>& rows) {
  if (rows.empty()) return;
  std::vector<double> flat;
  for (const HeatRow& row : rows)
    std::apply([&](const auto&... member) { (flat.push_back(member), ...); }, heat_members(row));
  file.write(path, flat, {rows.size(), 10});
}

std::vector<HeatRow> read_heat_rows(const Hdf5Reader& file, const std::string& path) {
  if (!file.has(path)) return {};
  const std::vector<double> flat = file.doubles(path);
  if (flat.size() % 10 != 0) throw Hdf5Error(path + " has the wrong length");
  std::vector<HeatRow> rows(flat.size() / 10);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    std::size_t c = 10 * k;
    std::apply([&](auto&... member) { ((member = flat[c++]), ...); }, heat_members(rows[k]));
  }
  return rows;
}

void write_history(Hdf5Writer& file, const std::string& group, const std::vector<HistoryRow>& rows) {
  // The first row's members name the columns; each column is gathered over all rows.
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
  HistoryRow any;
  each_number(any, [&](const char* name, auto&) { names.emplace_back(name); });
  columns.resize(names.size());
  for (const HistoryRow& row : rows) {
    std::size_t c = 0;
    each_number(row, [&](const char*, auto value) { columns[c++].push_back(static_cast<double>(value)); });
  }
  for (std::size_t c = 0; c < names.size(); ++c) file.write(group + "/" + names[c], columns[c]);
  std::vector<HeatRow> heat;
  for (const HistoryRow& row : rows)
    if (row.heat) heat.push_back(*row.heat);
  write_heat_rows(file, group + "/heat", heat);
}

std::vector<HistoryRow> read_history(const Hdf5Reader& file, const std::string& group) {
  std::vector<HistoryRow> rows(file.doubles(group + "/time").size());
  HistoryRow any;
  std::size_t column = 0;
  each_number(any, [&](const char* name, auto&) {
    const std::vector<double> values = file.doubles(group + "/" + name);
    if (values.size() != rows.size()) throw Hdf5Error(fmt::format("{}/{} has the wrong length", group, name));
    for (std::size_t r = 0; r < rows.size(); ++r) {
      std::size_t c = 0;
      each_number(rows[r], [&](const char*, auto& member) {
        if (c++ == column) member = static_cast<std::remove_reference_t<decltype(member)>>(values[r]);
      });
    }
    ++column;
  });
  const std::vector<HeatRow> heat = read_heat_rows(file, group + "/heat");
  if (!heat.empty() && heat.size() != rows.size()) throw Hdf5Error(group + "/heat has the wrong length");
  for (std::size_t r = 0; r < heat.size(); ++r) rows[r].heat = heat[r];
  return rows;
}

template <class Number, std::size_t N>
void write_rows(Hdf5Writer& file, const std::string& path, const std::vector<std::array<Number, N>>& rows) {
  std::vector<Number> flat;
  flat.reserve(N * rows.size());
  for (const auto& row : rows) flat.insert(flat.end(), row.begin(), row.end());
  file.write(path, std::span<const Number>(flat), {rows.size(), N});
}

template <std::size_t N, class Number>
std::vector<std::array<Number, N>> rows_of(const std::vector<Number>& flat, const std::string& path) {
  if (flat.size() % N != 0) throw Hdf5Error(fmt::format("{} has the wrong length", path));
  std::vector<std::array<Number, N>> rows(flat.size() / N);
  for (std::size_t k = 0; k < flat.size(); ++k) rows[k / N][k % N] = flat[k];
  return rows;
}

template <std::size_t N>
std::vector<std::array<double, N>> read_rows(const Hdf5Reader& file, const std::string& path) {
  return rows_of<N>(file.doubles(path), path);
}

template <class Memory>
auto memory_members(Memory& m) {
  return std::tie(m.slip, m.dwell, m.work_per_area, m.slip_resistance, m.film_temperature, m.age,
                  m.load_slip);
}
constexpr std::size_t memory_size =
    std::tuple_size_v<decltype(memory_members(std::declval<friction::ContactState&>()))>;
static_assert(sizeof(friction::ContactState) == memory_size * sizeof(double),
              "ContactState has changed: keep its new members");

void append_memory(std::vector<double>& flat, const std::vector<friction::ContactState>& row) {
  for (const friction::ContactState& m : row)
    std::apply([&](const auto&... member) { (flat.push_back(member), ...); }, memory_members(m));
}

std::vector<double> flat_memory(const State& state) {
  std::vector<double> flat;
  for (std::size_t k = 0; k < state.tool_z.size(); ++k) append_memory(flat, state.memory[k]);
  return flat;
}

static_assert(sizeof(ShearMemory) == 4 * sizeof(double), "ShearMemory has changed: keep its new members");

// Nothing is written of a fabric whose tows do not rub.
void write_shear_memory(Hdf5Writer& file, const std::string& path, const std::vector<ShearMemory>& memory) {
  if (memory.empty()) return;
  std::vector<std::array<double, 4>> rows;
  for (const ShearMemory& m : memory) rows.push_back({m.sine, m.widest, m.stress, m.stiffness});
  write_rows(file, path, rows);
}

std::vector<ShearMemory> read_shear_memory(const Hdf5Reader& file, const std::string& path) {
  std::vector<ShearMemory> memory;
  if (!file.has(path)) return memory;
  for (const auto& row : read_rows<4>(file, path)) memory.push_back({row[0], row[1], row[2], row[3]});
  return memory;
}

// Nothing is written of a single ply.
void write_plies(Hdf5Writer& file, const std::string& group, const State& state) {
  if (state.memory.size() == state.tool_z.size()) return;
  std::vector<double> flat;
  append_memory(flat, state.memory.back());
  file.write(group + "/contact_memory", flat, {state.memory.back().size(), memory_size});
  file.write(group + "/coupled_quad", state.coupling.quad);
  write_rows(file, group + "/coupled_place", state.coupling.local);
}

void read_plies(const Hdf5Reader& file, const std::string& group, State& state) {
  if (!file.has(group + "/contact_memory")) return;
  auto& row = state.memory.emplace_back();
  for (const auto& flat : read_rows<memory_size>(file, group + "/contact_memory")) {
    std::size_t c = 0;
    std::apply([&](auto&... member) { ((member = flat[c++]), ...); }, memory_members(row.emplace_back()));
  }
  state.coupling = {file.integers(group + "/coupled_quad"), read_rows<2>(file, group + "/coupled_place")};
  if (state.coupling.quad.size() != row.size() || state.coupling.local.size() != row.size())
    throw Hdf5Error(group + " has parts that do not fit");
}

void write_heat(Hdf5Writer& file, const std::string& group, const BlankHeat& heat) {
  if (heat.empty()) return;
  file.write(group + "/cells", static_cast<int>(heat.field.cells));
  file.write(group + "/temperature", heat.field.temperature);
  file.write(group + "/progress", heat.field.progress);
  write_rows(file, group + "/face", heat.field.face);
  write_rows(file, group + "/heat_in", heat.field.heat_in);
  write_rows(file, group + "/film", heat.film);
  file.write(group + "/rate_factor", heat.rate_factor);
  if (!heat.shear_factor.empty()) file.write(group + "/shear_factor", heat.shear_factor);
}

BlankHeat read_heat(const Hdf5Reader& file, const std::string& group) {
  BlankHeat heat;
  if (!file.has(group + "/cells")) return heat;
  heat.field.cells = static_cast<std::size_t>(file.integer(group + "/cells"));
  heat.field.temperature = file.doubles(group + "/temperature");
  heat.field.progress = file.doubles(group + "/progress");
  heat.field.face = read_rows<2>(file, group + "/face");
  heat.field.heat_in = read_rows<3>(file, group + "/heat_in");
  heat.film = read_rows<2>(file, group + "/film");
  heat.rate_factor = file.doubles(group + "/rate_factor");
  if (file.has(group + "/shear_factor")) heat.shear_factor = file.doubles(group + "/shear_factor");
  const std::size_t nodes = heat.field.nodes(), all = nodes * heat.field.cells;
  if (heat.field.temperature.size() != all || heat.field.progress.size() != all ||
      heat.field.heat_in.size() != nodes || heat.film.size() != nodes)
    throw Hdf5Error(group + " has parts that do not fit");
  return heat;
}

void write_state(Hdf5Writer& file, const std::string& group, const State& state) {
  file.write(group + "/time", state.time);
  file.write(group + "/x", std::span(state.x.data(), static_cast<std::size_t>(state.x.size())));
  file.write(group + "/v", std::span(state.v.data(), static_cast<std::size_t>(state.v.size())));
  file.write(group + "/tool_z", state.tool_z);
  file.write(group + "/corner_angle", state.corner_angle);
  write_shear_memory(file, group + "/shear_memory", state.shear_memory);
  const std::size_t tools = state.tool_z.size(), nodes = tools > 0 ? state.memory[0].size() : 0;
  file.write(group + "/contact_memory", flat_memory(state), {tools, nodes, memory_size});
  write_plies(file, group + "/plies", state);
  write_heat(file, group + "/heat", state.heat);
}

State read_state(const Hdf5Reader& file, const std::string& group) {
  const auto vector = [](const std::vector<double>& v) {
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size())));
  };
  State state;
  state.time = file.number(group + "/time");
  state.x = vector(file.doubles(group + "/x"));
  state.v = vector(file.doubles(group + "/v"));
  state.tool_z = file.doubles(group + "/tool_z");
  state.corner_angle = file.doubles(group + "/corner_angle");
  state.shear_memory = read_shear_memory(file, group + "/shear_memory");
  const auto flat = read_rows<memory_size>(file, group + "/contact_memory");
  const std::size_t tools = state.tool_z.size();
  if (tools == 0 || flat.size() % tools != 0) throw Hdf5Error(group + "/contact_memory has the wrong length");
  const std::size_t nodes = flat.size() / tools;
  for (std::size_t k = 0; k < tools; ++k) {
    auto& of_tool = state.memory.emplace_back();
    for (std::size_t i = 0; i < nodes; ++i) {
      std::size_t c = 0;
      std::apply([&](auto&... member) { ((member = flat[k * nodes + i][c++]), ...); },
                 memory_members(of_tool.emplace_back()));
    }
  }
  read_plies(file, group + "/plies", state);
  state.heat = read_heat(file, group + "/heat");
  return state;
}

template <std::size_t N>
std::vector<std::array<int, N>> read_index_rows(const Hdf5Reader& file, const std::string& path) {
  return rows_of<N>(file.integers(path), path);
}

// What all instants of one blank share: its grid, its cells and its outline.
void write_shared(Hdf5Writer& file, const std::string& group, const BlankState& blank) {
  file.write(group + "/cells", std::vector<int>{blank.nu, blank.nv});
  write_rows(file, group + "/grid", blank.grid);
  write_rows(file, group + "/reference", blank.reference);
  write_rows(file, group + "/quads", blank.quads);
  std::vector<int> piece_quad;
  std::vector<std::array<double, 8>> piece_corners;
  for (const CellPiece& piece : blank.pieces) {
    piece_quad.push_back(piece.quad);
    auto& flat = piece_corners.emplace_back();
    for (std::size_t k = 0; k < 8; ++k) flat[k] = piece.corners[k / 2][k % 2];
  }
  file.write(group + "/piece_quad", piece_quad);
  write_rows(file, group + "/piece_corners", piece_corners);
  write_rows(file, group + "/outline", blank.outline.outer);
  std::vector<std::array<int, 8>> plies;
  for (const PlyRange& p : blank.plies)
    plies.push_back(
        {p.nu, p.nv, p.first_node, p.end_node, p.first_quad, p.end_quad, p.first_edge, p.end_edge});
  if (!plies.empty()) write_rows(file, group + "/plies", plies);
  if (blank.symmetry != Symmetry::none) file.write(group + "/symmetry", static_cast<int>(blank.symmetry));
  file.write(group + "/holes", static_cast<int>(blank.outline.holes.size()));
  for (std::size_t k = 0; k < blank.outline.holes.size(); ++k)
    write_rows(file, fmt::format("{}/hole_{}", group, k), blank.outline.holes[k]);
}

BlankState read_shared(const Hdf5Reader& file, const std::string& group) {
  BlankState blank;
  const auto cells = file.integers(group + "/cells");
  if (cells.size() != 2) throw Hdf5Error(group + "/cells has the wrong length");
  blank.nu = cells[0];
  blank.nv = cells[1];
  blank.grid = read_index_rows<2>(file, group + "/grid");
  blank.reference = read_rows<2>(file, group + "/reference");
  blank.quads = read_index_rows<4>(file, group + "/quads");
  const auto piece_quad = file.integers(group + "/piece_quad");
  const auto piece_corners = read_rows<8>(file, group + "/piece_corners");
  if (piece_quad.size() != piece_corners.size())
    throw Hdf5Error(group + "/piece_corners has the wrong length");
  for (std::size_t k = 0; k < piece_quad.size(); ++k) {
    CellPiece piece{piece_quad[k], {}};
    for (std::size_t c = 0; c < 8; ++c) piece.corners[c / 2][c % 2] = piece_corners[k][c];
    blank.pieces.push_back(piece);
  }
  blank.outline.outer = read_rows<2>(file, group + "/outline");
  if (file.has(group + "/plies"))
    for (const auto& p : read_index_rows<8>(file, group + "/plies"))
      blank.plies.push_back({p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7]});
  if (file.has(group + "/symmetry")) {
    const int piece = file.integer(group + "/symmetry");
    if (piece < 0 || piece > static_cast<int>(Symmetry::quarter))
      throw Hdf5Error(group + "/symmetry is no piece of a blank");
    blank.symmetry = static_cast<Symmetry>(piece);
  }
  for (int k = 0; k < file.integer(group + "/holes"); ++k)
    blank.outline.holes.push_back(read_rows<2>(file, fmt::format("{}/hole_{}", group, k)));
  return blank;
}

// The nodal fields of one instant that are plain numbers.
template <class Blank, class Visit>
void each_field(Blank& blank, const Visit& visit) {
  visit("shear_angle", blank.shear_angle);
  visit("pressure", blank.pressure);
  visit("slip_speed", blank.slip_speed);
  visit("friction_coefficient", blank.friction_coefficient);
  visit("hersey", blank.hersey);
}
// And those that not every run has.
template <class Blank, class Visit>
void each_optional_field(Blank& blank, const Visit& visit) {
  visit("temperature_bottom", blank.heat.bottom);
  visit("temperature_top", blank.heat.top);
  visit("temperature_mean", blank.heat.mean);
  visit("crystallised", blank.heat.crystallised);
  visit("ply_slip", blank.ply_slip);
  visit("ply_pressure", blank.ply_pressure);
}

}  // namespace

void write_instant(Hdf5Writer& file, const std::string& group, const BlankState& blank) {
  file.write(group + "/time", blank.time);
  file.write(group + "/punch_displacement", blank.punch_displacement);
  file.write(group + "/binder_position", blank.binder_position);
  write_rows(file, group + "/position", blank.position);
  write_rows(file, group + "/velocity", blank.velocity);
  write_rows(file, group + "/tow_strain", blank.tow_strain);
  each_field(blank, [&](const char* name, const std::vector<double>& field) {
    file.write(group + "/" + name, field);
  });
  each_optional_field(blank, [&](const char* name, const std::vector<double>& field) {
    if (!field.empty()) file.write(group + "/" + name, field);
  });
  std::vector<std::array<double, 6>> edge;
  for (const EdgeState& e : blank.edge)
    edge.push_back({e.reference[0], e.reference[1], e.position[0], e.position[1], e.position[2], e.draw_in});
  write_rows(file, group + "/edge", edge);
}

BlankState read_instant(const Hdf5Reader& file, const std::string& group, const BlankState& shared) {
  BlankState blank;
  blank.nu = shared.nu;
  blank.nv = shared.nv;
  blank.symmetry = shared.symmetry;
  blank.plies = shared.plies;
  blank.grid = shared.grid;
  blank.reference = shared.reference;
  blank.quads = shared.quads;
  blank.pieces = shared.pieces;
  blank.outline = shared.outline;
  blank.time = file.number(group + "/time");
  blank.punch_displacement = file.number(group + "/punch_displacement");
  blank.binder_position = file.number(group + "/binder_position");
  blank.position = read_rows<3>(file, group + "/position");
  blank.velocity = read_rows<3>(file, group + "/velocity");
  blank.tow_strain = read_rows<2>(file, group + "/tow_strain");
  const std::size_t nodes = shared.reference.size();
  bool whole =
      blank.position.size() == nodes && blank.velocity.size() == nodes && blank.tow_strain.size() == nodes;
  each_field(blank, [&](const char* name, std::vector<double>& field) {
    field = file.doubles(group + "/" + name);
    whole &= field.size() == nodes;
  });
  each_optional_field(blank, [&](const char* name, std::vector<double>& field) {
    if (!file.has(group + "/" + name)) return;
    field = file.doubles(group + "/" + name);
    whole &= field.size() == nodes;
  });
  if (!whole) throw Hdf5Error(group + " does not fit its blank");
  for (const auto& e : read_rows<6>(file, group + "/edge"))
    blank.edge.push_back({{e[0], e[1]}, {e[2], e[3], e[4]}, e[5]});
  return blank;
}

void write(Hdf5Writer& file, const std::string& group, const StampingCheckpoint& checkpoint) {
  file.write(group + "/step", checkpoint.step);
  write_state(file, group + "/state", checkpoint.state);
  write_history(file, group + "/row", {checkpoint.row});
  write_history(file, group + "/history", checkpoint.history);
  write_heat_rows(file, group + "/hold", checkpoint.hold);
  if (checkpoint.release) {
    write_history(file, group + "/release/row", {checkpoint.release->row});
    file.write(group + "/release/moved", checkpoint.release->moved);
  }
  file.write(group + "/peak_force_balance", checkpoint.peak_force_balance);
  file.write(group + "/peak_pressure", checkpoint.peak_pressure);
  file.write(group + "/peak_swing", checkpoint.peak_swing);
  file.write(group + "/falling_branch", checkpoint.falling_branch ? 1 : 0);
  if (checkpoint.patterns > 0) {
    file.write(group + "/patterns", checkpoint.patterns);
    file.write(group + "/pairing", checkpoint.pairing);
  }
  file.write(group + "/rejected_steps", checkpoint.rejected_steps);
  file.write(group + "/newton_iterations", checkpoint.newton_iterations);
  file.write(group + "/factorisations", checkpoint.factorisations);
  write_shared(file, group + "/blank", checkpoint.blank);
  write_instant(file, group + "/blank/now", checkpoint.blank);
}

StampingCheckpoint read_checkpoint(const Hdf5Reader& file, const std::string& group) {
  StampingCheckpoint checkpoint;
  checkpoint.step = file.integer(group + "/step");
  checkpoint.state = read_state(file, group + "/state");
  const auto row = read_history(file, group + "/row");
  if (row.size() != 1) throw Hdf5Error(group + "/row is no single row");
  checkpoint.row = row[0];
  checkpoint.history = read_history(file, group + "/history");
  checkpoint.hold = read_heat_rows(file, group + "/hold");
  if (file.has(group + "/release/moved")) {
    const auto released = read_history(file, group + "/release/row");
    if (released.size() != 1) throw Hdf5Error(group + "/release/row is no single row");
    checkpoint.release = Release{released[0], file.number(group + "/release/moved")};
  }
  checkpoint.peak_force_balance = file.number(group + "/peak_force_balance");
  checkpoint.peak_pressure = file.number(group + "/peak_pressure");
  checkpoint.peak_swing = file.number(group + "/peak_swing");
  checkpoint.falling_branch = file.integer(group + "/falling_branch") != 0;
  if (file.has(group + "/patterns")) {
    checkpoint.patterns = file.integer(group + "/patterns");
    checkpoint.pairing = file.number(group + "/pairing");
  }
  checkpoint.rejected_steps = file.integer(group + "/rejected_steps");
  checkpoint.newton_iterations = file.integer(group + "/newton_iterations");
  checkpoint.factorisations = file.integer(group + "/factorisations");
  const BlankState shared = read_shared(file, group + "/blank");
  checkpoint.blank = read_instant(file, group + "/blank/now", shared);
  return checkpoint;
}

std::string fault_of(const StampingCheckpoint& c, const Blank& blank, ContactSites sites, int steps,
                     const StateSizes& sizes) {
  const auto tools = static_cast<std::size_t>(sizes.tools);
  const auto loaded = static_cast<std::size_t>(sizes.unknowns_of_tools);
  const std::size_t nodes = static_cast<std::size_t>(blank.nodes());
  const auto contacts = static_cast<std::size_t>(contact_count(blank, sites));
  const std::size_t between = ply_points(blank).size(), with_faces = between + self_points(blank).size();
  // Faces of cells have a memory once the sheet has met itself.
  const bool met = sizes.self_contact && c.state.coupling.quad.size() == with_faces;
  const std::size_t rows_behind = between > 0 || met ? 1 : 0;
  const auto unknowns = static_cast<Eigen::Index>(3 * nodes + loaded);
  const bool fits = c.state.x.size() == unknowns && c.state.v.size() == unknowns &&
                    c.state.tool_z.size() == tools && c.state.corner_angle.size() == 4 * blank.quads.size() &&
                    c.state.memory.size() == tools + rows_behind &&
                    std::all_of(c.state.memory.begin(), c.state.memory.begin() + tools,
                                [&](const auto& m) { return m.size() == contacts; }) &&
                    (rows_behind == 0 || c.state.memory.back().size() == (met ? with_faces : between));
  if (!fits) return "its state is of another blank or other tools";
  if (c.step < 0 || c.step > steps || c.history.size() != static_cast<std::size_t>(c.step))
    return fmt::format("it stands at step {} with {} rows of history, and the run has {} steps", c.step,
                       c.history.size(), steps);
  if (!c.state.heat.empty() &&
      (c.state.heat.field.nodes() != nodes || c.state.heat.rate_factor.size() != blank.quads.size()))
    return "its temperatures are of another blank";
  if (!c.state.shear_memory.empty() && c.state.shear_memory.size() != c.state.corner_angle.size())
    return "its memory of shear is of another blank";
  if (c.blank.position.size() != nodes) return "its picture is of another blank";
  return "";
}

}  // namespace heddle::macroscale
