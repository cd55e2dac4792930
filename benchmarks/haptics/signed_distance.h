/// @file
/// Exact signed distances of points from a closed mesh, for the peer of the god-object.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/mesh.h>

namespace firstcontact {

/// The place of a surface that is nearest to a point.
struct NearestPlace {
  double distance = 0.0;                             ///< [m]  >= 0
  Eigen::Vector3d place = Eigen::Vector3d::Zero();   ///< [m]
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< [-]  Of the triangle.
  bool is_inside = false;  ///< Whether the point is behind the pseudo-normal of the place.
};

/// A closed mesh with a tree of boxes.
class SignedDistance {
 public:
  explicit SignedDistance(const Mesh& mesh);

  /// Finds the nearest place to a point.
  ///
  /// @param most     [m]  places farther away do not count
  /// @param against  [-]  only triangles count whose normal is opposed to this one; null for all
  /// @param hint     a triangle that is tried first; takes the triangle that was found
  /// @returns  whether there is one
  bool nearest(const Eigen::Vector3d& point, double most, const Eigen::Vector3d* against,
               std::uint32_t& hint, NearestPlace& found) const;

 private:
  struct Node {
    Eigen::Vector3d lower;
    Eigen::Vector3d upper;
    std::uint32_t first = 0;  // The first triangle, or the second child.
    std::uint32_t count = 0;  // 0 of an inner node.
  };

  struct Triangle {
    std::array<Eigen::Vector3d, 3> corners;
    Eigen::Vector3d normal;
    // Pseudo-normals of the three corners, then of the edges that begin at them.
    std::array<Eigen::Vector3d, 6> pseudo;
  };

  void build(std::uint32_t begin, std::uint32_t end);
  void set_pseudo_normals(const Mesh& mesh);

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace firstcontact
