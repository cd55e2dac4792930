/// @file
/// The geometries of a COLLADA document: positions and polygons.

#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/model_files/detail/dae_document.h>
#include <firstcontact/model_files/detail/dae_polygons.h>

namespace firstcontact::detail {

/// Reads each geometry once, even where it is placed several times.
class DaeGeometries {
 public:
  explicit DaeGeometries(const DaeDocument& document) : document_(document) {}

  /// Reads the polygons of all primitives, with corners below the number of positions.
  ///
  /// @param geometry  a <geometry>
  /// @throws ParseError  curves and other kinds of geometry, and malformed geometries
  [[nodiscard]] const std::vector<DaePolygons>& polygons(const XmlElement& geometry);

  /// Reads the rows of the source of POSITION; not all of them need be finite.
  ///
  /// @throws ParseError  as polygons()
  [[nodiscard]] const std::vector<Eigen::Vector3d>& positions(const XmlElement& geometry);

  /// Counts the geometries that were read.
  [[nodiscard]] std::size_t size() const { return polygons_.size(); }

 private:
  const DaeDocument& document_;
  std::unordered_map<const XmlElement*, std::vector<DaePolygons>> polygons_;
  std::unordered_map<const XmlElement*, std::vector<Eigen::Vector3d>> positions_;
};

}  // namespace firstcontact::detail
