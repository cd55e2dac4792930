/// @file
/// A shape at rest.

#pragma once

#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/export.h>
#include <firstcontact/motion/motion.h>

namespace firstcontact {

/// A shape S at rest at a pose, prepared once for questions about many pairs.
///
/// It refers to the shape.
class FIRSTCONTACT_API PlacedShape {
 public:
  /// @throws std::invalid_argument as Motion::fixed()
  PlacedShape(const Shape& shape, const Pose& X_WS);

  [[nodiscard]] const Shape& shape() const { return *shape_; }
  [[nodiscard]] const Pose& pose() const { return pose_; }  ///< X_WS
  [[nodiscard]] const Motion& motion() const { return motion_; }

  /// The path of the centre of the shape's hierarchy.
  [[nodiscard]] const ConstantRatePath& path() const { return path_; }

 private:
  const Shape* shape_;
  Pose pose_;
  Motion motion_;
  ConstantRatePath path_;
};

}  // namespace firstcontact
