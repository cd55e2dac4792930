#include <firstcontact/narrowphase/triangle_distance.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using Type = TriangleFeature::Type;

double clamp_to_unit(double x) { return x > 0.0 ? std::min(x, 1.0) : 0.0; }

TriangleFeature edge_or_end(int edge, double s) {
  if (s == 0.0) {
    return {Type::vertex, edge};
  }
  return s == 1.0 ? TriangleFeature{Type::vertex, (edge + 1) % 3}
                  : TriangleFeature{Type::edge, edge};
}

/// A triangle with what all elementary pairs need of it.
struct Prepared {
  explicit Prepared(const Triangle& T) : corners(T), edges{T[1] - T[0], T[2] - T[1], T[0] - T[2]} {
    for (int k = 0; k < 3; ++k) {
      square[k] = edges[k].squaredNorm();
      inverse_square[k] = square[k] > 0.0 ? 1.0 / square[k] : 0.0;
    }
    normal = edges[0].cross(Vector3d(-edges[2]));
  }

  [[nodiscard]] Vector3d point(int edge, double s) const {
    return s == 1.0 ? corners[(edge + 1) % 3] : Vector3d(corners[edge] + s * edges[edge]);
  }
  /// Of the three corners of another triangle over this one's plane, times |normal|.
  [[nodiscard]] Vector3d heights(const Triangle& other) const {
    return {normal.dot(other[0] - corners[0]), normal.dot(other[1] - corners[0]),
            normal.dot(other[2] - corners[0])};
  }

  const Triangle& corners;
  std::array<Vector3d, 3> edges;
  std::array<double, 3> square;
  std::array<double, 3> inverse_square;
  Vector3d normal;
};

/// Closest points of edge i of A and edge j of B. One parameter comes from the normal equations,
/// then each is made the best for the other, which also mends what near-parallel edges lose.
/// Calls use(squared distance, features) with a function that makes the features.
template <class Use>
void edge_edge(const Prepared& A, int i, const Prepared& B, int j, const Use& use) {
  const Vector3d& u = A.edges[i];
  const Vector3d& v = B.edges[j];
  const Vector3d r = B.corners[j] - A.corners[i];
  const double uv = u.dot(v);
  const double ur = u.dot(r);
  const double vr = v.dot(r);
  const double determinant = A.square[i] * B.square[j] - uv * uv;
  double s = determinant > 0.0 ? clamp_to_unit((ur * B.square[j] - vr * uv) / determinant) : 0.0;
  const double t = clamp_to_unit((s * uv - vr) * B.inverse_square[j]);
  s = clamp_to_unit((t * uv + ur) * A.inverse_square[i]);
  const Vector3d p_A = A.point(i, s);
  const Vector3d p_B = B.point(j, t);
  use((p_B - p_A).squaredNorm(), [&] {
    return ClosestFeatures{(p_B - p_A).norm(), p_A, p_B, edge_or_end(i, s), edge_or_end(j, t)};
  });
}

/// One for each edge of a triangle, or for the corner where it begins; the last is idle.
using Lanes = Eigen::Array4d;
using LaneVectors = std::array<Lanes, 3>;

LaneVectors in_lanes(const std::array<Vector3d, 3>& v) {
  return {Lanes(v[0].x(), v[1].x(), v[2].x(), 0.0), Lanes(v[0].y(), v[1].y(), v[2].y(), 0.0),
          Lanes(v[0].z(), v[1].z(), v[2].z(), 0.0)};
}

Lanes dot(const LaneVectors& a, const Vector3d& b) {
  return a[0] * b.x() + (a[1] * b.y() + a[2] * b.z());
}

/// The two edges that edge_edge() finds nearest to each other, but for rounding. It does the same
/// for three edges of B at once, and without branches: which features are nearest cannot be
/// foreseen.
std::pair<int, int> nearest_edges(const Prepared& A, const Prepared& B) {
  constexpr double kTiny = 0x1p-1000;
  const LaneVectors corners = in_lanes(B.corners);
  const LaneVectors v = in_lanes(B.edges);
  const Lanes vv(B.square[0], B.square[1], B.square[2], 0.0);
  const Lanes inverse_vv(B.inverse_square[0], B.inverse_square[1], B.inverse_square[2], 0.0);
  std::array<double, 12> square{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d& u = A.edges[i];
    const LaneVectors r{corners[0] - A.corners[i].x(), corners[1] - A.corners[i].y(),
                        corners[2] - A.corners[i].z()};
    const Lanes uv = dot(v, u);
    const Lanes ur = dot(r, u);
    const Lanes vr = v[0] * r[0] + (v[1] * r[1] + v[2] * r[2]);
    const Lanes determinant = A.square[i] * vv - uv * uv;
    // Parallel edges begin with s = 0.
    const Lanes crossed = (determinant * (1.0 / kTiny)).max(0.0).min(1.0);
    Lanes s = ((ur * vv - vr * uv) * crossed / determinant.max(kTiny)).max(0.0).min(1.0);
    const Lanes t = ((s * uv - vr) * inverse_vv).max(0.0).min(1.0);
    s = ((t * uv + ur) * A.inverse_square[i]).max(0.0).min(1.0);
    const Lanes x = r[0] + t * v[0] - s * u.x();
    const Lanes y = r[1] + t * v[1] - s * u.y();
    const Lanes z = r[2] + t * v[2] - s * u.z();
    Lanes::Map(square.data() + 4 * i) = x * x + (y * y + z * z);
  }
  std::size_t nearest = 0;
  for (const std::size_t k : {1, 2, 4, 5, 6, 8, 9, 10}) {
    nearest = square[k] < square[nearest] ? k : nearest;
  }
  return {static_cast<int>(nearest / 4), static_cast<int>(nearest % 4)};
}

/// The foot of a point on the plane of a triangle, where it lies inside.
std::optional<Vector3d> foot_inside(const Vector3d& p, const Prepared& T) {
  const Vector3d& n = T.normal;
  const Vector3d u = T.edges[0];
  const Vector3d v = -T.edges[2];
  const double nn = n.dot(n);
  const Vector3d r = p - T.corners[0];
  const double b = r.cross(v).dot(n);
  const double c = u.cross(r).dot(n);
  if (!(nn > 0.0 && b > 0.0 && c > 0.0 && b + c < nn)) {
    return std::nullopt;
  }
  return T.corners[0] + (b / nn) * u + (c / nn) * v;
}

/// Where edge i of S, between two heights over T's plane, pierces T.
std::optional<Vector3d> piercing_point(const Prepared& S, int i, const Vector3d& heights,
                                       const Prepared& T) {
  const double above = heights[i];
  const double below = heights[(i + 1) % 3];
  if ((above > 0.0) == (below > 0.0) || above == below) {
    return std::nullopt;
  }
  return foot_inside(S.corners[i] + above / (above - below) * S.edges[i], T);
}

ClosestFeatures in_order(ClosestFeatures c, bool swapped) {
  if (swapped) {
    std::swap(c.p_A, c.p_B);
    std::swap(c.feature_A, c.feature_B);
  }
  return c;
}

constexpr unsigned kAllFeatures = 0x3f;
bool has_corner(unsigned features, int i) { return (features & 1u << i) != 0; }
bool has_edge(unsigned features, int i) { return (features & 8u << i) != 0; }

/// Corners of S over the face of T, and edges of S through it, of those asked; only feet within a
/// squared distance of `reach()`.
template <class Reach, class Use>
void corners_and_edges(const Prepared& S, unsigned features, const Prepared& T, bool swapped,
                       const Reach& reach, const Use& use) {
  if (features == 0) {
    return;
  }
  const Vector3d heights = T.heights(S.corners);
  const double nn = T.normal.squaredNorm();
  const double longest2 = std::max({T.square[0], T.square[1], T.square[2]});
  const double rounding = 0x1p-96 * longest2 * longest2;  // Squared, of a height per length.
  for (int i = 0; i < 3; ++i) {
    // Twice the squares' sum is at least the square of the sum of reach and rounding.
    const double r2 = (S.corners[i] - T.corners[0]).squaredNorm();
    if (has_corner(features, i) &&
        heights[i] * heights[i] <= 2.0 * (reach() * nn + rounding * r2)) {
      if (const auto foot = foot_inside(S.corners[i], T)) {
        use((*foot - S.corners[i]).squaredNorm(), [&] {
          return in_order({(*foot - S.corners[i]).norm(),
                           S.corners[i],
                           *foot,
                           {Type::vertex, i},
                           {Type::face, 0}},
                          swapped);
        });
      }
    }
    const auto point = has_edge(features, i) ? piercing_point(S, i, heights, T) : std::nullopt;
    if (point) {
      use(0.0, [&] {
        return in_order({0.0, *point, *point, {Type::edge, i}, {Type::face, 0}}, swapped);
      });
    }
  }
}

/// A number below kFeatures.
constexpr std::size_t kFeatures = 7;
std::size_t number_of(const TriangleFeature& feature) {
  return 3 * static_cast<std::size_t>(feature.type) + static_cast<std::size_t>(feature.index);
}

}  // namespace

ClosestFeatures triangle_distance(const Triangle& T_A, const Triangle& T_B) {
  const Prepared A(T_A);
  const Prepared B(T_B);
  const auto [i, j] = nearest_edges(A, B);
  ClosestFeatures best;
  double least = std::numeric_limits<double>::infinity();
  const auto use = [&](double squared_distance, const auto& features) {
    if (squared_distance < least) {
      least = squared_distance;
      best = features();
    }
  };
  const auto reach = [&least] { return least; };
  edge_edge(A, i, B, j, use);
  corners_and_edges(A, kAllFeatures, B, false, reach, use);
  corners_and_edges(B, kAllFeatures, A, true, reach, use);
  return best;
}

FeaturePairs feature_pairs_within(const Triangle& T_A, const Triangle& T_B, double band,
                                  unsigned features_A, unsigned features_B) {
  FeaturePairs within;
  std::array<std::uint8_t, kFeatures * kFeatures> place{};  // Plus 1; 0: not there yet.
  const double reach2 = band * band * (1.0 + 0x1p-40);      // Not less than rounding takes off.
  const auto use = [&](double squared_distance, const auto& features) {
    if (squared_distance > reach2) {
      return;
    }
    const ClosestFeatures c = features();
    if (!(c.distance <= band)) {
      return;
    }
    std::uint8_t& found = place[kFeatures * number_of(c.feature_A) + number_of(c.feature_B)];
    if (found == 0) {
      within.pairs[within.count++] = c;
      found = static_cast<std::uint8_t>(within.count);
    } else if (c.distance < within.pairs[found - 1].distance) {
      within.pairs[found - 1] = c;
    }
  };
  const Prepared A(T_A);
  const Prepared B(T_B);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (has_edge(features_A, i) && has_edge(features_B, j)) {
        edge_edge(A, i, B, j, use);
      }
    }
  }
  const auto reach = [reach2] { return reach2; };
  corners_and_edges(A, features_A, B, false, reach, use);
  corners_and_edges(B, features_B, A, true, reach, use);
  return within;
}

}  // namespace firstcontact
