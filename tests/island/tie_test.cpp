// Springs, cables and joints between bodies: closed forms, orders in the step, energy and momenta.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/record/write_run.h>
#include <firstcontact/simulation_model/detail/sim_tie.h>

#include "island/tie_laws.h"
#include "simulation/simulated_run.h"

namespace firstcontact {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using test::body;
using test::box;
using test::energy_of;
using test::expect_order;
using test::followed;
using test::number_text;
using test::numbers;
using test::run;
using test::simulator;
using test::steps_until;
using test::tie_settings;

constexpr double kGravity = 9.81;
constexpr double kPi = std::numbers::pi;

/// A ball of 1 kg, 5 cm in radius.
std::string mass_at(const std::string& name, const Vector3d& at, const Vector3d& v,
                    double mass = 1.0) {
  return body(name, test::ball("0.05"), numbers({at.x(), at.y(), at.z()}),
              R"(, "dynamics": {"mass": )" + number_text(mass) + R"(, "linear_velocity": )" +
                  numbers({v.x(), v.y(), v.z()}) + "}");
}

const std::string kSpring =
    R"({"type": "spring", "bodies": [null, "a"], "points": [[0, 0, 0], [0, 0, 0]], "length": 0.5,)";

// 20 steps a period, 100 periods.
TEST(Tie, SpringKeepsItsEnergy) {
  const double k = 4.0 * kPi * kPi;
  Simulator s =
      simulator(mass_at("a", {0.6, 0, 0}, Vector3d::Zero()),
                tie_settings(0.05, kSpring + R"("stiffness": )" + number_text(k) + "}", false));
  for (int i = 0; i < 2000; ++i) {
    const RunStep step = s.step().value();
    ASSERT_NEAR(energy_of(step), 0.5 * k * 0.01, 1e-9) << i;
    ASSERT_NEAR(step.bodies[0].X_WB.position.tail<2>().norm(), 0.0, 1e-12);
  }
}

TEST(Tie, SpringHasItsPeriod) {
  const double k = 4.0 * kPi * kPi;
  expect_order(0.04, [&](double h) {
    Simulator s =
        simulator(mass_at("a", {0.6, 0, 0}, Vector3d::Zero()),
                  tie_settings(h, kSpring + R"("stiffness": )" + number_text(k) + "}", false));
    run(s, steps_until(1.28, h));
    return std::abs(s.states()[0].X_WB.position.x() - 0.5 - 0.1 * std::cos(2.0 * kPi * 1.28));
  });
}

TEST(Tie, DampedSpringDecays) {
  const double k = 40.0;
  const double c = 2.0;
  expect_order(0.04, [&](double h) {
    Simulator s = simulator(mass_at("a", {0.6, 0, 0}, Vector3d::Zero()),
                            tie_settings(h, kSpring + R"("stiffness": 40, "damping": 2})", false));
    run(s, steps_until(1.28, h));
    const double w = std::sqrt(k - 0.25 * c * c);
    const double t = 1.28;
    const double right =
        0.1 * std::exp(-0.5 * c * t) * (std::cos(w * t) + 0.5 * c / w * std::sin(w * t));
    return std::abs(s.states()[0].X_WB.position.x() - 0.5 - right);
  });
}

// A damper alone: the decay of the velocity is exact at any step.
TEST(Tie, DamperIsExact) {
  Simulator s = simulator(
      mass_at("a", {0.6, 0, 0}, {1, 0, 0}),
      tie_settings(0.1,
                   R"({"type": "spring", "bodies": [null, "a"], "points": [[0, 0, 0], [0, 0, 0]],
                    "damping": 7})",
                   false));
  run(s, 10);
  EXPECT_NEAR(s.states()[0].v_WC.x(), std::exp(-7.0), 1e-9);
}

// However stiff: it swings on, and gains nothing.
TEST(Tie, StiffSpringIsStable) {
  for (const double k : {1e4, 1e8, 1e12}) {
    Simulator s =
        simulator(mass_at("a", {0.5001, 0, 0}, {0, 0.2, 0}),
                  tie_settings(0.01, kSpring + R"("stiffness": )" + number_text(k) + "}"));
    const double before = 0.02 + 0.5 * k * 1e-8;
    for (int i = 0; i < 300; ++i) {
      ASSERT_LE(energy_of(s.step().value()), before * (1.0 + 1e-6) + 1e-6) << k << " " << i;
    }
    EXPECT_NEAR(s.states()[0].X_WB.position.norm(), 0.5, 0.1);
  }
}

// A damper of any strength only dissipates energy, and the body creeps back. Bodies were once moved
// by the mean of their velocities, so 25 J became 102 J in the first step.
TEST(Tie, StrongDampersTakeEnergyAlone) {
  for (const double c : {1e1, 1e3, 1e4, 1e6, 1e9}) {
    const std::string law = R"("stiffness": 5e5, "damping": )" + number_text(c) + "}";
    Simulator s = simulator(mass_at("a", {0.5, 0, 0}, {5, 0, 0}, 2.0),
                            tie_settings(0.01, kSpring + law, false));
    double before = 25.0;
    for (int i = 0; i < 100; ++i) {
      const double energy = energy_of(s.step().value());
      ASSERT_LE(energy, before * (1.0 + 1e-12) + 1e-12) << c << " " << i;
      before = energy;
    }
    const double rate = 5e5 / c;  // [1/s]  Without mass: it decays by e^(-rate t).
    if (rate <= 5.0) {
      const double right = 10.0 / c * std::exp(-rate);
      EXPECT_NEAR(s.states()[0].X_WB.position.x() - 0.5, right, 0.05 * right) << c;
    }
  }
}

// The energy over one row is that of its docstring, to rounding.
TEST(Tie, SpringRowsLoseWhatTheirDampersTake) {
  std::mt19937 random(7);
  const auto power = [&] {
    return std::pow(10.0, std::uniform_real_distribution<double>(-3.0, 6.0)(random));
  };
  for (int i = 0; i < 1000; ++i) {
    const detail::SimTie tie{.stiffness = power(), .damping = i % 3 == 0 ? 0.0 : power()};
    const double span = 0.01;
    const double m = power();
    const double v = std::normal_distribution<double>()(random);
    const double x = 0.01 * std::normal_distribution<double>()(random);
    const detail::SpringRow row = detail::spring_row(tie,
                                                     {.begin = x,
                                                      .flight = x + span * v,
                                                      .speed_at_begin = v,
                                                      .speed_of_flight = v,
                                                      .inverse_mass = 1.0 / m},
                                                     span);
    const double r = (row.target - v) / (row.compliance + 1.0 / m);
    const double u = v + r / m;
    const double way = span * ((1.0 - row.weight) * v + row.weight * u);
    const double before = 0.5 * m * v * v + 0.5 * tie.stiffness * x * x;
    const double after = 0.5 * m * u * u + 0.5 * tie.stiffness * (x + way) * (x + way);
    const double taken = tie.damping * way * way / span +
                         (row.weight - 0.5) * (r * r / m + tie.stiffness * way * way);
    ASSERT_NEAR(after - before, -taken, 1e-10 * before) << i;
    ASSERT_GE(taken, 0.0) << i;
  }
}

// A weight that hangs in one stays at rest in the steps in which it sags.
TEST(Tie, StrongDampersLetAWeightSagToRest) {
  Simulator s = simulator(mass_at("a", {0, 0, -0.5}, Vector3d::Zero()),
                          tie_settings(0.01, kSpring + R"("stiffness": 100, "damping": 1000})"));
  run(s, 100);
  const double rate = 0.1;  // [1/s]
  EXPECT_NEAR(s.states()[0].X_WB.position.z() + 0.5, -kGravity / 100.0 * (1.0 - std::exp(-rate)),
              1e-4);
}

/// Two masses of 1 kg and 3 kg on a spring, which turn about each other.
Simulator orbiting(double h) {
  return simulator(mass_at("a", {0.4, 0, 0}, {0, 1.2, 0.1}) + "," +
                       mass_at("b", {-0.1, 0, 0}, {0.1, -0.3, 0}, 3.0),
                   tie_settings(h, R"({"type": "spring", "bodies": ["a", "b"],
                       "points": [[0, 0, 0], [0, 0, 0]], "length": 0.4, "stiffness": 30})",
                                false));
}

TEST(Tie, SpringOfTwoMassesKeepsMomentaAndEnergy) {
  Simulator s = orbiting(0.05);
  const RunStep first = s.step().value();
  for (int i = 0; i < 1000; ++i) {
    const RunStep step = s.step().value();
    ASSERT_LE((step.linear_momentum - first.linear_momentum).norm(), 1e-12);
    ASSERT_LE((step.angular_momentum - first.angular_momentum).norm(), 1e-9);
    ASSERT_NEAR(energy_of(step), energy_of(first), 1e-7) << i;
  }
}

TEST(Tie, SpringOfTwoMassesIsOfSecondOrder) {
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  Vector6d y;
  y << 0.5, 0, 0, -0.1, 1.5, 0.1;
  const Vector6d right = followed(y, 0.64, [](const Vector6d& state) {
    Vector6d rate;
    const Vector3d d = state.head<3>();
    rate << state.tail<3>(), -30.0 * (d.norm() - 0.4) * (1.0 + 1.0 / 3.0) * d.normalized();
    return rate;
  });
  expect_order(0.04, [&](double h) {
    Simulator s = orbiting(h);
    run(s, steps_until(0.64, h));
    const Vector3d d = s.states()[0].X_WB.position - s.states()[1].X_WB.position;
    return (d - right.head<3>()).norm();
  });
}

// A spring of length 0 passes through its point.
TEST(Tie, SpringOfNoLengthIsHarmonic) {
  const double k = 4.0 * kPi * kPi;
  expect_order(0.04, [&](double h) {
    Simulator s = simulator(
        mass_at("a", {0.3, 0, 0}, {0, 0.5, 0}),
        tie_settings(h,
                     R"({"type": "spring", "bodies": [null, "a"], "points": [[0, 0, 0], [0, 0, 0]],
                      "length": 0, "stiffness": )" +
                         number_text(k) + "}",
                     false));
    run(s, steps_until(1.28, h));
    const double t = 2.0 * kPi * 1.28;
    const Vector3d right(0.3 * std::cos(t), 0.5 / (2.0 * kPi) * std::sin(t), 0.0);
    return (s.states()[0].X_WB.position - right).norm();
  });
}

// An anisotropic box that turns on a spring at its corner: bodies with arms, too.
// It acts along the line between the points, as one of a length does: two balls that orbit on it
// keep their angular momentum, and do not begin to spin.
TEST(Tie, DamperOfASpringOfNoLengthActsAlongItsLine) {
  const std::string balls =
      mass_at("a", {-0.5, 0, 0}, {0, -1, 0}) + "," + mass_at("b", {0.5, 0, 0}, {0, 1, 0});
  const auto orbit = [&](const std::string& law) {
    Simulator s = simulator(balls, tie_settings(0.01,
                                                R"({"type": "spring", "bodies": ["a", "b"],
                                      "points": [[0, 0, 0], [0, 0, 0]], )" +
                                                    law + "}",
                                                false));
    return run(s, 300);
  };
  const std::vector<RunStep> none = orbit(R"("length": 0, "stiffness": 2, "damping": 1)");
  const std::vector<RunStep> tiny = orbit(R"("length": 1e-9, "stiffness": 2, "damping": 1)");
  for (std::size_t i = 0; i < none.size(); ++i) {
    ASSERT_LE((none[i].angular_momentum - Vector3d(0, 0, 1)).norm(), 1e-9) << i;
    ASSERT_LE(none[i].bodies[0].angular_velocity.norm(), 1e-3) << i;
    for (std::size_t b = 0; b < 2; ++b) {
      ASSERT_LE((none[i].bodies[b].X_WB.position - tiny[i].bodies[b].X_WB.position).norm(), 1e-4)
          << i;
    }
  }
  // A damper alone, and one whose points are together at the start.
  const std::vector<RunStep> alone = orbit(R"("length": 0, "damping": 1)");
  EXPECT_NEAR(alone.back().angular_momentum.z(), 1.0, 1e-9);
}

TEST(Tie, SpringAtACornerIsOfSecondOrder) {
  const auto made = [](double h) {
    return simulator(body("a", box("[0.3, 0.2, 0.1]"), "[0.4, 0, 0]",
                          R"(, "dynamics": {"mass": 2, "angular_velocity": [1, -2, 1.5]})"),
                     tie_settings(h, R"({"type": "spring", "bodies": [null, "a"],
                      "points": [[0, 0, 0], [-0.15, 0.1, 0.05]], "length": 0.2,
                      "stiffness": 50})"));
  };
  Simulator fine = made(0.0003125);
  run(fine, steps_until(0.64, 0.0003125));
  const Vector3d right = fine.states()[0].X_WB.position;
  expect_order(
      0.01,
      [&](double h) {
        Simulator s = made(h);
        run(s, steps_until(0.64, h));
        return (s.states()[0].X_WB.position - right).norm();
      },
      3.4);
}

const std::string kCable =
    R"({"type": "cable", "bodies": [null, "a"], "points": [[0, 0, 0], [0, 0, 0]], "length": 1})";

// [rad]  The angle of a pendulum of 1 m from the vertical after a time.
double pendulum_angle(double begin, double rate, double time) {
  return followed(Vector2d(begin, rate), time,
                  [](const Vector2d& y) { return Vector2d(y[1], -kGravity * std::sin(y[0])); })[0];
}

TEST(Tie, PendulumOnACableIsOfSecondOrder) {
  const double right = pendulum_angle(0.5 * kPi, 0.0, 1.28);
  expect_order(0.02, [&](double h) {
    Simulator s = simulator(mass_at("a", {1, 0, 0}, Vector3d::Zero()), tie_settings(h, kCable));
    run(s, steps_until(1.28, h));
    const Vector3d p = s.states()[0].X_WB.position;
    return std::abs(std::atan2(p.x(), -p.z()) - right);
  });
}

TEST(Tie, PendulumOnACableKeepsItsEnergy) {
  Simulator s = simulator(mass_at("a", {0.8, 0, -0.6}, {0, 0.5, 0}), tie_settings(0.01, kCable));
  const double before = 0.125 - kGravity * 0.6;
  std::vector<RunStep> steps = run(s, 1000);
  double off = 0.0;
  double farthest = 0.0;
  for (const RunStep& step : steps) {
    off = std::max(off, std::abs(energy_of(step) - before));
    farthest = std::max(farthest, std::abs(step.bodies[0].X_WB.position.norm() - 1.0));
  }
  EXPECT_LE(off, 1e-3);
  EXPECT_LE(farthest, 1e-7);
  EXPECT_EQ(test::verify(s.header(), {steps.begin(), steps.begin() + 20}).verdict,
            ProofVerdict::proven);
}

// It falls freely until the cable is taut, and goes on along the circle.
TEST(Tie, SlackCableTakesTheVelocityAlongIt) {
  Simulator s = simulator(mass_at("a", {0.6, 0, 0}, Vector3d::Zero()), tie_settings(0.01, kCable));
  const double fall = std::sqrt(2.0 * 0.8 / kGravity);
  const auto until = static_cast<std::size_t>(fall / 0.01);
  const RunStep free = run(s, until).back();
  EXPECT_NEAR(energy_of(free), 0.0, 1e-12);
  const RunStep taut = run(s, 3).back();
  const double along = kGravity * 0.8 * 0.6 * 0.6;  // Half the squared speed.
  EXPECT_NEAR(energy_of(taut), along - kGravity * 0.8, 1e-3);
  EXPECT_NEAR(s.states()[0].X_WB.position.norm(), 1.0, 1e-6);
}

TEST(Tie, BallGoesOverItsTop) {
  Simulator s = simulator(mass_at("a", {0, 0, -1}, {std::sqrt(5.5 * kGravity), 0, 0}),
                          tie_settings(0.005, kCable));
  double highest = -1.0;
  for (int i = 0; i < 200; ++i) {
    const RunStep step = s.step().value();
    ASSERT_NEAR(step.bodies[0].X_WB.position.norm(), 1.0, 1e-6) << i;
    ASSERT_NEAR(energy_of(step), 1.75 * kGravity, 5e-3) << i;
    highest = std::max(highest, step.bodies[0].X_WB.position.z());
  }
  EXPECT_NEAR(highest, 1.0, 1e-3);
}

// With less speed the cable becomes slack where v^2 = g z: at z = 2/3 for v^2 = 4 g at the bottom.
TEST(Tie, BallThatIsTooSlowLeavesItsCircle) {
  const double h = 0.001;
  Simulator s = simulator(mass_at("a", {0, 0, -1}, {std::sqrt(4.0 * kGravity), 0, 0}),
                          tie_settings(h, kCable));
  double left_at = 0.0;
  for (int i = 0; i < 1500 && left_at == 0.0; ++i) {
    const RunStep step = s.step().value();
    if (step.bodies[0].X_WB.position.norm() < 1.0 - 1e-6) {
      left_at = step.bodies[0].X_WB.position.z();
    }
  }
  EXPECT_NEAR(left_at, 2.0 / 3.0, 0.02);
}

// An elastic cable pulls as a spring does, and does not push.
TEST(Tie, ElasticCableOnlyPulls) {
  const std::string cable = R"({"type": "cable", "bodies": [null, "a"],
      "points": [[0, 0, 0], [0, 0, 0]], "length": 0.5, "stiffness": 40})";
  Simulator inwards =
      simulator(mass_at("a", {0.4, 0, 0}, {0.1, 0, 0}), tie_settings(0.01, cable, false));
  run(inwards, 50);
  EXPECT_NEAR(inwards.states()[0].X_WB.position.x(), 0.45, 1e-12);
  // There and back: half a period on the cable, which keeps the speed.
  const std::vector<RunStep> steps = run(inwards, 150);
  EXPECT_NEAR(inwards.states()[0].v_WC.x(), -0.1, 1e-4);
  EXPECT_NEAR(energy_of(steps.back()), 0.005, 1e-5);
}

// Five balls in touch, each on two cables: the last one flies off alone.
TEST(Tie, CradleOnCables) {
  std::string bodies;
  std::string ties;
  const double r = 0.05;
  const double apart = 2.0 * r + 1.2e-4;
  for (int k = 0; k < 5; ++k) {
    const std::string name(1, static_cast<char>('a' + k));
    const double x = apart * k;
    const double angle = k == 0 ? 0.4 : 0.0;
    bodies += (k > 0 ? "," : "") +
              body(name, test::ball("0.05"), numbers({x - std::sin(angle), 0.0, -std::cos(angle)}),
                   R"(, "dynamics": {"mass": 1, "restitution": 1, "friction": 0})");
    for (const double y : {-0.5, 0.5}) {
      ties += (ties.empty() ? "" : ",") + (R"({"type": "cable", "bodies": [null, ")" + name) +
              R"("], "points": [)" + numbers({x, y, 0.0}) + ", [0, 0, 0]]}";
    }
  }
  Simulator s = simulator(bodies, tie_settings(0.01, ties));
  const double speed = std::sqrt(2.0 * kGravity * (1.0 - std::cos(0.4)));
  std::optional<RunStep> hit;
  for (int i = 0; i < 100 && !hit; ++i) {
    RunStep step = s.step().value();
    if (!step.impacts.empty()) {
      hit = std::move(step);
    }
  }
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->bodies[4].linear_velocity.x(), speed, 0.05 * speed);
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(hit->bodies[static_cast<std::size_t>(k)].linear_velocity.x(), 0.0, 0.02) << k;
  }
}

// A box that hangs on a pin at its corner: as a physical pendulum, about an axis of its own.
const std::string kPin = R"({"type": "pin", "bodies": [null, "a"], "points": [[0, 0, 0], null]})";

Simulator physical_pendulum(double h, const std::string& tie) {
  return simulator(body("a", box("[0.4, 0.1, 0.2]"), "[0.2, 0, 0]", R"(, "dynamics": {"mass": 3})"),
                   tie_settings(h, tie));
}

double physical_angle(double time) {
  const double I = 3.0 / 12.0 * (0.16 + 0.04) + 3.0 * 0.04;
  return followed(Vector2d(0.5 * kPi, 0.0), time, [I](const Vector2d& y) {
    return Vector2d(y[1], -3.0 * kGravity * 0.2 / I * std::sin(y[0]));
  })[0];
}

TEST(Tie, PhysicalPendulumOnAPinIsOfSecondOrder) {
  const double right = physical_angle(1.28);
  for (const std::string& tie : {kPin, std::string(R"({"type": "hinge", "bodies": [null, "a"],
                              "points": [[0, 0, 0], null], "axis": [0, 1, 0]})")}) {
    expect_order(0.005, [&](double h) {
      Simulator s = physical_pendulum(h, tie);
      run(s, steps_until(1.28, h));
      const Vector3d p = s.states()[0].X_WB.position;
      return std::abs(std::atan2(p.x(), -p.z()) - right);
    });
  }
}

TEST(Tie, PinsStayTogetherAndKeepTheEnergy) {
  // A chain of two boxes on the world, in space.
  Simulator s = simulator(
      body("a", box("[0.4, 0.1, 0.2]"), "[0.25, 0, 0]", R"(, "dynamics": {"mass": 3})") + "," +
          body("b", box("[0.3, 0.1, 0.1]"), "[0.75, 0, 0]",
               R"(, "dynamics": {"mass": 1, "linear_velocity": [0, 0, 0]})"),
      tie_settings(0.01, R"({"type": "pin", "bodies": [null, "a"], "points": [[0, 0, 0.1], null]},
                   {"type": "pin", "bodies": ["a", "b"], "points": [[0.3, 0, 0.05], null]})"));
  const double before = -0.0;
  double off = 0.0;
  double apart = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const RunStep step = s.step().value();
    ASSERT_EQ(step.time_lost, 0.0) << i;
    off = std::max(off, std::abs(energy_of(step) - before));
    const auto point = [&](std::size_t b, const Vector3d& p) -> Vector3d {
      return step.bodies[b].X_WB.position + step.bodies[b].X_WB.rotation * p;
    };
    apart = std::max({apart, (point(0, {-0.25, 0, 0.1}) - Vector3d(0, 0, 0.1)).norm(),
                      (point(0, {0.3, 0, 0.05}) - point(1, {-0.2, 0, 0.05})).norm()});
  }
  EXPECT_LE(apart, 1e-7);
  EXPECT_LE(off, 0.02);
}

// Two boxes that are welded tumble as one body.
TEST(Tie, WeldMovesAsOneBody) {
  const auto made = [](double h) {
    return simulator(
        body(
            "a", box("[0.4, 0.1, 0.2]"), "[0, 0, 0]",
            R"(, "dynamics": {"mass": 3, "linear_velocity": [0, -0.15, 0.1], "angular_velocity": [1, 0.2, 0.3]})") +
            "," +
            body(
                "b", box("[0.1, 0.3, 0.1]"), "[0.5, 0, 0.1]",
                R"(, "dynamics": {"mass": 1, "linear_velocity": [0.02, -0.1, 0.0], "angular_velocity": [1, 0.2, 0.3]})"),
        tie_settings(h, R"({"type": "weld", "bodies": ["a", "b"]})", false));
  };
  Simulator s = made(0.02);
  const RunStep first = s.step().value();
  for (int i = 0; i < 500; ++i) {
    const RunStep step = s.step().value();
    ASSERT_LE((step.linear_momentum - first.linear_momentum).norm(), 1e-10) << i;
    ASSERT_LE((step.angular_momentum - first.angular_momentum).norm(), 1e-6) << i;
    ASSERT_NEAR(energy_of(step), energy_of(first), 1e-4 * energy_of(first)) << i;
    const Pose& A = step.bodies[0].X_WB;
    const Pose& B = step.bodies[1].X_WB;
    ASSERT_LE((A.rotation.conjugate() * (B.position - A.position) - Vector3d(0.5, 0, 0.1)).norm(),
              1e-6);
    ASSERT_LE((A.rotation.conjugate() * B.rotation).vec().norm(), 1e-6);
  }
}

// A beam of two boxes that the world holds at one end carries its weight.
TEST(Tie, WeldCarriesALoad) {
  Simulator s = simulator(
      body("a", box("[0.4, 0.1, 0.1]"), "[0.2, 0, 0]", R"(, "dynamics": {"mass": 3})") + "," +
          body("b", box("[0.4, 0.1, 0.1]"), "[0.7, 0, 0]", R"(, "dynamics": {"mass": 5})"),
      tie_settings(
          0.01,
          R"({"type": "weld", "bodies": [null, "a"]}, {"type": "weld", "bodies": ["a", "b"]})"));
  const std::vector<RunStep> steps = run(s, 100);
  EXPECT_LE((steps.back().bodies[1].X_WB.position - Vector3d(0.7, 0, 0)).norm(), 1e-8);
  EXPECT_LE(steps.back().kinetic_energy, 1e-12);
  EXPECT_TRUE(steps.back().bodies[1].rests);
  // The first weld carries both: 8 kg, and their moment about its point, the middle of "a".
  ASSERT_EQ(steps.back().ties.size(), 2u);
  EXPECT_LE((steps.back().ties[0].force - Vector3d(0, 0, 8.0 * kGravity)).norm(), 1e-5);
  EXPECT_LE((steps.back().ties[0].torque - Vector3d(0, -5.0 * 0.5 * kGravity, 0)).norm(), 1e-5);
  EXPECT_LE((steps.back().ties[1].force - Vector3d(0, 0, 5.0 * kGravity)).norm(), 1e-5);
}

// A hanging body at rest sleeps, and a swinging one does not.
TEST(Tie, HangingBodiesSleepAtEquilibriumAlone) {
  const double sag = kGravity / 100.0;
  const std::string spring = kSpring + R"("stiffness": 100, "damping": 1})";
  Simulator still =
      simulator(mass_at("a", {0, 0, -0.5 - sag}, Vector3d::Zero()), tie_settings(0.01, spring));
  EXPECT_TRUE(run(still, 20).back().bodies[0].rests);
  still.apply_force(0, {1, 0, 0});
  EXPECT_FALSE(still.step().value().bodies[0].rests);
  Simulator moving = simulator(mass_at("a", {0, 0, -0.51 - sag}, Vector3d::Zero()),
                               tie_settings(0.01, kSpring + R"("stiffness": 100})"));
  for (int i = 0; i < 400; ++i) {
    ASSERT_FALSE(moving.step().value().bodies[0].rests) << i;
  }
}

// A scripted body wakes what hangs on it, and lifts it.
TEST(Tie, ScriptedBodiesPullCables) {
  Simulator s = simulator(
      mass_at("a", {0, 0, -1}, Vector3d::Zero()) + "," +
          R"({"name": "hook", "shape": {"sphere": {"radius": 0.01}}, "motion": {"type": "waypoints",
              "times": [0, 0.5, 1.5, 2], "poses": [{"position": [0, 0, 0]}, {"position": [0, 0, 0]},
              {"position": [0, 0, 0.3]}, {"position": [0, 0, 0.3]}]}})",
      R"("step": 0.01, "contact_distance": 1e-4, "ties": [{"type": "cable",
          "bodies": ["hook", "a"], "points": [[0, 0, 0], [0, 0, 0]]}])");
  EXPECT_TRUE(run(s, 45).back().bodies[0].rests);
  EXPECT_FALSE(run(s, 55).back().bodies[0].rests);
  run(s, 80);
  EXPECT_NEAR(s.states()[0].X_WB.position.z(), -0.7, 1e-2);
}

// A run that is resumed goes on bit for bit.
/// A ball that a script leads away by 1 m and back, in 2 s.
const std::string kPuller = R"({"name": "A", "shape": {"sphere": {"radius": 0.1}}, "motion":
    {"type": "waypoints", "times": [0, 1, 2], "poses": [{"position": [0, 0, 0]},
     {"position": [1, 0, 0]}, {"position": [0, 0, 0]}]}})";

/// It is tied to a ball 1 m beside it.
Simulator pulled(const std::string& ties, const std::string& more = "",
                 const std::string& jams = "lose_time") {
  return simulator(kPuller + "," + mass_at("B", {-1, 0, 0}, Vector3d::Zero()) + more,
                   tie_settings(0.01, ties, false) + R"(, "jams": ")" + jams + "\"");
}

// A script pulls at what the world holds: ties do not break, so time is lost. Before, the points
// were 1 m apart in the end, and nothing said so.
TEST(Tie, ScriptsDoNotTearThem) {
  const std::string held = R"({"type": "weld", "bodies": [null, "B"]})";
  for (
      const std::string tie :
      {R"({"type": "weld", "bodies": ["A", "B"]})",
       R"({"type": "pin", "bodies": ["A", "B"], "points": [[0, 0, 0], null]})",
       R"({"type": "cable", "bodies": ["A", "B"], "points": [[0, 0, 0], [0, 0, 0]], "length": 1.2})"}) {
    const double slack = tie.find("cable") != std::string::npos ? 0.2 : 0.0;
    Simulator s = pulled(std::string(tie) + "," + held);
    double lost = 0.0;
    for (const RunStep& step : run(s, 100)) {
      lost += step.time_lost;
    }
    EXPECT_NEAR(lost, 1.0 - slack, 0.02) << tie;
    EXPECT_NEAR((s.states()[0].X_WB.position - s.states()[1].X_WB.position).norm(), 1.0 + slack,
                1e-3)
        << tie;
  }
}

// With "wait" the script alone stands still, and goes on where it leads back.
TEST(Tie, ScriptsThatPullWait) {
  const std::string wall = "," + body("w", box("[0.1, 1, 1]"), "[-0.5, 0, 0.2]");
  const std::string cable = R"({"type": "cable", "bodies": ["A", "B"],
                               "points": [[0, 0, 0], [0, 0, 0]], "length": 1.2})";
  const std::string weld = R"({"type": "weld", "bodies": ["A", "B"]})";
  for (const std::string& tie : {cable, weld}) {
    Simulator s = pulled(tie, wall, "wait");
    double most = 0.0;  // [m]
    for (const RunStep& step : run(s, 200)) {
      ASSERT_EQ(step.time_lost, 0.0) << tie << " " << step.index;
      for (const RunBody& moved : step.bodies) {
        const double x = moved.X_WB.position.x();
        most = std::max(most, moved.body == 0 ? x : most);
        ASSERT_TRUE(moved.body == 0 || x <= -0.6) << tie << " " << step.index;
      }
    }
    const double reach = tie == cable ? 0.6 : 0.4;  // Until B is at the wall.
    EXPECT_NEAR(most, reach, 5e-3) << tie;
    EXPECT_NEAR(s.states()[0].X_WB.position.x(), 0.0, 0.02) << tie;
  }
}

TEST(Tie, RunsAreResumed) {
  const auto made = [] { return orbiting(0.02); };
  Simulator whole = made();
  const std::vector<RunStep> steps = run(whole, 20);
  Simulator resumed = made();
  resumed.resume(steps[9]);
  const std::vector<RunStep> rest = run(resumed, 10);
  for (std::size_t k = 0; k < rest.size(); ++k) {
    for (std::size_t b = 0; b < 2; ++b) {
      ASSERT_EQ(rest[k].bodies[b].X_WB.position, steps[10 + k].bodies[b].X_WB.position);
      ASSERT_EQ(rest[k].bodies[b].angular_velocity, steps[10 + k].bodies[b].angular_velocity);
    }
  }
}

// A body on a cable that rests on the floor, and one that a spring presses on it.
TEST(Tie, ContactsActBesideTies) {
  Simulator s = simulator(
      test::kFloor + "," +
          body("a", box("[0.2, 0.2, 0.2]"), "[0, 0, 0.1002]", R"(, "dynamics": {"mass": 2})") +
          "," +
          body("b", box("[0.2, 0.2, 0.2]"), "[0.5, 0, 0.1002]",
               R"(, "dynamics": {"mass": 2, "friction": 0, "linear_velocity": [1, 0, 0]})"),
      R"("step": 0.01, "contact_distance": 1e-4, "friction": 0, "ties": [
          {"type": "cable", "bodies": ["a", "b"], "points": [[0, 0, 0], [0, 0, 0]], "length": 0.6},
          {"type": "spring", "bodies": [null, "a"], "points": [[0, 0, 1], [0, 0, 0]],
           "length": 2, "stiffness": 10}])");
  const std::vector<RunStep> steps = run(s, 100);
  // The cable makes both go on together.
  EXPECT_NEAR(steps.back().linear_momentum.y(), 0.0, 1e-6);
  EXPECT_LE((s.states()[2].X_WB.position - s.states()[1].X_WB.position).norm(), 0.6 + 1e-6);
  EXPECT_NEAR(s.states()[1].X_WB.position.z(), 0.1, 3e-4);
  EXPECT_EQ(test::verify(s.header(), steps).verdict, ProofVerdict::proven);
}

void expect_refused(const std::string& bodies, const std::string& ties, const std::string& what) {
  try {
    (void)simulator(bodies, tie_settings(0.01, ties));
    FAIL() << ties;
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
  }
}

TEST(Tie, ErrorsNameTheTieAndTheMend) {
  const std::string bodies =
      mass_at("a", {1, 0, 0}, Vector3d::Zero()) + "," + body("wall", box("[1, 1, 1]"), "[0, 0, 5]");
  expect_refused(bodies, R"({"type": "rope", "bodies": [null, "a"]})", "ties[0].type");
  expect_refused(bodies, R"({"type": "weld", "bodies": [null, null]})", "the world twice");
  expect_refused(bodies, R"({"type": "weld", "bodies": ["a", "a"]})", "got one twice");
  expect_refused(bodies, R"({"type": "weld", "bodies": ["a", "c"]})", "ties[0].bodies[1]");
  expect_refused(bodies, R"({"type": "pin", "bodies": [null, "a"]})", "\"points\"");
  expect_refused(bodies, R"({"type": "pin", "bodies": [null, "a"], "length": 1})", "length");
  expect_refused(bodies, R"({"type": "spring", "bodies": [null, "a"],
                             "points": [[0, 0, 0], [0, 0, 0]]})",
                 "stiffness");
  expect_refused(bodies, R"({"type": "cable", "bodies": [null, "a"],
                             "points": [[0, 0, 0], [0, 0, 0]], "damping": 1})",
                 "stiffness");
  expect_refused(bodies, R"({"type": "weld", "bodies": ["wall", null]})",
                 "simulation.ties[0], a weld of \"wall\" and the world: neither is free");
  expect_refused(bodies, R"({"type": "pin", "bodies": [null, "a"],
                             "points": [[0, 0, 0], [0, 0, 0]]})",
                 "its points are 1 m apart");
  expect_refused(bodies, R"({"type": "cable", "bodies": [null, "a"], "length": 0.5,
                             "points": [[0, 0, 0], [0, 0, 0]]})",
                 "farther than its length of 0.5 m");
  expect_refused(bodies, R"({"type": "spring", "bodies": [null, "a"], "length": 0.5,
                             "points": [[1, 0, 0], [0, 0, 0]], "stiffness": 1})",
                 "no direction");
  expect_refused(bodies, R"({"type": "hinge", "bodies": [null, "a"], "axis": [0, 0, 0],
                             "points": [[1, 0, 0], null]})",
                 "axis");
}

TEST(Tie, StatesThatWouldTearOneAreRefused) {
  Simulator s = simulator(mass_at("a", {1, 0, 0}, Vector3d::Zero()), tie_settings(0.01, kCable));
  RigidState state = s.states()[0];
  state.X_WB.position.x() = 1.1;
  EXPECT_THROW(s.set_state(0, state), std::invalid_argument);
  state.X_WB.position.x() = 0.9;
  s.set_state(0, state);
}

}  // namespace
}  // namespace firstcontact
