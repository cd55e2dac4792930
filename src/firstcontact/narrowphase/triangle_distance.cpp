#include <firstcontact/narrowphase/triangle_distance.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

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

/// Closest points of edge i of A and edge j of B. One parameter comes from the normal equations,
/// then each is made the best for the other, which also mends what near-parallel edges lose.
ClosestFeatures edge_edge(const Triangle& A, int i, const Triangle& B, int j) {
  const Vector3d& p = A[i];
  const Vector3d& q = B[j];
  const Vector3d u = A[(i + 1) % 3] - p;
  const Vector3d v = B[(j + 1) % 3] - q;
  const Vector3d r = q - p;
  const double uu = u.dot(u);
  const double vv = v.dot(v);
  const double uv = u.dot(v);
  const double ur = u.dot(r);
  const double vr = v.dot(r);
  const double determinant = uu * vv - uv * uv;
  double s = determinant > 0.0 ? clamp_to_unit((ur * vv - vr * uv) / determinant) : 0.0;
  const double t = vv > 0.0 ? clamp_to_unit((s * uv - vr) / vv) : 0.0;
  s = uu > 0.0 ? clamp_to_unit((t * uv + ur) / uu) : 0.0;
  ClosestFeatures c;
  c.p_A = s == 1.0 ? A[(i + 1) % 3] : Vector3d(p + s * u);
  c.p_B = t == 1.0 ? B[(j + 1) % 3] : Vector3d(q + t * v);
  c.distance = (c.p_B - c.p_A).norm();
  c.feature_A = edge_or_end(i, s);
  c.feature_B = edge_or_end(j, t);
  return c;
}

/// The foot of a point on the plane of a triangle, where it lies inside.
std::optional<Vector3d> foot_inside(const Vector3d& p, const Triangle& T) {
  const Vector3d u = T[1] - T[0];
  const Vector3d v = T[2] - T[0];
  const Vector3d n = u.cross(v);
  const double nn = n.dot(n);
  const Vector3d r = p - T[0];
  const double b = r.cross(v).dot(n);
  const double c = u.cross(r).dot(n);
  if (!(nn > 0.0 && b > 0.0 && c > 0.0 && b + c < nn)) {
    return std::nullopt;
  }
  return T[0] + (b / nn) * u + (c / nn) * v;
}

/// Where edge i of A pierces B.
std::optional<Vector3d> piercing_point(const Triangle& A, int i, const Triangle& B) {
  const Vector3d& p = A[i];
  const Vector3d& q = A[(i + 1) % 3];
  const Vector3d n = (B[1] - B[0]).cross(B[2] - B[0]);
  const double above = n.dot(p - B[0]);
  const double below = n.dot(q - B[0]);
  if ((above > 0.0) == (below > 0.0) || above == below) {
    return std::nullopt;
  }
  const double s = above / (above - below);
  return foot_inside(p + s * (q - p), B);
}

ClosestFeatures swapped(ClosestFeatures c) {
  std::swap(c.p_A, c.p_B);
  std::swap(c.feature_A, c.feature_B);
  return c;
}

/// Calls use(pair) for each of the at most 21 elementary pairs.
template <class Use>
void for_each_pair(const Triangle& A, const Triangle& B, const Use& use) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      use(edge_edge(A, i, B, j));
    }
  }
  const auto corners_and_edges = [&use](const Triangle& S, const Triangle& T, const auto& order) {
    for (int i = 0; i < 3; ++i) {
      if (const auto foot = foot_inside(S[i], T)) {
        use(order({(*foot - S[i]).norm(), S[i], *foot, {Type::vertex, i}, {Type::face, 0}}));
      }
      if (const auto point = piercing_point(S, i, T)) {
        use(order({0.0, *point, *point, {Type::edge, i}, {Type::face, 0}}));
      }
    }
  };
  corners_and_edges(A, B, [](const ClosestFeatures& c) { return c; });
  corners_and_edges(B, A, swapped);
}

}  // namespace

ClosestFeatures triangle_distance(const Triangle& A, const Triangle& B) {
  ClosestFeatures best;
  best.distance = std::numeric_limits<double>::infinity();
  for_each_pair(A, B, [&best](const ClosestFeatures& c) {
    if (c.distance < best.distance) {
      best = c;
    }
  });
  return best;
}

FeaturePairs feature_pairs_within(const Triangle& A, const Triangle& B, double band) {
  FeaturePairs within;
  for_each_pair(A, B, [&](const ClosestFeatures& c) {
    if (c.distance <= band) {
      within.pairs[within.count++] = c;
    }
  });
  return within;
}

}  // namespace firstcontact
