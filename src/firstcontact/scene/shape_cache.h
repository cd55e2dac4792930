/// @file
/// Shapes read from mesh files, kept from scene to scene.

#pragma once

#include <map>
#include <string>
#include <tuple>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/export.h>
#include <firstcontact/scene/scene.h>

namespace firstcontact {

/// A shape and the digest of the file that it came from.
struct CachedShape {
  Shape shape;
  std::string digest;  ///< SHA-256 of the mesh file, in hexadecimal.
};

/// Loads each mesh file once for every scale and radius, with its hierarchy. A file that changes
/// after it was loaded is not read again. For one thread at a time.
class FIRSTCONTACT_API ShapeCache {
 public:
  /// The shape of a mesh file; stays valid for as long as the cache lives. Coordinates are scaled
  /// in double precision; certificates hold for the rounded products.
  ///
  /// @param radius  [m]  >= 0
  /// @throws ParseError as read_mesh, and where no shape can be made of what was read
  const CachedShape& load(const MeshFile& file, double radius);

 private:
  std::map<std::tuple<std::string, double, double>, CachedShape> shapes_;
};

}  // namespace firstcontact
