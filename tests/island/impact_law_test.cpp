// The laws of impacts at the same time, and surfaces that run along their bodies.

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Core>

#include "simulation/simulated_run.h"

#include <firstcontact/record/run_step.h>

namespace firstcontact {
namespace {

using test::ball;
using test::body;
using test::box;
using test::kFloor;
using test::number_text;
using test::numbers;
using test::run;
using test::settings;
using test::simulator;

/// The velocities after `coming` of six equal balls hit the others, which touch.
std::vector<double> cradle(int coming, double restitution, const std::string& law) {
  std::string bodies;
  for (int k = 0; k < 6; ++k) {
    const double x = 0.2001 * k - (k < coming ? 0.05 : 0.0);
    bodies += (k == 0 ? "" : ", ") +
              body("ball " + std::to_string(k), ball("0.1"), numbers({x, 0.0, 0.0}),
                   k < coming ? R"(, "dynamics": {"linear_velocity": [1, 0, 0]})"
                              : R"(, "dynamics": {})");
  }
  Simulator s = simulator(bodies, settings(0.01, 0.3, 1e-4) + R"(, "gravity": [0, 0, 0],
      "restitution": )" + std::to_string(restitution) +
                                      law);
  const RunStep end = run(s, 20).back();
  std::vector<double> velocities;
  for (const RunBody& ball : end.bodies) {
    velocities.push_back(ball.linear_velocity.x());
  }
  return velocities;
}

TEST(ImpactLaw, ACradleInTouchSendsOffAsManyAsCome) {
  for (const int coming : {1, 2, 3}) {
    const std::vector<double> v = cradle(coming, 1.0, "");
    for (int k = 0; k < 6; ++k) {
      EXPECT_NEAR(v[static_cast<std::size_t>(k)], k < 6 - coming ? 0.0 : 1.0, 1e-6)
          << coming << " " << k;
    }
  }
}

TEST(ImpactLaw, BothKeepMomentumAndAddNoEnergy) {
  for (const double restitution : {0.0, 0.3, 0.8, 1.0}) {
    for (const std::string law : {"", R"(, "impacts": "simultaneous")"}) {
      double momentum = 0.0;
      double energy = 0.0;
      for (const double v : cradle(2, restitution, law)) {
        momentum += v;
        energy += v * v;
      }
      EXPECT_NEAR(momentum, 2.0, 1e-7) << restitution << law;
      EXPECT_LE(energy, 2.0 * (1.0 + 1e-9)) << restitution << law;
    }
  }
}

TEST(ImpactLaw, SimultaneousImpactsShareTheHit) {
  const std::vector<double> v = cradle(1, 1.0, R"(, "impacts": "simultaneous")");
  EXPECT_LT(v[0], -0.1);
  EXPECT_NEAR(v[4], v[5], 1e-6);
}

/// A ball of 0.1 m at a place with a velocity.
std::string moving_ball(const std::string& name, const std::vector<double>& at,
                        const std::vector<double>& velocity, double mass = 1.0) {
  return body(name, ball("0.1"), numbers(at),
              R"(, "dynamics": {"mass": )" + number_text(mass) + R"(, "linear_velocity": )" +
                  numbers(velocity) + "}");
}

/// The bodies that a scene lists in this order, joined.
std::string joined(const std::vector<std::string>& bodies) {
  std::string all;
  for (const std::string& one : bodies) {
    all += (all.empty() ? "" : ", ") + one;
  }
  return all;
}

/// The velocities of bodies after 0.4 s without gravity.
std::vector<Eigen::Vector3d> velocities_after(const std::vector<std::string>& bodies,
                                              double friction, double restitution) {
  Simulator s = simulator(joined(bodies), settings(0.01, friction, 1e-5) +
                                              R"(, "gravity": [0, 0, 0], "restitution": )" +
                                              number_text(restitution));
  std::vector<Eigen::Vector3d> velocities(bodies.size());
  for (const RunStep& step : run(s, 40)) {
    for (const RunBody& body : step.bodies) {
      velocities[body.body] = body.linear_velocity;
    }
  }
  return velocities;
}

// A ball hits two balls that touch it at the same time, 30 degrees to either side. Newton's law for
// both: p = 2 cos 30 / (1 + 2 cos^2 30) = 0.6928 N s each.
TEST(ImpactLaw, ACueBallPartsTwoBallsAlike) {
  const double x = 0.20001 * std::cos(std::numbers::pi / 6.0);
  const std::string cue = moving_ball("cue", {-0.05, 0, 0}, {1, 0, 0});
  const std::string left = moving_ball("left", {x, 0.100005, 0}, {0, 0, 0});
  const std::string right = moving_ball("right", {x, -0.100005, 0}, {0, 0, 0});
  for (const std::vector<std::string>& bodies :
       {std::vector{cue, left, right}, std::vector{cue, right, left}}) {
    const std::vector<Eigen::Vector3d> v = velocities_after(bodies, 0.0, 1.0);
    const double side = bodies[1] == left ? 1.0 : -1.0;
    EXPECT_NEAR((v[0] - Eigen::Vector3d(-0.2, 0, 0)).norm(), 0.0, 1e-6);
    EXPECT_NEAR((v[1] - Eigen::Vector3d(0.6, side * 0.6 / std::sqrt(3.0), 0)).norm(), 0.0, 1e-6);
    EXPECT_NEAR((v[2] - Eigen::Vector3d(0.6, -side * 0.6 / std::sqrt(3.0), 0)).norm(), 0.0, 1e-6);
  }
}

// Mirrored scenes stay mirrored, however the scene lists them: with friction, and where heavy balls
// make impacts travel faster and faster towards the middle.
TEST(ImpactLaw, AMirroredHitStaysMirrored) {
  const std::string heavy_left = moving_ball("heavy left", {-0.85, 0, 0}, {2, 0, 0}, 4.0);
  const std::string left = moving_ball("left", {-0.40002, 0, 0}, {0, 0, 0});
  const std::string next_left = moving_ball("next left", {-0.20001, 0, 0}, {0, 0, 0}, 0.5);
  const std::string middle = moving_ball("middle", {0, 0, 0}, {0, 0, 0});
  const std::string next_right = moving_ball("next right", {0.20001, 0, 0}, {0, 0, 0}, 0.5);
  const std::string right = moving_ball("right", {0.40002, 0, 0}, {0, 0, 0});
  const std::string heavy_right = moving_ball("heavy right", {0.85, 0, 0}, {-2, 0, 0}, 4.0);
  for (const double restitution : {0.9, 1.0}) {
    const std::vector<Eigen::Vector3d> v = velocities_after(
        {heavy_left, left, next_left, middle, heavy_right, right, next_right}, 0.3, restitution);
    EXPECT_NEAR(v[3].norm(), 0.0, 1e-6);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR((v[k] + v[k + 4]).norm(), 0.0, 1e-6) << k;
      EXPECT_LE(v[k].x(), 1e-6) << k;
    }
  }
}

// The plank rests on its pivot without bouncing, and holds there while both balls bounce.
TEST(ImpactLaw, ASeesawThatIsHitOnBothEndsStaysLevel) {
  const std::string plank = body("plank", box("[2, 0.2, 0.04]"), "[0, 0, 0.02001]",
                                 R"(, "dynamics": {"mass": 1, "restitution": 0})");
  const std::string pivot = body("pivot", box("[0.1, 0.3, 1]"), "[0, 0, -0.5]");
  const std::string left = moving_ball("left", {-0.9, 0, 0.3}, {0, 0, -1});
  const std::string right = moving_ball("right", {0.9, 0, 0.3}, {0, 0, -1});
  for (const auto& bodies :
       {std::vector{plank, pivot, left, right}, std::vector{right, plank, left, pivot}}) {
    Simulator s = simulator(joined(bodies), settings(0.005, 0.3, 1e-5) + R"(, "pairs": [
        {"bodies": ["plank", "left"], "restitution": 0.5},
        {"bodies": ["plank", "right"], "restitution": 0.5}])");
    const std::size_t at = bodies[0] == plank ? 0 : 1;
    for (const RunStep& step : run(s, 60)) {
      for (const RunBody& body : step.bodies) {
        if (body.body == at) {
          EXPECT_NEAR(body.angular_velocity.norm(), 0.0, 1e-6) << step.index;
        }
      }
    }
  }
}

TEST(Belt, CarriesABlockUpToItsSpeed) {
  // Friction speeds it up by mu g, until it goes with the belt, 0.5 m/s along the belt's x.
  const std::string belt =
      R"({"name": "belt", "shape": {"box": {"size": [9, 9, 1]}}, "pose": {"position": [0, 0, -0.5],
      "rpy": [0, 0, 0.5]}, "surface": {"velocity": [0.5, 0, 0], "friction": 0.4}})";
  for (const double step : {0.01, 0.003}) {
    Simulator s = simulator(belt + ", " +
                                body("block", box("[0.2, 0.2, 0.1]"), "[0, 0, 0.0501]",
                                     R"(, "dynamics": {"friction": 0.4})"),
                            settings(step, 0.4, 1e-4));
    const double speeding = 0.5 / (0.4 * 9.81);
    const auto steps = run(s, static_cast<std::size_t>(std::lround(1.0 / step)));
    const RunBody& end = steps.back().bodies[0];
    EXPECT_NEAR(end.linear_velocity.x(), 0.5 * std::cos(0.5), 1e-6);
    EXPECT_NEAR(end.linear_velocity.y(), 0.5 * std::sin(0.5), 1e-6);
    const double way = 0.5 * (steps.back().time - 0.5 * speeding);
    EXPECT_NEAR(end.X_WB.position.head<2>().norm(), way, 0.4 * 9.81 * step * step) << step;
    EXPECT_NEAR(end.angular_velocity.norm(), 0.0, 1e-6);
  }
}

TEST(Belt, CarriesWhatFallsOnIt) {
  // The block lands within a step: what brakes it there is the belt, not the body below it.
  const std::string belt =
      R"({"name": "belt", "shape": {"box": {"size": [9, 9, 1]}}, "pose": {"position": [0, 0, -0.5]},
      "surface": {"velocity": [0.5, 0, 0]}})";
  Simulator s = simulator(belt + ", " +
                              body("block", box("[0.2, 0.2, 0.02]"), "[0, 0, 0.05]",
                                   R"(, "dynamics": {"linear_velocity": [0.5, 0, 0]})"),
                          settings(0.01, 0.5, 1e-4));
  for (const RunStep& step : run(s, 50)) {
    EXPECT_NEAR(step.bodies[0].linear_velocity.x(), 0.5, 1e-6) << step.index;
  }
}

TEST(Belt, HoldsAWheelThatRollsAgainstIt) {
  // On a belt that runs at -v a ball that spins at v / r stays where it is.
  const std::string belt =
      R"({"name": "belt", "shape": {"box": {"size": [9, 9, 1]}}, "pose": {"position": [0, 0, -0.5]},
      "surface": {"velocity": [-0.6, 0, 0]}})";
  Simulator s = simulator(belt + ", " +
                              body("ball", ball("0.1"), "[0, 0, 0.1001]",
                                   R"(, "dynamics": {"angular_velocity": [0, 6, 0]})"),
                          settings(0.01, 0.5, 1e-4));
  const RunBody end = run(s, 100).back().bodies[0];
  EXPECT_NEAR(end.X_WB.position.x(), 0.0, 1e-3);
  EXPECT_NEAR(end.angular_velocity.y(), 6.0, 1e-2);
}

/// A capsule along y, or a box, whose top at z = 0 runs along x.
std::string running(const std::string& name, double x, double velocity, bool is_round) {
  const std::string shape =
      is_round ? R"({"capsule": {"radius": 0.1, "length": 0.6}})" : box("[0.3, 0.6, 0.2]");
  const std::string turn = is_round ? R"(, "rpy": [1.5707963267948966, 0, 0])" : "";
  return R"({"name": ")" + name + R"(", "shape": )" + shape + R"(, "pose": {"position": )" +
         numbers({x, 0.0, -0.1}) + turn + R"(}, "surface": {"velocity": )" +
         numbers({velocity, 0.0, 0.0}) + "}}";
}

// Timoshenko's plank, on rollers or belts that run against each other. All of its contacts slide:
// unequal shares of its weight on one side would turn it.
TEST(Belt, TwoAgainstEachOtherDoNotTurnAPlank) {
  for (const bool is_round : {true, false}) {
    for (const double speed : {2.0, -2.0}) {
      Simulator s =
          simulator(running("left", -0.4, speed, is_round) + ", " +
                        running("right", 0.4, -speed, is_round) + ", " +
                        body("plank", box("[2, 0.3, 0.04]"), "[0, 0, 0.02001]",
                             R"(, "dynamics": {"mass": 1, "linear_velocity": [0.1, 0, 0]})"),
                    settings(0.01, 0.3, 1e-5));
      const std::size_t steps = speed > 0.0 ? 200 : 40;
      for (const RunStep& step : run(s, steps)) {
        const RunBody& plank = step.bodies[0];
        EXPECT_NEAR(plank.angular_velocity.z(), 0.0, 1e-3) << is_round << speed << step.index;
        EXPECT_NEAR(plank.X_WB.position.y(), 0.0, 1e-5) << is_round << speed << step.index;
      }
    }
  }
}

}  // namespace
}  // namespace firstcontact
