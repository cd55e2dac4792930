/// @file
/// Closest points of two triangles by brute force, in any arithmetic: an estimate for the oracle.

#pragma once

#include <array>
#include <cstddef>

#include "support/vector3.h"

namespace firstcontact::oracle {

template <class T>
using Triangle = std::array<Vector3<T>, 3>;

/// Barycentric weights of the closest points, and directions that may separate the triangles.
template <class T>
struct ClosestPoints {
  T distance2 = T(-1);  ///< [m^2]  Squared distance; 0 where the triangles meet.
  std::array<T, 3> weights_A{};
  std::array<T, 3> weights_B{};
  Vector3<T> difference;  ///< Vector from A's point to B's.
  Vector3<T> normal;  ///< Normal of the features: face normal or product of the edges; may be zero.
};

namespace detail {

template <class T>
T clamped(T s) {
  return s < T(0) ? T(0) : (s > T(1) ? T(1) : s);
}

template <class T>
class ClosestPointsSearch {
 public:
  ClosestPointsSearch(const Triangle<T>& A, const Triangle<T>& B) : A_(A), B_(B) {}

  ClosestPoints<T> run() {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        edges(i, j);
      }
      vertex_and_face(i, A_, B_, false);
      vertex_and_face(i, B_, A_, true);
      piercing(i, A_, B_, false);
      piercing(i, B_, A_, true);
    }
    return best_;
  }

 private:
  using Weights = std::array<T, 3>;

  void offer(const Weights& a, const Weights& b, const Vector3<T>& normal) {
    const Vector3<T> difference = (b[0] * B_[0] + b[1] * (B_[1]) + b[2] * B_[2]) -
                                  (a[0] * A_[0] + a[1] * (A_[1]) + a[2] * A_[2]);
    offer(a, b, normal, difference, dot(difference, difference));
  }

  void offer(const Weights& a, const Weights& b, const Vector3<T>& normal,
             const Vector3<T>& difference, T distance2) {
    if (best_.distance2 < T(0) || distance2 < best_.distance2) {
      best_ = {distance2, a, b, difference, normal};
    }
  }

  static Weights on_edge(std::size_t k, T s) {
    Weights w{};
    w[k] = T(1) - s;
    w[(k + 1) % 3] = s;
    return w;
  }

  void edges(std::size_t i, std::size_t j) {
    const Vector3<T>& a = A_[i];
    const Vector3<T>& b = B_[j];
    const Vector3<T> u = A_[(i + 1) % 3] - a;
    const Vector3<T> v = B_[(j + 1) % 3] - b;
    const Vector3<T> r = a - b;
    const T uu = dot(u, u);
    const T vv = dot(v, v);
    const T uv = dot(u, v);
    const T ur = dot(u, r);
    const T vr = dot(v, r);
    const T determinant = uu * vv - uv * uv;
    T s = determinant > T(0) ? clamped<T>((uv * vr - ur * vv) / determinant) : T(0);
    const T t = vv > T(0) ? clamped<T>((uv * s + vr) / vv) : T(0);
    s = uu > T(0) ? clamped<T>((uv * t - ur) / uu) : T(0);
    offer(on_edge(i, s), on_edge(j, t), cross(u, v));
  }

  /// Computes the weights of the foot of P in the plane of the triangle; false where it lies
  /// outside.
  static bool foot_weights(const Vector3<T>& P, const Triangle<T>& face, const Vector3<T>& n,
                           Weights& w) {
    const T nn = dot(n, n);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3<T>& from = face[(k + 1) % 3];
      w[k] = dot(n, cross(face[(k + 2) % 3] - from, P - from)) / nn;
      if (!(w[k] >= T(0))) {
        return false;
      }
    }
    return true;
  }

  void vertex_and_face(std::size_t i, const Triangle<T>& corners, const Triangle<T>& face,
                       bool swapped) {
    const Vector3<T> n = cross(face[1] - face[0], face[2] - face[0]);
    Weights foot;
    if (!(dot(n, n) > T(0)) || !foot_weights(corners[i], face, n, foot)) {
      return;
    }
    Weights corner{};
    corner[i] = T(1);
    const T height = dot(n, corners[i] - face[0]) / dot(n, n);
    const Vector3<T> difference = (swapped ? height : -height) * n;
    offer(swapped ? foot : corner, swapped ? corner : foot, n, difference,
          dot(difference, difference));
  }

  void piercing(std::size_t i, const Triangle<T>& edges, const Triangle<T>& face, bool swapped) {
    const Vector3<T> n = cross(face[1] - face[0], face[2] - face[0]);
    const std::size_t end = (i + 1) % 3;
    const T from = dot(n, edges[i] - face[0]);
    const T to = dot(n, edges[end] - face[0]);
    if (!((from < T(0) && to > T(0)) || (from > T(0) && to < T(0)))) {
      return;
    }
    const T s = from / (from - to);
    const Vector3<T> P = edges[i] + s * (edges[end] - edges[i]);
    Weights w;
    if (foot_weights(P, face, n, w)) {
      const Weights edge = on_edge(i, s);
      offer(swapped ? w : edge, swapped ? edge : w, n, {}, T(0));
    }
  }

  const Triangle<T>& A_;
  const Triangle<T>& B_;
  ClosestPoints<T> best_;
};

}  // namespace detail

template <class T>
ClosestPoints<T> closest_points(const Triangle<T>& A, const Triangle<T>& B) {
  return detail::ClosestPointsSearch<T>(A, B).run();
}

}  // namespace firstcontact::oracle
