/// @file
/// The meshes of a page that plays a result, each of them once.

#pragma once

#include <cstddef>
#include <map>
#include <string>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/robot/link_geometry.h>
#include <firstcontact/text/json_tree.h>

namespace firstcontact::detail {

/// Collects meshes, and numbers them from 0 in the order of adding.
class PageMeshes {
 public:
  /// Adds the mesh of a shape and returns its number, the same for the same object.
  ///
  /// The triangles around a curved shape are marked to be drawn smooth.
  ///
  /// @param shape  its mesh lives as long as this object
  [[nodiscard]] std::size_t add(const Shape& shape);

  /// Adds the mesh of a geometry of a link and returns its number, the same for the same file and
  /// scale.
  ///
  /// Reads the file if it is neither known nor loaded.
  ///
  /// @throws as make_shape
  [[nodiscard]] std::size_t add(const LinkGeometry& geometry);

  /// Returns all meshes in the form of the page (docs/viewer.md).
  [[nodiscard]] JsonArray take();

 private:
  std::size_t append(const Shape& shape);

  JsonArray meshes_;
  std::map<const Mesh*, std::size_t> of_objects_;
  std::map<std::string, std::size_t> of_files_;  // Numbers by path and scale.
};

}  // namespace firstcontact::detail
