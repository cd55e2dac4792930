/// @file
/// The primitives of a COLLADA mesh as polygons.

#pragma once

#include <cstdint>
#include <vector>

#include <firstcontact/mesh_files/detail/dae_document.h>

namespace firstcontact::detail {

/// The polygons of one primitive element.
struct DaePolygons {
  const XmlElement* element = nullptr;
  std::vector<std::uint32_t> corners;  ///< Rows of POSITION, polygon after polygon.
  std::vector<std::uint32_t> sizes;    ///< Corners of each polygon; empty: all have three.
};

/// Reads all primitives of a <mesh> that have polygons. Lines, and polygons of one or two corners,
/// are drawings: they are left out by name. Strips and fans become triangles.
///
/// @throws ParseError  counts that contradict each other, indices that are no whole numbers >= 0,
///         polygons with holes
[[nodiscard]] std::vector<DaePolygons> read_dae_polygons(const DaeDocument& document,
                                                         const XmlElement& mesh);

}  // namespace firstcontact::detail
