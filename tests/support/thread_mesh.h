// Meshes of threads with facets: rods and, a little wider, nuts.

#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <firstcontact/geometry/shape.h>

namespace firstcontact::test {

struct Thread {
  int segments = 24;    // Number of segments of a turn.
  int turns = 3;        // Number of turns about the z axis, from z = 0 on.
  double lead = 0.5;    // [m]  Advance of one turn.
  double radius = 1.0;  // [m]  Radius of the root.
  double depth = 0.2;   // [m]
  double wider = 0.0;   // [m]  Addition to the radius, for a nut.
  double shift = 0.0;   // [rad]  Angle at which facets begin.
};

inline Shape make_thread(const Thread& thread) {
  constexpr int kProfile = 4;
  const std::array<double, kProfile> out{0.0, 1.0, 1.0, 0.0};
  Mesh mesh;
  const int steps = thread.segments * thread.turns;
  for (int i = 0; i <= steps; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / thread.segments + thread.shift;
    for (int k = 0; k <= kProfile; ++k) {
      const double r = thread.radius + thread.wider + thread.depth * out[k % kProfile];
      const double z = thread.lead * (angle / (2.0 * std::numbers::pi) + 0.25 * k);
      mesh.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
  }
  const auto index = [](int i, int k) {
    return static_cast<std::uint32_t>(i * (kProfile + 1) + k);
  };
  for (int i = 0; i < steps; ++i) {
    for (int k = 0; k < kProfile; ++k) {
      mesh.triangles.push_back({index(i, k), index(i + 1, k), index(i + 1, k + 1)});
      mesh.triangles.push_back({index(i, k), index(i + 1, k + 1), index(i, k + 1)});
    }
  }
  return Shape(std::move(mesh));
}

}  // namespace firstcontact::test
