// Robots whose motors without bound press on what cannot yield.

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "simulation/double_pendulum.h"
#include "simulation/simulated_run.h"

#include <firstcontact/record/run_step.h>

namespace firstcontact {
namespace {

std::string ball_of(const std::string& radius) {
  return R"(<collision><geometry><sphere radius=")" + radius + R"("/></geometry></collision>)";
}

/// Two balls on slides that cross; the second slide leads one ball against the other, beside its
/// middle.
std::string crossed_slides() {
  const std::string limit = R"(<limit lower="-0.4" upper="0.4" effort="0" velocity="9"/>)";
  return test::massive("base", 2.11, "0 0 0", {0.02, 0.025, 0.03}, "", ball_of("0.065")) +
         test::massive("slide", 0.627, "0.05 0 0.02", {0.01, 0.012, 0.008}) +
         test::massive("ball", 1.004, "0.05 0 0.02", {0.01, 0.012, 0.008}, "", ball_of("0.138")) +
         test::connected("j0", "prismatic", "base", "slide", "0 1 0", "0.196 0.2625 0.1256",
                         limit) +
         test::connected("j1", "prismatic", "slide", "ball", "1 0 0", "-0.3907 -0.2296 -0.2387",
                         limit);
}

/// A run of 1 s of such a robot, which floats and turns.
std::vector<RunStep> pressed(const std::string& spin, double step) {
  const std::filesystem::path urdf =
      std::filesystem::temp_directory_path() / "firstcontact_pressing_robot.urdf";
  std::ofstream(urdf) << "<robot name=\"r\">" << crossed_slides() << "</robot>";
  const std::string text =
      R"({"firstcontact": 1, "bodies": [], "robots": [{"name": "r", "urdf": ")" + urdf.string() +
      R"(", "dynamics": {"base": "free", "motors": {"j1": {"velocity": 0.5}},
                         "angular_velocity": )" +
      spin + R"(}}], "simulation": {"gravity": [0, 0, 0], "friction": 0.5, "step": )" +
      test::number_text(step) + "}}";
  ShapeCache cache;
  Simulator s(load_scene(parse_scene(text, "test.json"), cache));
  std::vector<RunStep> steps = test::run(s, static_cast<std::size_t>(1.0 / step + 0.5));
  EXPECT_EQ(test::verify(s.header(), steps).verdict, ProofVerdict::proven) << spin << step;
  std::filesystem::remove(urdf);
  return steps;
}

// The way out for the ball is along the other slide, thousands of times as fast as the motor.
TEST(PressingRobot, ShootsNothingOut) {
  for (const std::string& spin :
       {std::string("[1.919, -1.58, 1.675]"), std::string("[4, -3, 3]")}) {
    for (const double step : {0.01, 0.02}) {
      const std::vector<RunStep> steps = pressed(spin, step);
      double greatest = 0.0;
      for (const RunStep& now : steps) {
        greatest = std::max(greatest, now.kinetic_energy);
        ASSERT_LE((now.linear_momentum - steps[0].linear_momentum).norm(), 1e-10) << now.time;
        ASSERT_LE((now.angular_momentum - steps[0].angular_momentum).norm(), 1e-10) << now.time;
      }
      // What it has, and what the motor gives to the moving links.
      EXPECT_LE(greatest, steps[0].kinetic_energy + 0.5 * 3.741 * 0.25) << spin << step;
    }
  }
}

}  // namespace
}  // namespace firstcontact
