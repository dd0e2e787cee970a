// Voxel decks in the form in which TexGen exports them.
#include "mesoscale/solid/texgen_file.h"

#include <unistd.h>

#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "core/text_file.h"
#include "mesoscale/solid/homogenise.h"
#include "mesoscale/solid/solid_cell.h"
#include "sample_cells.h"
#include "tests/source_dir.h"

using namespace heddle::mesoscale::solid;
using namespace heddle::test;
namespace fs = std::filesystem;

namespace {

const fs::path data = fs::path(source_dir) / "tests/mesoscale/data";

VoxelFileSpec spec_of(const fs::path& deck, const fs::path& directions) {
  VoxelFileSpec spec;
  spec.format = VoxelFormat::texgen;
  spec.file = deck;
  spec.orientations = directions;
  spec.phases = {{0, {polypropylene.bulk(), polypropylene.shear()}}};
  spec.tow = chamis(glass, polypropylene, 0.6);
  return spec;
}

VoxelFileSpec plain() {
  return spec_of(data / "plain_texgen.inp", data / "plain_texgen.ori");
}

// Two files that hold a text each, gone when the test ends.
struct ScratchDeck {
  ScratchDeck(const std::string& deck, const std::string& directions)
      : folder(fs::temp_directory_path() / ("heddle-texgen-" + std::to_string(getpid()))) {
    fs::create_directories(folder);
    std::ofstream(folder / "cell.inp", std::ios::binary) << deck;
    std::ofstream(folder / "cell.ori", std::ios::binary) << directions;
  }
  ~ScratchDeck() {
    std::error_code ignored;  // a folder that stays behind is no failure of the test
    fs::remove_all(folder, ignored);
  }
  VoxelFileSpec spec() const { return spec_of(folder / "cell.inp", folder / "cell.ori"); }
  fs::path folder;
};

std::string replaced(std::string text, const std::string& before, const std::string& after) {
  const std::size_t at = text.find(before);
  REQUIRE(at != std::string::npos);
  return text.replace(at, before.size(), after);
}

// What is wrong with the plain weave's files after a change of either.
heddle::Problems problems_of(const std::string& deck, const std::string& directions) {
  return check(ScratchDeck(deck, directions).spec());
}

// A deck of 2 x 1 x 1 voxels: matrix, then a yarn. Elements may stand in any order.
std::string two_voxels() {
  return "*Heading\nmade by hand\n*Node\n"
         "1, 0, 0, 0\n2, 1, 0, 0\n3, 2, 0, 0\n4, 0, 2, 0\n5, 1, 2, 0\n6, 2, 2, 0\n"
         "7, 0, 0, 3\n8, 1, 0, 3\n9, 2, 0, 3\n10, 0, 2, 3\n11, 1, 2, 3\n12, 2, 2, 3\n"
         "*ELEMENT, TYPE=c3d8\n2, 3, 6, 5, 2, 9, 12, 11, 8\n1, 2, 5, 4, 1, 8, 11, 10, 7\n"
         "*ElSet, ElSet=Matrix, Generate\n1, 1, 1\n*Elset, elset=Yarn0\n2,\n";
}

}  // namespace

TEST_CASE("a deck of two voxels gives their places, sizes and directions", "[solid][texgen]") {
  const ScratchDeck files(two_voxels(), ", 1.0, 0.0, 0.0,   0.0, 1.0, 0.0\n2, 0, -3, 0,   1, 0, 0\n");
  VoxelFileSpec spec = files.spec();
  spec.length_unit = 0.1;
  const ReadVoxels read = read_voxels(spec);
  CHECK(read.cell.count == std::array{2, 1, 1});
  CHECK(read.cell.edges.diagonal().isApprox(Eigen::Vector3d(0.2, 0.2, 0.3), 1e-14));
  CHECK(read.cell.content == std::vector<std::uint16_t>{0, 1});
  REQUIRE(read.cell.contents.size() == 2);
  CHECK(read.cell.contents[1].portions[0].phase == 1);
  CHECK(read.cell.directions[read.cell.contents[1].portions[0].direction] == Eigen::Vector3d::UnitY());
}

TEST_CASE("a plain weave of TexGen's form is balanced and stiff along its yarns", "[solid][texgen]") {
  const ReadVoxels read = read_voxels(plain());
  CHECK(read.cell.count == std::array{12, 12, 6});
  CHECK(read.cell.edges.diagonal().isApprox(Eigen::Vector3d(10.78e-3, 10.78e-3, 1.5e-3), 1e-5));
  CHECK(phase_shares(read.cell, 2)[1] == Approx(512.0 / 864.0));
  const SolidResult result = analyse(plain(), {.tolerance = 1e-8});
  CHECK(result.thickness == Approx(1.5e-3));
  CHECK(imbalances(result).empty());
  const Matrix6& c = result.stack->stiffness;
  CHECK(c(0, 0) > 1.5 * c(2, 2));
  CHECK(c(0, 0) < result.stack->voigt(0, 0));
  // The same voxels with a tow that is the matrix: nothing but the places is left, and they do not matter.
  VoxelFileSpec one = plain();
  one.tow = {polypropylene.modulus, polypropylene.modulus, polypropylene.shear(), polypropylene.shear(),
             polypropylene.poisson};
  CHECK(gap(analyse(one).stack->stiffness, stiffness(polypropylene)) < 1e-9);
}

TEST_CASE("the order of nodes, elements and blocks in a deck does not matter", "[solid][texgen]") {
  const std::string deck = heddle::read_text_file(plain().file);
  // The first node last, and the matrix set before the elements.
  std::string turned = replaced(deck, "\n1, 0, 0, -0.75\n", "\n");
  turned = replaced(turned, "*Element, Type=C3D8R\n", "1, 0, 0, -0.75\n*Element, Type=C3D8R\n");
  const ScratchDeck files(turned, heddle::read_text_file(plain().orientations));
  CHECK(read_voxels(files.spec()).cell.content == read_voxels(plain()).cell.content);
}

TEST_CASE("a deck that is none is refused with the rule it breaks and the place", "[solid][texgen]") {
  const std::string deck = heddle::read_text_file(plain().file),
                    directions = heddle::read_text_file(plain().orientations);
  struct Broken {
    std::string deck, directions, id, text;
  };
  const std::vector<Broken> broken{
      {"", directions, "cell.voxels.file.deck", "has no elements"},
      {"*Node\n1, 0, 0\n", directions, "cell.voxels.file.deck", "line 2 reads \"1, 0, 0\""},
      {replaced(deck, "Type=C3D8R", "Type=C3D4"), directions, "cell.voxels.file.deck", "has c3d4 in line"},
      {replaced(deck, "\n2, 0.898333, 0, -0.75\n", "\n2, nan, 0, -0.75\n"), directions,
       "cell.voxels.file.deck", "nan"},
      {replaced(deck, "\n2, 0.898333, 0, -0.75\n", "\n"), directions, "cell.voxels.file.deck",
       "has no node 2"},
      {replaced(deck, "\n2, 0.898333, 0, -0.75\n", "\n2, 0.5, 0, -0.75\n"), directions,
       "cell.voxels.file.box", "not evenly spaced along x"},
      {replaced(deck, "\n1, 2, 15, 14, 1, 171, 184, 183, 170\n", "\n"), directions, "cell.voxels.file.box",
       "863 elements for 12 x 12 x 6 voxels"},
      {replaced(deck, "\n1, 2, 15, 14, 1, 171, 184, 183, 170\n", "\n1, 3, 16, 15, 2, 172, 185, 184, 171\n"),
       directions, "cell.voxels.file.box", "in the place of another one"},
      {replaced(deck, "\n1, 2, 15, 14, 1, 171, 184, 183, 170\n", "\n1, 2, 15, 14, 1, 171, 184, 183, 171\n"),
       directions, "cell.voxels.file.box", "element 1 is no voxel of it"},
      {replaced(deck, "ElSet=Yarn3", "ElSet=Other"), directions, "cell.voxels.file.sets",
       "128 of 864 are in none"},
      {replaced(deck, "*ElSet, ElSet=Yarn3\n", "*ElSet, ElSet=Yarn2\n1\n*ElSet, ElSet=Yarn3\n"), directions,
       "cell.voxels.file.sets", "element 1 is in two of them"},
      {deck, ", 1, 0, 0, 0, 1, 0\n", "cell.voxels.orientations.fibre", "has none of element"},
      {deck, "1, 1, 0, 0\n", "cell.voxels.orientations.fibre", "line 1 reads"},
  };
  for (const Broken& b : broken) {
    CAPTURE(b.id, b.text);
    const heddle::Problems problems = problems_of(b.deck, b.directions);
    REQUIRE(problems.size() == 1);
    CHECK(problems[0].id == b.id.c_str());
    CHECK_THAT(problems[0].rule, Catch::Matchers::Contains(b.text));
    CHECK_FALSE(problems[0].way_out.empty());
  }
}

TEST_CASE("constants of the yarns that no stable material has are refused, all problems at once",
          "[solid][texgen]") {
  VoxelFileSpec spec = plain();
  spec.tow.axial_poisson = 3.0;
  spec.phases.clear();
  const heddle::Problems problems = check(spec);
  REQUIRE(problems.size() == 2);
  CHECK(problems[0].id == "cell.phases.missing");
  CHECK(problems[1].id == "cell.tow.stable");
  CHECK_THROWS_AS(read_voxels(spec), heddle::InputError);
}
