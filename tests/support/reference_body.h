/// @file
/// Body that generators write in every format, for round trips through the readers.

#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace firstcontact::test {

/// Surface as lists, without types of the library, so that a generator shares nothing with a
/// reader.
struct ReferenceBody {
  std::vector<std::array<double, 3>> vertices;        ///< [m]
  std::vector<std::vector<std::size_t>> polygons;     ///< Corners, counter-clockwise from outside.
  std::vector<std::array<std::size_t, 3>> triangles;  ///< The same surface in triangles.
};

/// An oblique prism over a dart: 8 vertices, 6 planar quads, 12 triangles, no symmetry.
///
/// Corner 1 of each cap is concave. A fan about the first corner of a cap leaves the cap, as does
/// the one about its third corner. Each coordinate is a whole number, from -3 to 13, times `unit`.
///
/// @param unit  [m]  A power of two keeps all faces exactly planar; 0.1 needs a double's digits.
inline ReferenceBody reference_body(double unit = 0.125) {
  constexpr std::array<std::array<int, 3>, 8> kVertices = {{{12, -3, -2},
                                                            {5, 2, -2},
                                                            {7, 11, -2},
                                                            {0, 0, -2},
                                                            {11, -1, 5},
                                                            {4, 4, 5},
                                                            {6, 13, 5},
                                                            {-1, 2, 5}}};
  ReferenceBody body;
  for (const auto& [x, y, z] : kVertices) {
    body.vertices.push_back({x * unit, y * unit, z * unit});
  }
  body.polygons = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                   {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  body.triangles = {{0, 3, 1}, {1, 3, 2}, {4, 5, 7}, {5, 6, 7}, {0, 1, 5}, {0, 5, 4},
                    {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
  return body;
}

}  // namespace firstcontact::test
