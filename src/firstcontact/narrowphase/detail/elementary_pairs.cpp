#include <firstcontact/narrowphase/detail/elementary_pairs.h>

#include <bit>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "firstcontact/narrowphase/detail/elementary_pairs.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <firstcontact/narrowphase/detail/corner_lanes.h>

HWY_BEFORE_NAMESPACE();
namespace firstcontact::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kStride = ElementaryPairs::kStride;
static_assert(kStride == kCornerLanes);
constexpr double kTiny = 0x1p-1000;
constexpr std::int64_t kPlaceBits = 31;

using D = hn::CappedTag<double, kStride>;
using V = hn::Vec<D>;

/// A triangle: of corner k, or of the edge that begins there, at [k]; the last repeats the third.
struct Prepared {
  alignas(32) double corner[3][kStride];
  double edge[3][kStride];
  double square[kStride];
  double inverse_square[kStride];  // 0 of an edge without length.
  // A point r from the first corner has its foot at u = r . across[0], v = r . across[1].
  double normal[3];
  double across[2][3];
};

HWY_INLINE V unit_interval(V x) {
  const D d;
  return hn::Min(hn::Max(x, hn::Zero(d)), hn::Set(d, 1.0));
}

HWY_INLINE V dot(const V* x, const V* y) {
  return hn::MulAdd(x[0], y[0], hn::MulAdd(x[1], y[1], hn::Mul(x[2], y[2])));
}

HWY_INLINE void load(const double (*from)[kStride], std::size_t first, V* v) {
  for (int k = 0; k < 3; ++k) {
    v[k] = hn::Load(D(), from[k] + first);
  }
}

HWY_INLINE void broadcast(const double (*from)[kStride], std::size_t lane, V* v) {
  for (int k = 0; k < 3; ++k) {
    v[k] = hn::Set(D(), from[k][lane]);
  }
}

HWY_INLINE void broadcast(const double* from, V* v) {
  for (int k = 0; k < 3; ++k) {
    v[k] = hn::Set(D(), from[k]);
  }
}

HWY_INLINE void cross(const double* x, const double* y, double scale, double* product) {
  product[0] = (x[1] * y[2] - x[2] * y[1]) * scale;
  product[1] = (x[2] * y[0] - x[0] * y[2]) * scale;
  product[2] = (x[0] * y[1] - x[1] * y[0]) * scale;
}

HWY_INLINE void prepare_face(Prepared& T) {
  const double u[3] = {T.edge[0][0], T.edge[1][0], T.edge[2][0]};
  const double v[3] = {-T.edge[0][2], -T.edge[1][2], -T.edge[2][2]};
  double* n = T.normal;
  cross(u, v, 1.0, n);
  const double square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
  const double inverse = square > 0.0 ? 1.0 / square : 0.0;
  cross(v, n, inverse, T.across[0]);
  cross(n, u, inverse, T.across[1]);
}

HWY_INLINE void prepare(const Triangle& triangle, Prepared& T) {
  const D d;
  for (std::size_t first = 0; first < kStride; first += hn::Lanes(d)) {
    V edge[3];
    for (int k = 0; k < 3; ++k) {
      const V corner = corner_lanes(d, triangle, k, first, false);
      edge[k] = hn::Sub(corner_lanes(d, triangle, k, first, true), corner);
      hn::Store(corner, d, T.corner[k] + first);
      hn::Store(edge[k], d, T.edge[k] + first);
    }
    const V square = dot(edge, edge);
    hn::Store(square, d, T.square + first);
    hn::Store(hn::IfThenElseZero(hn::Gt(square, hn::Zero(d)), hn::Div(hn::Set(d, 1.0), square)), d,
              T.inverse_square + first);
  }
  prepare_face(T);
}

/// Edge i of A against edges of B, from a lane on. One parameter comes from the normal equations,
/// then each is made the best for the other, which also mends what near-parallel edges lose.
HWY_INLINE V edge_against_edges(const Prepared& A, std::size_t i, const Prepared& B,
                                std::size_t first, ElementaryPairs::Edges& edges) {
  const D d;
  V a[3];
  V u[3];
  V v[3];
  V r[3];
  broadcast(A.corner, i, a);
  broadcast(A.edge, i, u);
  load(B.edge, first, v);
  load(B.corner, first, r);
  for (int k = 0; k < 3; ++k) {
    r[k] = hn::Sub(r[k], a[k]);
  }
  const V vv = hn::Load(d, B.square + first);
  const V uv = dot(u, v);
  const V ur = dot(u, r);
  const V vr = dot(v, r);
  const V determinant = hn::NegMulAdd(uv, uv, hn::Mul(hn::Set(d, A.square[i]), vv));
  const V crossing = hn::Div(hn::NegMulAdd(vr, uv, hn::Mul(ur, vv)), determinant);
  // Parallel edges begin with s = 0.
  const V tiny = hn::Set(d, kTiny);
  V s = hn::IfThenElseZero(hn::Gt(determinant, tiny), unit_interval(crossing));
  const V t =
      unit_interval(hn::Mul(hn::Sub(hn::Mul(s, uv), vr), hn::Load(d, B.inverse_square + first)));
  s = unit_interval(hn::Mul(hn::MulAdd(t, uv, ur), hn::Set(d, A.inverse_square[i])));
  for (int k = 0; k < 3; ++k) {
    r[k] = hn::NegMulAdd(s, u[k], hn::MulAdd(t, v[k], r[k]));
  }
  const V square = dot(r, r);
  const std::size_t at = kStride * i + first;
  hn::Store(square, d, edges.square.data() + at);
  hn::Store(s, d, edges.s.data() + at);
  hn::Store(t, d, edges.t.data() + at);
  return square;
}

HWY_INLINE V corners_over_face(const Prepared& S, const Prepared& T, std::size_t first,
                               ElementaryPairs::Corners& corners) {
  const D d;
  V origin[3];
  V n[3];
  V across_u[3];
  V across_v[3];
  V along_u[3];
  V along_v[3];
  V r[3];
  broadcast(T.corner, 0, origin);
  broadcast(T.normal, n);
  broadcast(T.across[0], across_u);
  broadcast(T.across[1], across_v);
  broadcast(T.edge, 0, along_u);
  broadcast(T.edge, 2, along_v);  // From the third corner to the first.
  load(S.corner, first, r);
  for (int k = 0; k < 3; ++k) {
    r[k] = hn::Sub(r[k], origin[k]);
  }
  const V zero = hn::Zero(d);
  const V height = dot(n, r);
  const V u = dot(across_u, r);
  const V v = dot(across_v, r);
  const auto inside =
      hn::And(hn::And(hn::Gt(u, zero), hn::Gt(v, zero)), hn::Lt(hn::Add(u, v), hn::Set(d, 1.0)));
  for (int k = 0; k < 3; ++k) {
    r[k] = hn::MulAdd(v, along_v[k], hn::NegMulAdd(u, along_u[k], r[k]));
  }
  const V square = hn::IfThenElse(inside, dot(r, r), hn::Set(d, ElementaryPairs::kNone));
  hn::Store(square, d, corners.square.data() + first);
  hn::Store(u, d, corners.u.data() + first);
  hn::Store(v, d, corners.v.data() + first);
  hn::Store(height, d, corners.height.data() + first);
  return square;
}

/// Squares with their place in the last bits: of the least, the place is known. Neither infinity
/// nor what flushes to zero could hold it.
HWY_INLINE V with_place(V square, std::size_t place) {
  const D d;
  square = hn::Min(hn::Max(square, hn::Set(d, kTiny)), hn::Set(d, ElementaryPairs::kNone));
  const hn::RebindToSigned<D> di;
  return hn::BitCast(d, hn::Or(hn::AndNot(hn::Set(di, kPlaceBits), hn::BitCast(di, square)),
                               hn::Iota(di, static_cast<std::int64_t>(place))));
}

void FindElementaryPairs(const Triangle& triangle_A, const Triangle& triangle_B,
                         ElementaryPairs& pairs) {
  const D d;
  Prepared A;
  Prepared B;
  prepare(triangle_A, A);
  prepare(triangle_B, B);
  V least = hn::Set(d, ElementaryPairs::kNone);
  for (std::size_t first = 0; first < kStride; first += hn::Lanes(d)) {
    for (std::size_t i = 0; i < 3; ++i) {
      const V square = edge_against_edges(A, i, B, first, pairs.edges);
      least = hn::Min(least, with_place(square, kStride * i + first));
    }
    const V of_A = corners_over_face(A, B, first, pairs.corners[0]);
    const V of_B = corners_over_face(B, A, first, pairs.corners[1]);
    least = hn::Min(least, hn::Min(with_place(of_A, 3 * kStride + first),
                                   with_place(of_B, 4 * kStride + first)));
  }
  const double least_of_all = hn::GetLane(hn::MinOfLanes(d, least));
  pairs.nearest = static_cast<int>(std::bit_cast<std::int64_t>(least_of_all) & kPlaceBits);
}

}  // namespace firstcontact::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace firstcontact::detail {

HWY_EXPORT(FindElementaryPairs);

void find_elementary_pairs(const Triangle& A, const Triangle& B, ElementaryPairs& pairs) {
  HWY_DYNAMIC_DISPATCH(FindElementaryPairs)(A, B, pairs);
}

}  // namespace firstcontact::detail
#endif
