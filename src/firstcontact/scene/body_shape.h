/// @file
/// What a body is made of, as a scene says it.

#pragma once

#include <filesystem>
#include <optional>
#include <variant>

#include <Eigen/Core>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// A mesh that lies in a file of its own.
struct MeshFile {
  /// As opened: relative to the working directory, or absolute; never to the scene's folder.
  std::filesystem::path path;
  double scale = 1.0;  ///< [-]  Multiplies every coordinate; > 0.
};

/// make_sphere
struct SphereShape {
  double radius = 0.0;  ///< [m]
};

/// make_capsule
struct CapsuleShape {
  double radius = 0.0;  ///< [m]
  double length = 0.0;  ///< [m]  Of the segment along z, without the caps.
};

/// make_box
struct BoxShape {
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< [m]
};

/// make_cylinder
struct CylinderShape {
  double radius = 0.0;                    ///< [m]
  double length = 0.0;                    ///< [m]  Along z.
  std::optional<double> enclosure_error;  ///< [m]
};

/// make_cone
struct ConeShape {
  double radius = 0.0;                    ///< [m]  Of the base.
  double length = 0.0;                    ///< [m]  Along z, from base to tip.
  std::optional<double> enclosure_error;  ///< [m]
};

/// What a body is made of, in the body frame.
struct BodyShape {
  /// A Mesh holds what its scene writes inline, not welded.
  std::variant<MeshFile, Mesh, SphereShape, CapsuleShape, BoxShape, CylinderShape, ConeShape>
      source;
  double radius = 0.0;                 ///< [m]  Thickens every triangle of a mesh; >= 0.
  Filling filling = Filling::surface;  ///< Of a mesh; the other shapes are solid.
};

}  // namespace firstcontact
