#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/contact_solver/contact_problem.h>

#include "contact_solver/wall_problem.h"
#include "support/rounds.h"

namespace firstcontact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kTolerance = 1e-10;  // [m/s]

Vector3d any_vector(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  return {normal(rng), normal(rng), normal(rng)};
}

Matrix3d random_frame(std::mt19937& rng) {
  std::normal_distribution<double> n;
  return Eigen::Quaterniond(n(rng), n(rng), n(rng), n(rng)).normalized().toRotationMatrix();
}

ContactBody cube(double mass, const Vector3d& v = Vector3d::Zero()) {
  ContactBody body;
  body.inverse_inertia.mass = Vector3d::Constant(1.0 / mass);
  body.inverse_inertia.rotation = 6.0 / mass * Matrix3d::Identity();  // Cube of side 1.
  body.v = v;
  return body;
}

/// A contact with normal z between the ground, body 0, and body 1 with its centre at height 1/2.
ContactPoint on_ground(double x, double y, double friction) {
  ContactPoint contact;
  contact.bodies = {0, 1};
  contact.arm_A = {x, y, 0.0};
  contact.arm_B = {x, y, -0.5};
  contact.frame << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  contact.friction = friction;
  return contact;
}

/// A heap of bodies, each touching some before it; body 0 is fixed.
ContactProblem random_heap(std::mt19937& rng, double friction) {
  std::normal_distribution<double> normal;
  ContactProblem problem;
  problem.bodies.resize(1);
  for (std::size_t b = 1; b < 7; ++b) {
    ContactBody body = cube(std::exp(normal(rng)), any_vector(rng));
    body.w = any_vector(rng);
    problem.bodies.push_back(body);
    for (int k = 0; k < 4; ++k) {
      ContactPoint contact;
      contact.bodies = {rng() % b, b};
      contact.arm_A = any_vector(rng);
      contact.arm_B = any_vector(rng);
      contact.frame = random_frame(rng);
      contact.friction = friction;
      contact.least_normal_velocity = -std::abs(0.1 * normal(rng));
      problem.contacts.push_back(contact);
    }
  }
  return problem;
}

ContactSolution solve(const ContactProblem& problem, ProjectionSpace space) {
  return project_on_contacts(problem, {.tolerance = kTolerance, .space = space, .sweeps = 100000});
}

double greatest_difference(const ContactSolution& x, const ContactSolution& y) {
  double greatest = 0.0;
  for (std::size_t b = 0; b < x.bodies.size(); ++b) {
    greatest = std::max(
        {greatest, (x.bodies[b].v - y.bodies[b].v).norm(), (x.bodies[b].w - y.bodies[b].w).norm()});
  }
  return greatest;
}

/// 1/2 |V - V_free|^2 in the kinetic metric, of bodies of which something moves.
double constraint(const ContactProblem& problem, const std::vector<ContactBody>& bodies) {
  double sum = 0.0;
  for (std::size_t b = 1; b < bodies.size(); ++b) {
    const InverseInertia& inverse = problem.bodies[b].inverse_inertia;
    const Vector3d dv = bodies[b].v - problem.bodies[b].v;
    const Vector3d dw = bodies[b].w - problem.bodies[b].w;
    sum += 0.5 * dv.dot(inverse.mass.cwiseInverse().cwiseProduct(dv)) +
           0.5 * dw.dot(inverse.rotation.inverse() * dw);
  }
  return sum;
}

TEST(ProjectOnContacts, IsTheSameInBothSpacesWithoutFriction) {
  std::mt19937 rng(1);
  for (int i = 0; i < 100; ++i) {
    const ContactProblem problem = random_heap(rng, 0.0);
    const ContactSolution contact = solve(problem, ProjectionSpace::contact);
    const ContactSolution motion = solve(problem, ProjectionSpace::motion);
    ASSERT_LE(contact.residual, kTolerance) << i;
    ASSERT_LE(motion.residual, kTolerance) << i;
    ASSERT_LE(greatest_difference(contact, motion), 1e-7) << i;
  }
}

// Gauss: nothing that the contacts allow is nearer to the free velocities.
TEST(ProjectOnContacts, IsTheNearestAllowedMotion) {
  std::mt19937 rng(2);
  for (int i = 0; i < 10; ++i) {
    const ContactProblem problem = random_heap(rng, 0.0);
    const ContactSolution solution = solve(problem, ProjectionSpace::automatic);
    const double least = constraint(problem, solution.bodies);
    for (int k = 0; k < 20; ++k) {
      // Another allowed motion: the answer to other free velocities.
      ContactProblem other = problem;
      for (std::size_t b = 1; b < other.bodies.size(); ++b) {
        other.bodies[b].v += 0.1 * any_vector(rng);
        other.bodies[b].w += 0.1 * any_vector(rng);
      }
      const ContactSolution allowed = solve(other, ProjectionSpace::automatic);
      ASSERT_GE(constraint(problem, allowed.bodies), least - 1e-8) << i;
    }
  }
}

TEST(ProjectOnContacts, MeetsTheLawsWithFriction) {
  std::mt19937 rng(3);
  for (int i = 0; i < 100; ++i) {
    // Arms as long as a body: a contact that sees less inertia along its normal than friction
    // takes may have no solution (Painleve).
    ContactProblem problem = random_heap(rng, 0.4);
    for (ContactPoint& contact : problem.contacts) {
      contact.arm_A *= 0.3;
      contact.arm_B *= 0.3;
    }
    for (const ProjectionSpace space : {ProjectionSpace::contact, ProjectionSpace::motion}) {
      const ContactSolution solution =
          project_on_contacts(problem, {.tolerance = 1e-8, .space = space, .sweeps = 20000});
      ASSERT_LE(solution.residual, 1e-8) << i << " " << static_cast<int>(space);
      ASSERT_NEAR(contact_residual(problem, solution), solution.residual, 1e-12) << i;
      for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
        const Vector3d& r = solution.impulses[k];
        ASSERT_LE(r.tail<2>().norm(), 0.4 * r[0] + 1e-12) << i;
      }
    }
  }
}

// Momentum changes by the impulses and by nothing else.
TEST(ProjectOnContacts, ImpulsesMakeTheVelocities) {
  std::mt19937 rng(4);
  const ContactProblem problem = random_heap(rng, 0.3);
  const ContactSolution solution = solve(problem, ProjectionSpace::automatic);
  std::vector<Vector3d> momentum(problem.bodies.size(), Vector3d::Zero());
  for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
    const ContactPoint& contact = problem.contacts[k];
    const Vector3d impulse = contact.frame.transpose() * solution.impulses[k];
    momentum[contact.bodies[0]] -= impulse;
    momentum[contact.bodies[1]] += impulse;
  }
  for (std::size_t b = 1; b < problem.bodies.size(); ++b) {
    const Vector3d change = problem.bodies[b].inverse_inertia.mass.cwiseProduct(momentum[b]);
    EXPECT_LE((solution.bodies[b].v - problem.bodies[b].v - change).norm(), 1e-12);
  }
}

// The cone is round: friction points against sliding, whatever its direction.
TEST(ProjectOnContacts, FrictionOpposesSlidingInEveryDirection) {
  for (int degrees = 0; degrees < 360; degrees += 7) {
    const double angle = degrees * 3.14159265358979 / 180.0;
    ContactProblem problem;
    problem.bodies = {{}, cube(2.0, {3.0 * std::cos(angle), 3.0 * std::sin(angle), -1.0})};
    problem.bodies[1].inverse_inertia.rotation.setZero();
    problem.contacts = {on_ground(0.0, 0.0, 0.5)};
    const ContactSolution solution = solve(problem, ProjectionSpace::automatic);
    const Vector3d expected(2.5 * std::cos(angle), 2.5 * std::sin(angle), 0.0);
    EXPECT_LE((solution.bodies[1].v - expected).norm(), 1e-12) << degrees;
  }
}

TEST(ProjectOnContacts, SticksInsideTheConeAndSlidesOutside) {
  const auto speed_after = [](double friction) {
    ContactProblem problem;
    problem.bodies = {{}, cube(1.0, {0.5, 0.0, -1.0})};
    for (const double x : {-0.5, 0.5}) {
      for (const double y : {-0.5, 0.5}) {
        problem.contacts.push_back(on_ground(x, y, friction));
      }
    }
    return solve(problem, ProjectionSpace::automatic).bodies[1].v.x();
  };
  EXPECT_NEAR(speed_after(0.51), 0.0, 1e-9);
  EXPECT_NEAR(speed_after(0.49), 0.01, 1e-9);
}

TEST(ProjectOnContacts, SticksToABeltAsToAGroundThatMoves) {
  for (const ProjectionSpace space : {ProjectionSpace::contact, ProjectionSpace::motion}) {
    ContactProblem belt;
    ContactBody body = cube(2.0, {0.3, -0.1, -1.0});
    belt.bodies = {ContactBody{}, body};
    for (const double x : {-0.5, 0.5}) {
      for (const double y : {-0.5, 0.5}) {
        belt.contacts.push_back(on_ground(x, y, 0.4));
      }
    }
    ContactProblem ground = belt;
    ground.bodies[0].v = {0.5, 0.2, 0.0};
    for (ContactPoint& contact : belt.contacts) {
      contact.sticking_velocity = {0.5, 0.2};  // The tangents of on_ground() are x and y.
    }
    const ContactSolution on_belt = solve(belt, space);
    EXPECT_LE(contact_residual(belt, on_belt), kTolerance);
    const ContactSolution on_moving = solve(ground, space);
    EXPECT_LE((on_belt.bodies[1].v - on_moving.bodies[1].v).norm(), 1e-8);
    EXPECT_LE((on_belt.bodies[1].w - on_moving.bodies[1].w).norm(), 1e-8);
  }
}

TEST(ProjectOnContacts, TakesAThousandRedundantContacts) {
  ContactProblem problem;
  problem.bodies = {{}, cube(1.0, {0.2, 0.1, -1.0})};
  problem.bodies[1].w = {0.3, -0.2, 0.1};
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> side(-0.5, 0.5);
  for (int k = 0; k < 1000; ++k) {
    problem.contacts.push_back(on_ground(side(rng), side(rng), 0.6));
  }
  for (const ProjectionSpace space : {ProjectionSpace::automatic, ProjectionSpace::motion}) {
    const ContactSolution solution = solve(problem, space);
    EXPECT_LE(solution.residual, 1e-9);  // A sum of a thousand impulses is rounded.
    EXPECT_LE(solution.bodies[1].v.norm() + solution.bodies[1].w.norm(), 1e-9);
  }
}

/// A body thrown into a bowl that it touches all over: thousands of contacts for six velocities.
ContactProblem in_a_bowl(std::mt19937& rng, double friction) {
  std::uniform_real_distribution<double> angle(0.0, 6.28);
  std::uniform_real_distribution<double> slope(0.0, 1.2);
  std::uniform_real_distribution<double> way(-0.02, 0.0);
  ContactProblem problem;
  problem.bodies = {{}, cube(1.0, 2.0 * any_vector(rng) - Vector3d(0.0, 0.0, 2.0))};
  problem.bodies[1].w = any_vector(rng);
  for (int k = 0; k < 3000; ++k) {
    const Eigen::AngleAxisd turn(angle(rng), Vector3d::UnitZ());
    ContactPoint contact = on_ground(0.0, 0.0, friction);
    contact.frame *=
        (turn * Eigen::AngleAxisd(slope(rng), Vector3d::UnitX())).toRotationMatrix().transpose();
    const Vector3d out(1.0, 0.7, 0.9);  // Semi-axes of an ellipsoid: the bowl holds it.
    contact.arm_B = -0.5 * contact.frame.row(0).transpose().cwiseProduct(out);
    contact.arm_A = contact.arm_B;
    contact.least_normal_velocity = way(rng);
    problem.contacts.push_back(contact);
  }
  return problem;
}

// Few of these contacts press; their solution satisfies all of them together.
TEST(ProjectOnContacts, SolvesThousandsOfContactsByTheFewThatDecide) {
  std::mt19937 rng(11);
  for (const double friction : {0.0, 0.1, 0.6}) {
    for (int trial = 0; trial < test::rounds(10, 2); ++trial) {
      const ContactProblem problem = in_a_bowl(rng, friction);
      const ContactSolution solution = solve(problem, ProjectionSpace::automatic);
      // With friction the few themselves are not solved nearer in some, nor are all in motion
      // space.
      EXPECT_LE(contact_residual(problem, solution), friction > 0.0 ? 5e-5 : 2.0 * kTolerance);
      const auto pressing = std::ranges::count_if(
          solution.impulses, [](const Vector3d& impulse) { return impulse.norm() > 0.0; });
      EXPECT_GT(pressing, 0);
      EXPECT_LE(pressing, 6);
      if (friction == 0.0) {  // Then the velocities are unique.
        const ContactSolution whole = solve(problem, ProjectionSpace::motion);
        EXPECT_LE((solution.bodies[1].v - whole.bodies[1].v).norm(), 1e-7);
        EXPECT_LE((solution.bodies[1].w - whole.bodies[1].w).norm(), 1e-7);
      }
    }
  }
}

// A light cube under a heavy one.
TEST(ProjectOnContacts, TakesMassRatiosOfTenThousand) {
  for (const double ratio : {1e-4, 1.0, 1e4}) {
    ContactProblem problem;
    problem.bodies = {{}, cube(1.0, {0, 0, -1}), cube(ratio, {0, 0, -1})};
    for (const std::size_t upper : {1u, 2u}) {
      for (const double x : {-0.5, 0.5}) {
        for (const double y : {-0.5, 0.5}) {
          ContactPoint contact = on_ground(x, y, 0.5);
          contact.bodies = {upper - 1, upper};
          contact.arm_A.z() = upper == 1 ? 0.0 : 0.5;
          problem.contacts.push_back(contact);
        }
      }
    }
    const ContactSolution solution = project_on_contacts(problem, {.tolerance = 1e-9});
    EXPECT_LE(solution.residual, 1e-9) << ratio;
    for (const ContactBody& body : solution.bodies) {
      EXPECT_LE(body.v.norm() + body.w.norm(), 1e-7) << ratio;
    }
  }
}

TEST(ProjectOnContacts, StartsFromAGoodGuess) {
  std::mt19937 rng(6);
  ContactProblem problem = random_heap(rng, 0.3);
  const ContactSolution first = solve(problem, ProjectionSpace::contact);
  ASSERT_GT(first.iterations, 1);
  for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
    problem.contacts[k].guess = first.impulses[k];
  }
  EXPECT_LE(project_on_contacts(problem, {.tolerance = 2.0 * kTolerance}).iterations, 1);
}

// Two impulses of the step before are far off: with them the residual is larger than with none.
TEST(ProjectOnContacts, WrongGuessesSpoilNoOthers) {
  std::mt19937 rng(5);
  ContactProblem problem = test::wall(rng, 12, 12, 0.5, 0.0);
  const ContactSolution solved = project_on_contacts(
      problem, {.tolerance = 1e-7, .space = ProjectionSpace::contact, .sweeps = 20000});
  ASSERT_LE(solved.residual, 1e-7);
  constexpr ProjectionOptions kFew{
      .tolerance = 1e-7, .space = ProjectionSpace::contact, .sweeps = 30};
  const double from_nothing = project_on_contacts(problem, kFew).residual;
  for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
    problem.contacts[k].guess = solved.impulses[k];
  }
  problem.contacts[0].guess.setZero();
  problem.contacts[1].guess *= 3.0;
  const detail::ContactRows rows(problem);
  detail::Impulses guesses;
  for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
    guesses.contacts.emplace_back(rows.contacts[k].own.turn() * problem.contacts[k].guess);
  }
  ASSERT_GT(detail::greatest_residual(rows, guesses, detail::velocities_after(rows, guesses)),
            test::nothing(problem, rows).residual);
  EXPECT_LE(project_on_contacts(problem, kFew).residual, 0.1 * from_nothing);
}

// While bodies move, sweeps end as soon as they improve little. Near the tolerance the sweeps
// continue, because bodies at rest would creep.
TEST(ProjectOnContacts, SweepsEndEarlyButNearTheTolerance) {
  std::mt19937 rng(7);
  std::normal_distribution<double> normal;
  ContactProblem problem = test::wall(rng, 12, 12, 0.5, 0.0);
  const ContactSolution solved = project_on_contacts(
      problem, {.tolerance = 1e-7, .space = ProjectionSpace::contact, .sweeps = 20000});
  ASSERT_LE(solved.residual, 1e-7);
  constexpr ProjectionOptions kAll{
      .tolerance = 1e-5, .space = ProjectionSpace::contact, .sweeps = 2000};
  ProjectionOptions some = kAll;
  some.enough = 1e-2;
  const auto guess = [&](double error) {
    for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
      problem.contacts[k].guess = (1.0 + error * normal(rng)) * solved.impulses[k];
    }
  };
  guess(0.01);
  EXPECT_LE(project_on_contacts(problem, some).residual, some.tolerance);
  guess(0.3);
  const ContactSolution ended = project_on_contacts(problem, some);
  EXPECT_LE(ended.residual, 0.5 * some.enough);
  EXPECT_LE(2 * ended.iterations, project_on_contacts(problem, kAll).iterations);
}

// A hard hit is solved to a fraction of its speed; weight alone as exactly as ever.
TEST(ProjectOnContacts, LeavesAPartOfHits) {
  std::mt19937 rng(8);
  for (const double speed : {0.0, 1.0}) {
    const ContactProblem problem = test::wall(rng, 4, 5, 0.5, speed);
    ProjectionOptions options{.tolerance = 1e-9, .of_hits = 1e-3, .hit = 0.5};
    const ContactSolution part = project_on_contacts(problem, options);
    EXPECT_LE(part.residual, part.allowed) << speed;
    EXPECT_LE(part.allowed, speed > 0.0 ? 0.1 : 1e-9) << speed;
    EXPECT_NEAR(contact_residual(problem, part), part.residual, 1e-9) << speed;
  }
  EXPECT_THROW((void)project_on_contacts({}, {.of_hits = -1.0}), std::invalid_argument);
  EXPECT_THROW((void)project_on_contacts({}, {.hit = std::nan("")}), std::invalid_argument);
}

// A guess that the objective prefers to nothing, where nothing is the solution.
TEST(ProjectOnContacts, LeavesAloneWhatOpens) {
  ContactProblem problem;
  problem.bodies = {{}, cube(1.0, {1.0, 0.0, 0.001})};
  problem.contacts = {on_ground(0.0, 0.0, 0.5)};
  problem.contacts[0].guess = {0.01, -0.005, 0.0};
  const ContactSolution solution = solve(problem, ProjectionSpace::automatic);
  EXPECT_EQ(solution.iterations, 0);
  EXPECT_EQ(solution.bodies[1].v, Vector3d(1.0, 0.0, 0.001));
}

TEST(ProjectOnContacts, KeepsLockedAxes) {
  ContactProblem problem;
  problem.bodies = {{}, cube(1.0, {0.5, 0.0, -1.0})};
  problem.bodies[1].inverse_inertia.rotation.setZero();
  problem.bodies[1].inverse_inertia.mass.y() = 0.0;
  problem.contacts = {on_ground(0.4, 0.1, 0.2)};
  const ContactSolution solution = solve(problem, ProjectionSpace::automatic);
  EXPECT_EQ(solution.bodies[1].v.y(), 0.0);
  EXPECT_EQ(solution.bodies[1].w, Vector3d::Zero());
  EXPECT_NEAR(solution.bodies[1].v.x(), 0.3, 1e-12);
}

TEST(ContactResidual, GrowsWithTheErrorOfASolution) {
  std::mt19937 rng(7);
  const ContactProblem problem = random_heap(rng, 0.3);
  ContactSolution wrong = solve(problem, ProjectionSpace::automatic);
  ASSERT_LE(contact_residual(problem, wrong), kTolerance);
  wrong.impulses[0][0] += 0.01;
  EXPECT_GE(contact_residual(problem, wrong), 1e-4);
}

// Without friction the cone is a ray: nothing pulls where bodies part straight along the normal.
TEST(ContactResidual, IsZeroWhereBodiesPartWithoutFriction) {
  ContactProblem problem;
  problem.bodies = {{}, cube(1.0, {0.0, 0.0, 0.5})};
  problem.contacts = {on_ground(0.0, 0.0, 0.0)};
  const ContactSolution solution = solve(problem, ProjectionSpace::automatic);
  EXPECT_EQ(solution.bodies[1].v, Vector3d(0.0, 0.0, 0.5));
  EXPECT_EQ(contact_residual(problem, solution), 0.0);
}

// Sweeps alone, without the directions of those before, leave 1.4e-2 m/s.
TEST(ProjectOnContacts, SolvesTallStacksBySweeps) {
  ContactProblem problem;
  problem.bodies.resize(1);
  constexpr std::size_t kLevels = 20;
  for (std::size_t level = 1; level <= kLevels; ++level) {
    problem.bodies.push_back(cube(1.0, {0.0, 0.0, -0.1}));
    for (const double x : {-0.5, 0.5}) {
      for (const double y : {-0.5, 0.5}) {
        ContactPoint contact = on_ground(x, y, 0.5);
        contact.bodies = {level - 1, level};
        contact.arm_A.z() = level == 1 ? 0.0 : 0.5;
        problem.contacts.push_back(contact);
      }
    }
  }
  const ContactSolution solution = project_on_contacts(
      problem, {.tolerance = 1e-9, .space = ProjectionSpace::contact, .sweeps = 100});
  EXPECT_LE(solution.residual, 3e-3);
}

// Bricks on four corners: 1.8e-4 m/s are left where directions start anew at each step that is
// longer than the one before.
TEST(ProjectOnContacts, SolvesWallsBySweeps) {
  std::mt19937 rng(1);
  const ContactSolution solution =
      project_on_contacts(test::wall(rng, 12, 12, 0.0, 0.3),
                          {.tolerance = 1e-12, .space = ProjectionSpace::contact, .sweeps = 400});
  EXPECT_LE(solution.residual, 1e-5);
}

TEST(ProjectOnContacts, RefusesOptionsOutOfRange) {
  EXPECT_THROW((void)project_on_contacts({}, {.tolerance = 0.0}), std::invalid_argument);
  EXPECT_THROW((void)project_on_contacts({}, {.tolerance = std::nan("")}), std::invalid_argument);
  EXPECT_THROW((void)project_on_contacts({}, {.sweeps = 0}), std::invalid_argument);
  EXPECT_THROW((void)project_on_contacts({}, {.enough = -1.0}), std::invalid_argument);
  EXPECT_THROW((void)project_on_contacts({}, {.enough = std::nan("")}), std::invalid_argument);
}

/// The same problem with the bodies from the second one on as links of one mechanism, six
/// coordinates each, mixed by a matrix that can be inverted.
ContactProblem as_mechanism(std::mt19937& rng, const ContactProblem& problem) {
  const auto n = static_cast<Eigen::Index>(6 * (problem.bodies.size() - 1));
  std::normal_distribution<double> normal;
  Eigen::MatrixXd mix = Eigen::MatrixXd::Identity(n, n);
  mix += 0.1 * Eigen::MatrixXd::NullaryExpr(n, n, [&] { return normal(rng); });
  const Eigen::MatrixXd inverse = mix.inverse();
  Eigen::MatrixXd inverse_mass = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd velocity(n);
  ContactProblem linked = problem;
  for (std::size_t b = 1; b < problem.bodies.size(); ++b) {
    const auto at = static_cast<Eigen::Index>(6 * (b - 1));
    const ContactBody& body = problem.bodies[b];
    inverse_mass.block<3, 3>(at, at) = body.inverse_inertia.mass.asDiagonal();
    inverse_mass.block<3, 3>(at + 3, at + 3) = body.inverse_inertia.rotation;
    velocity.segment<6>(at) << body.v, body.w;
    linked.bodies[b].link = MechanismLink{0, mix.middleRows(at, 6)};
  }
  linked.mechanisms.push_back({inverse * inverse_mass * inverse.transpose(), inverse * velocity});
  return linked;
}

TEST(ProjectOnContacts, MovesLinksAsItMovesBodies) {
  std::mt19937 rng(21);
  for (int i = 0; i < 20; ++i) {
    const ContactProblem problem = random_heap(rng, i % 2 == 0 ? 0.0 : 0.3);
    const ContactProblem linked = as_mechanism(rng, problem);
    const ContactSolution expected = solve(problem, ProjectionSpace::contact);
    for (const ProjectionSpace space : {ProjectionSpace::contact, ProjectionSpace::motion}) {
      const ContactSolution solution = solve(linked, space);
      ASSERT_LE(solution.residual, i % 2 == 0 ? kTolerance : 1e-6) << i;
      ASSERT_LE(greatest_difference(expected, solution), 1e-5) << i;
      ASSERT_LE(contact_residual(linked, solution), solution.residual + 1e-12) << i;
    }
  }
}

// The same of a link, and from guesses that many contacts press, as an interior point leaves them.
TEST(ProjectOnContacts, SolvesThousandsOfContactsOfALinkAndFromAnyGuess) {
  std::mt19937 rng(12);
  std::uniform_real_distribution<double> press(0.0, 0.1);
  for (int trial = 0; trial < 5; ++trial) {
    ContactProblem problem = in_a_bowl(rng, 0.0);
    const ContactSolution expected = solve(problem, ProjectionSpace::motion);
    const ContactSolution linked = solve(as_mechanism(rng, problem), ProjectionSpace::automatic);
    EXPECT_LE(greatest_difference(expected, linked), 1e-6) << trial;
    for (ContactPoint& contact : problem.contacts) {
      contact.guess = {press(rng), 0.0, 0.0};
    }
    const ContactSolution guessed = solve(problem, ProjectionSpace::automatic);
    EXPECT_LE(greatest_difference(expected, guessed), 1e-6) << trial;
    EXPECT_LE(std::ranges::count_if(guessed.impulses,
                                    [](const Vector3d& impulse) { return impulse.norm() > 0.0; }),
              6);
  }
}

/// Fewer coordinates than the six velocities of a body: a random robot that touched itself in free
/// space read beyond the end of its velocities.
TEST(ProjectOnContacts, TwoSlidersOfOneMechanismMeetAlone) {
  const Eigen::Vector2d masses(1.0, 3.0);
  ContactProblem problem;
  problem.mechanisms.push_back(
      {masses.cwiseInverse().asDiagonal().toDenseMatrix(), Eigen::Vector2d(1.0, -1.0)});
  for (int k = 0; k < 2; ++k) {
    ContactBody slider;
    slider.link = MechanismLink{.mechanism = 0, .J = Eigen::Matrix<double, 6, 2>::Zero()};
    slider.link->J(0, k) = 1.0;
    problem.bodies.push_back(slider);
  }
  problem.contacts.push_back({.bodies = {0, 1}});
  for (const ProjectionSpace space :
       {ProjectionSpace::automatic, ProjectionSpace::contact, ProjectionSpace::motion}) {
    const ContactSolution solution = solve(problem, space);
    ASSERT_LE(solution.residual, kTolerance);
    for (int k = 0; k < 2; ++k) {
      EXPECT_NEAR(solution.mechanisms[0][k], (1.0 * 1.0 - 3.0 * 1.0) / 4.0, 1e-9);
    }
    EXPECT_NEAR(solution.impulses[0].x(), 1.5, 1e-9);
  }
}

/// A mechanism of coordinates with random inertia and velocities, each driven.
ContactProblem random_drives(std::mt19937& rng, Eigen::Index n) {
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return normal(rng); });
  ContactProblem problem;
  problem.mechanisms.push_back({root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(n, n),
                                Eigen::VectorXd::NullaryExpr(n, [&] { return normal(rng); })});
  for (Eigen::Index k = 0; k < n; ++k) {
    JointDrive drive{.coordinate = static_cast<std::size_t>(k), .target = normal(rng)};
    drive.compliance = k % 3 == 0 ? 0.0 : std::abs(normal(rng));
    drive.least = k % 2 == 0 ? 0.0 : -std::abs(0.3 * normal(rng));
    drive.greatest = k % 4 == 0 ? drive.greatest : std::abs(0.3 * normal(rng));
    problem.drives.push_back(drive);
  }
  return problem;
}

TEST(ProjectOnContacts, DrivesMeetTheirTargetsWithinTheirBounds) {
  std::mt19937 rng(22);
  for (int i = 0; i < 50; ++i) {
    const ContactProblem problem = random_drives(rng, 8);
    const ContactMechanism& mechanism = problem.mechanisms[0];
    for (const ProjectionSpace space : {ProjectionSpace::contact, ProjectionSpace::motion}) {
      const ContactSolution solution = solve(problem, space);
      ASSERT_LE(solution.residual, kTolerance) << i;
      Eigen::VectorXd r(8);
      for (Eigen::Index k = 0; k < 8; ++k) {
        const JointDrive& drive = problem.drives[static_cast<std::size_t>(k)];
        r[k] = solution.drives[static_cast<std::size_t>(k)];
        const double excess = solution.mechanisms[0][k] + drive.compliance * r[k] - drive.target;
        ASSERT_GE(r[k], drive.least) << i;
        ASSERT_LE(r[k], drive.greatest) << i;
        if (r[k] > drive.least) {
          ASSERT_LE(excess, 1e-8) << i;  // Beyond the target only with the least impulse.
        }
        if (r[k] < drive.greatest) {
          ASSERT_GE(excess, -1e-8) << i;
        }
      }
      // Impulses change velocities by the inverse mass.
      ASSERT_LE((mechanism.velocity + mechanism.inverse_mass * r - solution.mechanisms[0]).norm(),
                1e-9)
          << i;
    }
  }
}

}  // namespace
}  // namespace firstcontact
