#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/query/close_features.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;

Vector3d any_vector(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  return {normal(rng), normal(rng), normal(rng)};
}

Mesh box(const Vector3d& half) {
  Mesh mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.vertices.emplace_back((k & 1) != 0 ? half.x() : -half.x(),
                               (k & 2) != 0 ? half.y() : -half.y(),
                               (k & 4) != 0 ? half.z() : -half.z());
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// With so many more triangles far away, to one side, that its pairs are found by its boxes.
Mesh with_more(Mesh mesh, double side) {
  for (std::uint32_t k = 0; k < 20; ++k) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const Vector3d far(side * (50.0 + k), 0.0, 0.0);
    mesh.vertices.insert(mesh.vertices.end(),
                         {far, far + Vector3d::UnitY(), far + Vector3d::UnitZ()});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

std::vector<Contact> close(const Mesh& a, const Pose& X_WA, const Mesh& b, const Pose& X_WB,
                           double band) {
  const Shape A(a);
  const Shape B(b);
  const Motion motion_A = Motion::fixed(X_WA);
  const Motion motion_B = Motion::fixed(X_WB);
  Workspace workspace;
  std::vector<Contact> contacts;
  close_features({A, motion_A}, {B, motion_B}, 0.0, band, workspace, contacts);
  // Edges are counted otherwise where there are more triangles, but are in the same order.
  std::ranges::sort(contacts, {}, [](const Contact& contact) {
    return std::tuple(contact.feature_A.type, contact.feature_A.index, contact.feature_B.type,
                      contact.feature_B.index);
  });
  return contacts;
}

// Meshes of few triangles are searched otherwise than large ones; features near each other are the
// same.
TEST(CloseFeatures, OfFewTrianglesAreThoseOfMany) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::size_t found = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const Mesh a = box({0.2 + uniform(rng), 0.2 + uniform(rng), 0.2 + uniform(rng)});
    const Mesh b = box({0.2 + uniform(rng), 0.2 + uniform(rng), 0.2 + uniform(rng)});
    // Face on face, turned about the normal; or anyhow.
    const bool flat = trial % 2 == 0;
    const Eigen::Quaterniond q(Eigen::AngleAxisd(
        3.0 * uniform(rng), flat ? Vector3d(Vector3d::UnitX()) : any_vector(rng).normalized()));
    const Eigen::Quaterniond all(Eigen::AngleAxisd(3.0, any_vector(rng).normalized()));
    const Vector3d way = flat ? Vector3d(a.vertices[7].x() + b.vertices[7].x() + 0.01,
                                         0.3 * uniform(rng), 0.3 * uniform(rng))
                              : Vector3d(1.5 * any_vector(rng));
    const Pose X_WA{any_vector(rng), all};
    const Pose X_WB{X_WA.position + all * way, all * q};
    const double band = flat ? 0.02 : 0.3 * uniform(rng);
    const auto few = close(a, X_WA, b, X_WB, band);
    const auto many = close(with_more(a, -1.0), X_WA, with_more(b, 1.0), X_WB, band);
    ASSERT_EQ(few.size(), many.size()) << trial;
    for (std::size_t k = 0; k < few.size(); ++k) {
      ASSERT_NEAR(few[k].distance, many[k].distance, 1e-11) << trial;
      ASSERT_LE((few[k].p_WA - many[k].p_WA).norm(), 1e-9) << trial;
      ASSERT_EQ(few[k].feature_A.type, many[k].feature_A.type) << trial;
      ASSERT_EQ(few[k].feature_B.type, many[k].feature_B.type) << trial;
    }
    found += few.size();
  }
  EXPECT_GT(found, 2000u);
}

// A capsule's core is a triangle with one corner twice. Both of its ends are near a parallel one.
TEST(CloseFeatures, AreBothEndsOfACapsuleBesideAnother) {
  const Shape A = make_capsule(0.8, 2.0);
  const Shape B = make_capsule(0.1, 0.2);
  Workspace workspace;
  for (const double tilt : {-1e-6, -1e-9, -1e-15, 0.0, 1e-15, 1e-9, 1e-6}) {
    const Pose X_WB{{0.9 + 1e-4, 0.0, 0.0},
                    Eigen::Quaterniond(Eigen::AngleAxisd(tilt, Vector3d::UnitY()))};
    std::vector<Contact> contacts;
    close_features(PlacedShape(A, Pose{}), PlacedShape(B, X_WB), 1e-3, workspace, contacts);
    for (const std::uint32_t end : {0u, 1u}) {
      EXPECT_TRUE(std::ranges::any_of(contacts,
                                      [&](const Contact& c) {
                                        return c.feature_B == Feature{FeatureType::vertex, end, 0};
                                      }))
          << tilt << " " << end;
    }
  }
}

}  // namespace
}  // namespace firstcontact
