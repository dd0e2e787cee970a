// The same net, strip and capstan by CalculiX: another code's large displacements and friction.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "tests/ccx_run.h"
#include "tests/macroscale/capstan.h"
#include "tests/macroscale/diagonal_net.h"
#include "tests/macroscale/hanging_strip.h"

using namespace heddle::test;

namespace {

// Tows and diagonals of n x n cells as springs, the rim driven as a picture frame in equal turns.
std::string net_deck(int n, double side, double k, double angle) {
  const auto node = [&](int i, int j) { return 1 + j * (n + 1) + i; };
  const auto at = [&](int i) { return side * (static_cast<double>(i) / n - 0.5); };
  std::string deck = "*NODE, NSET=ALL\n", frame = "*NSET, NSET=FRAME\n";
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) deck += fmt::format("{}, {}, {}, 0.\n", node(i, j), at(i), at(j));
  int element = 0;
  const auto spring = [&](int a, int b) { return fmt::format("{}, {}, {}\n", ++element, a, b); };
  deck += "*ELEMENT, TYPE=SPRINGA, ELSET=TOWS\n";
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      if (i < n) deck += spring(node(i, j), node(i + 1, j));
      if (j < n) deck += spring(node(i, j), node(i, j + 1));
    }
  deck += "*ELEMENT, TYPE=SPRINGA, ELSET=DIAGONALS\n";
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      deck += spring(node(i, j), node(i + 1, j + 1));
      deck += spring(node(i + 1, j), node(i, j + 1));
    }
  deck += fmt::format("*SPRING, ELSET=TOWS\n\n{:.3f}\n*SPRING, ELSET=DIAGONALS\n\n{:.3f}\n", 1e4 * k, k);
  const auto on_frame = [&](int i, int j) { return i == 0 || j == 0 || i == n || j == n; };
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      if (on_frame(i, j)) frame += fmt::format("{},\n", node(i, j));
  deck += frame + "*BOUNDARY\nALL, 3, 3, 0.\n";
  constexpr int steps = 6;
  for (int step = 1; step <= steps; ++step) {
    deck += "*STEP, NLGEOM, INC=200\n*STATIC\n1., 1.\n*CONTROLS, PARAMETERS=FIELD\n1e-8, 1e-8\n*BOUNDARY\n";
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        if (!on_frame(i, j)) continue;
        const Eigen::Vector3d from(at(i), at(j), 0.0);
        const Eigen::Vector3d by = in_frame(from, angle * step / steps) - from;
        deck += fmt::format("{0}, 1, 1, {1:.12e}\n{0}, 2, 2, {2:.12e}\n", node(i, j), by.x(), by.y());
      }
    deck += "*NODE PRINT, NSET=FRAME\nRF\n*END STEP\n";
  }
  return deck;
}

// A strip of quadratic bricks, one over width and thickness, clamped at x = 0, that hangs under its weight
// per area; set TIP is the middle of its end. nu = 0 makes the bricks a beam.
std::string strip_deck(double weight, int bricks) {
  using hanging_strip::length, hanging_strip::stiffness;
  constexpr double width = 0.01, thickness = 2e-3;
  const double modulus = 12.0 * stiffness / std::pow(thickness, 3);
  // Corners and middles of edges: at most one of the places in half bricks is odd.
  const auto node = [&](int i, int j, int k) { return 1 + 9 * i + 3 * j + k; };
  std::string deck = "*NODE, NSET=ALL\n", root = "*NSET, NSET=ROOT\n";
  for (int i = 0; i <= 2 * bricks; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) {
        if (i % 2 + j % 2 + k % 2 > 1) continue;
        deck += fmt::format("{}, {}, {}, {}\n", node(i, j, k), 0.5 * length * i / bricks, 0.5 * width * j,
                            0.5 * thickness * (k - 1));
        if (i == 0) root += fmt::format("{},\n", node(i, j, k));
      }
  constexpr int corner[8][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0},
                                {0, 0, 2}, {2, 0, 2}, {2, 2, 2}, {0, 2, 2}};
  constexpr int edge[12][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                               {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  deck += "*ELEMENT, TYPE=C3D20, ELSET=STRIP\n";
  for (int e = 0; e < bricks; ++e) {
    deck += fmt::format("{}", e + 1);
    for (const auto& [i, j, k] : corner) deck += fmt::format(", {}", node(2 * e + i, j, k));
    int on_line = 8;
    for (const auto& [a, b] : edge) {
      if (++on_line == 15) deck += ",\n ";
      const auto& p = corner[a];
      const auto& q = corner[b];
      deck += fmt::format("{}{}", on_line == 15 ? "" : ", ",
                          node(2 * e + (p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2));
    }
    deck += "\n";
  }
  return deck + root + fmt::format("*NSET, NSET=TIP\n{}\n", node(2 * bricks, 0, 1)) +
         fmt::format("*MATERIAL, NAME=STRIP\n*ELASTIC\n{}, 0.\n*DENSITY\n{:.12e}\n", modulus,
                     weight / thickness) +
         "*SOLID SECTION, ELSET=STRIP, MATERIAL=STRIP\n*BOUNDARY\nROOT, 1, 3\n"
         "*STEP, NLGEOM, INC=500\n*STATIC\n0.02, 1.\n*DLOAD\nSTRIP, GRAV, 1., 0., 0., -1.\n"
         "*NODE PRINT, NSET=TIP\nU\n*END STEP\n";
}

// A belt of bricks, one over width and thickness, laid over a fixed cylinder by a quarter turn with straight
// tails [N, mm]; its near end (NSLACK) carries 10 N, its far end (NTIGHT) is drawn 0.25 mm along its tangent,
// and then by five times 0.01 mm. Mortar contact: penalty contact of faceted cylinders is 3 to 13 % off.
struct BeltDeck {
  static constexpr double radius = 50.0, thickness = 0.1, width = 1.0, tail = 8.0, depth = 5.0, load = 10.0;
  int arc;  ///< bricks over the quarter turn
  double mu;

  std::string text() const {
    const double turn = 0.5 * std::numbers::pi / arc;
    const int tails = std::max(2, static_cast<int>(std::ceil(tail / (radius * turn))));
    const int over = static_cast<int>(std::ceil(0.105 / turn));  // 6 deg of cylinder beyond either end
    const int belt = arc + 2 * tails, cylinder = arc + 2 * over;
    std::string deck = "*NODE, NSET=ALL\n";
    const auto add_nodes = [&](int first, int count, double z_low, double z_high, const auto& place) {
      for (int i = 0; i <= count; ++i)
        for (int j = 0; j < 2; ++j)
          for (int k = 0; k < 2; ++k) {
            const auto [x, y] = place(i, j);
            deck += fmt::format("{}, {:.12g}, {:.12g}, {:.12g}\n", first + 4 * i + 2 * j + k, x, y,
                                k == 0 ? z_low : z_high);
          }
    };
    using Place = std::array<double, 2>;
    add_nodes(1, belt, 0.0, width, [&](int i, int j) -> Place {
      const double r = radius + j * thickness;
      if (i <= tails) return {r, -tail * (tails - i) / tails};
      if (i >= tails + arc) return {-tail * (i - tails - arc) / tails, r};
      return {r * std::cos((i - tails) * turn), r * std::sin((i - tails) * turn)};
    });
    const int first = 1 + 4 * (belt + 1);
    add_nodes(first, cylinder, -0.5 * width, 1.5 * width, [&](int i, int j) -> Place {
      const double r = radius - depth * (1 - j), angle = (i - over) * turn;
      return {r * std::cos(angle), r * std::sin(angle)};
    });
    int element = 0;
    const auto add_bricks = [&](const char* type, const char* name, int from, int count) {
      deck += fmt::format("*ELEMENT, TYPE={}, ELSET={}\n", type, name);
      for (int e = 0; e < count; ++e) {
        const auto n = [&](int i, int j, int k) { return from + 4 * (e + i) + 2 * j + k; };
        deck += fmt::format("{}, {}, {}, {}, {}, {}, {}, {}, {}\n", ++element, n(0, 0, 0), n(0, 1, 0),
                            n(1, 1, 0), n(1, 0, 0), n(0, 0, 1), n(0, 1, 1), n(1, 1, 1), n(1, 0, 1));
      }
    };
    add_bricks("C3D8I", "BELT", 1, belt);
    add_bricks("C3D8", "CYLINDER", first, cylinder);
    const auto set = [&](const char* name, int from, int to) {
      deck += fmt::format("*NSET, NSET={}, GENERATE\n{}, {}\n", name, from, to);
    };
    set("NBELT", 1, first - 1);
    set("NCYL", first, first + 4 * cylinder + 3);
    set("NTIGHT", first - 4, first - 1);
    deck += "*SURFACE, NAME=SBELT, TYPE=ELEMENT\n";
    for (int e = tails; e <= tails + arc + 1; ++e) deck += fmt::format("{}, S6\n", e);
    deck += "*SURFACE, NAME=SCYL, TYPE=ELEMENT\n";
    for (int e = 1; e <= cylinder; ++e) deck += fmt::format("{}, S4\n", belt + e);
    deck +=
        "*MATERIAL, NAME=BELT\n*ELASTIC\n1e5, 0.\n*MATERIAL, NAME=STEEL\n*ELASTIC\n210000., 0.3\n"
        "*SOLID SECTION, ELSET=BELT, MATERIAL=BELT\n*SOLID SECTION, ELSET=CYLINDER, MATERIAL=STEEL\n"
        "*SURFACE INTERACTION, NAME=RUB\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e4\n";
    if (mu > 0.0) deck += fmt::format("*FRICTION\n{}, 1000.\n", mu);
    deck +=
        "*CONTACT PAIR, INTERACTION=RUB, TYPE=MORTAR\nSBELT, SCYL\n*BOUNDARY\nNCYL, 1, 3, 0.\nNBELT, 3, 3, "
        "0.\n"
        "*STEP, NLGEOM, INC=1000\n*STATIC\n0.1, 1., 1e-6, 0.25\n*BOUNDARY\nNTIGHT, 1, 1, -0.25\n*CLOAD\n";
    for (int n = 1; n <= 4; ++n) deck += fmt::format("{}, 2, {}\n", n, -0.25 * load);
    return deck +
           "*END STEP\n*STEP, NLGEOM, INC=1000\n*STATIC\n0.2, 1., 1e-6, 0.2\n*BOUNDARY\nNTIGHT, 1, 1, -0.3\n"
           "*NODE PRINT, NSET=NTIGHT\nRF\n*END STEP\n";
  }

  double ratio() const {
    double drawn = 0.0;
    for (const auto& [node, force] : last_table(run_ccx(text()), "forces (fx,fy,fz)")) drawn -= force[0];
    return drawn / load;
  }
};

}  // namespace

TEST_CASE("V6: CalculiX's belt over a cylinder carries what the strip does, and exp(mu theta)",
          "[macroscale][verification][ccx]") {
  if (!ccx_is_there()) return;
  constexpr double mu = 0.3, wrap = 0.5 * std::numbers::pi;
  // Friction acts on the belt's face, tension in its middle.
  const double lever = BeltDeck::radius / (BeltDeck::radius + 0.5 * BeltDeck::thickness);
  const double theirs = BeltDeck{20, mu}.ratio(), exact = std::exp(mu * wrap),
               ours = capstan_ratio(coulomb(mu), wrap, 20, ContactSites::nodes);
  WARN("V6 T2/T1: CalculiX " << theirs << " (exp(mu theta R / (R + t/2)) = " << std::exp(mu * wrap * lever)
                             << "), ours " << ours << ", exp(mu theta) " << exact);
  CHECK(theirs == Approx(std::exp(mu * wrap * lever)).epsilon(1e-3));
  CHECK(ours == Approx(theirs).epsilon(2e-3));
  CHECK(BeltDeck{20, 0.0}.ratio() == Approx(1.0).epsilon(1e-3));
}

TEST_CASE("V3: CalculiX's net of springs asks for the torque of ours in the picture frame",
          "[macroscale][verification][ccx]") {
  if (!ccx_is_there()) return;
  constexpr int n = 10;
  constexpr double k = 200.0, side = 0.1, angle = 0.6;
  const Vectors force = last_table(run_ccx(net_deck(n, side, k, angle)), "forces (fx,fy,fz)");
  REQUIRE(force.size() == 4 * n);
  // Power of the reactions over the rate of the angle.
  double torque = 0.0;
  for (const auto& [node, f] : force) {
    const Eigen::Vector3d from(side * ((node - 1) % (n + 1) / static_cast<double>(n) - 0.5),
                               side * ((node - 1) / (n + 1) / static_cast<double>(n) - 0.5), 0.0);
    constexpr double h = 1e-6;
    const Eigen::Vector3d rate = (in_frame(from, angle + h) - in_frame(from, angle - h)) / (2.0 * h);
    torque += f[0] * rate.x() + f[1] * rate.y();
  }
  const double ours = frame_torque(diagonal_net(k), side, side / n, 0.0, angle);
  WARN("V3 torque: CalculiX " << torque << ", ours " << ours << " N m");
  CHECK(ours == Approx(torque).epsilon(1e-4));
}

TEST_CASE("V9: CalculiX's bricks hang as far as the strip does, and as the elastica",
          "[macroscale][verification][ccx]") {
  if (!ccx_is_there()) return;
  using namespace hanging_strip;
  const double weight = 10.0 * stiffness / std::pow(length, 3);  // the tip sags by 70 % of the length
  const auto [node, u] = *last_table(run_ccx(strip_deck(weight, 40)), "displacements (vx,vy,vz)").begin();
  const Tip theirs{-u[2], -u[0]}, exact = elastica(weight);
  const Tip coarse = strip_under_weight(weight, 20, 4), fine = strip_under_weight(weight, 40, 4);
  // Ours is of second order in the spacing.
  const Tip ours{fine.down + (fine.down - coarse.down) / 3.0,
                 fine.inwards + (fine.inwards - coarse.inwards) / 3.0};
  WARN("V9 tip down, inwards: CalculiX " << 1e3 * theirs.down << ", " << 1e3 * theirs.inwards << "; ours "
                                         << 1e3 * ours.down << ", " << 1e3 * ours.inwards << "; elastica "
                                         << 1e3 * exact.down << ", " << 1e3 * exact.inwards << " mm");
  CHECK(ours.down == Approx(theirs.down).epsilon(0.002));
  CHECK(ours.inwards == Approx(theirs.inwards).epsilon(0.005));
}
