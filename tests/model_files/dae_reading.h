/// @file
/// Reads COLLADA documents that a test has written, and compares them with the reference body.

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <firstcontact/model_files/detail/parse_dae.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/reading_log.h>

#include "support/dae_writer.h"

namespace firstcontact::test {

struct DaeReading {
  Mesh mesh;
  FileReport report;
};

inline DaeReading read_dae(const std::string& text, const ReadingOptions& options = {}) {
  detail::ReadingLog log("folder/body.dae", "DAE", options);
  Mesh mesh = detail::parse_dae(text, log);
  return {std::move(mesh), log.finish()};
}

inline DaeReading read_dae(const DaeWriter& writer, const ReadingOptions& options = {}) {
  return read_dae(writer.text(), options);
}

/// Returns the one line of the error; empty if the document is read.
inline std::string error_of_dae(const std::string& text, const ReadingOptions& options = {}) {
  try {
    EXPECT_FALSE(read_dae(text, options).mesh.triangles.empty());
    return "";
  } catch (const ParseError& error) {
    const std::string line = error.what();
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    EXPECT_EQ(line.find("folder/body.dae:"), 0u) << line;
    return line;
  }
}

/// Tests whether the document is refused by one line that contains `says`.
inline testing::AssertionResult is_refused(const DaeWriter& writer, const std::string& says) {
  const std::string line = error_of_dae(writer.text());
  if (line.empty()) {
    return testing::AssertionFailure() << "it is read";
  }
  return line.find(says) != std::string::npos ? testing::AssertionSuccess()
                                              : testing::AssertionFailure() << "it says: " << line;
}

using Point = std::array<double, 3>;

/// Computes six times the signed volume, and twice the area.
inline std::array<double, 2> volume_and_area(const Mesh& mesh) {
  std::array<double, 2> sums{};
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto& p = mesh.vertices[a];
    const auto& q = mesh.vertices[b];
    const auto& r = mesh.vertices[c];
    sums[0] += p.dot(q.cross(r));
    sums[1] += (q - p).cross(r - p).norm();
  }
  return sums;
}

/// Returns the reference body with its vertices moved by a map.
inline Mesh moved_body(double unit, const std::function<Point(Point)>& map) {
  Mesh mesh;
  const ReferenceBody body = reference_body(unit);
  for (const auto& vertex : body.vertices) {
    const Point p = map(vertex);
    mesh.vertices.emplace_back(p[0], p[1], p[2]);
  }
  for (const auto& [a, b, c] : body.triangles) {
    mesh.triangles.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
                              static_cast<std::uint32_t>(c)});
  }
  return mesh;
}

/// Expects that each vertex of one body is within `tolerance` of a vertex of the other.
///
/// The number of triangles, the volume and the area must agree. Faces may be cut into triangles in
/// any way.
inline void expect_same_body(const Mesh& mesh, const Mesh& expected, double tolerance = 0.0) {
  ASSERT_EQ(mesh.triangles.size(), expected.triangles.size());
  ASSERT_EQ(mesh.vertices.size(), expected.vertices.size());
  for (const Mesh* one : {&mesh, &expected}) {
    const Mesh& other = one == &mesh ? expected : mesh;
    for (const auto& p : one->vertices) {
      double nearest = HUGE_VAL;
      for (const auto& q : other.vertices) {
        nearest = std::min(nearest, (p - q).cwiseAbs().maxCoeff());
      }
      EXPECT_LE(nearest, tolerance) << p.transpose();
    }
  }
  const auto [volume, area] = volume_and_area(mesh);
  const auto [expected_volume, expected_area] = volume_and_area(expected);
  EXPECT_NEAR(volume, expected_volume, 1e-12 * std::abs(expected_volume));
  EXPECT_NEAR(area, expected_area, 1e-12 * expected_area);
}

inline Point same(Point p) { return p; }

inline bool leaves_out(const FileReport& report, const std::string& name) {
  return std::any_of(report.left_out.begin(), report.left_out.end(),
                     [&](const LeftOut& entry) { return entry.name == name; });
}

}  // namespace firstcontact::test
