/// @file
/// Square sheets of triangles.

#pragma once

#include <cstdint>

#include <firstcontact/geometry/mesh.h>

namespace firstcontact::test {

/// Makes the surface z = height(x, y) over n by n squares of [-2, 2]^2.
template <class Height>
Mesh sheet(int n, const Height& height) {
  Mesh mesh;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const double x = 4.0 * i / n - 2.0;
      const double y = 4.0 * j / n - 2.0;
      mesh.vertices.emplace_back(x, y, height(x, y));
    }
  }
  const auto index = [n](int i, int j) { return static_cast<std::uint32_t>(i * (n + 1) + j); };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      mesh.triangles.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
      mesh.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
    }
  }
  return mesh;
}

}  // namespace firstcontact::test
