// One body in every format and feature, by a generator that shares no code with the readers.

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/geometry/point_cloud.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/geometry/weld.h>
#include <firstcontact/mesh_files/read_mesh.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/query/workspace.h>

#include "support/reference_body.h"
#include "support/write_reference_body.h"

namespace firstcontact {
namespace {

using test::Keeps;
using test::ReferenceBody;
using test::WrittenBody;

/// Three corners, the least first.
using Corners = std::array<std::array<double, 3>, 3>;

/// The triangles by their coordinates, in an order of their own.
std::vector<Corners> surface(const Mesh& mesh) {
  std::vector<Corners> triangles;
  for (const auto& t : mesh.triangles) {
    Corners corners;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d& p = mesh.vertices[t[k]];
      corners[k] = {p.x(), p.y(), p.z()};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    triangles.push_back(corners);
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

Mesh mesh_of(const ReferenceBody& body, Keeps keeps) {
  Mesh mesh;
  for (const auto& [x, y, z] : body.vertices) {
    const Eigen::Vector3d p(x, y, z);
    mesh.vertices.push_back(keeps == Keeps::floats ? p.cast<float>().cast<double>().eval() : p);
  }
  for (const auto& [a, b, c] : body.triangles) {
    mesh.triangles.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
                              static_cast<std::uint32_t>(c)});
  }
  return mesh;
}

MeshReading read_back(const WrittenBody& written) {
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) /
      ("firstcontact_round_trip." + std::to_string(::getpid()) + written.extension);
  std::ofstream(path, std::ios::binary) << written.bytes;
  MeshReading reading = read_mesh_file(path);
  std::filesystem::remove(path);
  return reading;
}

/// A small ball flies through the notch of the upper cap, past where a fan would be, and meets a
/// wall of the notch.
FirstContactResult contact_in_the_notch(const Mesh& mesh, double unit) {
  const Shape body(mesh);
  const Shape ball = make_point_cloud({Eigen::Vector3d::Zero()}, 0.5 * unit);
  const Motion rest = Motion::fixed();
  const Motion fall = Motion::constant_velocity({.position = unit * Eigen::Vector3d(8.0, 5.0, 9.0)},
                                                unit * Eigen::Vector3d(-3.0, 0.0, -9.0));
  Workspace workspace;
  return first_contact({body, rest}, {ball, fall}, workspace, {.tolerance = 1e-7 * unit});
}

/// The mesh of a surface, whose numbers say nothing about the file: the last bits of what is
/// computed may depend on them.
Mesh in_one_order(const Mesh& mesh) {
  Mesh ordered;
  for (const Corners& corners : surface(mesh)) {
    std::array<std::uint32_t, 3> triangle{};
    for (int k = 0; k < 3; ++k) {
      triangle[k] = static_cast<std::uint32_t>(ordered.vertices.size());
      ordered.vertices.emplace_back(corners[k][0], corners[k][1], corners[k][2]);
    }
    ordered.triangles.push_back(triangle);
  }
  weld(ordered);
  return ordered;
}

void expect_same_contact(const Mesh& read, const Mesh& expected, double unit) {
  const FirstContactResult a = contact_in_the_notch(in_one_order(read), unit);
  const FirstContactResult b = contact_in_the_notch(in_one_order(expected), unit);
  ASSERT_EQ(a.verdict, Verdict::contact);
  EXPECT_GT(a.t, 0.5);  // Below the upper cap.
  EXPECT_EQ(a.verdict, b.verdict);
  EXPECT_EQ(a.t, b.t);
  ASSERT_EQ(a.contacts.size(), b.contacts.size());
  for (std::size_t i = 0; i < a.contacts.size(); ++i) {
    EXPECT_EQ(a.contacts[i].p_WA, b.contacts[i].p_WA);
    EXPECT_EQ(a.contacts[i].n_AB_W, b.contacts[i].n_AB_W);
    EXPECT_EQ(a.contacts[i].distance, b.contacts[i].distance);
  }
  const FirstContactResult as_numbered = contact_in_the_notch(read, unit);
  EXPECT_EQ(as_numbered.verdict, Verdict::contact);
  EXPECT_NEAR(as_numbered.t, a.t, 1e-12);
}

class RoundTrip : public testing::TestWithParam<double> {
 protected:
  void expect_the_body(const std::vector<WrittenBody>& all) {
    const double unit = GetParam();
    for (const WrittenBody& written : all) {
      if (written.keeps == Keeps::whole_numbers && unit != 1.0) {
        continue;
      }
      SCOPED_TRACE(written.extension + " " + written.name);
      const Mesh expected = mesh_of(body_, written.keeps);
      const MeshReading reading = read_back(written);
      EXPECT_EQ(reading.mesh.vertices.size(), 8u);
      ASSERT_EQ(surface(reading.mesh), surface(expected));
      expect_same_contact(reading.mesh, expected, unit);
    }
  }

  ReferenceBody body_ = test::reference_body(GetParam());
};

TEST_P(RoundTrip, ThroughObj) { expect_the_body(test::written_as_obj(body_)); }
TEST_P(RoundTrip, ThroughStl) { expect_the_body(test::written_as_stl(body_)); }
TEST_P(RoundTrip, ThroughPly) { expect_the_body(test::written_as_ply(body_)); }
TEST_P(RoundTrip, ThroughOff) { expect_the_body(test::written_as_off(body_)); }

// Powers of two keep faces planar; 0.1 and 0.001 need all digits of a double.
INSTANTIATE_TEST_SUITE_P(Units, RoundTrip, testing::Values(0.125, 1.0, 0.1, 0.001, 1000.0));

// The two caps are concave, and no polygon is reported as bent.
TEST(RoundTripReport, CountsTheConcaveCaps) {
  for (const double unit : {0.125, 0.1}) {
    const FileReport report =
        read_back(test::written_as_off(test::reference_body(unit)).front()).report;
    ASSERT_GE(report.contents.size(), 2u);
    EXPECT_EQ(report.contents[0].count, 6u);
    EXPECT_EQ(report.contents[1].what, "concave polygons");
    EXPECT_EQ(report.contents[1].count, 2u);
    EXPECT_TRUE(report.warnings.empty());
  }
}

}  // namespace
}  // namespace firstcontact
