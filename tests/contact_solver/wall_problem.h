/// @file
/// Contact problems of many contacts.

#pragma once

#include <random>

#include <Eigen/Core>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/contact_solver/detail/contact_rows.h>

namespace firstcontact::test {

/// Makes a wall of bricks, 2 m wide, 1 m high and deep and of 1 kg, each on two of the row below.
///
/// The lowest bricks stand on the ground (body 0). Velocities are random, with 0.1 m/s downwards
/// added.
inline ContactProblem wall(std::mt19937& rng, int rows, int columns, double friction,
                           double speed = 0.02) {
  std::normal_distribution<double> normal(0.0, speed);
  ContactProblem problem;
  problem.bodies.resize(1);
  const auto touch = [&](std::size_t below, std::size_t above, double x_below, double x_above) {
    for (const double y : {-0.5, 0.5}) {
      ContactPoint contact;
      contact.bodies = {below, above};
      contact.arm_A = {x_below, y, 0.5};
      contact.arm_B = {x_above, y, -0.5};
      contact.frame << 0, 0, 1, 1, 0, 0, 0, 1, 0;
      contact.friction = friction;
      problem.contacts.push_back(contact);
    }
  };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      ContactBody brick;
      brick.inverse_inertia.mass.setOnes();
      brick.inverse_inertia.rotation = Eigen::Vector3d(6.0, 2.4, 2.4).asDiagonal();
      brick.v = {normal(rng), normal(rng), -0.1 + normal(rng)};
      brick.w = {normal(rng), normal(rng), normal(rng)};
      problem.bodies.push_back(brick);
      const auto above = problem.bodies.size() - 1;
      if (row == 0) {
        touch(0, above, -1.0, -1.0);
        touch(0, above, 1.0, 1.0);
        continue;
      }
      // Every other row is shifted by half a brick to the right.
      const int right = row % 2 == 1 ? column + 1 : column;
      for (const int below : {right - 1, right}) {
        if (below < 0 || below >= columns) {
          continue;
        }
        const auto place = static_cast<std::size_t>(1 + (row - 1) * columns + below);
        const double sign = below == right ? 1.0 : -1.0;
        touch(place, above, -sign, 0.0);
        touch(place, above, 0.0, sign);
      }
    }
  }
  return problem;
}

/// Makes two rows of bricks, of which the upper ones are heavier.
inline ContactProblem wall_with_heavy_top(std::mt19937& rng, int columns, double friction,
                                          double heavier) {
  ContactProblem problem = wall(rng, 2, columns, friction);
  for (auto b = static_cast<std::size_t>(columns) + 1; b < problem.bodies.size(); ++b) {
    problem.bodies[b].inverse_inertia.mass /= heavier;
    problem.bodies[b].inverse_inertia.rotation /= heavier;
  }
  return problem;
}

/// Makes a projection without impulses.
inline detail::Projection nothing(const ContactProblem& problem, const detail::ContactRows& rows) {
  detail::Projection projection;
  projection.impulses.contacts.assign(problem.contacts.size(), Eigen::Vector3d::Zero());
  projection.velocities = detail::velocities_after(rows, projection.impulses);
  projection.residual = detail::greatest_residual(rows, projection.impulses, projection.velocities);
  return projection;
}

}  // namespace firstcontact::test
