#include <firstcontact/narrowphase/detail/elementary_pairs.h>

#include <bit>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "firstcontact/narrowphase/detail/elementary_pairs.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <firstcontact/narrowphase/detail/corner_lanes.h>
#include <firstcontact/narrowphase/detail/feature_lanes.h>

HWY_BEFORE_NAMESPACE();
namespace firstcontact::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kStride = ElementaryPairs::kStride;
static_assert(kStride == kCornerLanes);
static_assert(ElementaryPairs::kNone == kNoSquare);
constexpr double kTiny = 0x1p-1000;
constexpr std::int64_t kPlaceBits = 31;

using D = hn::CappedTag<double, kStride>;
using V = hn::Vec<D>;

/// A triangle: corner k, and the edge that begins there, at [k]; the last repeats the third.
struct Prepared {
  alignas(32) double corner[3][kStride];
  double edge[3][kStride];
  double square[kStride];
  double inverse_square[kStride];  // 0 for an edge without length.
  FaceWays face;
};

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
    const V square = dot_lanes(edge, edge);
    hn::Store(square, d, T.square + first);
    hn::Store(inverse_of_square(d, square), d, T.inverse_square + first);
  }
  const double u[3] = {T.edge[0][0], T.edge[1][0], T.edge[2][0]};
  const double v[3] = {-T.edge[0][2], -T.edge[1][2], -T.edge[2][2]};
  find_face_ways(u, v, T.face);
}

/// Edge i of A against edges of B, from a lane on.
HWY_INLINE V edge_against_edges(const Prepared& A, std::size_t i, const Prepared& B,
                                std::size_t first, ElementaryPairs::Edges& edges) {
  const D d;
  EdgeLanes<D> a;
  EdgeLanes<D> b;
  broadcast(A.corner, i, a.corner);
  broadcast(A.edge, i, a.along);
  a.square = hn::Set(d, A.square[i]);
  a.inverse_square = hn::Set(d, A.inverse_square[i]);
  load(B.corner, first, b.corner);
  load(B.edge, first, b.along);
  b.square = hn::Load(d, B.square + first);
  b.inverse_square = hn::Load(d, B.inverse_square + first);
  const ClosestOnEdges<D> closest = closest_on_edges(d, a, b);
  const std::size_t at = kStride * i + first;
  hn::Store(closest.square, d, edges.square.data() + at);
  hn::Store(closest.s, d, edges.s.data() + at);
  hn::Store(closest.t, d, edges.t.data() + at);
  return closest.square;
}

HWY_INLINE V corners_over_face(const Prepared& S, const Prepared& T, std::size_t first,
                               ElementaryPairs::Corners& corners) {
  const D d;
  FaceLanes<D> face;
  V corner[3];
  broadcast(T.corner, 0, face.origin);
  broadcast(T.face.normal, face.normal);
  broadcast(T.face.across[0], face.across[0]);
  broadcast(T.face.across[1], face.across[1]);
  broadcast(T.edge, 0, face.first_edge);
  broadcast(T.edge, 2, face.last_edge);
  load(S.corner, first, corner);
  const FeetOfCorners<D> feet = feet_of_corners(d, corner, face);
  hn::Store(feet.square, d, corners.square.data() + first);
  hn::Store(feet.u, d, corners.u.data() + first);
  hn::Store(feet.v, d, corners.v.data() + first);
  hn::Store(feet.height, d, corners.height.data() + first);
  return feet.square;
}

/// Squares with their place in the last bits, so that the place of the least is known.
///
/// Neither infinity nor a number that flushes to zero could hold it.
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
