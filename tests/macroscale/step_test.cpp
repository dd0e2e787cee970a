#include <fcntl.h>
#include <unistd.h>
#include <catch2/catch.hpp>
#include <iterator>
#include <numbers>
#include <random>

#include "macroscale/cad.h"
#include "macroscale/mesh_distance.h"
#include "macroscale/tool_band.h"
#include "macroscale/tool_file.h"
#include "macroscale/tool_set.h"
#include "tests/macroscale/sample_meshes.h"
#include "tests/source_dir.h"

using namespace heddle;
using namespace heddle::macroscale;
using namespace heddle::test;

namespace {

constexpr double pi = std::numbers::pi;
const std::filesystem::path shipped = std::filesystem::path(source_dir) / "configs/tools";
const double expected_chord_error = SurfaceResolution{}.chord_error;
const Expectation expected{"tools.punch", {0.32, 0.32}, 0.07};

std::string contents(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

ToolFile tool(const std::filesystem::path& file, double mesh_size = 6e-3) {
  ToolFile result;
  result.file = file;
  result.mesh_size = mesh_size;
  return result;
}

/// Material that a fillet takes from the edge of a round opening: the square less the quarter disc, turned
/// around the axis (Pappus).
double fillet_volume(double opening, double r) {
  const double square = r * r * 2.0 * pi * (opening + 0.5 * r);
  const double disc = 0.25 * pi * r * r * 2.0 * pi * (opening + r - 4.0 * r / (3.0 * pi));
  return square - disc;
}

}  // namespace

TEST_CASE("the shipped STEP files are what their script makes", "[macroscale][step]") {
  const Folder folder;
  struct Shape {
    const char* name;
    double volume;
    std::array<double, 3> low, high;
  };
  const double ring = 0.4 * 0.4;
  const std::vector<Shape> shapes{{"punch.step",
                                   pi * (2.0 / 3.0 * std::pow(0.07, 3) + 0.07 * 0.07 * 0.1),
                                   {-0.07, -0.07, 0},
                                   {0.07, 0.07, 0.17}},
                                  {"die.step",
                                   0.1 * (ring - pi * 0.072 * 0.072) - fillet_volume(0.072, 0.02),
                                   {-0.2, -0.2, -0.1},
                                   {0.2, 0.2, 0}},
                                  {"binder.step",
                                   0.04 * (ring - pi * 0.092 * 0.092) - fillet_volume(0.092, 0.002),
                                   {-0.2, -0.2, 0},
                                   {0.2, 0.2, 0.04}}};
  for (int i = 0; i < 3; ++i) {
    const Shape& shape = shapes[i];
    INFO(shape.name);
    write_step(shipped / "make_tools.geo", i + 1, folder / shape.name);
    const CadSummary fresh = summarise_step(folder / shape.name), kept = summarise_step(shipped / shape.name);
    CHECK(kept.solids == 1);
    CHECK(fresh.volume == Approx(kept.volume).epsilon(1e-9));
    CHECK(kept.volume == Approx(shape.volume).epsilon(1e-9));
    for (int c = 0; c < 3; ++c) {
      CHECK(std::abs(fresh.low[c] - kept.low[c]) < 1e-12);
      CHECK(std::abs(fresh.high[c] - kept.high[c]) < 1e-12);
      CHECK(std::abs(kept.low[c] - shape.low[c]) < 1e-9);  // OpenCASCADE widens boxes by 1e-7 mm
      CHECK(std::abs(kept.high[c] - shape.high[c]) < 1e-9);
    }
    const std::string text = contents(shipped / shape.name);
    CHECK(text.find("2000-01-01T00:00:00") != std::string::npos);
    CHECK(text.find('/') == std::string::npos);  // no path
    CHECK(text.size() < 50000);
  }
}

TEST_CASE("the double dome's and the tetrahedron's STEP files are what their scripts make",
          "[macroscale][step]") {
  const Folder folder;
  struct Tool {
    const char *script, *name;
    int number;
  };
  for (const Tool& tool : {Tool{"double_dome.geo", "double_dome_punch.step", 1},
                           {"double_dome.geo", "double_dome_die.step", 2},
                           {"double_dome.geo", "double_dome_binder.step", 3},
                           {"tetrahedron.geo", "tetrahedron_punch.step", 1},
                           {"tetrahedron.geo", "tetrahedron_die.step", 2}}) {
    INFO(tool.name);
    write_step(shipped / tool.script, tool.number, folder / tool.name);
    const CadSummary fresh = summarise_step(folder / tool.name), kept = summarise_step(shipped / tool.name);
    CHECK(kept.solids == 1);
    CHECK(fresh.volume == Approx(kept.volume).epsilon(1e-9));
    for (int c = 0; c < 3; ++c) {
      CHECK(std::abs(fresh.low[c] - kept.low[c]) < 1e-12);
      CHECK(std::abs(fresh.high[c] - kept.high[c]) < 1e-12);
    }
  }
  // The binder's opening: a stadium of radius 70 mm about two axes 110 mm apart, its edge rounded by 3 mm.
  const double r = 0.07, fillet = 0.003, apart = 0.11;
  const double opening = pi * r * r + 2.0 * r * apart;
  const double straight = 2.0 * apart * fillet * fillet * (1.0 - 0.25 * pi);
  CHECK(summarise_step(shipped / "double_dome_binder.step").volume ==
        Approx(0.03 * (0.44 * 0.32 - opening) - fillet_volume(r, fillet) - straight).epsilon(1e-9));
}

TEST_CASE("a STEP tool becomes a closed mesh that follows its surface", "[macroscale][step]") {
  const LoadedTool punch = load_tool(tool(shipped / "punch.step", 5e-3), expected);
  const double edge = edge_length({5e-3, expected_chord_error}, 0.07);
  CHECK(edge < 5e-3);
  const double bound = edge * edge / (2.0 * 0.07);  // edges up to twice as long as asked for
  CHECK(mesh_volume(punch.mesh) ==
        Approx(pi * (2.0 / 3.0 * std::pow(0.07, 3) + 0.07 * 0.07 * 0.1)).epsilon(2e-3));
  double worst_vertex = 0.0, worst_facet = 0.0;
  int below = 0;
  for (const auto& t : punch.mesh.triangles) {
    const auto radius = [](double x, double y, double z) { return std::hypot(x, y, z - 0.07); };
    std::array<double, 3> centre{};
    bool on_sphere = true;
    for (int vertex : t) {
      const auto& p = punch.mesh.vertices[vertex];
      on_sphere = on_sphere && p[2] < 0.07 + 1e-9;
      for (int c = 0; c < 3; ++c) centre[c] += p[c] / 3.0;
    }
    if (!on_sphere) continue;
    ++below;
    for (int vertex : t) {
      const auto& p = punch.mesh.vertices[vertex];
      worst_vertex = std::max(worst_vertex, std::abs(radius(p[0], p[1], p[2]) - 0.07));
    }
    worst_facet = std::max(worst_facet, 0.07 - radius(centre[0], centre[1], centre[2]));
  }
  CHECK(below > 1000);
  CHECK(worst_vertex < 1e-9);
  CHECK(worst_facet < bound);
  CHECK(worst_facet > 0.1 * bound);

  const TriangleMesh again = read_tool(tool(shipped / "punch.step", 20e-3), expected);
  const TriangleMesh once_more = read_tool(tool(shipped / "punch.step", 20e-3), expected);
  CHECK(again.vertices == once_more.vertices);
  CHECK(again.triangles == once_more.triangles);

  const MeshDistance distance(punch.mesh);
  CHECK(std::abs(distance.signed_distance({0, 0, -0.01}) - 0.01) < 1e-9);
  CHECK(distance.signed_distance({0, 0, 0.05}) < 0.0);
}

TEST_CASE("edges follow the radius of a fillet", "[macroscale][step]") {
  ToolFile die = tool(shipped / "die.step", 20e-3);
  const LoadedTool loaded = load_tool(die, expected);
  // On the fillet: torus of radius 20 mm around the circle of radius 92 mm at z = -20 mm.
  double worst = 0.0;
  int on_fillet = 0;
  for (const auto& t : loaded.mesh.triangles) {
    std::array<double, 3> centre{};
    bool all = true;
    for (int vertex : t) {
      const auto& p = loaded.mesh.vertices[vertex];
      all = all && std::abs(std::hypot(std::hypot(p[0], p[1]) - 0.092, p[2] + 0.02) - 0.02) < 1e-7 &&
            p[2] > -0.02 - 1e-9 && std::hypot(p[0], p[1]) < 0.092 + 1e-9;
      for (int c = 0; c < 3; ++c) centre[c] += p[c] / 3.0;
    }
    if (!all) continue;
    ++on_fillet;
    worst = std::max(worst,
                     std::abs(std::hypot(std::hypot(centre[0], centre[1]) - 0.092, centre[2] + 0.02) - 0.02));
  }
  CHECK(on_fillet > 500);
  CHECK(worst < expected_chord_error);
  CHECK(worst > 0.1 * expected_chord_error);
}

TEST_CASE("the bands of the shipped tools hold the exact distance to their meshes, smoothed over a voxel",
          "[macroscale][step][tool_band][slow]") {
  StampingSpec spec;
  spec.blank.size = {0.32, 0.32};
  spec.process.stroke = 0.07;
  const auto check_tool = [&](const char* name, Role role, double rms_limit, double max_limit) {
    const LoadedTool loaded = load_tool(tool(shipped / name, 2e-3), expected);
    const Box reach = reach_of_fabric(spec, role, loaded.mesh);
    const double half_width = required_half_width(0.7e-3, 1.5e-3, 2e-3);
    const ToolBand band =
        tool_band(loaded.mesh, {.voxel = 1e-3, .half_width = half_width, .region = reach}, "tools.punch");
    const MeshDistance exact(loaded.mesh);
    // About the vertices, which are densest where the surface curves, as far off as the fabric gets.
    std::mt19937 random(5);
    std::uniform_int_distribution<std::size_t> any(0, loaded.mesh.vertices.size() - 1);
    std::uniform_real_distribution<double> off(-1e-3, 1e-3);
    double sum = 0.0, worst = 0.0;
    int count = 0;
    for (int n = 0; n < 20000; ++n) {
      const auto& v = loaded.mesh.vertices[any(random)];
      const Eigen::Vector3d x(v[0] + off(random), v[1] + off(random), v[2] + off(random));
      if (x.z() < reach.low[2] || x.z() > reach.high[2] || x.head<2>().cwiseAbs().maxCoeff() > 0.16) continue;
      const double error = evaluate(band, x).distance - exact.signed_distance({x.x(), x.y(), x.z()});
      sum += error * error;
      worst = std::max(worst, std::abs(error));
      ++count;
    }
    const double rms = std::sqrt(sum / count);
    WARN(fmt::format("{}: {} places, rms {:.2f} um, largest {:.1f} um", name, count, 1e6 * rms, 1e6 * worst));
    CHECK(count > 2000);
    CHECK(rms < rms_limit);
    CHECK(worst < max_limit);
  };
  check_tool("punch.step", Role::punch, 2e-6, 10e-6);
  check_tool("die.step", Role::die, 3e-6, 25e-6);
  check_tool("binder.step", Role::binder, 10e-6, 100e-6);
}

TEST_CASE("standard output stays clean while OpenCASCADE works", "[macroscale][step]") {
  const Folder folder;
  std::fflush(stdout);
  const int saved = ::dup(STDOUT_FILENO);
  const int file = ::open((folder / "out.txt").c_str(), O_WRONLY | O_CREAT, 0600);
  ::dup2(file, STDOUT_FILENO);
  const std::string punch = contents(shipped / "punch.step");
  const auto broken = folder.write(
      "broken.step", replaced(punch, "MANIFOLD_SOLID_BREP('',#16)", "MANIFOLD_SOLID_BREP('',#99999)"));
  const Problems problems = refusal([&] { load_tool(tool(broken), expected); });
  CHECK_NOTHROW(summarise_step(shipped / "punch.step"));
  std::fputs("after\n", stdout);
  std::fflush(stdout);
  ::dup2(saved, STDOUT_FILENO);
  ::close(saved);
  ::close(file);
  CHECK(contents(folder / "out.txt") == "after\n");
  INFO(format(problems));
  CHECK_FALSE(problems.empty());
}

TEST_CASE("the unit a STEP file states must be the one the case states", "[macroscale][step]") {
  const Folder folder;
  const std::string punch = contents(shipped / "punch.step");
  ToolFile file = tool(shipped / "punch.step");
  file.length_unit = 1.0;
  CHECK(names(refusal([&] { read_tool(file, expected); }), "tools.punch.length_unit.stated",
              {"punch.step states: mm", "Write length_unit: mm"}));

  file = tool(folder.write("metre.step", replaced(punch, "SI_UNIT(.MILLI.,.METRE.)", "SI_UNIT($,.METRE.)")));
  CHECK(names(refusal([&] { read_tool(file, expected); }), "tools.punch.length_unit.stated",
              {"metre.step states: m", "Write length_unit: m,"}));
  // A punch of 70 m: the unit agrees now, the size does not. It is refused before it is cut into millions of
  // triangles.
  file.length_unit = 1.0;
  const Problems large = refusal([&] { read_tool(file, expected); });
  INFO(format(large));
  CHECK(names(large, "tools.punch.length_unit.size", {"length_unit: mm would make it 140 x 140 x 170 mm"}));

  const std::string inch =
      replaced(punch, "( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.) );",
               "( CONVERSION_BASED_UNIT('INCH',#9001) LENGTH_UNIT() NAMED_UNIT(#9003) );\n"
               "#9001 = LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#9002);\n"
               "#9002 = ( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.) );\n"
               "#9003 = DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);");
  file = tool(folder.write("inch.step", inch));
  CHECK(names(refusal([&] { read_tool(file, expected); }), "tools.punch.length_unit.stated",
              {"inch.step states: in"}));

  file = tool(folder.write("none.step",
                           replaced(punch, "GLOBAL_UNIT_ASSIGNED_CONTEXT", "GLOBAL_UNIT_FORGOTTEN_CONTEXT")));
  CHECK(names(refusal([&] { read_tool(file, expected); }), "tools.punch.file.unit",
              {"must state its length unit"}));
}

TEST_CASE("STEP files that cannot be meshed are refused with the reason", "[macroscale][step]") {
  const Folder folder;
  const std::string punch = contents(shipped / "punch.step");
  const auto cut = folder.write("cut.step", punch.substr(0, punch.size() / 2));
  CHECK(names(refusal([&] { read_tool(tool(cut), expected); }), "tools.punch.file.cut_off",
              {"END-ISO-10303-21"}));
  const auto large = folder.write("large.step", punch);
  std::filesystem::resize_file(large, 65u << 20);
  CHECK(names(refusal([&] { read_tool(tool(large), expected); }), "tools.punch.file.size",
              {"at most 64 MB; it has 65"}));
  const auto coarse = tool(shipped / "punch.step", 0.2);
  CHECK(names(refusal([&] { read_tool(coarse, expected); }), "tools.punch.mesh_size.cad",
              {"half the tool's largest extent (170 mm)"}));
  const auto fine = tool(shipped / "punch.step", 1e-5);
  CHECK(names(refusal([&] { read_tool(fine, expected); }), "tools.punch.mesh_size.cad",
              {"at most 2000000 triangles"}));
}

TEST_CASE("gmsh and CGAL stay behind the files that wall them off", "[macroscale][layout]") {
  const std::vector<std::pair<std::string, std::vector<std::string>>> walls{
      {"#include <gmsh", {"macroscale/cad.cpp"}},
      {"#include <CGAL/",
       {"macroscale/mesh_predicates.cpp", "macroscale/mesh_distance.cpp", "macroscale/outline.cpp"}}};
  const std::filesystem::path source = source_dir;
  int seen = 0;
  for (const char* room : {"core", "friction", "mesoscale", "macroscale", "pipeline"}) {
    for (const auto& entry : std::filesystem::directory_iterator(source / room)) {
      if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
      const std::string name = std::filesystem::relative(entry.path(), source).generic_string();
      const std::string text = contents(entry.path());
      for (const auto& [line, files] : walls) {
        if (text.find(line) == std::string::npos) continue;
        INFO(name << " has " << line);
        CHECK(std::find(files.begin(), files.end(), name) != files.end());
        ++seen;
      }
    }
  }
  CHECK(seen == 4);
}
