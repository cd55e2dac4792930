#include <firstcontact/narrowphase/feature_batches.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "firstcontact/narrowphase/feature_batches.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <firstcontact/narrowphase/detail/feature_lanes.h>

HWY_BEFORE_NAMESPACE();
namespace firstcontact::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;
static_assert(FeatureLanes::kCapacity % 8 == 0);

HWY_INLINE V load(const FeatureLanes& lanes, std::size_t first) {
  return hn::Load(D(), lanes.at.data() + first);
}

HWY_INLINE void load(const std::array<FeatureLanes, 3>& from, std::size_t first, V* v) {
  for (std::size_t k = 0; k < 3; ++k) {
    v[k] = load(from[k], first);
  }
}

HWY_INLINE void broadcast(const std::array<FeatureLanes, 3>& from, std::size_t lane, V* v) {
  for (std::size_t k = 0; k < 3; ++k) {
    v[k] = hn::Set(D(), from[k][lane]);
  }
}

HWY_INLINE void store(V v, std::size_t first, FeatureLanes& lanes) {
  hn::Store(v, D(), lanes.at.data() + first);
}

HWY_INLINE std::uint64_t bits(hn::Mask<D> mask, std::size_t first) {
  std::uint8_t lanes[8] = {};  // Highway writes eight bytes.
  hn::StoreMaskBits(D(), mask, lanes);
  return static_cast<std::uint64_t>(lanes[0]) << first;
}

/// The bits of the first `count` lanes.
HWY_INLINE std::uint64_t all_of(std::size_t count) { return (std::uint64_t{1} << count) - 1; }

void PrepareEdges(EdgeBatch& edges) {
  const D d;
  for (std::size_t first = 0; first < edges.count(); first += hn::Lanes(d)) {
    V along[3];
    for (std::size_t k = 0; k < 3; ++k) {
      along[k] = hn::Sub(load(edges.to.corner[k], first), load(edges.from.corner[k], first));
      store(along[k], first, edges.along[k]);
    }
    const V square = dot_lanes(along, along);
    store(square, first, edges.square);
    store(inverse_of_square(d, square), first, edges.inverse_square);
  }
}

/// The distances, with each operation rounded by itself and in the order of Eigen.
///
/// So lanes have the bits of single computations.
HWY_INLINE V distance_of(const EdgeBatch& A, std::size_t i, const EdgeLanes<D>& a,
                         const EdgeBatch& B, std::size_t first, const EdgeLanes<D>& b,
                         const ClosestOnEdges<D>& closest) {
  const V one = hn::Set(D(), 1.0);
  V square[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const V on_A = hn::IfThenElse(hn::Eq(closest.s, one), hn::Set(D(), A.to.corner[k][i]),
                                  hn::Add(a.corner[k], hn::Mul(closest.s, a.along[k])));
    const V on_B = hn::IfThenElse(hn::Eq(closest.t, one), load(B.to.corner[k], first),
                                  hn::Add(b.corner[k], hn::Mul(closest.t, b.along[k])));
    const V between = hn::Sub(on_B, on_A);
    square[k] = hn::Mul(between, between);
  }
  return hn::Sqrt(hn::Add(hn::Add(square[0], square[1]), square[2]));
}

/// [m^2]  Squares of distances up to this are looked at more closely; beyond the band by more than
/// their errors.
HWY_INLINE double square_of_reach(double band, double size) {
  const double reach = band + 0x1p-43 * size;
  return reach * reach;
}

void FindEdgeDistances(const EdgeBatch& A, std::size_t i, const EdgeBatch& B, double band,
                       double size, EdgeDistances& distances) {
  const D d;
  const V reach2 = hn::Set(d, square_of_reach(band, size));
  EdgeLanes<D> a;
  broadcast(A.from.corner, i, a.corner);
  broadcast(A.along, i, a.along);
  a.square = hn::Set(d, A.square[i]);
  a.inverse_square = hn::Set(d, A.inverse_square[i]);
  distances.within = 0;
  for (std::size_t first = 0; first < B.count(); first += hn::Lanes(d)) {
    EdgeLanes<D> b;
    load(B.from.corner, first, b.corner);
    load(B.along, first, b.along);
    b.square = load(B.square, first);
    b.inverse_square = load(B.inverse_square, first);
    const ClosestOnEdges<D> closest = closest_on_edges(d, a, b);
    const auto near = hn::Le(closest.square, reach2);
    if (hn::AllFalse(d, near)) {
      continue;
    }
    const V distance = distance_of(A, i, a, B, first, b, closest);
    store(closest.s, first, distances.s);
    store(closest.t, first, distances.t);
    store(distance, first, distances.distance);
    distances.within |=
        bits(hn::And(near, hn::Le(distance, hn::Set(d, band))), first) & all_of(B.count());
  }
}

static_assert(FaceBatch::kCapacity % 8 == 0);

/// The vector product, with each operation rounded by itself as in a single computation.
HWY_INLINE void cross_lanes(const V* x, const V* y, V* product) {
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3;
    const int j = (k + 2) % 3;
    product[k] = hn::Sub(hn::Mul(x[i], y[j]), hn::Mul(x[j], y[i]));
  }
}

HWY_INLINE void store(const V* v, V scale, std::size_t first, std::array<FeatureLanes, 3>& to) {
  for (std::size_t k = 0; k < 3; ++k) {
    store(hn::Mul(v[k], scale), first, to[k]);
  }
}

/// Prepares faces lane by lane, as find_face_ways() does.
void PrepareFaces(FaceBatch& faces) {
  const D d;
  const V one = hn::Set(d, 1.0);
  for (std::size_t first = 0; first < faces.count(); first += hn::Lanes(d)) {
    V u[3];
    V v[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const V origin = load(faces.corner[0].corner[k], first);
      u[k] = hn::Sub(load(faces.corner[1].corner[k], first), origin);
      v[k] = hn::Sub(load(faces.corner[2].corner[k], first), origin);
    }
    V n[3];
    cross_lanes(u, v, n);
    store(n, one, first, faces.normal);
    const V square =
        hn::Add(hn::Add(hn::Mul(n[0], n[0]), hn::Mul(n[1], n[1])), hn::Mul(n[2], n[2]));
    const V inverse = inverse_of_square(d, square);
    V across[3];
    cross_lanes(v, n, across);
    store(across, inverse, first, faces.across[0]);
    cross_lanes(n, u, across);
    store(across, inverse, first, faces.across[1]);
  }
}

HWY_INLINE void load(const FaceBatch& faces, std::size_t first, FaceLanes<D>& lanes) {
  load(faces.corner[0].corner, first, lanes.origin);
  load(faces.normal, first, lanes.normal);
  load(faces.across[0], first, lanes.across[0]);
  load(faces.across[1], first, lanes.across[1]);
  for (std::size_t k = 0; k < 3; ++k) {
    lanes.first_edge[k] = hn::Sub(load(faces.corner[1].corner[k], first), lanes.origin[k]);
    lanes.last_edge[k] = hn::Sub(lanes.origin[k], load(faces.corner[2].corner[k], first));
  }
}

void FindCornerFeet(const CornerBatch& corners, const FaceBatch& faces, double band, double size,
                    CornerFeet* feet) {
  const D d;
  const V reach2 = hn::Set(d, square_of_reach(band, size));
  for (std::size_t c = 0; c < corners.count; ++c) {
    feet[c].above = 0;
    feet[c].within = 0;
  }
  for (std::size_t first = 0; first < faces.count(); first += hn::Lanes(d)) {
    FaceLanes<D> face;
    load(faces, first, face);
    const std::uint64_t lanes = all_of(faces.count());
    for (std::size_t c = 0; c < corners.count; ++c) {
      V corner[3];
      broadcast(corners.corner, c, corner);
      const FeetOfCorners<D> found = feet_of_corners(d, corner, face);
      const auto is_inside = hn::Lt(found.square, hn::Set(d, kNoSquare));
      hn::Store(found.u, d, feet[c].u.data() + first);
      hn::Store(found.v, d, feet[c].v.data() + first);
      hn::Store(found.height, d, feet[c].height.data() + first);
      feet[c].above |=
          static_cast<std::uint32_t>(bits(hn::Gt(found.height, hn::Zero(d)), first) & lanes);
      feet[c].within |= static_cast<std::uint32_t>(
          bits(hn::And(is_inside, hn::Le(found.square, reach2)), first) & lanes);
    }
  }
}

}  // namespace firstcontact::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace firstcontact {
namespace detail {

HWY_EXPORT(PrepareEdges);
HWY_EXPORT(FindEdgeDistances);
HWY_EXPORT(PrepareFaces);
HWY_EXPORT(FindCornerFeet);

}  // namespace detail

void prepare(EdgeBatch& edges) {
  using namespace detail;  // NOLINT: the table of functions is looked up here.
  HWY_DYNAMIC_DISPATCH(PrepareEdges)(edges);
}

void edge_distances(const EdgeBatch& A, std::size_t edge, const EdgeBatch& B, double band,
                    double size, EdgeDistances& distances) {
  using namespace detail;  // NOLINT
  HWY_DYNAMIC_DISPATCH(FindEdgeDistances)(A, edge, B, band, size, distances);
}

void prepare(FaceBatch& faces) {
  using namespace detail;  // NOLINT
  HWY_DYNAMIC_DISPATCH(PrepareFaces)(faces);
}

void corner_feet(const CornerBatch& corners, const FaceBatch& faces, double band, double size,
                 std::array<CornerFeet, FeatureLanes::kCapacity>& feet) {
  using namespace detail;  // NOLINT
  HWY_DYNAMIC_DISPATCH(FindCornerFeet)(corners, faces, band, size, feet.data());
}

}  // namespace firstcontact
#endif
