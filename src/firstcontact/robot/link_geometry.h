/// @file
/// What a link looks like, or is made of for collisions.

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include <Eigen/Core>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact {

/// A mesh in a file of its own.
struct MeshGeometry {
  std::filesystem::path path;                       ///< As opened.
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();  ///< [-]  Of each axis; not 0. < 0 mirrors.
};

/// Sizes of 0 make what is left: a rectangle, a segment or a point, which touch as well.
struct BoxGeometry {
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< [m]  >= 0.
};

/// A point where the radius is 0.
struct SphereGeometry {
  double radius = 0.0;  ///< [m]  >= 0.
};

/// About z. A disc where the length is 0, a segment where the radius is, a point where both are.
struct CylinderGeometry {
  double radius = 0.0;  ///< [m]  >= 0.
  double length = 0.0;  ///< [m]  >= 0.
};

/// About z.
struct CapsuleGeometry {
  double radius = 0.0;  ///< [m]  >= 0.
  double length = 0.0;  ///< [m]  >= 0.  Of the segment, without the caps.
};

using GeometrySource =
    std::variant<MeshGeometry, BoxGeometry, SphereGeometry, CylinderGeometry, CapsuleGeometry>;

/// One piece of a link, in a frame G of its own.
struct LinkGeometry {
  std::string name;  ///< May be empty.
  Pose X_LG = {};
  GeometrySource source = {};
  std::optional<Shape> shape = {};  ///< In G; none where it was not asked for.
};

}  // namespace firstcontact
