// A body slides or rolls over the seam of flush bodies without a change of its motion; a step stops
// it.

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "simulation/simulated_run.h"

#include <firstcontact/record/run_step.h>

namespace firstcontact {
namespace {

using test::body;
using test::box;
using test::numbers;
using test::run;
using test::settings;
using test::simulator;

constexpr double kDistance = 1e-4;  // [m]  Contact distance.

/// Two slabs side by side whose tops are at z = 0 and z = step.
///
/// @param apart  [m]
std::string slabs(double step, double apart = 0.0, const std::string& more = "") {
  return body("a", box("[2, 2, 0.2]"), "[-1, 0, -0.1]", more) + ", " +
         body("b", box("[2, 2, 0.2]"), numbers({1.0 + apart, 0.0, step - 0.1}), more);
}

std::string sliding(const std::string& shape, double height, double yaw, const std::string& more) {
  return R"(, {"name": "slider", "shape": )" + shape + R"(, "pose": {"position": )" +
         numbers({-0.4, 0.0, height}) + R"(, "rpy": )" + numbers({0.0, 0.0, yaw}) +
         R"(}, "dynamics": {"linear_velocity": [2, 0.1, 0])" + more + "}}";
}

RunBody after(Simulator& simulator, double duration, double step) {
  const auto steps = run(simulator, static_cast<std::size_t>(std::lround(duration / step)));
  EXPECT_EQ(test::verify(simulator.header(), steps).verdict, ProofVerdict::proven);
  return steps.back().bodies.back();
}

TEST(Seam, ABlockSlidesOver) {
  for (const double gap : {0.92, 1.0, 1.1, 1.3, 1.45}) {
    for (const double yaw : {0.0, 0.3, 0.7853981633974483}) {
      for (const double step : {0.01, 0.003}) {
        Simulator s = simulator(
            slabs(0.0) + sliding(box("[0.12, 0.12, 0.06]"), 0.03 + gap * kDistance, yaw, ""),
            settings(step, 0.0, kDistance));
        const RunBody end = after(s, 0.6, step);
        EXPECT_NEAR(end.linear_velocity.x(), 2.0, 1e-3) << gap << " " << yaw << " " << step;
        EXPECT_NEAR(end.linear_velocity.y(), 0.1, 1e-3) << gap << " " << yaw << " " << step;
        EXPECT_NEAR(end.linear_velocity.z(), 0.0, 1e-3) << gap << " " << yaw << " " << step;
        EXPECT_LE(end.angular_velocity.norm(), 1e-2) << gap << " " << yaw << " " << step;
      }
    }
  }
}

TEST(Seam, ABallAndACylinderRollOver) {
  const std::string spin = R"(, "angular_velocity": [-2, 40, 0])";
  Simulator ball = simulator(
      slabs(0.0) + sliding(R"({"sphere": {"radius": 0.05}})", 0.05 + kDistance, 0.0, spin),
      settings(0.01, 0.5, kDistance));
  EXPECT_NEAR(after(ball, 0.5, 0.01).linear_velocity.x(), 2.0, 5e-3);
  const std::string cylinder =
      R"(, {"name": "roller", "shape": {"cylinder": {"radius": 0.1, "length": 0.2}}, "pose":
      {"position": )" +
      numbers({-0.3, 0.0, 0.1 + kDistance}) +
      R"(, "rpy": [1.5707963267948966, 0, 0]}, "dynamics": {"linear_velocity": [1, 0, 0],
      "angular_velocity": [0, 10, 0]}})";
  Simulator roller = simulator(slabs(0.0) + cylinder, settings(0.01, 0.5, kDistance));
  EXPECT_NEAR(after(roller, 0.6, 0.01).linear_velocity.x(), 1.0, 5e-3);
}

TEST(Seam, ABlockSlidesOverSlabsThatAreFree) {
  const std::string heavy = R"(, "dynamics": {"density": 1e5})";
  Simulator s = simulator(body("floor", box("[9, 9, 1]"), "[0, 0, -0.7001]") + ", " +
                              slabs(0.0, kDistance, heavy) +
                              sliding(box("[0.12, 0.12, 0.06]"), 0.03 + kDistance, 0.0, ""),
                          settings(0.01, 0.0, kDistance));
  EXPECT_NEAR(after(s, 0.5, 0.01).linear_velocity.x(), 2.0, 1e-3);
}

TEST(Seam, AStepStops) {
  Simulator s =
      simulator(slabs(0.005) + sliding(box("[0.12, 0.12, 0.06]"), 0.03 + kDistance, 0.0, ""),
                settings(0.01, 0.0, kDistance));
  EXPECT_LT(after(s, 0.5, 0.01).linear_velocity.x(), 1.9);
}

}  // namespace
}  // namespace firstcontact
