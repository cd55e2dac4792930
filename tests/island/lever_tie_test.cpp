// Ties on long arms and light links, and ties that say the same twice.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "island/tie_laws.h"
#include "simulation/simulated_run.h"
#include "support/rounds.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using test::body;
using test::box;
using test::energy_of;
using test::run;
using test::simulator;
using test::tie_settings;

const std::string kFree = R"(, "dynamics": {})";

/// [m]  How far a point of a body gets from a place.
double farthest(const std::vector<RunStep>& steps, std::size_t b, const Vector3d& p_B,
                const Vector3d& place) {
  double most = 0.0;
  for (const RunStep& step : steps) {
    const Pose& X = step.bodies[b].X_WB;
    most = std::max(most, (X.position + X.rotation * p_B - place).norm());
  }
  return most;
}

/// [N]  The greatest force of a tie.
double greatest_force(const std::vector<RunStep>& steps, std::size_t tie) {
  double most = 0.0;
  for (const RunStep& step : steps) {
    most = std::max(most, step.ties[tie].force.norm());
  }
  return most;
}

// The arm is at least a hundred times the cube's radius of gyration: impulses turn the cube, and
// move it little.
TEST(LeverTie, ASmallCubeSwingsOnALongArm) {
  for (const std::string size : {"0.1", "0.05", "0.02", "0.01"}) {
    Simulator s = simulator(
        body("bob", box("[" + size + ", " + size + ", " + size + "]"), "[1, 0, 0]", kFree),
        tie_settings(0.01, R"({"type": "pin", "bodies": [null, "bob"],
                                         "points": [[0, 0, 0], null]})"));
    const std::vector<RunStep> steps = run(s, 128);
    EXPECT_LE(farthest(steps, 0, {-1, 0, 0}, Vector3d::Zero()), 1e-8) << size;
    const double weight = std::pow(std::stod(size), 3) * 1000.0 * 9.81;  // [N]
    EXPECT_NEAR(energy_of(steps.back()), energy_of(steps.front()), 1e-4 * weight) << size;
  }
}

// A rod of a thousandth of its load holds the load, and keeps the energy.
TEST(LeverTie, ALightRodHoldsALoad) {
  Simulator s = simulator(
      body("rod", box("[0.1, 0.1, 0.1]"), "[0.5, 0, 0]", R"(, "dynamics": {"mass": 1e-3})") + ", " +
          body("load", box("[0.1, 0.1, 0.1]"), "[1, 0, 0]", R"(, "dynamics": {"mass": 1})"),
      tie_settings(0.01, R"({"type": "pin", "bodies": [null, "rod"], "points": [[0, 0, 0], null]},
                            {"type": "pin", "bodies": ["rod", "load"],
                             "points": [[0.25, 0, 0], null]})"));
  const std::vector<RunStep> steps = run(s, 100);
  EXPECT_LE(farthest(steps, 0, {-0.5, 0, 0}, Vector3d::Zero()), 1e-6);
  // The energy at the start is 7.4 J.
  EXPECT_LE(std::abs(energy_of(steps.back()) - energy_of(steps.front())), 0.05);
}

// Guesses of their forces turn such links without end; shorter plans find them.
TEST(LeverTie, LightLinksHoldALoad) {
  const auto link_at = [](const std::string& name, double x, double mass) {
    return body(name, box("[0.18, 0.04, 0.04]"), test::numbers({x, 0, 0}),
                R"(, "dynamics": {"mass": )" + test::number_text(mass) + "}");
  };
  // Links touch where they turn far; that is of no interest here.
  const std::string ties = R"({"type": "pin", "bodies": [null, "a"], "points": [[0, 0, 0], null]},
      {"type": "pin", "bodies": ["a", "b"], "points": [[0.1, 0, 0], [-0.1, 0, 0]]},
      {"type": "pin", "bodies": ["b", "c"], "points": [[0.1, 0, 0], [-0.1, 0, 0]]})";
  Simulator s = simulator(
      link_at("a", 0.1, 1e-3) + ", " + link_at("b", 0.3, 1e-3) + ", " + link_at("c", 0.5, 1.0),
      tie_settings(0.01, ties));
  const std::vector<RunStep> steps = run(s, 20);
  EXPECT_LE(farthest(steps, 0, {-0.1, 0, 0}, Vector3d::Zero()), 1e-6);
  EXPECT_NEAR(energy_of(steps.back()), energy_of(steps.front()), 1e-3);
}

// A limit: a heavy last body loses energy where the others snap through a line, and gains none.
TEST(LeverTie, LightLinksThatSnapUnderALoadLoseLittleAndGainNothing) {
  const auto link = [](const std::string& name, const Vector3d& p, double angle, double mass) {
    return R"({"name": ")" + name +
           R"(", "shape": {"sphere": {"radius": 0.01}}, "pose": {"position": )" +
           test::numbers({p.x(), p.y(), p.z()}) + R"(, "rpy": )" +
           test::numbers({0.0, angle, 0.0}) + R"(}, "dynamics": {"mass": )" +
           test::number_text(mass) + R"(, "centre_of_mass": [0, 0, 0], "inertia": [)" +
           test::numbers({0.02 * mass, 0.0, 0.0}) + ", " + test::numbers({0.0, 0.02 * mass, 0.0}) +
           ", " + test::numbers({0.0, 0.0, 0.002 * mass}) + "]}}";
  };
  std::string links;
  std::string ties;
  Vector3d end = Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const double angle = std::vector{1.2, 2.2, 2.7}[static_cast<std::size_t>(k)];
    const Vector3d along = -0.5 * Vector3d(std::sin(angle), 0.0, std::cos(angle));
    const std::string name(1, static_cast<char>('a' + k));
    const std::string before(1, static_cast<char>('a' + k - 1));
    links += (k == 0 ? "" : ", ") + link(name, end + 0.5 * along, angle, k == 2 ? 100.0 : 1.0);
    ties += (k == 0 ? R"({"type": "pin", "bodies": [null, "a"], "points": [[0, 0, 0], )"
                    : R"(, {"type": "pin", "bodies": [")" + before + R"(", ")" + name +
                          R"("], "points": [[0, 0, -0.25], )") +
            "[0, 0, 0.25]]}";
    end += along;
  }
  Simulator s = simulator(links, tie_settings(0.0025, ties));
  const std::vector<RunStep> steps = run(s, test::rounds(600, 100));
  double most = 0.0;
  for (const RunStep& step : steps) {
    most = std::max(most, step.kinetic_energy);
    ASSERT_LE(energy_of(step), energy_of(steps.front()) + 2e-3 * 1500.0) << step.index;
  }
  EXPECT_GE(energy_of(steps.back()), energy_of(steps.front()) - 0.08 * most);
}

/// Two rockers on the ground and a coupler, as bodies that hinges hold.
std::string four_bars() {
  const auto bar = [](const std::string& name, const std::string& length, const std::string& at,
                      const std::string& turn) {
    return R"({"name": ")" + name + R"(", "shape": )" + box("[" + length + ", 0.03, 0.03]") +
           R"(, "pose": {"position": )" + at + R"(, "quaternion_wxyz": )" + turn +
           R"(}, "dynamics": {"mass": 1}})";
  };
  return bar("a", "0.4", "[0.15, 0, 0.2]", "[0.8944271909999159, 0, -0.447213595499958, 0]") +
         ", " +
         bar("b", "0.7", "[0.75, 0.1, 0.45]", "[0.9984697628555456, 0, -0.05530038574178801, 0]") +
         ", " +
         bar("c", "0.4", "[1.1, 0, 0.25]", "[0.8280672304692728, 0, -0.5606288093051839, 0]");
}

// It swings through positions in which repeats do not find the forces: it lost 38 % of its energy
// in one step there.
TEST(LeverTie, AClosedLinkageKeepsItsEnergy) {
  const auto hinge = [](const std::string& ends) {
    return R"({"type": "hinge", "axis": [0, 1, 0], )" + ends + "}";
  };
  const std::string ties =
      hinge(R"("bodies": [null, "a"], "points": [[0, 0, 0], null])") + ", " +
      hinge(R"("bodies": ["a", "b"], "points": [[0.25, 0, 0], null])") + ", " +
      hinge(R"("bodies": ["b", "c"], "points": [null, [0.2692582403567252, 0, 0]])") + ", " +
      hinge(R"("bodies": [null, "c"], "points": [[1, 0, 0], null])");
  Simulator s = simulator(four_bars(), tie_settings(0.01, ties));
  const std::vector<RunStep> steps = run(s, 100);
  const double begin = energy_of(steps.front());
  for (std::size_t k = 1; k < steps.size(); ++k) {
    ASSERT_NEAR(energy_of(steps[k]), energy_of(steps[k - 1]), 0.05 * begin) << k;
    ASSERT_NEAR(energy_of(steps[k]), begin, 0.05 * begin) << k;
  }
}

// Nothing acts on it but a hinge.
TEST(LeverTie, ABodyOnAHingeKeepsItsEnergy) {
  const auto drift = [](const std::string& made, const std::string& hinge) {
    Simulator s = simulator(made, tie_settings(0.01, hinge, false));
    const std::vector<RunStep> steps = run(s, 300);
    return energy_of(steps.back()) / energy_of(steps.front()) - 1.0;
  };
  const std::string hinge = R"({"type": "hinge", "bodies": [null, "a"],
                                "points": [[0, 0, 0], null], "axis": [0, 0, 1]})";
  EXPECT_LE(std::abs(drift(body("a", box("[0.1, 0.1, 0.1]"), "[1, 0, 0]",
                                R"(, "dynamics": {"linear_velocity": [0, 4, 0],
                                                   "angular_velocity": [0, 0, 4]})"),
                           hinge)),
            1e-6);
  // Half a radian in a step.
  EXPECT_LE(std::abs(drift(body("a", box("[0.2, 0.05, 0.05]"), "[0.1, 0, 0]",
                                R"(, "dynamics": {"linear_velocity": [0, 5, 0],
                                                   "angular_velocity": [0, 0, 50]})"),
                           hinge)),
            2e-4);
}

// Each further hinge of a door gives the same constraint as the first one.
TEST(LeverTie, ADoorMayHaveMoreHingesThanItNeeds) {
  const auto hinge = [](double z) {
    return R"({"type": "hinge", "bodies": [null, "door"], "points": [)" + test::numbers({0, 0, z}) +
           R"(, null], "axis": [0, 0, 1]})";
  };
  const auto door = [](const std::string& hinges) {
    return simulator(body("door", box("[0.8, 0.04, 2]"), "[0.4, 0, 0]",
                          R"(, "dynamics": {"mass": 20, "angular_velocity": [0, 0, 8],
                                            "linear_velocity": [0, 3.2, 0]})"),
                     tie_settings(0.01, hinges));
  };
  for (const std::string& hinges : {hinge(-0.8), hinge(-0.8) + ", " + hinge(0.8),
                                    hinge(-0.8) + ", " + hinge(0.8) + ", " + hinge(0.3)}) {
    Simulator s = door(hinges);
    const std::vector<RunStep> steps = run(s, 200);
    EXPECT_NEAR(energy_of(steps.back()), energy_of(steps.front()), 1e-4 * 136.6);
    // m w^2 r is 512 N, and the weight 196 N.
    EXPECT_NEAR(greatest_force(steps, 0), std::hypot(512.0, 196.2), 5.0);
  }
}

// Welds that close a frame of four bars are more than it needs.
TEST(LeverTie, AFrameOfWeldsStaysWhole) {
  const auto bar = [](const std::string& name, const std::string& size, const std::string& at) {
    return body(name, box(size), at, kFree);
  };
  Simulator s = simulator(bar("a", "[1, 0.1, 0.1]", "[0, 0, 0]") + ", " +
                              bar("b", "[0.1, 0.1, 1]", "[0.6, 0, 0.5]") + ", " +
                              bar("c", "[1, 0.1, 0.1]", "[0, 0, 1]") + ", " +
                              bar("d", "[0.1, 0.1, 1]", "[-0.6, 0, 0.5]"),
                          tie_settings(0.01, R"({"type": "weld", "bodies": ["a", "b"]},
                            {"type": "weld", "bodies": ["b", "c"]},
                            {"type": "weld", "bodies": ["c", "d"]},
                            {"type": "weld", "bodies": ["d", "a"]},
                            {"type": "hinge", "bodies": [null, "a"], "points": [[0, 0, 0], null],
                             "axis": [0, 1, 0]})"));
  const std::vector<RunStep> steps = run(s, 100);
  EXPECT_LE(farthest(steps, 0, Vector3d::Zero(), Vector3d::Zero()), 1e-6);
  for (const RunStep& step : steps) {
    const Pose& a = step.bodies[0].X_WB;
    const Pose& c = step.bodies[2].X_WB;
    ASSERT_LE((a.rotation.conjugate() * (c.position - a.position) - Vector3d(0, 0, 1)).norm(),
              1e-5);
  }
  EXPECT_NEAR(energy_of(steps.back()), energy_of(steps.front()), 0.1);
}

// A damper beside its spring is one of the cable: neither acts where that is slack.
TEST(LeverTie, ASlackCableDoesNotDamp) {
  Simulator s = simulator(body("a", test::ball("0.05"), "[0.2, 0, 0]",
                               R"(, "dynamics": {"mass": 2, "linear_velocity": [3, 0, 0]})"),
                          tie_settings(0.005, R"({"type": "cable", "bodies": [null, "a"],
                              "points": [[0, 0, 0], [0, 0, 0]], "length": 1, "stiffness": 500,
                              "damping": 200})",
                                       false));
  double pull = 0.0;
  double energy = 9.0;  // [J]
  for (const RunStep& step : run(s, 200)) {
    const double x = step.bodies[0].X_WB.position.x();
    if (x <= 1.0 && pull == 0.0) {
      EXPECT_EQ(step.ties[0].force.norm(), 0.0) << x;
    }
    pull = std::max(pull, -step.ties[0].force.x());
    EXPECT_LE(energy_of(step), energy + 1e-9);
    EXPECT_LE(step.ties[0].force.x(), 1e-9);
    energy = energy_of(step);
  }
  EXPECT_GT(pull, 100.0);
  EXPECT_LT(energy, 9.0);
}

}  // namespace
}  // namespace firstcontact
