#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/mechanism/mechanism.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kGravity = 9.81;  // [m/s^2]
const Vector3d kDown{0.0, 0.0, -kGravity};

LinkInertia point_mass(double mass, const Vector3d& at) { return {.mass = mass, .p_LC = at}; }

LinkInertia random_inertia(std::mt19937& rng) {
  std::normal_distribution<double> n;
  const Eigen::Matrix3d root = Eigen::Matrix3d::NullaryExpr([&] { return n(rng); });
  // Second moments of points, so that the inertia is that of a real body.
  const Eigen::Matrix3d points = root * root.transpose() + 0.1 * Eigen::Matrix3d::Identity();
  return {.mass = std::exp(n(rng)),
          .p_LC = {n(rng), n(rng), n(rng)},
          .about_C_L = points.trace() * Eigen::Matrix3d::Identity() - points};
}

Pose random_pose(std::mt19937& rng) {
  std::normal_distribution<double> n;
  return {{n(rng), n(rng), n(rng)},
          Eigen::Quaterniond(n(rng), n(rng), n(rng), n(rng)).normalized()};
}

/// A chain of joints of these types; every other joint branches off the second link.
RobotModel chain(std::mt19937& rng, const std::vector<JointType>& types) {
  std::normal_distribution<double> n;
  RobotDescription robot{.name = "chain"};
  robot.links.push_back({.name = "l0", .inertia = random_inertia(rng)});
  for (std::size_t k = 0; k < types.size(); ++k) {
    const std::string name = "l" + std::to_string(k + 1);
    robot.links.push_back({.name = name, .inertia = random_inertia(rng)});
    Joint joint{.name = "j" + std::to_string(k), .type = types[k]};
    joint.parent = "l" + std::to_string(k % 2 == 1 && k > 2 ? 1 : k);
    joint.child = name;
    joint.X_PJ = random_pose(rng);
    joint.axis = {n(rng), n(rng), n(rng)};
    joint.pitch = 0.3;
    robot.joints.push_back(joint);
  }
  return RobotModel(std::move(robot));
}

MechanismState random_state(std::mt19937& rng, const Mechanism& mechanism) {
  std::normal_distribution<double> n;
  MechanismState state = mechanism.rest();
  const auto random = [&] { return n(rng); };
  state.positions =
      mechanism.moved(state.positions, VectorXd::NullaryExpr(mechanism.size(), random));
  state.velocities = VectorXd::NullaryExpr(mechanism.size(), random);
  return state;
}

RobotModel pendulum(double length) {
  RobotDescription robot{.name = "pendulum"};
  robot.links.push_back({.name = "base"});
  robot.links.push_back({.name = "bob", .inertia = point_mass(2.0, {0, 0, -length})});
  robot.joints.push_back({.name = "hinge",
                          .type = JointType::continuous,
                          .parent = "base",
                          .child = "bob",
                          .axis = {0.0, 1.0, 0.0}});
  return RobotModel(std::move(robot));
}

TEST(Mechanism, APendulumHasItsMomentAndItsWeight) {
  const Mechanism mechanism(pendulum(0.5), {}, false);
  MechanismState state = mechanism.rest();
  state.positions[0] = 0.3;
  const MechanismInstant instant = mechanism.at(state);
  EXPECT_NEAR(mechanism.mass_matrix(instant)(0, 0), 2.0 * 0.25, 1e-15);
  EXPECT_NEAR(mechanism.bias_forces(instant, kDown)[0], 2.0 * kGravity * 0.5 * std::sin(0.3),
              1e-14);
}

// Its period by the complete elliptic integral, through the arithmetic-geometric mean.
TEST(Mechanism, APendulumSwingsInItsPeriod) {
  const double length = 0.5;
  const double amplitude = 1.2;
  double a = 1.0;
  double b = std::cos(0.5 * amplitude);
  for (int k = 0; k < 10; ++k) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  const double period = 2.0 * std::numbers::pi * std::sqrt(length / kGravity) / a;
  const Mechanism mechanism(pendulum(length), {}, false);
  MechanismState state = mechanism.rest();
  state.positions[0] = amplitude;
  const int steps = 400;
  for (int k = 0; k < steps; ++k) {
    state = mechanism.after_free_motion(state, kDown, period / steps);
  }
  EXPECT_NEAR(state.positions[0], amplitude, 1e-8);
  EXPECT_NEAR(state.velocities[0], 0.0, 1e-7);
}

/// Changes over a step of free motion: energy, and without gravity momentum.
struct Drift {
  double energy = 0.0;
  double linear = 0.0;
  double angular = 0.0;
};

Drift drift(const Mechanism& mechanism, const MechanismState& begin, const Vector3d& gravity,
            double dt, int steps) {
  MechanismState state = begin;
  for (int k = 0; k < steps; ++k) {
    state = mechanism.after_free_motion(state, gravity, dt / steps);
  }
  const MechanismMechanics before = mechanism.mechanics(begin, gravity);
  const MechanismMechanics after = mechanism.mechanics(state, gravity);
  return {std::abs(after.kinetic_energy + after.potential_energy - before.kinetic_energy -
                   before.potential_energy),
          (after.linear_momentum - before.linear_momentum).norm(),
          (after.angular_momentum - before.angular_momentum).norm()};
}

/// Links of 0.5 m that turn about y, the last one of another mass; inertias as of slender rods.
RobotModel rope(std::size_t links, double last_mass) {
  RobotDescription robot{.name = "rope"};
  robot.links.push_back({.name = "l0"});
  for (std::size_t k = 1; k <= links; ++k) {
    const double mass = k == links ? last_mass : 1.0;
    robot.links.push_back(
        {.name = "l" + std::to_string(k),
         .inertia = LinkInertia{.mass = mass,
                                .p_LC = {0.0, 0.0, -0.25},
                                .about_C_L = Vector3d(0.02, 0.02, 0.002).asDiagonal() * mass}});
    Joint joint{.name = "j" + std::to_string(k), .type = JointType::continuous};
    joint.parent = "l" + std::to_string(k - 1);
    joint.child = "l" + std::to_string(k);
    joint.X_PJ = {{0.0, 0.0, k == 1 ? 0.0 : -0.5}, Eigen::Quaterniond::Identity()};
    joint.axis = {0.0, 1.0, 0.0};
    robot.joints.push_back(joint);
  }
  return RobotModel(std::move(robot));
}

// Light links turn by radians in no time as they snap through a line. Sub-steps by the speed from
// before gained up to 1e12 J there.
TEST(Mechanism, LightLinksThatCarryAHeavyOneKeepTheEnergy) {
  for (const std::size_t links : {2U, 3U, 5U}) {
    for (const double mass : {10.0, 100.0, 1e3, 1e4}) {
      const Mechanism mechanism(rope(links, mass), {}, false);
      MechanismState state = mechanism.rest();
      state.positions[0] = 1.2;
      state.positions[1] = 1.0;
      const MechanismMechanics begin = mechanism.mechanics(state, kDown);
      double most = 0.0;
      double off = 0.0;
      for (int k = 0; k < 150; ++k) {
        state = mechanism.after_free_motion(state, kDown, 0.01);
        const MechanismMechanics now = mechanism.mechanics(state, kDown);
        most = std::max(most, now.kinetic_energy);
        off = std::max(
            off, std::abs(now.kinetic_energy + now.potential_energy - begin.potential_energy));
      }
      EXPECT_LE(off, 5e-4 * most) << links << " links, " << mass << " kg";
    }
  }
}

// A torque that is large beside the inertia turns a link that rests by radians in one step.
TEST(Mechanism, AStrongTorqueTurnsAsItShould) {
  const Mechanism mechanism(rope(1, 1.0), {}, false);
  const double moment = 0.02 + 0.25 * 0.25;
  MechanismDrive drive;
  drive.forces = VectorXd::Constant(1, 500.0);
  const MechanismMotion motion =
      mechanism.after_driven_motion(mechanism.rest(), Vector3d::Zero(), drive, 0.05);
  EXPECT_NEAR(motion.end.positions[0], 0.5 * 500.0 / moment * 0.05 * 0.05, 1e-9);
  EXPECT_NEAR(motion.end.velocities[0], 500.0 / moment * 0.05, 1e-9);
}

// Wrong bias forces or a wrong mass matrix of any joint type would change the energy at once.
TEST(Mechanism, KeepsItsEnergyWhateverItsJoints) {
  std::mt19937 rng(5);
  const std::vector<std::vector<JointType>> chains{
      {JointType::revolute, JointType::prismatic, JointType::continuous},
      {JointType::screw, JointType::planar},
      {JointType::ball, JointType::revolute, JointType::ball},
      {JointType::floating, JointType::prismatic, JointType::screw},
      {JointType::planar, JointType::fixed, JointType::ball, JointType::floating}};
  for (const bool free_base : {false, true}) {
    for (const auto& types : chains) {
      const Mechanism mechanism(chain(rng, types), random_pose(rng), free_base);
      const MechanismState state = random_state(rng, mechanism);
      const Drift coarse = drift(mechanism, state, kDown, 0.1, 200);
      const Drift fine = drift(mechanism, state, kDown, 0.1, 400);
      EXPECT_LE(coarse.energy, 1e-2 * (1.0 + mechanism.mechanics(state, kDown).kinetic_energy));
      // Converges with the fourth power of the step.
      EXPECT_LE(fine.energy, 0.1 * coarse.energy + 1e-10);
    }
  }
}

TEST(Mechanism, KeepsItsMomentumWhereNothingHoldsIt) {
  std::mt19937 rng(6);
  for (int i = 0; i < 5; ++i) {
    const Mechanism mechanism(chain(rng, {JointType::revolute, JointType::ball, JointType::screw}),
                              random_pose(rng), true);
    const MechanismState state = random_state(rng, mechanism);
    const Drift coarse = drift(mechanism, state, Vector3d::Zero(), 0.1, 200);
    const Drift fine = drift(mechanism, state, Vector3d::Zero(), 0.1, 400);
    EXPECT_LE(fine.linear, 0.1 * coarse.linear + 1e-10) << i;
    EXPECT_LE(fine.angular, 0.1 * coarse.angular + 1e-10) << i;
    EXPECT_LE(fine.linear + fine.angular, 1e-4) << i;
  }
}

// Along its own way a mechanism is carried as inertia takes it, to second order in the time: half
// of it leaves a quarter of the difference.
TEST(Mechanism, CarriesVelocitiesAsInertiaDoes) {
  std::mt19937 rng(7);
  for (int trial = 0; trial < 20; ++trial) {
    const Mechanism mechanism(chain(rng, {JointType::floating, JointType::revolute, JointType::ball,
                                          JointType::planar, JointType::prismatic}),
                              {}, trial % 2 == 0);
    const MechanismState state = random_state(rng, mechanism);
    const double energy = mechanism.mechanics(state, Vector3d::Zero()).kinetic_energy;
    const auto difference = [&](double dt) {
      const MechanismState after = mechanism.after_free_motion(state, Vector3d::Zero(), dt);
      const VectorXd carried = mechanism.carried(state, after.positions);
      EXPECT_NEAR(mechanism.mechanics({after.positions, carried}, Vector3d::Zero()).kinetic_energy,
                  energy, 1e-9 * energy);
      return (carried - after.velocities).norm() / state.velocities.norm();
    };
    EXPECT_LT(difference(5e-4), 0.3 * difference(1e-3)) << trial;
    EXPECT_LT(difference(1e-3), 1e-3) << trial;
  }
}

// Power and impulses balance, and driven coordinates have the rates that are asked for.
TEST(Mechanism, MovesUnderForcesAndDrives) {
  std::mt19937 rng(8);
  for (int trial = 0; trial < 10; ++trial) {
    const Mechanism mechanism(
        chain(rng, {JointType::revolute, JointType::prismatic, JointType::revolute}), {},
        trial % 2 == 0);
    const MechanismState state = random_state(rng, mechanism);
    const Eigen::Index n = mechanism.size();
    const MechanismDrive drive{.forces = VectorXd::Random(n),
                               .driven = {n - 2},
                               .accelerations = VectorXd::Constant(1, 3)};
    const auto after = [&](double dt) {
      return mechanism.after_driven_motion(state, kDown, drive, dt);
    };
    const double dt = 1e-3;
    const MechanismMotion motion = after(dt);
    EXPECT_NEAR(motion.end.velocities[n - 2], state.velocities[n - 2] + 3.0 * dt, 1e-12);
    const auto energy = [&](const MechanismState& at) {
      const MechanismMechanics mechanics = mechanism.mechanics(at, kDown);
      return mechanics.kinetic_energy + mechanics.potential_energy;
    };
    VectorXd forces = drive.forces;
    forces[n - 2] += motion.impulses[0] / dt;
    const double work = forces.dot(0.5 * dt * (state.velocities + motion.end.velocities));
    const double gained = energy(motion.end) - energy(state);
    EXPECT_NEAR(gained, work, 1e-4 * (std::abs(work) + dt * dt * energy(state) + 1e-4)) << trial;
  }
}

TEST(Mechanism, GivesAFreeBaseTheMomentaThatItIsToHave) {
  std::mt19937 rng(9);
  const Mechanism mechanism(chain(rng, {JointType::revolute, JointType::ball}), random_pose(rng),
                            true);
  MechanismState state = random_state(rng, mechanism);
  const VectorXd before = state.velocities;
  state.velocities = mechanism.with_momenta(state, {1, 2, 3}, {-3, 2, 5});
  const MechanismMechanics mechanics = mechanism.mechanics(state, kDown);
  EXPECT_LE((mechanics.linear_momentum - Vector3d(1, 2, 3)).norm(), 1e-12);
  EXPECT_LE((mechanics.angular_momentum - Vector3d(-3, 2, 5)).norm(), 1e-12);
  EXPECT_EQ(state.velocities.tail(mechanism.size() - 6), before.tail(mechanism.size() - 6));
}

TEST(Mechanism, CarriesVelocitiesOfOneHingeUnchanged) {
  const Mechanism mechanism(pendulum(0.7), {}, false);
  const MechanismState state{VectorXd::Constant(1, 0.3), VectorXd::Constant(1, 5.0)};
  EXPECT_NEAR(mechanism.carried(state, VectorXd::Constant(1, 0.4))[0], 5.0, 1e-12);
}

// The Jacobians are the derivatives of where the links are.
TEST(Mechanism, LinksMoveAsTheirJacobiansSay) {
  std::mt19937 rng(7);
  constexpr double kStep = 1e-6;
  const Mechanism mechanism(chain(rng, {JointType::planar, JointType::ball, JointType::screw,
                                        JointType::prismatic, JointType::floating}),
                            random_pose(rng), true);
  const MechanismState state = random_state(rng, mechanism);
  const MechanismInstant now = mechanism.at(state);
  MechanismState next = state;
  next.positions = mechanism.moved(state.positions, kStep * state.velocities);
  const MechanismInstant then = mechanism.at(next);
  for (std::size_t l = 0; l < now.X_WL.size(); ++l) {
    const MechanismInstant::Spatial V = now.J[l] * state.velocities;
    EXPECT_LE((V - now.velocity[l]).norm(), 1e-12 * V.norm());
    const Vector3d w = V.tail<3>();
    const Vector3d v = V.head<3>() + w.cross(now.X_WL[l].position - now.reference);
    const Vector3d moved = (then.X_WL[l].position - now.X_WL[l].position) / kStep;
    EXPECT_LE((moved - v).norm(), 1e-4 * (1.0 + v.norm())) << l;
    const Eigen::AngleAxisd turned(then.X_WL[l].rotation * now.X_WL[l].rotation.conjugate());
    EXPECT_LE((turned.angle() * turned.axis() / kStep - w).norm(), 1e-4 * (1.0 + w.norm())) << l;
  }
}

TEST(Mechanism, AMimicMovesAlong) {
  RobotDescription robot{.name = "gripper"};
  robot.links.push_back({.name = "palm"});
  for (const char* finger : {"left", "right"}) {
    robot.links.push_back({.name = finger, .inertia = point_mass(0.1, {0, 0, 0})});
    robot.joints.push_back({.name = finger,
                            .type = JointType::prismatic,
                            .parent = "palm",
                            .child = finger,
                            .axis = {1.0, 0.0, 0.0}});
  }
  robot.joints[1].mimic = Mimic{.joint = "left", .multiplier = -2.0, .offset = 0.05};
  const Mechanism mechanism(RobotModel(std::move(robot)), {}, false);
  ASSERT_EQ(mechanism.size(), 1);
  MechanismState state = mechanism.rest();
  state.positions[0] = 0.01;
  state.velocities[0] = 1.0;
  const MechanismInstant instant = mechanism.at(state);
  EXPECT_NEAR(instant.X_WL[2].position.x(), 0.03, 1e-15);
  EXPECT_NEAR(instant.velocity[2][0], -2.0, 1e-15);
  EXPECT_NEAR(mechanism.mass_matrix(instant)(0, 0), 0.1 + 4.0 * 0.1, 1e-15);
}

void expect_refused(RobotDescription robot, const std::string& part) {
  try {
    const Mechanism mechanism(RobotModel(std::move(robot)), {}, false);
    mechanism.require_mass(mechanism.rest().positions);
    FAIL() << "expected a complaint with " << part;
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(Mechanism, NamesWhatMovesNoMass) {
  RobotDescription robot{.name = "light"};
  robot.links.resize(2);
  robot.links[0].name = "base";
  robot.links[1].name = "bob";
  robot.joints.push_back(
      {.name = "hinge", .type = JointType::continuous, .parent = "base", .child = "bob"});
  expect_refused(robot, "joint \"hinge\" moves no mass");
  robot.links[1].inertia = LinkInertia{.mass = -1.0};
  expect_refused(robot, "link \"bob\": its mass must be >= 0");
  robot.links[1].inertia =
      LinkInertia{.mass = 1.0, .about_C_L = Vector3d(1.0, 1.0, -1.0).asDiagonal()};
  expect_refused(robot, "link \"bob\": a principal moment");
  robot.links[1].inertia = LinkInertia{.mass = 1.0, .defect = "r.urdf:7: a second one"};
  expect_refused(robot, "link \"bob\": r.urdf:7: a second one");
}

}  // namespace
}  // namespace firstcontact
