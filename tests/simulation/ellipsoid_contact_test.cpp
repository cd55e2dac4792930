// Contacts of ellipsoids, and one that rolls on a floor.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/query/close_features.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/query/placed_shape.h>
#include <firstcontact/record/run_step.h>
#include <firstcontact/simulation_model/detail/common_normal.h>
#include <firstcontact/simulation_model/detail/ellipsoid_contact.h>
#include <firstcontact/simulation_model/detail/inscribed_triangles.h>
#include <firstcontact/simulation_model/detail/round_ellipsoid.h>

#include "simulation/simulated_run.h"
#include "support/random.h"
#include "support/rounds.h"

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d squares_of(const Vector3d& radii, const Matrix3d& R) {
  return R * radii.cwiseAbs2().asDiagonal() * R.transpose();
}

/// The point of an ellipsoid that is nearest to one outside, by bisection of Lagrange's multiplier
/// in long double; axes of the ellipsoid.
Vector3d nearest_by_bisection(const Vector3d& radii, const Vector3d& p) {
  using Real = long double;
  const auto excess = [&](Real t) {
    Real sum = -1.0L;
    for (int k = 0; k < 3; ++k) {
      const Real r = radii[k];
      const Real x = r * static_cast<Real>(p[k]) / (r * r + t);
      sum += x * x;
    }
    return sum;
  };
  Real low = 0.0L;
  Real high = 1.0L;
  while (excess(high) > 0.0L) {
    high *= 2.0L;
  }
  for (int k = 0; k < 200; ++k) {
    const Real middle = 0.5L * (low + high);
    (excess(middle) > 0.0L ? low : high) = middle;
  }
  Vector3d nearest;
  for (int k = 0; k < 3; ++k) {
    const Real r2 = static_cast<Real>(radii[k]) * radii[k];
    nearest[k] = static_cast<double>(r2 * p[k] / (r2 + low));
  }
  return nearest;
}

/// [m]  Of an ellipsoid.
Vector3d any_radii(double low, double high, test::Random& random) {
  return {random.uniform(low, high), random.uniform(low, high), random.uniform(low, high)};
}

/// A unit vector near n.
Vector3d near(const Vector3d& n, double by, test::Random& random) {
  return (n + by * random.direction()).normalized();
}

TEST(CommonNormal, IsThatOfTheNearestPoint) {
  test::Random random(1);
  for (int k = 0; k < 500; ++k) {
    const Vector3d radii = any_radii(0.1, 1.0, random);
    const Matrix3d R = random.rotation().toRotationMatrix();
    const Vector3d out = random.direction();
    const RoundEllipsoid ellipsoid{.radii = radii};
    const double apart = std::pow(10.0, random.uniform(-9.0, 1.0));
    const Vector3d p = ellipsoid.farthest(out) + apart * out;
    const Vector3d n =
        common_normal({NormalSide{.squares = squares_of(radii, R)}, NormalSide{.point = R * p}},
                      near(R * out, 0.4, random));
    const Vector3d away = p - nearest_by_bisection(radii, p);
    EXPECT_LE((n - R * out).norm(), 1e-12) << k;
    EXPECT_NEAR(away.normalized().dot(out), 1.0, 1e-6 + 1e-12 / (apart * apart)) << "the oracle";
  }
}

// Of two sets apart the segment between the points farthest along n and against it has that
// direction, and only then.
TEST(CommonNormal, JoinsClosestPointsOfTwoEllipsoids) {
  test::Random random(2);
  for (int k = 0; k < 500; ++k) {
    const std::array<Matrix3d, 2> squares{
        squares_of(any_radii(0.1, 1.0, random), random.rotation().toRotationMatrix()),
        squares_of(any_radii(0.1, 1.0, random), random.rotation().toRotationMatrix())};
    const Vector3d out = random.direction();
    std::array<NormalSide, 2> sides{NormalSide{.squares = squares[0]},
                                    NormalSide{.squares = squares[1]}};
    const double apart = std::pow(10.0, random.uniform(-6.0, 0.0));
    sides[1].point = sides[0].farthest(out) + apart * out + sides[1].farthest(out);
    const Vector3d n = common_normal(sides, near(out, 0.4, random));
    EXPECT_LE((n - out).norm(), 1e-12) << k;
  }
}

TEST(CommonNormal, IsAcrossALine) {
  test::Random random(3);
  for (int k = 0; k < 500; ++k) {
    const NormalSide egg{
        .squares = squares_of(any_radii(0.1, 1.0, random), random.rotation().toRotationMatrix())};
    const Vector3d out = random.direction();
    const Vector3d along = out.cross(random.direction()).normalized();
    const NormalSide line{.point = egg.farthest(out) + random.uniform(1e-6, 0.1) * out +
                                   random.uniform(-3.0, 3.0) * along,
                          .line = along};
    EXPECT_LE((common_normal({egg, line}, near(out, 0.3, random)) - out).norm(), 1e-11) << k;
    EXPECT_LE((common_normal({line, egg}, near(-out, 0.3, random)) + out).norm(), 1e-11) << k;
  }
}

// Ends where it began, or better, also where the sets overlap.
TEST(CommonNormal, SeparatesNoLessThanItsStart) {
  test::Random random(4);
  for (int k = 0; k < 500; ++k) {
    const std::array<NormalSide, 2> sides{
        NormalSide{.squares = squares_of(any_radii(0.01, 1.0, random), Matrix3d::Identity())},
        NormalSide{.point = 0.3 * random.direction(),
                   .squares = squares_of(any_radii(0.01, 1.0, random), Matrix3d::Identity())}};
    const auto apart = [&](const Vector3d& n) {
      return n.dot(sides[1].point - sides[0].farthest(n) - sides[1].farthest(n));
    };
    const Vector3d from = random.direction();
    const Vector3d n = common_normal(sides, from);
    EXPECT_NEAR(n.norm(), 1.0, 1e-12);
    EXPECT_GE(apart(n), apart(from) - 1e-12) << k;
  }
}

TEST(RoundEllipsoids, AreTheShapesThemselves) {
  const Vector3d radii(0.1, 0.04, 0.07);
  for (const double error : {5e-4, 1e-4}) {
    const Shape egg = make_ellipsoid(radii, error);
    const auto round = round_ellipsoid_of(egg);
    ASSERT_TRUE(round.has_value());
    EXPECT_EQ(round->radii, radii);
    const Shape inscribed = inscribed_triangles(egg);
    for (const Vector3d& corner : inscribed.mesh().vertices) {
      EXPECT_NEAR(corner.cwiseQuotient(radii).norm(), 1.0, 1e-15);
    }
  }
  EXPECT_FALSE(round_ellipsoid_of(make_cylinder(0.1, 0.2)).has_value());
  EXPECT_FALSE(round_ellipsoid_of(make_sphere(0.1)).has_value());
  EXPECT_FALSE(round_ellipsoid_of(make_box({1.0, 1.0, 1.0})).has_value());
}

// Each corner stays where it is along the axis and around it.
TEST(InscribedTriangles, HaveTheirCornersOnTheShape) {
  for (const Shape& shape : {make_cylinder(0.3, 0.8), make_cone(0.3, 0.8)}) {
    const Shape inscribed = inscribed_triangles(shape);
    ASSERT_EQ(inscribed.mesh().triangles, shape.mesh().triangles);
    for (std::size_t k = 0; k < shape.mesh().vertices.size(); ++k) {
      const Vector3d& around = shape.mesh().vertices[k];
      const Vector3d& on = inscribed.mesh().vertices[k];
      EXPECT_EQ(on.z(), around.z());
      if (around.head<2>().norm() > 0.0) {
        EXPECT_NEAR(on.head<2>().norm(), 0.3, 2e-16);
        EXPECT_NEAR((on.head<2>() - 0.3 * around.head<2>().normalized()).norm(), 0.0, 2e-16);
      } else {
        EXPECT_TRUE(std::abs(on.z()) == 0.4);
      }
    }
    EXPECT_FALSE(inscribed.is_curved());
  }
  const Shape box = make_box({1.0, 1.0, 1.0});
  EXPECT_EQ(&inscribed_triangles(box).mesh(), &box.mesh());
}

/// A shape, and its triangles for contacts.
struct Other {
  explicit Other(const Shape& shape)
      : exact(shape), triangles(inscribed_triangles(shape)), ellipsoid(round_ellipsoid_of(shape)) {}

  [[nodiscard]] PlacedRound at(const Pose& pose) const {
    return {.shape = &triangles,
            .is_curved = exact.is_curved(),
            .ellipsoid = ellipsoid ? &*ellipsoid : nullptr,
            .pose = pose};
  }

  Shape exact;
  Shape triangles;
  std::optional<RoundEllipsoid> ellipsoid;
};

// Computed from its features, each nearest contact is as near as the distance of the sets, which
// certified advancement finds. Bodies of a thousandth of the egg's size are among them.
TEST(EllipsoidContacts, AreAsNearAsTheBodies) {
  test::Random random(5);
  Workspace workspace;
  std::vector<Contact> contacts;
  const auto exact_distance = [&](const Other& A, const Pose& X_A, const Other& B,
                                  const Pose& X_B) {
    const Motion a = Motion::fixed(X_A);
    const Motion b = Motion::fixed(X_B);
    return distance({A.exact, a}, {B.exact, b}, 0.0, workspace).distance;
  };
  for (int k = 0; k < test::rounds(140, 14); ++k) {
    const Other egg(make_ellipsoid(any_radii(0.03, 0.1, random)));
    const std::array<Other, 7> others{Other(make_box({0.2, 0.15, 0.1})),
                                      Other(make_sphere(0.05)),
                                      Other(make_capsule(0.03, 0.1)),
                                      Other(Shape(make_box({0.05, 0.05, 0.05}).mesh(), 0.01)),
                                      Other(make_ellipsoid(any_radii(0.03, 0.1, random))),
                                      Other(make_box({1e-4, 2e-4, 1e-4})),
                                      Other(make_cylinder(0.05, 0.1))};
    const Other& other = others[static_cast<std::size_t>(k) % others.size()];
    const Pose X_A{Vector3d(5.0, -3.0, 2.0), random.rotation()};
    Pose X_B{X_A.position + random.direction(), random.rotation()};
    // Towards each other, to 1 mm.
    for (int pass = 0; pass < 8; ++pass) {
      X_B.position += (exact_distance(egg, X_A, other, X_B) - 1e-3) *
                      (X_A.position - X_B.position).normalized();
    }
    const double exact = exact_distance(egg, X_A, other, X_B);
    ASSERT_NEAR(exact, 1e-3, 5e-4);
    close_points_of_sets(PlacedShape(egg.exact, X_A), PlacedShape(other.exact, X_B), 3e-3,
                         workspace, contacts);
    ASSERT_FALSE(contacts.empty());
    double least = std::numeric_limits<double>::infinity();
    for (Contact contact : contacts) {
      const auto round = make_ellipsoidal({egg.at(X_A), other.at(X_B)}, contact);
      EXPECT_EQ(round[0].ellipsoid, &*egg.ellipsoid);
      least = std::min(least, contact.distance);
      EXPECT_NEAR((contact.p_WB - contact.p_WA - contact.distance * *contact.n_AB_W).norm(), 0.0,
                  1e-9);
    }
    EXPECT_NEAR(least, exact, 1e-9) << k;
  }
}

// The search may give a face of the box. The contact becomes one of the edge or the corner on which
// it is, so that it is not moved as one of the face.
TEST(EllipsoidContacts, OnAFaceToWhichTheyAreNotPerpendicularAreOfItsRim) {
  const Other egg(make_ellipsoid({0.08, 0.06, 0.05}));
  const Other bar(make_box({0.2, 0.1, 0.1}));
  const Pose X_B{Vector3d::Zero(), Eigen::Quaterniond::Identity()};
  const auto contact_at = [&](const Vector3d& point, const Vector3d& n, std::uint32_t face) {
    const Pose X_A{point + egg.ellipsoid->farthest(n) + 1e-3 * n, Eigen::Quaterniond::Identity()};
    Contact contact;
    contact.feature_A = {FeatureType::face, 0, 0};
    contact.feature_B = {FeatureType::face, face, face};
    contact.p_WB = point;
    contact.p_WA = point + 1e-3 * n;
    contact.n_AB_W = -n;
    contact.distance = 1e-3;
    EXPECT_TRUE(make_ellipsoidal({egg.at(X_A), bar.at(X_B)}, contact)[0].is_curved());
    EXPECT_LE((*contact.n_AB_W + n).norm(), 1e-9);
    EXPECT_NEAR(contact.distance, 1e-3, 1e-12);
    return contact;
  };
  const auto& v = bar.exact.mesh().vertices;
  int corners = 0;
  int edges = 0;
  for (std::uint32_t face = 0; face < bar.exact.mesh().triangles.size(); ++face) {
    for (const std::uint32_t corner : bar.exact.mesh().triangles[face]) {
      const Contact contact = contact_at(v[corner], v[corner].cwiseSign().normalized(), face);
      EXPECT_EQ(contact.feature_B.type, FeatureType::vertex);
      EXPECT_EQ(contact.feature_B.index, corner);
      ++corners;
    }
    const auto& t = bar.exact.mesh().triangles[face];
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d middle = 0.5 * (v[t[k]] + v[t[(k + 1) % 3]]);
      if ((v[t[k]] - v[t[(k + 1) % 3]]).cwiseAbs().maxCoeff() + 1e-12 <
          (v[t[k]] - v[t[(k + 1) % 3]]).norm()) {
        continue;  // The diagonal of a side.
      }
      const Vector3d n = middle.cwiseQuotient(Vector3d(0.1, 0.05, 0.05)).normalized();
      const Contact contact = contact_at(middle, n, face);
      EXPECT_EQ(contact.feature_B.type, FeatureType::edge);
      EXPECT_EQ(contact.feature_B.index, bar.exact.edge_index(t[k], t[(k + 1) % 3]));
      ++edges;
    }
  }
  EXPECT_EQ(corners, 36);
  EXPECT_EQ(edges, 24);
}

// Flat and long ones too are found in few steps, not only within the most that are allowed.
TEST(CommonNormal, OfAFlatEllipsoidIsFoundToo) {
  test::Random random(6);
  for (int k = 0; k < 200; ++k) {
    const RoundEllipsoid lens{.radii = {1.0, 0.7, 1e-2}};
    const Vector3d out = random.direction();
    const Vector3d p = lens.farthest(out) + 1e-3 * out;
    const NormalSide side{.squares = squares_of(lens.radii, Matrix3d::Identity())};
    const Vector3d n = common_normal({side, NormalSide{.point = p}}, near(out, 0.1, random));
    EXPECT_NEAR(n.dot(p - side.farthest(n)), 1e-3, 1e-14) << k;
  }
}

// One that rolls about its long axis goes on as it began.
TEST(Ellipsoids, RollOnWithoutResistance) {
  Simulator s = test::simulator(
      test::kFloor + R"(, {"name": "egg", "shape": {"ellipsoid": {"radii": [0.1, 0.05, 0.05]}},
          "pose": {"position": [0, -1, 0.0504]}, "dynamics": {"linear_velocity": [0, 0.5, 0],
          "angular_velocity": [-10, 0, 0]}})",
      test::settings(0.01, 0.8, 1e-4));
  const std::vector<RunStep> steps = test::run(s, test::rounds(300, 60));
  const double begin = steps[49].bodies[0].linear_velocity.y();
  EXPECT_NEAR(steps.back().bodies[0].linear_velocity.y(), begin, 1e-4 * begin);
  const RunVerification proof = test::verify(s.header(), steps);
  EXPECT_EQ(proof.verdict, ProofVerdict::proven) << proof.problem;
}

}  // namespace
}  // namespace firstcontact::detail
