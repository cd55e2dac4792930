/// @file
/// The primitives of a COLLADA mesh as polygons.

#pragma once

#include <cstdint>
#include <vector>

#include <firstcontact/model_files/detail/dae_document.h>

namespace firstcontact::detail {

/// A ring of corners around a polygon, or around a hole of the polygon before.
struct DaeRing {
  std::uint32_t size = 0;
  bool hole = false;
};

/// The polygons of one primitive element.
struct DaePolygons {
  const XmlElement* element = nullptr;
  std::vector<std::uint32_t> corners;  ///< Rows of POSITION, ring after ring.
  std::vector<DaeRing> rings;          ///< Empty: all corners belong to triangles.
};

/// Reads all primitives of a <mesh> that have polygons.
///
/// Lines, and polygons of one or two corners, are drawings: they are left out by name. Strips and
/// fans become triangles.
///
/// @throws ParseError  counts that contradict each other, indices that are not whole numbers >= 0
[[nodiscard]] std::vector<DaePolygons> read_dae_polygons(const DaeDocument& document,
                                                         const XmlElement& mesh);

}  // namespace firstcontact::detail
