#include <firstcontact/separation/detail/closest_on_triangles.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>

#include <Eigen/Geometry>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

double clamped(double numerator, double denominator) {
  return denominator > 0.0 ? std::clamp(numerator / denominator, 0.0, 1.0) : 0.0;
}

PointPair pair_of(const Vector3d& a, const Vector3d& b) { return {a, b, (b - a).norm()}; }

/// The closest points of two segments: those of the lines, each put back into its segment.
PointPair closest(const Vector3d& a, const Vector3d& a_to, const Vector3d& b,
                  const Vector3d& b_to) {
  const Vector3d u = a_to - a;
  const Vector3d v = b_to - b;
  const Vector3d w = b - a;
  const double uu = u.squaredNorm();
  const double vv = v.squaredNorm();
  const double uv = u.dot(v);
  double s = clamped(u.dot(w) * vv - v.dot(w) * uv, uu * vv - uv * uv);
  const double t = clamped(s * uv - v.dot(w), vv);
  s = clamped(t * uv + u.dot(w), uu);
  return pair_of(a + s * u, b + t * v);
}

/// The parameter of a line through p along u at the plane of a triangle, if it meets the inside.
std::optional<double> meets(const Vector3d& p, const Vector3d& u, const TrianglePoints& t,
                            const Vector3d& normal) {
  const double s = normal.dot(t[0] - p) / normal.dot(u);
  const Vector3d q = p + s * u;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d& from = t[k];
    // Negated, so that the NaN of a degenerate triangle is no meeting.
    if (!(normal.dot((t[(k + 1) % 3] - from).cross(q - from)) >= 0.0)) {
      return std::nullopt;
    }
  }
  return s;
}

Vector3d normal_of(const TrianglePoints& t) { return (t[1] - t[0]).cross(t[2] - t[0]); }

/// Keeps the closer one of the offered pairs.
class Closest {
 public:
  void offer(const PointPair& pair) {
    if (pair.distance < best_.distance) {
      best_ = pair;
    }
  }

  void offer_swapped(const PointPair& pair) { offer({pair.on_B, pair.on_A, pair.distance}); }

  [[nodiscard]] const PointPair& best() const { return best_; }

 private:
  PointPair best_{.distance = std::numeric_limits<double>::infinity()};
};

/// Offers the corners of A over the face of B, and the edges of A through it; as (A, B).
template <class Offer>
void offer_face(const TrianglePoints& A, const TrianglePoints& B, const Offer& offer) {
  const Vector3d normal = normal_of(B);
  for (std::size_t k = 0; k < 3; ++k) {
    if (const auto s = meets(A[k], normal, B, normal)) {
      offer(pair_of(A[k], A[k] + *s * normal));
    }
    const Vector3d edge = A[(k + 1) % 3] - A[k];
    const auto s = meets(A[k], edge, B, normal);
    if (s && *s >= 0.0 && *s <= 1.0) {
      const Vector3d through = A[k] + *s * edge;
      offer(pair_of(through, through));
    }
  }
}

/// The foot of p in the plane, by two weights that are clamped to the triangle.
Vector3d foot_in(const TrianglePoints& t, const Vector3d& p) {
  const Vector3d u = t[1] - t[0];
  const Vector3d v = t[2] - t[0];
  const Vector3d w = p - t[0];
  const double determinant = u.squaredNorm() * v.squaredNorm() - u.dot(v) * u.dot(v);
  const double a = clamped(u.dot(w) * v.squaredNorm() - v.dot(w) * u.dot(v), determinant);
  const double b = clamped(v.dot(w) * u.squaredNorm() - u.dot(w) * u.dot(v), determinant);
  const double sum = std::max(1.0, a + b);
  return t[0] + (a / sum) * u + (b / sum) * v;
}

}  // namespace

Vector3d point_on_triangle(const TrianglePoints& triangle, const Vector3d& p) {
  Vector3d best = foot_in(triangle, p);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d& from = triangle[k];
    const Vector3d edge = triangle[(k + 1) % 3] - from;
    const Vector3d foot = from + clamped(edge.dot(p - from), edge.squaredNorm()) * edge;
    if (!((best - p).squaredNorm() <= (foot - p).squaredNorm())) {
      best = foot;
    }
  }
  return best;
}

PointPair closest_estimate(const TrianglePoints& A, const TrianglePoints& B) {
  Closest found;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      found.offer(closest(A[i], A[(i + 1) % 3], B[j], B[(j + 1) % 3]));
    }
  }
  offer_face(A, B, [&](const PointPair& pair) { found.offer(pair); });
  offer_face(B, A, [&](const PointPair& pair) { found.offer_swapped(pair); });
  return found.best();
}

}  // namespace firstcontact::detail
