/// @file
/// Body that tests of glTF write in many ways: 12 triangles, closed, not symmetric, with faces that
/// are not convex.

#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

#include "support/gltf_writer.h"

namespace firstcontact::test {

/// Corners on a grid that fits a signed byte: an arrowhead at the bottom, a smaller one at the top.
inline constexpr std::array<std::array<int, 3>, 8> kGridCorners = {{{-100, -80, -70},
                                                                    {120, -119, -70},
                                                                    {-10, -15, -70},
                                                                    {97, 101, -70},
                                                                    {-61, -50, 90},
                                                                    {83, -73, 90},
                                                                    {3, -7, 90},
                                                                    {71, 67, 90}}};

/// Four corners a face, counter-clockwise from outside: triangles (0, 1, 2) and (0, 2, 3).
inline constexpr std::array<std::array<std::uint8_t, 4>, 6> kQuads = {
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};

/// Corners of triangles, three for each.
using Corners = std::vector<Eigen::Vector3d>;

inline std::vector<std::uint8_t> indices_of_triangles() {
  std::vector<std::uint8_t> indices;
  for (const auto& [a, b, c, d] : kQuads) {
    indices.insert(indices.end(), {a, b, c, a, c, d});
  }
  return indices;
}

inline Corners corners_of_triangles(const std::vector<Eigen::Vector3d>& vertices) {
  Corners corners;
  for (const std::uint8_t index : indices_of_triangles()) {
    corners.push_back(vertices[index]);
  }
  return corners;
}

/// Floats without a short binary form.
inline std::vector<float> float_positions() {
  std::vector<float> positions;
  for (const auto& corner : kGridCorners) {
    for (const int c : corner) {
      positions.push_back(static_cast<float>(c) * 0.01f);
    }
  }
  return positions;
}

/// Converts the positions to another type on the same grid, shifted where it has no sign.
template <class T>
std::vector<T> grid_positions() {
  std::vector<T> positions;
  for (const auto& corner : kGridCorners) {
    for (const int c : corner) {
      const int factor = sizeof(T) == 1 ? 1 : 250;
      positions.push_back(static_cast<T>(factor * (std::is_signed_v<T> ? c : c + 125)));
    }
  }
  return positions;
}

/// Converts rows of three to points.
template <class T>
std::vector<Eigen::Vector3d> points_of(const std::vector<T>& numbers, double divisor = 1.0) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
    points.emplace_back(static_cast<double>(numbers[i]) / divisor,
                        static_cast<double>(numbers[i + 1]) / divisor,
                        static_cast<double>(numbers[i + 2]) / divisor);
  }
  return points;
}

/// Writes the JSON of a primitive.
inline std::string primitive_text(std::size_t positions, std::size_t indices,
                                  const std::string& attributes = "",
                                  const std::string& more = "") {
  return R"({"attributes":{"POSITION":)" + std::to_string(positions) + attributes +
         R"(},"indices":)" + std::to_string(indices) + more + "}";
}

inline std::string mesh_text(const std::vector<std::string>& primitives,
                             const std::string& more = "") {
  return R"({"primitives":)" + GltfWriter::list(primitives) + more + "}";
}

/// Writes the body in floats as mesh 0, placed by node 0.
///
/// Accessor 0 has the positions, accessor 1 the indices.
inline GltfWriter plain_gltf() {
  GltfWriter gltf;
  gltf.add_numbers(float_positions(), "VEC3");
  gltf.add_numbers(indices_of_triangles(), "SCALAR");
  gltf.meshes = {mesh_text({primitive_text(0, 1)})};
  gltf.nodes = {R"({"mesh":0})"};
  return gltf;
}

}  // namespace firstcontact::test
