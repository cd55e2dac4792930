/// @file
/// The geometry of a link, for its looks or for collisions.

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
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();  ///< [-]  Factor of each axis; not 0. < 0
                                                    ///< mirrors.
};

/// A box; sizes of 0 leave a rectangle, a segment or a point, which touch as well.
struct BoxGeometry {
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< [m]  >= 0.
};

/// A ball; a point where the radius is 0.
struct SphereGeometry {
  double radius = 0.0;  ///< [m]  >= 0.
};

/// A cylinder about z; a disc where the length is 0, a segment where the radius is, a point where
/// both are.
struct CylinderGeometry {
  double radius = 0.0;  ///< [m]  >= 0.
  double length = 0.0;  ///< [m]  >= 0.
};

/// A capsule about z.
struct CapsuleGeometry {
  double radius = 0.0;  ///< [m]  >= 0.
  double length = 0.0;  ///< [m]  >= 0.  Length of the segment, without the caps.
};

using GeometrySource =
    std::variant<MeshGeometry, BoxGeometry, SphereGeometry, CylinderGeometry, CapsuleGeometry>;

/// One geometry of a link, in a frame G of its own.
struct LinkGeometry {
  std::string name;  ///< May be empty.
  Pose X_LG = {};
  GeometrySource source = {};
  std::optional<Shape> shape = {};  ///< The shape in G; none where it was not asked for.
};

}  // namespace firstcontact
