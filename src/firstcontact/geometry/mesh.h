/// @file
/// A triangle mesh as plain data, and what may be wrong with one.

#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace firstcontact {

/// Triangles over shared vertices, in the body frame.
///
/// A soup is legal: open, non-manifold, doubled, degenerate. Repeated corners make an edge or a
/// point of a triangle.
struct Mesh {
  std::vector<Eigen::Vector3d> vertices;                ///< [m]
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Indices into vertices.
};

}  // namespace firstcontact
