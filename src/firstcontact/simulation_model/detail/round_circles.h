/// @file
/// Regular polygons of a mesh that stand for circles.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/query/contact.h>

namespace firstcontact::detail {

/// A circle that a regular polygon of edges stands for.
struct RoundCircle {
  Eigen::Vector3d centre_B = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d axis_B = Eigen::Vector3d::UnitZ();   ///< [-]
  double outer = 0.0;                                  ///< [m]  Radius through the corners.
  double inner = 0.0;                                  ///< [m]  Radius that the edges touch.
  bool is_rim = false;   ///< Whether a surface around it faces away from the axis.
  bool is_hole = false;  ///< Whether a surface around it faces the axis.

  [[nodiscard]] double sag() const { return outer - inner; }  ///< [m]
};

/// The circle of a feature.
struct OnCircle {
  const RoundCircle* circle = nullptr;  ///< Null: the feature is flat.
  /// Whether the feature lies between two equal circles about one axis.
  ///
  /// Then it is on the side of a cylinder, and `circle` is one of them. Else it is on the circle
  /// itself.
  bool is_side = false;
};

/// The circles of a shape: rims of cylinders and of discs, holes, rings, necks.
///
/// A polygon is a circle if all its edges have one length and turn by one angle. Its edges lie
/// inside of the circle through the corners by `sag` at most, or by kSagOfRadius. A corner is on
/// one circle at most, the first that is found. So in a sphere's mesh some parallels are circles,
/// or one meridian is. A thickened shape has none.
class RoundCircles {
 public:
  RoundCircles() = default;  ///< The circles of a shape that has none.

  /// @param sag  [m]  infinite for a shape whose polygons are all meant as circles
  RoundCircles(const Shape& shape, double sag);

  [[nodiscard]] const std::vector<RoundCircle>& circles() const { return circles_; }

  /// [m]  The most by which a circle may be nearer than its polygon.
  [[nodiscard]] double sag() const;

  /// The circle of a feature.
  ///
  /// @param shape  the shape with these circles
  [[nodiscard]] OnCircle at(const Shape& shape, const Feature& feature) const;

 private:
  [[nodiscard]] OnCircle between(const Shape& shape, std::span<const std::uint32_t> corners) const;
  void find_sides(const Mesh& mesh);

  std::vector<RoundCircle> circles_;
  std::vector<std::int32_t> of_vertex_;  // Index of its circle; -1: none.
};

}  // namespace firstcontact::detail
