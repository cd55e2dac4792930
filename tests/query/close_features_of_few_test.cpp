// Features of small meshes that are close: the same to the last bit as pair of triangles by pair of
// triangles, on every instruction set, and of shapes at rest as of motions that rest.

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/moving_pairs/detail/moving_pair.h>
#include <firstcontact/query/close_features.h>
#include <firstcontact/query/detail/order.h>

#include "support/instruction_sets.h"
#include "support/rounds.h"

namespace firstcontact::few_triangles {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Two shapes at rest.
struct Case {
  Shape A;
  Pose X_WA;
  Shape B;
  Pose X_WB;
  double band = 0.0;  // [m]
};

double uniform(std::mt19937& rng, double least, double most) {
  return std::uniform_real_distribution<double>(least, most)(rng);
}

Vector3d any_vector(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  return {normal(rng), normal(rng), normal(rng)};
}

Quaterniond any_rotation(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  return Quaterniond(normal(rng), normal(rng), normal(rng), normal(rng)).normalized();
}

Shape any_box(std::mt19937& rng) {
  return make_box({uniform(rng, 0.2, 1.2), uniform(rng, 0.2, 1.2), uniform(rng, 0.2, 1.2)});
}

/// Up to 16 triangles of few vertices, so that they share features; some are degenerate.
Shape soup(std::mt19937& rng) {
  Mesh mesh;
  const std::uint32_t vertices = 3 + static_cast<std::uint32_t>(rng() % (rng() % 2 == 0 ? 10 : 45));
  for (std::uint32_t k = 0; k < vertices + 2; ++k) {
    mesh.vertices.push_back(0.5 * any_vector(rng));
  }
  for (std::size_t count = 1 + rng() % 16; count > 0; --count) {
    const auto any = [&] { return static_cast<std::uint32_t>(rng() % vertices); };
    mesh.triangles.push_back({any(), any(), any()});
  }
  return Shape(mesh, rng() % 2 == 0 ? 0.0 : 0.01);
}

/// Face on face a hundredth apart, turned about the normal; or edges parallel too.
Case flat(std::mt19937& rng, bool turns) {
  Case c{any_box(rng), {}, any_box(rng), {}, 0.02};
  const auto half = [](const Shape& box) { return box.mesh().vertices.back().cwiseAbs().eval(); };
  const Quaterniond about(
      Eigen::AngleAxisd(turns ? uniform(rng, 0.0, 3.0) : 0.0, Vector3d::UnitX()));
  const Quaterniond all = rng() % 2 == 0 ? any_rotation(rng) : Quaterniond::Identity();
  const Vector3d way(half(c.A).x() + half(c.B).x() + 0.01, turns ? 0.3 * uniform(rng, -1, 1) : 0.0,
                     rng() % 2 == 0 ? 0.3 * uniform(rng, -1, 1) : 0.0);
  c.X_WA = {any_vector(rng), all};
  c.X_WB = {c.X_WA.position + all * way, all * about};
  return c;
}

Case any_case(std::mt19937& rng, int kind) {
  switch (kind % 5) {
    case 0:
      return flat(rng, true);
    case 1: {
      Case c = flat(rng, false);  // The same shape, moved: edges over edges, corners over corners.
      c.B = c.A;
      const Vector3d half = c.A.mesh().vertices.back().cwiseAbs();
      c.X_WB.position =
          c.X_WA.position + c.X_WA.rotation * Vector3d(0.0, 0.0, 2.0 * half.z() + 0.01);
      return c;
    }
    case 2:
      return {any_box(rng),
              {any_vector(rng), any_rotation(rng)},
              any_box(rng),
              {any_vector(rng), any_rotation(rng)},
              uniform(rng, 0.0, 0.5)};
    case 3:  // In contact, or one in the other.
      return {any_box(rng),
              {0.3 * any_vector(rng), any_rotation(rng)},
              soup(rng),
              {0.3 * any_vector(rng), any_rotation(rng)},
              uniform(rng, 0.0, 0.1)};
    default:
      return {soup(rng),
              {any_vector(rng), any_rotation(rng)},
              soup(rng),
              {any_vector(rng), any_rotation(rng)},
              uniform(rng, 0.0, 0.5)};
  }
}

Case moved_by(Case c, const Vector3d& way) {
  c.X_WA.position += way;
  c.X_WB.position += way;
  return c;
}

std::vector<Contact> close(const Case& c) {
  Workspace workspace;
  std::vector<Contact> contacts;
  close_features(PlacedShape(c.A, c.X_WA), PlacedShape(c.B, c.X_WB), c.band, workspace, contacts);
  return contacts;
}

// --- Pair of triangles by pair of triangles ------------------------------------------------------

/// The closest points of two features, and of which triangles.
struct Closest {
  double distance = 0.0;
  std::array<std::uint32_t, 2> triangles{};
  Vector3d p_A = Vector3d::Zero();
  Vector3d p_B = Vector3d::Zero();
};
using Features = std::array<std::uint32_t, 4>;  // Type and index of A's, and of B's.
using ByFeatures = std::map<Features, Closest>;

std::array<std::uint32_t, 2> in_mesh(const Shape& shape, std::uint32_t triangle,
                                     const TriangleFeature& local) {
  const auto& corners = shape.mesh().triangles[triangle];
  const auto type = static_cast<std::uint32_t>(local.type);
  if (local.type == TriangleFeature::Type::face) {
    return {type, triangle};
  }
  const std::uint32_t from = corners[static_cast<std::size_t>(local.index)];
  return {type,
          local.type == TriangleFeature::Type::vertex
              ? from
              : shape.edge_index(from, corners[static_cast<std::size_t>(local.index + 1) % 3])};
}

bool repeats_a_corner(const Shape& shape, std::uint32_t triangle) {
  const auto& corners = shape.mesh().triangles[triangle];
  return corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
}

/// Points relative to A's centre.
ByFeatures close_by_triangles(const MovingShape& A, const MovingShape& B, double band) {
  const Hierarchy& hierarchy_A = A.shape.hierarchy();
  const Hierarchy& hierarchy_B = B.shape.hierarchy();
  ConstantRatePair motion =
      detail::motion_of(A, B, 1e-14 * (hierarchy_A.radius + hierarchy_B.radius));
  motion.enter(0.0);
  const detail::MovingPair pair(hierarchy_A, hierarchy_B, motion);
  const RelativeState state = motion.state(0.0);
  ByFeatures found;
  for (std::uint32_t a = 0; a < hierarchy_A.triangles.size(); ++a) {
    for (std::uint32_t b = 0; b < hierarchy_B.triangles.size(); ++b) {
      const TrianglePair at = pair.place(state, a, b);
      const FeaturePairs within =
          feature_pairs_within(at.A, at.B, A.shape.radius() + B.shape.radius() + band,
                               A.shape.own_features()[a], B.shape.own_features()[b]);
      for (std::size_t k = 0; k < within.count; ++k) {
        const ClosestFeatures& c = within.pairs[k];
        const Closest closest{c.distance,
                              {hierarchy_A.triangle_index[a], hierarchy_B.triangle_index[b]},
                              c.p_A,
                              c.p_B};
        const auto of_A = in_mesh(A.shape, closest.triangles[0], c.feature_A);
        const auto of_B = in_mesh(B.shape, closest.triangles[1], c.feature_B);
        const auto [place, is_new] =
            found.try_emplace({of_A[0], of_A[1], of_B[0], of_B[1]}, closest);
        if (!is_new && std::tie(closest.distance, closest.triangles) <
                           std::tie(place->second.distance, place->second.triangles)) {
          place->second = closest;
        }
      }
    }
  }
  return found;
}

/// In the order in which the query looks at them; then contacts are in that of the features.
void expect_as_by_triangles(Case c) {
  const Motion fixed_A = Motion::fixed(c.X_WA);
  const Motion fixed_B = Motion::fixed(c.X_WB);
  if (!detail::in_order({c.A, fixed_A}, {c.B, fixed_B})) {
    std::swap(c.A, c.B);
    std::swap(c.X_WA, c.X_WB);
  }
  const Motion X_WA = Motion::fixed(c.X_WA);
  const Motion X_WB = Motion::fixed(c.X_WB);
  const ByFeatures expected = close_by_triangles({c.A, X_WA}, {c.B, X_WB}, c.band);
  const std::vector<Contact> contacts = close(c);
  const Vector3d p_WC = X_WA.path(0, c.A.hierarchy().centre).pivot(0.0).value();
  ASSERT_EQ(contacts.size(), expected.size());
  auto pair = expected.begin();
  for (const Contact& contact : contacts) {
    const auto& [features, closest] = *pair++;
    ASSERT_EQ(
        (Features{static_cast<std::uint32_t>(contact.feature_A.type), contact.feature_A.index,
                  static_cast<std::uint32_t>(contact.feature_B.type), contact.feature_B.index}),
        features);
    ASSERT_EQ(contact.distance, closest.distance - c.A.radius() - c.B.radius());
    ASSERT_EQ(contact.feature_A.triangle, closest.triangles[0]);
    ASSERT_EQ(contact.feature_B.triangle, closest.triangles[1]);
    // Where corners repeat, several features of a triangle are one and may be as near.
    const bool is_told_apart = !repeats_a_corner(c.A, closest.triangles[0]) &&
                               !repeats_a_corner(c.B, closest.triangles[1]);
    if (c.A.radius() == 0.0 && c.B.radius() == 0.0 && is_told_apart) {
      ASSERT_EQ(contact.p_WA, p_WC + closest.p_A);
      ASSERT_EQ(contact.p_WB, p_WC + closest.p_B);
    }
  }
}

using CloseFeaturesOn = test::OnInstructionSet;

TEST_P(CloseFeaturesOn, OfFewTrianglesAreThoseOfAllTheirPairs) {
  std::mt19937 rng(1);
  std::size_t found = 0;
  for (int trial = 0; trial < test::rounds(1500, 300); ++trial) {
    const Case c = any_case(rng, trial);
    SCOPED_TRACE(trial);
    ASSERT_NO_FATAL_FAILURE(expect_as_by_triangles(c));
    ASSERT_NO_FATAL_FAILURE(expect_as_by_triangles(moved_by(c, {1e6, -2e6, 1e6})));
    found += close(c).size();
  }
  EXPECT_GT(found, std::size_t{test::rounds(10'000, 2'000)});
}

INSTANTIATE_TEST_SUITE_P(, CloseFeaturesOn, testing::ValuesIn(test::instruction_sets()),
                         test::instruction_set_name);

// A band of nothing leaves what pierces; an infinitesimal one beyond a gap shows what is beside it.
TEST(CloseFeatures, OfFewTrianglesEndWithTheBand) {
  const Shape box = make_box({1.0, 1.0, 1.0});
  Case c{box, {}, box, {.position = {1.25, 0.0, 0.0}}, 0.25};
  EXPECT_FALSE(close(c).empty());
  c.band = 0.25 - 1e-12;
  EXPECT_TRUE(close(c).empty());
}

// --- At rest -------------------------------------------------------------------------------------

TEST(CloseFeatures, OfPlacedShapesAreThoseOfMotionsThatRest) {
  std::mt19937 rng(2);
  const Shape ball = make_cylinder(0.5, 1.0);  // Has many triangles.
  for (int trial = 0; trial < 500; ++trial) {
    Case c = any_case(rng, trial);
    c.B = trial % 7 == 0 ? ball : c.B;
    c = moved_by(c, trial % 3 == 0 ? Vector3d(-3e5, 0.0, 1e6) : Vector3d::Zero());
    const Motion X_WA = Motion::fixed(c.X_WA);
    const Motion X_WB = Motion::fixed(c.X_WB);
    Workspace workspace;
    std::vector<Contact> expected;
    close_features({c.A, X_WA}, {c.B, X_WB}, 0.0, c.band, workspace, expected);
    const std::vector<Contact> contacts = close(c);
    ASSERT_EQ(contacts.size(), expected.size()) << trial;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      ASSERT_EQ(contacts[k].feature_A, expected[k].feature_A) << trial;
      ASSERT_EQ(contacts[k].feature_B, expected[k].feature_B) << trial;
      ASSERT_EQ(contacts[k].p_WA, expected[k].p_WA) << trial;
      ASSERT_EQ(contacts[k].p_WB, expected[k].p_WB) << trial;
      ASSERT_EQ(contacts[k].n_AB_W, expected[k].n_AB_W) << trial;
      ASSERT_EQ(contacts[k].distance, expected[k].distance) << trial;
      ASSERT_EQ(contacts[k].normal_velocity, expected[k].normal_velocity) << trial;
    }
  }
}

}  // namespace
}  // namespace firstcontact::few_triangles
