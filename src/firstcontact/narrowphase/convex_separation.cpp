#include <firstcontact/narrowphase/convex_separation.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <limits>

#include <Eigen/Geometry>

#include <firstcontact/narrowphase/detail/farthest_corners.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;

/// Most rounds; more of them gain nothing.
constexpr int kRounds = 16;

constexpr std::size_t kPlaces = detail::kDirections;

/// Up to four points; nearest() keeps those that hold the point nearest to the origin.
class Simplex {
 public:
  void add(const Vector3d& p) { points_[static_cast<std::size_t>(count_++)] = p; }

  /// The nearest point to the origin; drops all points but those that hold it. Zero if the origin
  /// is inside.
  Vector3d nearest() {
    switch (count_) {
      case 1:
        return points_[0];
      case 2:
        return of_segment();
      case 3:
        return of_triangle();
      default:
        return of_tetrahedron();
    }
  }

 private:
  Vector3d keep(const Vector3d& a) {
    count_ = 1;
    return points_[0] = a;
  }

  Vector3d keep(const Vector3d& a, const Vector3d& b, double share) {
    count_ = 2;
    const Vector3d nearest = a + share * (b - a);
    points_[0] = a;
    points_[1] = b;
    return nearest;
  }

  Vector3d of_segment() {
    const Vector3d a = points_[0];
    const Vector3d b = points_[1];
    const Vector3d ab = b - a;
    const double along = -a.dot(ab);
    if (along <= 0.0) {
      return keep(a);
    }
    const double square = ab.squaredNorm();
    return along >= square ? keep(b) : keep(a, b, along / square);
  }

  /// Source: C. Ericson, "Real-Time Collision Detection", 2005, section 5.1.5.
  Vector3d of_triangle() {
    const Vector3d a = points_[0];
    const Vector3d b = points_[1];
    const Vector3d c = points_[2];
    const Vector3d ab = b - a;
    const Vector3d ac = c - a;
    const double d1 = -ab.dot(a);
    const double d2 = -ac.dot(a);
    if (d1 <= 0.0 && d2 <= 0.0) {
      return keep(a);
    }
    const double d3 = -ab.dot(b);
    const double d4 = -ac.dot(b);
    if (d3 >= 0.0 && d4 <= d3) {
      return keep(b);
    }
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
      return keep(a, b, d1 / (d1 - d3));
    }
    const double d5 = -ab.dot(c);
    const double d6 = -ac.dot(c);
    if (d6 >= 0.0 && d5 <= d6) {
      return keep(c);
    }
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
      return keep(a, c, d2 / (d2 - d6));
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
      return keep(b, c, (d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    const double sum = va + vb + vc;
    return a + (vb / sum) * ab + (vc / sum) * ac;
  }

  Vector3d of_tetrahedron() {
    const std::array<Vector3d, 4> all = points_;
    constexpr int kFaces[4][4] = {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}};
    Vector3d best = Vector3d::Zero();
    double least = std::numeric_limits<double>::infinity();
    std::array<Vector3d, 4> kept = all;
    int kept_count = 4;
    for (const auto& [i, j, k, opposite] : kFaces) {
      const Vector3d& a = all[static_cast<std::size_t>(i)];
      const Vector3d normal =
          (all[static_cast<std::size_t>(j)] - a).cross(all[static_cast<std::size_t>(k)] - a);
      const double origin_side = -normal.dot(a);
      const double other_side = normal.dot(all[static_cast<std::size_t>(opposite)] - a);
      if (origin_side * other_side > 0.0) {
        continue;  // The origin is on the inner side of this face.
      }
      points_ = {a, all[static_cast<std::size_t>(j)], all[static_cast<std::size_t>(k)], a};
      count_ = 3;
      const Vector3d nearest = of_triangle();
      if (nearest.squaredNorm() < least) {
        least = nearest.squaredNorm();
        best = nearest;
        kept = points_;
        kept_count = count_;
      }
    }
    points_ = kept;
    count_ = kept_count;
    return best;
  }

  std::array<Vector3d, 4> points_ = {};
  int count_ = 0;
};

/// A polytope at its places, which all have the same corners.
using Places = std::span<const PlacedPolytope>;

/// The point that is farthest along n, at each place, relative to an origin.
std::array<Vector3d, kPlaces> farthest(Places P, const Vector3d& n, const Vector3d& origin) {
  std::array<Vector3d, kPlaces> directions;
  for (std::size_t k = 0; k < P.size(); ++k) {
    directions[k] = P[k].R.transpose() * n;
  }
  const PointRows& corners = P[0].corners;
  const auto rows = detail::farthest_corners(corners, std::span(directions).first(P.size()));
  std::array<Vector3d, kPlaces> points;
  for (std::size_t k = 0; k < P.size(); ++k) {
    points[k] = (P[k].centre - origin) + P[k].R * corners.row(rows[k]).transpose();
  }
  return points;
}

/// The difference B - A that is least along n.
Vector3d least_difference(Places A, Places B, const Vector3d& n) {
  const Vector3d& origin = A[0].centre;  // Near both: large offsets cancel before they are rounded.
  const auto on_A = farthest(A, n, origin);
  const auto on_B = farthest(B, -n, origin);
  Vector3d least = on_B[0] - on_A[0];
  for (std::size_t k = 1; k < std::max(A.size(), B.size()); ++k) {
    const Vector3d difference = on_B[B.size() == 1 ? 0 : k] - on_A[A.size() == 1 ? 0 : k];
    if (n.dot(difference) < n.dot(least)) {
      least = difference;
    }
  }
  return least;
}

}  // namespace

Separation separate(Places A, Places B, const Vector3d& n, const GapRange& range) {
  assert((A.size() == 1 || A.size() == kPlaces) && (B.size() == 1 || B.size() == kPlaces));
  Separation best{n, -std::numeric_limits<double>::infinity()};
  Simplex simplex;  // Simplex of the differences B - A.
  Vector3d along = n;
  for (int round = 0; round < kRounds; ++round) {
    const Vector3d difference = least_difference(A, B, along);
    const double gap = along.dot(difference);
    if (gap > best.gap) {
      best = {along, gap};
    }
    if (best.gap >= range.enough) {
      break;
    }
    simplex.add(difference);
    const Vector3d nearest = simplex.nearest();
    const double distance = nearest.norm();
    const double more = distance - range.least;
    if (!(distance > 0.0 && more > 0.0) || best.gap - range.least >= range.near * more) {
      break;
    }
    along = nearest / distance;
  }
  return best;
}

Separation separate(const PlacedPolytope& A, const PlacedPolytope& B, const Vector3d& n,
                    const GapRange& range) {
  return separate(std::span(&A, 1), std::span(&B, 1), n, range);
}

}  // namespace firstcontact
