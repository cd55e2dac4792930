// Nearly degenerate queries of features whose corners move on lines, against exact truth: where
// doubles cannot tell, double-doubles do.
//
// FIRSTCONTACT_LINEAR_QUERIES (default 270; 7650 in two minutes) chooses how many.

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/geometry/deforming_body.h>
#include <firstcontact/narrowphase/linear_contact.h>
#include <firstcontact/query/first_contact.h>

#include "support/from_environment.h"
#include "support/linear_query.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using oracle::LinearFamily;
using oracle::LinearQuery;

constexpr double kFine = 1e-18;  // [m]  For sizes of about 1.

Vector3d vector(const oracle::Vector3<double>& v) { return {v.x, v.y, v.z}; }

/// The part of the answer that both functions give.
struct Answer {
  bool is_free = false;
  bool is_contact = false;
  double t = 0.0;
  double tolerance_used = 0.0;
};

Answer ask_features(const LinearQuery& q, double tolerance) {
  const auto point = [&](std::size_t k) { return LinearPoint{vector(q.from[k]), vector(q.to[k])}; };
  LinearContactOptions options;
  options.tolerance = tolerance;
  const LinearContact found =
      q.edges ? linear_edge_edge_contact({point(0), point(1)}, {point(2), point(3)}, options)
              : linear_vertex_face_contact(point(3), {point(0), point(1), point(2)}, options);
  return {found.verdict == LinearVerdict::free, found.verdict == LinearVerdict::contact, found.t,
          found.tolerance_used};
}

DeformingBody body_of(const oracle::MovingSoup& soup) {
  Mesh mesh;
  std::vector<Vector3d> to;
  for (std::size_t k = 0; k < soup.vertices.size(); ++k) {
    mesh.vertices.push_back(vector(soup.vertices[k]));
    to.push_back(vector(soup.to[k]));
  }
  for (const auto& t : soup.triangles) {
    mesh.triangles.push_back({static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]),
                              static_cast<std::uint32_t>(t[2])});
  }
  return move_vertices(Shape(std::move(mesh)), to);
}

Answer ask_bodies(const LinearQuery& q, double tolerance) {
  const auto soups = soups_of(q);
  const DeformingBody A = body_of(soups[0]);
  const DeformingBody B = body_of(soups[1]);
  FirstContactOptions options;
  options.tolerance = tolerance;
  Workspace workspace;
  const FirstContactResult found =
      first_contact({A.shape, A.X_WS}, {B.shape, B.X_WS}, workspace, options);
  const bool is_contact =
      found.verdict == Verdict::contact || found.verdict == Verdict::contact_at_start;
  EXPECT_EQ(is_contact, !found.contacts.empty());
  return {found.verdict == Verdict::free, is_contact, found.t, found.tolerance_used};
}

class LinearPrecision : public testing::TestWithParam<int> {};

TEST_P(LinearPrecision, NoneIsMissedNoneIsFalseNoneIsUndecided) {
  const auto family = static_cast<LinearFamily>(GetParam());
  const std::uint64_t count =
      test::from_environment("FIRSTCONTACT_LINEAR_QUERIES", 270) / oracle::kLinearFamilies;
  std::uint64_t known = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const LinearQuery q = oracle::linear_query(family, i);
    const oracle::LinearTruth truth = oracle::linear_truth(q, kFine);
    known += truth.touches || truth.is_apart ? 1 : 0;
    for (const double tolerance : {1e-12, kFine}) {
      for (const auto& ask : {ask_features, ask_bodies}) {
        const Answer answer = ask(q, tolerance);
        const std::string which = std::to_string(i) + " at " + std::to_string(-tolerance);
        ASSERT_TRUE(answer.is_free || answer.is_contact) << which;
        ASSERT_FALSE(truth.touches && answer.is_free) << "missed: " << which;
        ASSERT_FALSE(tolerance == kFine && truth.is_apart && answer.is_contact)
            << "false: " << which;
        // Nothing is faster than 8 m in the step.
        ASSERT_LE(answer.tolerance_used, std::max(tolerance, 8.0 * 0x1p-53)) << which;
      }
    }
  }
  EXPECT_GT(known, count / 2);
}

INSTANTIATE_TEST_SUITE_P(Families, LinearPrecision, testing::Range(0, oracle::kLinearFamilies));

/// Two bodies that pass each other by a gap, far from the origin and turned; they only translate.
Answer pass_by(double gap, const Pose& X_WF) {
  Mesh face;
  face.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  face.triangles = {{0, 1, 2}};
  Mesh corner;
  corner.vertices = {{0.25, 0.25, gap}, {0.5, 0.25, 1.0}, {0.25, 0.5, 1.0}};
  corner.triangles = {{0, 1, 2}};
  const Shape A(face);
  const Shape B(corner);
  const Motion rest = Motion::fixed(X_WF);
  const Motion slides = Motion::constant_velocity(X_WF, X_WF.rotation * Vector3d(0.25, 0.125, 0.0));
  FirstContactOptions options;
  options.tolerance = kFine;
  Workspace workspace;
  const FirstContactResult found = first_contact({A, rest}, {B, slides}, workspace, options);
  return {found.verdict == Verdict::free, found.verdict != Verdict::free, found.t,
          found.tolerance_used};
}

// Bodies in other poses have lines, too: coordinates in their own frames hold such gaps.
TEST(LinearPrecisionOfRigidBodies, TellsGapsOfTranslatingBodies) {
  const Pose quarter{.position = {3.0, -5.0, 7.0},
                     .rotation = Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5)};
  for (const Pose& X_WF : {Pose{}, quarter}) {
    for (const double gap : {1e-14, 1e-16, 4e-18}) {
      EXPECT_TRUE(pass_by(gap, X_WF).is_free) << gap;
      EXPECT_TRUE(pass_by(-gap, X_WF).is_contact) << gap;  // It pierces at the start.
    }
    EXPECT_TRUE(pass_by(0.0, X_WF).is_contact);
  }
}

// Above a face that tilts, the time that a plane stays between is the root of the gap: with the
// product of edges as they go on one step is enough.
TEST(LinearPrecisionOfRigidBodies, ATinyGapThatLastsCostsLittle) {
  const LinearFace face = {
      {{{-3, -3, 0}, {-3, -3, -3}}, {{3, -3, 0}, {3, -3, 3}}, {{0, 3, 0}, {0, 3, 0}}}};
  for (const double gap : {1e-9, 1e-12, 1e-15}) {
    LinearContactOptions options;
    options.tolerance = 0.01 * gap;
    const LinearContact found =
        linear_vertex_face_contact({{0, 0, gap}, {0, 0, gap}}, face, options);
    EXPECT_EQ(found.verdict, LinearVerdict::free) << gap;
    EXPECT_LE(found.steps, 120) << gap;
  }
}

}  // namespace
}  // namespace firstcontact
