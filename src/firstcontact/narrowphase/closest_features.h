/// @file
/// The closest points of two features of triangles, from where on the features they are.

#pragma once

#include <cstddef>
#include <optional>
#include <utility>

#include <Eigen/Core>

#include <firstcontact/narrowphase/triangle_distance.h>

namespace firstcontact {

/// The place of a corner over a face T: its foot is T[0] + u (T[1] - T[0]) + v (T[2] - T[0]).
struct CornerFoot {
  double u = 0.0;       ///< [-]
  double v = 0.0;       ///< [-]
  double height = 0.0;  ///< Height over the plane of T, in any unit.
};

/// The feature of a triangle in whose interior the point of an edge at s in [0, 1] lies.
inline TriangleFeature edge_or_end(int edge, double s) {
  using Type = TriangleFeature::Type;
  if (s == 0.0) {
    return {Type::vertex, edge};
  }
  return s == 1.0 ? TriangleFeature{Type::vertex, (edge + 1) % 3}
                  : TriangleFeature{Type::edge, edge};
}

/// The point of an edge at s, exact at its ends.
inline Eigen::Vector3d point_on_edge(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                     double s) {
  return s == 1.0 ? to : Eigen::Vector3d(from + s * (to - from));
}

inline Eigen::Vector3d point_on_face(const Triangle& T, double u, double v) {
  return T[0] + u * (T[1] - T[0]) + v * (T[2] - T[0]);
}

/// The closest features with the roles of A and B exchanged, or as they are.
inline ClosestFeatures exchanged_if(bool swapped, ClosestFeatures c) {
  if (swapped) {
    std::swap(c.p_A, c.p_B);
    std::swap(c.feature_A, c.feature_B);
  }
  return c;
}

/// The closest features of corner k of S and the face of T, inside which the corner's foot is.
///
/// @param swapped  S belongs to B
inline ClosestFeatures corner_over_face(const Triangle& S, int k, const Triangle& T,
                                        const CornerFoot& foot, bool swapped) {
  using Type = TriangleFeature::Type;
  const auto corner = static_cast<std::size_t>(k);
  const Eigen::Vector3d p = point_on_face(T, foot.u, foot.v);
  return exchanged_if(swapped,
                      {(p - S[corner]).norm(), S[corner], p, {Type::vertex, k}, {Type::face, 0}});
}

/// [m]  An upper bound of the greatest coordinate.
inline double greatest_coordinate(const Triangle& T) {
  return (T[0].cwiseAbs() + T[1].cwiseAbs() + T[2].cwiseAbs()).maxCoeff();
}

/// The point where edge k of S, between two heights over T's plane, pierces T.
///
/// Where T is a needle, rounding may have put the point on T elsewhere. Then the distance of the
/// two points is returned.
///
/// @param begin,end  feet of the edge's ends
/// @param swapped    S belongs to B
inline std::optional<ClosestFeatures> edge_through_face(const Triangle& S, int k, const Triangle& T,
                                                        const CornerFoot& begin,
                                                        const CornerFoot& end, bool swapped) {
  using Type = TriangleFeature::Type;
  constexpr double kRounding = 0x1p-40;  // [-]  Relative to the size, with room.
  if ((begin.height > 0.0) == (end.height > 0.0) || begin.height == end.height) {
    return std::nullopt;
  }
  const double part = begin.height / (begin.height - end.height);
  const double u = begin.u + part * (end.u - begin.u);
  const double v = begin.v + part * (end.v - begin.v);
  if (!(u > 0.0 && v > 0.0 && u + v < 1.0)) {
    return std::nullopt;
  }
  const auto corner = static_cast<std::size_t>(k);
  const Eigen::Vector3d on_S = point_on_edge(S[corner], S[(corner + 1) % 3], part);
  const Eigen::Vector3d on_T = point_on_face(T, u, v);
  const double apart = (on_T - on_S).norm();
  const bool pierces = apart <= kRounding * (greatest_coordinate(S) + greatest_coordinate(T));
  return exchanged_if(
      swapped,
      {pierces ? 0.0 : apart, pierces ? on_T : on_S, on_T, edge_or_end(k, part), {Type::face, 0}});
}

}  // namespace firstcontact
