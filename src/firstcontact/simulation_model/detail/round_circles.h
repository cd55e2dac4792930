/// @file
/// Regular polygons of a mesh that stand for circles.

#pragma once

#include <cstdint>
#include <memory>
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
};

/// The circles of a shape: rims of cylinders and of discs, holes, rings, necks.
///
/// A polygon is one if all its edges have one length and turn by one angle, and are not farther
/// inside of the circle through the corners than `sag` or kSagOfRadius. A corner is on one circle
/// at most. A thickened shape has none.
class RoundCircles {
 public:
  /// @param sag  [m]
  RoundCircles(const Shape& shape, double sag);

  [[nodiscard]] const std::vector<RoundCircle>& circles() const { return circles_; }

  /// [m]  How much nearer a circle may be than its polygon.
  [[nodiscard]] double sag() const;

  /// The circle that a feature is part of, or one of those at the ends of the cylinder that it is
  /// part of; null where it is flat.
  [[nodiscard]] const RoundCircle* at(const Shape& shape, const Feature& feature) const;

 private:
  /// The circle of corners whose features are between equal circles of one axis; null: of others.
  [[nodiscard]] const RoundCircle* around(std::uint32_t a, std::uint32_t b) const;

  std::vector<RoundCircle> circles_;
  std::vector<std::int32_t> of_vertex_;  // Index of its circle; -1: none.
};

}  // namespace firstcontact::detail
