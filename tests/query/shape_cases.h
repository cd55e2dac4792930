/// @file
/// Random shapes of every kind, each with an independent description of the same body.

#pragma once

#include <optional>
#include <random>
#include <vector>

#include <firstcontact/geometry/shape.h>

#include "support/convex_distance.h"
#include "support/moving_soup.h"

namespace firstcontact::oracle {

enum class ShapeKind {
  sphere,
  capsule,
  box,
  convex_hull,
  point_cloud,
  height_map,
  solid_mesh,
  surface_mesh,
  cylinder,
  cone,
  ellipsoid,
};

inline constexpr int kExactKinds = static_cast<int>(ShapeKind::cylinder);
inline constexpr int kAllKinds = static_cast<int>(ShapeKind::ellipsoid) + 1;

struct ShapeCase {
  Shape shape;
  /// Soup whose union has the same first contacts with bodies outside; not for curved bodies.
  MovingSoup soup;
  std::vector<Support> pieces;  ///< Convex bodies whose union is the body, without the radius.
  /// Corners of a solid that is their convex hull.
  std::vector<Vector3<double>> solid_corners;
};

/// Makes a body of a size of about 1.
ShapeCase random_shape(ShapeKind kind, std::mt19937_64& rng);

/// Makes a motion of one of four kinds from about one position to another.
MotionInput random_course(std::mt19937_64& rng, const Vector3<double>& from,
                          const Vector3<double>& to);

}  // namespace firstcontact::oracle
