/// @file
/// Distances of edges, and of corners from faces, side by side in vectors.
///
/// Included once for each instruction set.

#if defined(FIRSTCONTACT_NARROWPHASE_DETAIL_FEATURE_LANES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRSTCONTACT_NARROWPHASE_DETAIL_FEATURE_LANES_H
#undef FIRSTCONTACT_NARROWPHASE_DETAIL_FEATURE_LANES_H
#else
#define FIRSTCONTACT_NARROWPHASE_DETAIL_FEATURE_LANES_H
#endif

#include <limits>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace firstcontact::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The square of the distance of a corner that is over no face.
inline constexpr double kNoSquare = std::numeric_limits<double>::max();

template <class V>
HWY_INLINE V dot_lanes(const V* x, const V* y) {
  return hn::MulAdd(x[0], y[0], hn::MulAdd(x[1], y[1], hn::Mul(x[2], y[2])));
}

template <class D>
HWY_INLINE hn::Vec<D> unit_interval(D d, hn::Vec<D> x) {
  return hn::Min(hn::Max(x, hn::Zero(d)), hn::Set(d, 1.0));
}

/// The reciprocal of a squared length; 0 for an edge without length.
template <class D>
HWY_INLINE hn::Vec<D> inverse_of_square(D d, hn::Vec<D> square) {
  return hn::IfThenElseZero(hn::Gt(square, hn::Zero(d)), hn::Div(hn::Set(d, 1.0), square));
}

/// Edges: their first ends, the vectors along them, and the squares of their lengths.
template <class D>
struct EdgeLanes {
  hn::Vec<D> corner[3];
  hn::Vec<D> along[3];
  hn::Vec<D> square;
  hn::Vec<D> inverse_square;
};

template <class D>
struct ClosestOnEdges {
  hn::Vec<D> square;  // Square of the distance.
  hn::Vec<D> s;       // Place on A's edge, in [0, 1].
  hn::Vec<D> t;       // Place on B's edge, in [0, 1].
};

/// Finds the closest points of edges of A and edges of B.
///
/// One parameter comes from the normal equations. Then each parameter is made the best for the
/// other. That also recovers the accuracy that near-parallel edges lose.
template <class D>
HWY_INLINE ClosestOnEdges<D> closest_on_edges(D d, const EdgeLanes<D>& A, const EdgeLanes<D>& B) {
  using V = hn::Vec<D>;
  constexpr double kTiny = 0x1p-1000;
  const V* u = A.along;
  const V* v = B.along;
  V r[3];
  for (int k = 0; k < 3; ++k) {
    r[k] = hn::Sub(B.corner[k], A.corner[k]);
  }
  const V uv = dot_lanes(u, v);
  const V ur = dot_lanes(u, r);
  const V vr = dot_lanes(v, r);
  const V determinant = hn::NegMulAdd(uv, uv, hn::Mul(A.square, B.square));
  const V crossing = hn::Div(hn::NegMulAdd(vr, uv, hn::Mul(ur, B.square)), determinant);
  // Parallel edges begin with s = 0.
  V s = hn::IfThenElseZero(hn::Gt(determinant, hn::Set(d, kTiny)), unit_interval(d, crossing));
  const V t = unit_interval(d, hn::Mul(hn::Sub(hn::Mul(s, uv), vr), B.inverse_square));
  s = unit_interval(d, hn::Mul(hn::MulAdd(t, uv, ur), A.inverse_square));
  for (int k = 0; k < 3; ++k) {
    r[k] = hn::NegMulAdd(s, u[k], hn::MulAdd(t, v[k], r[k]));
  }
  return {dot_lanes(r, r), s, t};
}

/// Faces: a point r from the first corner has its foot at u = r . across[0], v = r . across[1].
template <class D>
struct FaceLanes {
  hn::Vec<D> origin[3];
  hn::Vec<D> normal[3];
  hn::Vec<D> across[2][3];
  hn::Vec<D> first_edge[3];
  hn::Vec<D> last_edge[3];  // From the third corner to the first.
};

template <class D>
struct FeetOfCorners {
  hn::Vec<D> square;  // Square of the distance; kNoSquare where the foot is not inside.
  hn::Vec<D> u;
  hn::Vec<D> v;
  hn::Vec<D> height;  // Height over the face's plane, in any unit.
};

template <class D>
HWY_INLINE FeetOfCorners<D> feet_of_corners(D d, const hn::Vec<D>* corner, const FaceLanes<D>& T) {
  using V = hn::Vec<D>;
  V r[3];
  for (int k = 0; k < 3; ++k) {
    r[k] = hn::Sub(corner[k], T.origin[k]);
  }
  const V zero = hn::Zero(d);
  const V height = dot_lanes(T.normal, r);
  const V u = dot_lanes(T.across[0], r);
  const V v = dot_lanes(T.across[1], r);
  const auto inside =
      hn::And(hn::And(hn::Gt(u, zero), hn::Gt(v, zero)), hn::Lt(hn::Add(u, v), hn::Set(d, 1.0)));
  for (int k = 0; k < 3; ++k) {
    r[k] = hn::MulAdd(v, T.last_edge[k], hn::NegMulAdd(u, T.first_edge[k], r[k]));
  }
  return {hn::IfThenElse(inside, dot_lanes(r, r), hn::Set(d, kNoSquare)), u, v, height};
}

HWY_INLINE void cross(const double* x, const double* y, double scale, double* product) {
  product[0] = (x[1] * y[2] - x[2] * y[1]) * scale;
  product[1] = (x[2] * y[0] - x[0] * y[2]) * scale;
  product[2] = (x[0] * y[1] - x[1] * y[0]) * scale;
}

/// The normal of a face, and the vectors across it.
struct FaceWays {
  double normal[3];
  double across[2][3];
};

/// @param u  from the first corner to the second
/// @param v  from the first corner to the third
HWY_INLINE void find_face_ways(const double* u, const double* v, FaceWays& ways) {
  double* n = ways.normal;
  cross(u, v, 1.0, n);
  const double square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
  const double inverse = square > 0.0 ? 1.0 / square : 0.0;
  cross(v, n, inverse, ways.across[0]);
  cross(n, u, inverse, ways.across[1]);
}

}  // namespace firstcontact::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
