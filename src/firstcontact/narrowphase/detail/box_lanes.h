/// @file
/// Arithmetic on lanes of boxes in single precision, and the slacks that cover its rounding.
/// Included once for each instruction set.

#if defined(FIRSTCONTACT_QUERY_DETAIL_BOX_LANES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRSTCONTACT_QUERY_DETAIL_BOX_LANES_H
#undef FIRSTCONTACT_QUERY_DETAIL_BOX_LANES_H
#else
#define FIRSTCONTACT_QUERY_DETAIL_BOX_LANES_H
#endif

#include <cstddef>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace firstcontact::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Derivation of the slacks, u = 2^-24, lengths of a pair L = |c_A| + |c_B| + r_A + r_B with
// centres c relative to a point beside them (formed in double, then rounded).
//  - Centres: u |c|; their difference u |d|; its dot product with a direction 3 u |d|.
//  - Axes: the scalar part of the quaternion is at least 0.65 and within 3.5 u, entries of the
//    matrix within 8 u; after the body's rotation an axis is within 20 u of its box's.
//  - Directions are what they are, stored; only box extents along them have errors: at most
//    24 u sqrt(3) r for axes and products. The sum stays below 64 u L.
//  - Velocities: cross and dot products add up to 10 u of |s| + w_A rho_A + w_B rho_B, as positions
//    relative to the pivot are formed in double; w (n x u) to 4 u w, and as part of an extent to
//    4 u sqrt(3) w r.
//  - Extents at the horizon, along m = n + H w (n x u): 24 u sqrt(3) r |m|. If two extents are
//    interpolated, each error counts by its share; with |m| <= 1 + H w |n x u| the gap's slack has
//    24 u sqrt(3) r. The other box's axes b see w (n x u) . b_k as (n . b_i) (w . b_j) - (n . b_j)
//    (w . b_i), which is w (n x u) . (b_i x b_j) and thus within 40 u w |n x u|, and 9 u w for
//    rounding. All in all 16 u w r of the speed, and 70 u r w |n x u|, for which is kSwingSlack.
//  - Bodies that deform: boxes are interpolated in double; sums of the rates of centres and
//    extents, each at most 2 D, err by less than 80 u D, for which the frame's speed has 4 D more.
constexpr float kGapSlack = 0x1p-18f;
constexpr float kSpeedSlack = 0x1p-19f;
constexpr float kSwingSlack = 0x1p-17f;
constexpr float kTimeSlack = 1.0f - 0x1p-18f;
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR
constexpr float kRoughness = HWY_TARGET <= HWY_AVX3 ? 0x1p-13f : 0x1p-11f;
#else
constexpr float kRoughness = 0x1p-18f;
#endif
constexpr float kSmallestGap = 0x1p-40f;  // The least gap whose reciprocal is taken.
constexpr float kTiny = 0x1p-60f;         // Above the loss of a square by underflow.
constexpr float kTinyLength = 0x1p-100f;  // Above the loss of extents when their unit is scaled.
constexpr float kExtentDoubt = 0x1p-9f;   // [-]  Part of the radius, above the rounding up of
                                          // extents.
constexpr float kLargest = 1e30f;         // Beyond, products may overflow.
constexpr float kShortest = 0x1p-40f;     // The least time until which extents are followed.

template <class D>
using V = hn::Vec<D>;

/// The values that get(tag, lane) returns for the lanes from that one on, at most four, of one
/// node.
template <class D, class Get>
HWY_INLINE V<D> of_parts(D d, std::size_t first, const Get& get) {
  if constexpr (hn::MaxLanes(D()) > 4) {
    const hn::Half<D> half;
    return Combine(d, of_parts(half, first + hn::MaxLanes(half), get), of_parts(half, first, get));
  } else {
    return get(d, first);
  }
}

template <class D>
HWY_INLINE V<D> dot(D, const V<D>* x, const V<D>* y) {
  return hn::MulAdd(x[0], y[0], hn::MulAdd(x[1], y[1], hn::Mul(x[2], y[2])));
}

/// The reciprocals 1 / x and 1 / sqrt(x), within 3/4 kRoughness.
///
/// x86 promises 2^-14 for the whole registers of AVX-512 and 1.5 x 2^-12 for others. Elsewhere they
/// are exact up to rounding.
template <class D>
HWY_INLINE V<D> reciprocal(D d, V<D> x) {
  static_assert(kRoughness > 0x1p-12f || kRoughness < 0x1p-15f || hn::MaxLanes(D()) == 16);
  if constexpr (kRoughness > 0x1p-15f) {
    (void)d;
    return hn::ApproximateReciprocal(x);
  } else {
    return hn::Div(hn::Set(d, 1.0f), x);
  }
}
template <class D>
HWY_INLINE V<D> reciprocal_root(D d, V<D> x) {
  static_assert(kRoughness > 0x1p-12f || kRoughness < 0x1p-15f || hn::MaxLanes(D()) == 16);
  if constexpr (kRoughness > 0x1p-15f) {
    (void)d;
    return hn::ApproximateReciprocalSqrt(x);
  } else {
    return hn::Div(hn::Set(d, 1.0f), hn::Sqrt(x));
  }
}

/// An upper bound of sqrt(x), within 2^-20 of it and kTiny.
///
/// It also holds for x that is too small by a few units in the last place.
template <class D>
HWY_INLINE V<D> root_up(D d, V<D> x) {
  return hn::Mul(hn::Sqrt(hn::Add(x, hn::Set(d, kTiny * kTiny))), hn::Set(d, 1.0f + 0x1p-21f));
}

template <class VD>
HWY_INLINE void cross(const VD* x, const VD* y, VD* product) {
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3;
    const int j = (k + 2) % 3;
    product[k] = hn::NegMulAdd(x[j], y[i], hn::Mul(x[i], y[j]));
  }
}

}  // namespace firstcontact::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
