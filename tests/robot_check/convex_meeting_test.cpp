// Meshes that come to convex sets: contacts that are found by a few triangles, and meshes with deep
// cavities. A slow oracle judges each triangle by support points.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/robot_check/detail/hull_approach.h>
#include <firstcontact/robot_check/detail/link_query.h>
#include <firstcontact/robot_check/link_pair_motion.h>

#include "support/convex_distance.h"
#include "support/random.h"
#include "support/rounds.h"

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;

constexpr double kHalf = 0.1;  // [m]  Half the side of a cup.

/// A cube of thin sheets that is open below: its hull is the whole cube.
Shape cup(int cells) {
  Mesh mesh;
  const auto sheet = [&](const Vector3d& corner, const Vector3d& u, const Vector3d& v) {
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    const auto row = static_cast<std::uint32_t>(cells + 1);
    for (int i = 0; i <= cells; ++i) {
      for (int j = 0; j <= cells; ++j) {
        mesh.vertices.push_back(corner + (u * i + v * j) / cells);
      }
    }
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      for (std::uint32_t j = 0; j + 1 < row; ++j) {
        const std::uint32_t at = base + i * row + j;
        mesh.triangles.push_back({at, at + row, at + 1});
        mesh.triangles.push_back({at + 1, at + row, at + row + 1});
      }
    }
  };
  const double side = 2.0 * kHalf;
  const Vector3d low(-kHalf, -kHalf, -kHalf);
  const Vector3d x(side, 0, 0);
  const Vector3d y(0, side, 0);
  const Vector3d z(0, 0, side);
  sheet(low + z, x, y);
  sheet(low, x, z);
  sheet(low + y, x, z);
  sheet(low, y, z);
  sheet(low + x, y, z);
  return Shape(mesh);
}

/// A box or a cylinder, known to the oracle by its sizes.
struct Peg {
  Shape shape;
  Vector3d half;  // [m]  Of the box; radius, radius and half length of the cylinder.
  bool is_round = false;

  [[nodiscard]] Vector3d support(const Vector3d& n) const {
    if (!is_round) {
      return {std::copysign(half.x(), n.x()), std::copysign(half.y(), n.y()),
              std::copysign(half.z(), n.z())};
    }
    const double across = std::hypot(n.x(), n.y());
    const double scale = across > 0.0 ? half.x() / across : 0.0;
    return {scale * n.x(), scale * n.y(), std::copysign(half.z(), n.z())};
  }

  [[nodiscard]] bool holds(const Vector3d& p) const {
    const bool is_between = std::abs(p.z()) <= half.z() * (1.0 + 1e-12);
    return is_between && (is_round ? std::hypot(p.x(), p.y()) <= half.x() * (1.0 + 1e-12)
                                   : std::abs(p.x()) <= half.x() * (1.0 + 1e-12) &&
                                         std::abs(p.y()) <= half.y() * (1.0 + 1e-12));
  }
};

Peg box_peg(const Vector3d& half) { return {make_box(2.0 * half), half, false}; }
Peg round_peg(double radius, double half_length) {
  return {make_cylinder(radius, 2.0 * half_length), {radius, radius, half_length}, true};
}

/// A mesh that moves at constant rates, and a peg at rest.
struct Meeting {
  Shape mesh;
  Motion motion;
  Peg peg;

  [[nodiscard]] Pose pose(double t) const { return motion.pose(t); }

  /// [m]  The distance of the triangles and the solid peg; at most an upper bound of it.
  [[nodiscard]] double distance_at(double t) const {
    const Pose X = pose(t);
    const auto to_peg = [this](const Vector3d& n) { return peg.support(n); };
    double least = std::numeric_limits<double>::infinity();
    for (const auto& triangle : mesh.mesh().triangles) {
      std::array<Vector3d, 3> p;
      for (std::size_t k = 0; k < 3; ++k) {
        p[k] = X.position + X.rotation.normalized() * mesh.mesh().vertices[triangle[k]];
      }
      const auto along = [&p](const Vector3d& n) {
        return *std::ranges::max_element(
            p, [&n](const Vector3d& x, const Vector3d& y) { return n.dot(x) < n.dot(y); });
      };
      least = std::min(least, oracle::convex_distance(along, to_peg).upper);
    }
    return least;
  }

  [[nodiscard]] FirstContactResult early(double by, const TimeWindow& window = {}) const {
    const Shape& A = mesh;
    const Shape& B = peg.shape;
    const LinkMotion X_FA(motion);
    const LinkMotion X_FB(Motion::fixed());
    const detail::HullCorners corners_A = detail::hull_corners(A);
    const detail::HullCorners corners_B = detail::hull_corners(B);
    detail::LinkWorkspace workspace;
    FirstContactResult result;
    detail::first_contact_early({A, X_FA}, {B, X_FB}, detail::hull_of(A, B, corners_A),
                                detail::hull_of(B, A, corners_B), window, by, workspace,
                                {.tolerance = 1e-9, .contacts = ContactState::none}, result);
    return result;
  }

  /// Whether a few triangles at the hull decide.
  [[nodiscard]] bool is_met_by_few(double by) const {
    const LinkMotion X_FA(motion);
    const LinkMotion X_FB(Motion::fixed());
    const auto ball = [](const Shape& shape, const LinkMotion& X) {
      return LinkBall{X, shape.hierarchy().centre, shape.hierarchy().radius * (1.0 + 1e-12)};
    };
    LinkScratch scratch;
    LinkPairMotion relative(ball(mesh, X_FA), ball(peg.shape, X_FB), scratch);
    const detail::HullCorners corners_A = detail::hull_corners(mesh);
    const detail::HullCorners corners_B = detail::hull_corners(peg.shape);
    return detail::follow_hulls(detail::hull_of(mesh, peg.shape, corners_A),
                                detail::hull_of(peg.shape, mesh, corners_B), relative, {}, 0.0,
                                1e-9, by)
        .t_contact.has_value();
  }

  [[nodiscard]] bool has_vertex_inside(double t) const {
    const LinkMotion X_FA(motion);
    const LinkMotion X_FB(Motion::fixed());
    const detail::HullCorners corners_A = detail::hull_corners(mesh);
    const detail::HullCorners corners_B = detail::hull_corners(peg.shape);
    detail::LinkWorkspace workspace;
    const detail::ShapeHull A = detail::hull_of(mesh, peg.shape, corners_A);
    const detail::ShapeHull B = detail::hull_of(peg.shape, mesh, corners_B);
    const bool forth =
        detail::has_vertex_inside({mesh, X_FA}, {peg.shape, X_FB}, A, B, t, workspace);
    EXPECT_EQ(detail::has_vertex_inside({peg.shape, X_FB}, {mesh, X_FA}, B, A, t, workspace),
              forth);
    return forth;
  }

  /// Whether some vertex is in the peg.
  [[nodiscard]] bool is_vertex_in_peg(double t) const {
    const Pose X = pose(t);
    return std::ranges::any_of(mesh.mesh().vertices, [&](const Vector3d& v) {
      return peg.holds(X.position + X.rotation.normalized() * v);
    });
  }
};

Peg any_peg(Random& random) {
  return random.chance(0.5) ? box_peg({random.uniform(0.01, 0.3), random.uniform(0.01, 0.3), 0.05})
                            : round_peg(random.uniform(0.02, 0.1), random.uniform(0.02, 0.2));
}

Meeting any_meeting(Random& random) {
  const Vector3d from = random.vector(0.3, 0.8);
  const Vector3d way = random.vector(0.0, 0.4) - 1.5 * from;
  const Vector3d turn = random.vector(0.0, 3.0);
  return {cup(static_cast<int>(random.uniform(1.0, 6.0))),
          Motion::constant_velocity(Pose{from, random.rotation()}, way, turn), any_peg(random)};
}

// A cup that comes down over a peg: its hull is pierced all the way, the sheets are free until the
// tip meets the lid.
TEST(ConvexMeeting, KeepsACavityFree) {
  for (const Peg& peg : {box_peg({0.05, 0.05, 0.3}), round_peg(0.06, 0.3)}) {
    for (const int cells : {1, 4}) {
      const auto down_to = [&](double z) {
        return Meeting{
            cup(cells),
            Motion::constant_velocity(Pose{{0.01, 0.0, 1.0}, Eigen::Quaterniond::Identity()},
                                      Pose{{0.01, 0.0, z}, Eigen::Quaterniond::Identity()}),
            peg};
      };
      for (const double by : {0.0, 1e-3, 0.1, 1.0}) {
        EXPECT_EQ(down_to(0.21).early(by).verdict, Verdict::free) << by;
        const FirstContactResult met = down_to(0.1).early(by);
        const double meets = 0.8 / 0.9;
        ASSERT_EQ(met.verdict, Verdict::contact) << by;
        EXPECT_LE(met.t, meets + 1e-8);
        EXPECT_GE(met.t, meets - by - 1e-8);
      }
    }
  }
}

// No contact is late, none is told more than a thousandth too early, and each is one.
TEST(ConvexMeeting, AgreesWithSupportPoints) {
  Random random(5);
  constexpr double kEarly = 1e-3;
  constexpr int kSamples = rounds(20, 5);
  int met = 0;
  int free = 0;
  int by_few = 0;
  for (int k = 0; k < rounds(80, 8); ++k) {
    const Meeting meeting = any_meeting(random);
    const FirstContactResult found = meeting.early(kEarly);
    ASSERT_NE(found.verdict, Verdict::undecided) << k;
    if (found.verdict == Verdict::contact_at_start) {
      ASSERT_LE(meeting.distance_at(0.0), 1e-8) << k;
      continue;
    }
    const bool is_free = found.verdict == Verdict::free;
    (is_free ? free : met) += 1;
    for (int i = 0; i < kSamples; ++i) {
      ASSERT_GT(meeting.distance_at(found.t * i / kSamples), 0.0) << k;
    }
    if (is_free) {
      ASSERT_GT(meeting.distance_at(1.0), 0.0) << k;
      continue;
    }
    ASSERT_GT(meeting.distance_at(found.t * (1.0 - 1e-9)), 0.0) << k;
    by_few += meeting.is_met_by_few(kEarly) ? 1 : 0;
    ASSERT_TRUE(found.t_upper.has_value());
    ASSERT_LE(*found.t_upper, found.t + kEarly + 1e-15) << k;
    ASSERT_LE(meeting.distance_at(*found.t_upper), 1e-8) << k;
  }
  EXPECT_GT(met, rounds(10, 1));
  EXPECT_GT(free, rounds(2, -1));
  EXPECT_GT(by_few, met / 2);  // Tight: most contacts need no search.
}

// A vertex is told inside only where one is; and deep in the peg it is told.
TEST(ConvexMeeting, FindsVerticesInside) {
  Random random(6);
  int found = 0;
  int known = 0;
  for (int k = 0; k < rounds(500, 150); ++k) {
    const Meeting meeting = any_meeting(random);
    const double t = random.uniform(0.3, 0.9);
    const bool is_found = meeting.has_vertex_inside(t);
    const bool is_known = meeting.is_vertex_in_peg(t);
    ASSERT_TRUE(is_known || !is_found) << k;
    found += is_found;
    known += is_known;
  }
  EXPECT_GT(found, 10);
  EXPECT_GT(known, found);  // Only vertices of the hull are looked at.
}

// The corners of the triangles around a cylinder are no points of it.
TEST(ConvexMeeting, TakesACylinderAsItIs) {
  const Peg cylinder = round_peg(0.1, 0.2);
  double far = 0.0;
  for (const Vector3d& corner : cylinder.shape.mesh().vertices) {
    far = std::max(far, std::hypot(corner.x(), corner.y()));
  }
  ASSERT_GT(far, 0.1);
  const Vector3d corner = cylinder.shape.mesh().vertices.front();
  const Vector3d out = Vector3d(corner.x(), corner.y(), 0.0).normalized();
  const auto turned = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitX(), out);
  // The face of a cube, between the cylinder and the corners around it.
  const auto at = [&](double gap) {
    return Meeting{make_box({0.2, 0.2, 0.2}),
                   Motion::fixed({(0.2 + gap) * out, Eigen::Quaterniond(turned)}), cylinder};
  };
  EXPECT_FALSE(at(0.1 * (far - 0.1)).has_vertex_inside(0.5));
}

}  // namespace
}  // namespace firstcontact::test
