/// @file
/// Bodies and places drawn at random.

#pragma once

#include <algorithm>
#include <random>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/simulation_model/detail/sim_body.h>

namespace firstcontact::test {

inline Eigen::Vector3d random_vector(std::mt19937& rng, double size) {
  std::normal_distribution<double> normal(0.0, size);
  return {normal(rng), normal(rng), normal(rng)};
}

inline Eigen::Quaterniond random_rotation(std::mt19937& rng) {
  std::normal_distribution<double> n;
  return Eigen::Quaterniond(n(rng), n(rng), n(rng), n(rng)).normalized();
}

/// Makes a tetrahedron of about a metre, with a random centre of mass near it.
inline detail::SimBody tetrahedron(std::mt19937& rng) {
  Mesh mesh;
  for (int k = 0; k < 4; ++k) {
    mesh.vertices.push_back(random_vector(rng, 1.0));
  }
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
  detail::SimBody body{.shape = Shape(mesh), .surface = Shape(mesh)};
  body.inertia.p_BC = random_vector(rng, 0.5);
  for (const Eigen::Vector3d& v : mesh.vertices) {
    body.box_B.extend(v);
    body.reach = std::max(body.reach, (v - body.inertia.p_BC).norm());
  }
  return body;
}

}  // namespace firstcontact::test
