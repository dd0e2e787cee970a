#include "pipeline/study_command.h"

#include <cmath>
#include <iostream>
#include <optional>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include "core/hdf5_file.h"
#include "core/progress.h"
#include "core/sha256.h"
#include "core/units.h"
#include "mesoscale/forming.h"
#include "pipeline/cache.h"
#include "pipeline/case.h"
#include "pipeline/interrupt.h"
#include "pipeline/painter.h"
#include "pipeline/run_folder.h"
#include "pipeline/stage_keys.h"
#include "pipeline/stamping_study.h"

namespace heddle::pipeline {

namespace {

namespace study = mesoscale::study;

// ---- one cell and the cache

/// What the numbers of a cell depend on, as text.
std::string inputs_of_cell(const mesoscale::CellSpec& cell, const Case& a_case) {
  std::string text = "study cell\n" + mesoscale::describe(cell) + "\n";
  for (const double angle : a_case.study->shear_angles) text += shortest(angle) + " ";
  if (a_case.solid)
    for (const Key& key : schema())
      if (const Setting* setting = a_case.settings.find(key.path); key.stage == Stage::solid && setting)
        text += "\n" + key.path + " " + resolved_value(*setting);
  for (const auto& [name, hash] : source_hashes())
    if (name == "core" || name == "mesoscale" || name == "build") text += "\n" + name + " " + hash;
  return text + "\n" + processor_name();
}

std::string bytes_of(const study::CellProperties& properties, const std::string& key) {
  std::vector<double> values;
  for (const auto& row : properties.at) values.insert(values.end(), row.begin(), row.end());
  Hdf5Writer file;
  file.write("/key", key);
  file.write("/values", values, {properties.at.size(), study::properties().size()});
  return file.finish();
}

study::CellProperties read_cell(const Hdf5Reader& file) {
  const std::vector<double> values = file.doubles("/values");
  const std::size_t columns = study::properties().size();
  if (values.empty() || values.size() % columns != 0) throw Hdf5Error("/values has another size");
  study::CellProperties properties;
  for (auto row = values.begin(); row != values.end(); row += static_cast<std::ptrdiff_t>(columns))
    properties.at.emplace_back(row, row + static_cast<std::ptrdiff_t>(columns));
  return properties;
}

/// Computes cells one by one, says how far it is, and counts.
class CellWorker {
 public:
  CellWorker(const Case& a_case, const Cache& cache, std::size_t cells, bool quiet)
      : case_(a_case),
        cache_(cache),
        progress_("weaves", static_cast<int>(cells), progress_style_of_standard_error(quiet), std::cerr) {}

  study::CellProperties look_at(const mesoscale::CellSpec& cell) {
    const std::string key = sha256(inputs_of_cell(cell, case_));
    std::optional<study::CellProperties> found = cache_.find(key, read_cell);
    found ? ++reused_ : ++computed_;
    if (!found) {
      found = study::cell_properties(cell, case_.solid, case_.study->shear_angles);
      cache_.store(key, bytes_of(*found, key));
    }
    progress_.update(computed_ + reused_);
    return std::move(*found);
  }
  int computed() const { return computed_; }
  int reused() const { return reused_; }

 private:
  const Case& case_;
  const Cache& cache_;
  Progress progress_;
  int computed_ = 0, reused_ = 0;
};

// ---- the study

void look_at_points(CellStudyFindings& findings, const Case& a_case, CellWorker& worker, RunFolder& folder) {
  for (study::StudyPoint& point : study::points(*a_case.cell, *a_case.study)) {
    if (InterruptGuard::interrupted()) return;
    StudiedCell cell{std::move(point), {}};
    try {
      cell.properties = worker.look_at(cell.point.cell);
    } catch (const NumericalError& error) {  // one weave must not end the study
      cell.failure = error.what();
    }
    findings.cells.push_back(std::move(cell));
    folder.write("table.csv", study_table_csv(findings));
  }
}

void add_sensitivities(CellStudyFindings& findings, const Case& a_case, CellWorker& worker) {
  if (!a_case.study->sensitivities || !findings.cells.front().failure.empty()) return;
  const study::StudySpec& spec = *a_case.study;
  for (const study::Dimension dimension : study::dimensions) {
    const std::array<mesoscale::CellSpec, 4> cells = study::stencil(*a_case.cell, spec, dimension);
    std::array<study::CellProperties, 4> around;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      if (InterruptGuard::interrupted()) return;
      around[k] = worker.look_at(cells[k]);
    }
    const auto found =
        study::sensitivities(findings.cells.front().properties, around,
                             study::step_of(*a_case.cell, spec, dimension), dimension, spec.shear_angles);
    findings.sensitivities.insert(findings.sensitivities.end(), found.begin(), found.end());
  }
}

std::size_t cells_in(const Case& a_case) {
  return study::points(*a_case.cell, *a_case.study).size() + (a_case.study->sensitivities ? 12 : 0);
}

Case read_study(const RunOptions& options) {
  Case a_case = read_case(options.file, options.assignments);
  const bool of_stampings = stamping_study_of(a_case.settings).has_value();
  if (!a_case.study && !of_stampings)
    throw InputError({{"study.missing"_rule, "study", "", "is missing, and this command needs it",
                       "Add `study:` for unit cells, as configs/study_weave.yaml, or `stamping_study:`, as "
                       "configs/studies/paper.yaml.",
                       options.file.string()}});
  if (a_case.study && of_stampings)
    throw InputError({{"study.both"_rule, "stamping_study", "", "stands beside `study`",
                       "One file holds one study: leave one of the two out.", options.file.string()}});
  return a_case;
}

double length_of(const CellStudyFindings& findings, study::Dimension dimension) {
  const mesoscale::TowSpec warp = findings.base.weave.tow(0);
  switch (dimension) {
    case study::Dimension::tow_width:
      return warp.width;
    case study::Dimension::gap:
      return warp.gap;
    case study::Dimension::tow_thickness:
      break;
  }
  return warp.thickness;
}

void print(const CellStudyFindings& findings, const CellWorker& worker, const std::filesystem::path& folder) {
  if (!findings.sensitivities.empty()) {
    fmt::print("{:<28}{:>14}   change in % for 1 % of the tow width, the gap, the thickness\n", "property",
               "value");
    const auto& all = study::properties();
    for (std::size_t p = 0; p < all.size(); ++p) {
      std::string line;
      for (const study::Sensitivity& s : findings.sensitivities) {
        if (s.property != p || s.angle != findings.spec.shear_angles.front() || s.value == 0.0) continue;
        if (line.empty()) line = fmt::format("{:<28}{:>14.5g}", all[p].key, s.value * all[p].per_si);
        line += fmt::format("{:>10.3f}", s.relative(length_of(findings, s.dimension)));
      }
      if (!line.empty()) fmt::print("{}\n", line);
    }
  }
  fmt::print(
      "weaves               {} of the study, {} computed and {} reused with those of the differences\n",
      findings.cells.size(), worker.computed(), worker.reused());
  fmt::print("results              {}\n", folder.string());
}

// ---- files

std::string csv_number(double value, double per_si) {
  return std::isfinite(value) ? shortest(value * per_si) : "";
}

// Fractions are shown in per cent and kept as fractions.
double in_file(const study::Property& property) {
  return property.unit == "%" ? 1.0 : property.per_si;
}

bool is_shown(const CellStudyFindings& findings, const study::Property& property) {
  return findings.solid || !property.solid;
}

}  // namespace

std::string study_table_csv(const CellStudyFindings& findings) {
  std::string out = "case,pattern,tow_width_mm,gap_mm,tow_thickness_mm,shear_angle_deg";
  for (const study::Property& property : study::properties())
    if (is_shown(findings, property)) out += "," + property.key;
  out += ",failure\n";
  for (std::size_t c = 0; c < findings.cells.size(); ++c) {
    const StudiedCell& cell = findings.cells[c];
    for (std::size_t k = 0; k < findings.spec.shear_angles.size(); ++k) {
      out += fmt::format("{},{}", c, cell.point.pattern);
      for (const double length : cell.point.lengths) out += "," + shortest(1e3 * length);
      out += "," + shortest(degrees * findings.spec.shear_angles[k]);
      for (std::size_t p = 0; p < study::properties().size(); ++p) {
        const study::Property& property = study::properties()[p];
        if (is_shown(findings, property))
          out += "," + (cell.failure.empty() ? csv_number(cell.properties.at[k][p], in_file(property)) : "");
      }
      std::string failure = cell.failure;
      for (char& c_of : failure)
        if (c_of == ',' || c_of == '\n') c_of = ';';
      out += "," + failure + "\n";
    }
  }
  return out;
}

std::string study_table_h5(const CellStudyFindings& findings) {
  const std::size_t angles = findings.spec.shear_angles.size();
  Hdf5Writer file;
  std::string patterns;
  std::vector<int> number;
  std::array<std::vector<double>, 3> lengths;
  std::vector<double> angle;
  for (std::size_t c = 0; c < findings.cells.size(); ++c)
    for (std::size_t k = 0; k < angles; ++k) {
      number.push_back(static_cast<int>(c));
      patterns += findings.cells[c].point.pattern + "\n";
      for (std::size_t d = 0; d < 3; ++d) lengths[d].push_back(1e3 * findings.cells[c].point.lengths[d]);
      angle.push_back(degrees * findings.spec.shear_angles[k]);
    }
  file.write("/keys/case", std::span<const int>(number));
  file.write("/keys/pattern", patterns);
  for (const study::Dimension dimension : study::dimensions)
    file.write("/keys/" + study::name_of(dimension) + "_mm",
               std::span<const double>(lengths[static_cast<std::size_t>(dimension)]));
  file.write("/keys/shear_angle_deg", std::span<const double>(angle));
  for (std::size_t p = 0; p < study::properties().size(); ++p) {
    const study::Property& property = study::properties()[p];
    if (!is_shown(findings, property)) continue;
    std::vector<double> values;
    for (const StudiedCell& cell : findings.cells)
      for (std::size_t k = 0; k < angles; ++k)
        values.push_back(cell.failure.empty() ? cell.properties.at[k][p] * in_file(property) : std::nan(""));
    file.write("/results/" + property.key, std::span<const double>(values));
  }
  return file.finish();
}

std::string sensitivities_csv(const CellStudyFindings& findings) {
  std::string out =
      "property,length,shear_angle_deg,value,slope_per_mm,slope_error_per_mm,percent_per_percent,"
      "percent_per_percent_error\n";
  for (const study::Sensitivity& s : findings.sensitivities) {
    const study::Property& property = study::properties()[s.property];
    const double per_si = in_file(property), length = length_of(findings, s.dimension);
    const bool relative = s.value != 0.0;  // no share of nothing: shear flow at rest
    out += fmt::format(
        "{},{},{},{},{},{},{},{}\n", property.key, study::name_of(s.dimension), shortest(degrees * s.angle),
        shortest(s.value * per_si), shortest(1e-3 * s.slope * per_si), shortest(1e-3 * s.error * per_si),
        relative ? shortest(s.relative(length)) : "", relative ? shortest(s.relative_error(length)) : "");
  }
  return out;
}

int study_case(const RunOptions& options) {
  const Case a_case = read_study(options);
  if (!a_case.study) return study_stampings(options, a_case);
  std::optional<tbb::global_control> threads;
  if (options.threads > 0) threads.emplace(tbb::global_control::max_allowed_parallelism, options.threads);
  RunFolder folder(a_case, output_folder(options, a_case.name), options.force);
  const Cache cache(options.cache, [&](const std::string& line) { folder.log(line); });
  const InterruptGuard guard;
  CellStudyFindings findings{a_case.name, *a_case.cell, *a_case.study, a_case.solid.has_value(),
                             {},          {},           a_case.notes};
  CellWorker worker(a_case, cache, cells_in(a_case), options.quiet);
  folder.stage("study", [&](bool& reused) {
    look_at_points(findings, a_case, worker, folder);
    if (!findings.cells.empty()) add_sensitivities(findings, a_case, worker);
    reused = worker.computed() == 0;
    return 0;
  });
  if (InterruptGuard::interrupted()) {
    folder.write_log();
    std::cerr << fmt::format(
        "heddle: interrupted after {} of {} weaves; the same command goes on: those {} in the cache\n",
        worker.computed() + worker.reused(), cells_in(a_case), options.cache.empty() ? "would be" : "are");
    return exit_failed;
  }
  folder.write("table.h5", study_table_h5(findings));
  if (a_case.study->sensitivities) folder.write("sensitivities.csv", sensitivities_csv(findings));
  folder.write("report.html", cell_study_html(findings));
  folder.close(a_case, {{"study", case_hash(a_case)}});
  if (options.print) print(findings, worker, folder.path());
  int code = exit_done;
  for (const StudiedCell& cell : findings.cells)
    if (!cell.failure.empty()) {
      std::cerr << fmt::format("heddle: {} failed: {}\n", cell.point.pattern, cell.failure);
      code = exit_failed;
    }
  return code;
}

}  // namespace heddle::pipeline
