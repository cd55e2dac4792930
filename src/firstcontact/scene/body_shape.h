/// @file
/// The shapes that a scene can give to a body.

#pragma once

#include <filesystem>
#include <optional>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/height_map.h>
#include <firstcontact/geometry/mesh.h>
#include <firstcontact/geometry/shape.h>

namespace firstcontact {

/// A mesh that lies in a file of its own.
struct MeshFile {
  /// The path as opened: relative to the working directory, or absolute; never to the scene's
  /// folder.
  std::filesystem::path path;
  double scale = 1.0;  ///< [-]  Multiplies every coordinate; > 0.
};

/// A sphere, with the parameters of make_sphere().
struct SphereShape {
  double radius = 0.0;  ///< [m]
};

/// A capsule, with the parameters of make_capsule().
struct CapsuleShape {
  double radius = 0.0;  ///< [m]
  double length = 0.0;  ///< [m]  Length of the segment along z, without the caps.
};

/// A box, with the parameters of make_box(); its radius is BodyShape::radius.
struct BoxShape {
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< [m]
};

/// A cylinder, with the parameters of make_cylinder().
struct CylinderShape {
  double radius = 0.0;                    ///< [m]
  double length = 0.0;                    ///< [m]  Length along z.
  std::optional<double> enclosure_error;  ///< [m]
};

/// A cone, with the parameters of make_cone().
struct ConeShape {
  double radius = 0.0;                    ///< [m]  Radius of the base.
  double length = 0.0;                    ///< [m]  Length along z, from base to tip.
  std::optional<double> enclosure_error;  ///< [m]
};

/// An ellipsoid, with the parameters of make_ellipsoid().
struct EllipsoidShape {
  Eigen::Vector3d radii = Eigen::Vector3d::Zero();  ///< [m]
  std::optional<double> enclosure_error;            ///< [m]
};

/// The convex hull of points or of a mesh in a file, as make_convex_hull() makes it.
struct ConvexHullShape {
  std::variant<MeshFile, std::vector<Eigen::Vector3d>> of;  ///< [m]  Points, or a mesh in a file.
};

/// A point cloud in a file of its own, as make_point_cloud() makes it.
struct PointFile {
  std::filesystem::path path;  ///< As MeshFile::path.
  double scale = 1.0;          ///< [-]  Multiplies every coordinate; > 0.
};

/// A point cloud of given points, as make_point_cloud() makes it.
struct PointCloud {
  std::vector<Eigen::Vector3d> points;  ///< [m]
};

/// A height map in a file of its own, as make_height_map() makes it.
struct HeightFile {
  std::filesystem::path path;                      ///< As MeshFile::path.
  Eigen::Vector2d cell = Eigen::Vector2d::Ones();  ///< [m]
};

/// The shape of a body, in the body frame.
struct BodyShape {
  /// The source of the shape.
  ///
  /// A Mesh holds the triangles that its scene writes inline, not welded. A Shape is ready, with a
  /// radius and a filling of its own. It comes from no file, and is written as its primitive or as
  /// its mesh.
  std::variant<MeshFile, Mesh, SphereShape, CapsuleShape, BoxShape, CylinderShape, ConeShape,
               EllipsoidShape, ConvexHullShape, PointFile, PointCloud, HeightFile, HeightMap, Shape>
      source;
  double radius = 0.0;  ///< [m]  Thickens a box, and any source that is no primitive; >= 0.
  Filling filling = Filling::surface;  ///< The filling of a mesh.
  double enclosure_error = 0.0;        ///< [m]  Shape::enclosure_error() of an inline mesh; >= 0.
};

}  // namespace firstcontact
