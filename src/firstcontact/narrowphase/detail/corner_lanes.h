/// @file
/// The corners of a triangle side by side in a vector. Included once for each instruction set.

#if defined(FIRSTCONTACT_NARROWPHASE_DETAIL_CORNER_LANES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRSTCONTACT_NARROWPHASE_DETAIL_CORNER_LANES_H
#undef FIRSTCONTACT_NARROWPHASE_DETAIL_CORNER_LANES_H
#else
#define FIRSTCONTACT_NARROWPHASE_DETAIL_CORNER_LANES_H
#endif

#include <cstddef>

#include <hwy/highway.h>

#include <firstcontact/narrowphase/triangle_distance.h>

HWY_BEFORE_NAMESPACE();
namespace firstcontact::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Number of lanes of corners: three, and the fourth repeats the third.
inline constexpr std::size_t kCornerLanes = 4;

/// One component of corners first, first + 1, ..., as many as the vector holds.
///
/// With `next` it is the component of the next corner in the triangle. Single numbers are put
/// together, as a vector that was just written in parts is slow to load. Some instruction sets have
/// no Combine(), so that it is found by its arguments.
template <class D>
HWY_INLINE hn::Vec<D> corner_lanes(D d, const Triangle& T, int component, std::size_t first,
                                   bool next) {
  if constexpr (hn::MaxLanes(D()) > 2) {
    const hn::Half<D> half;
    return Combine(d, corner_lanes(half, T, component, first + hn::MaxLanes(half), next),
                   corner_lanes(half, T, component, first, next));
  } else {
    const auto lane = [&](std::size_t k) HWY_ATTR {
      const std::size_t corner = k < 3 ? k : 2;
      return hn::Set(d, T[next ? (corner + 1) % 3 : corner][component]);
    };
    if constexpr (hn::MaxLanes(D()) == 2) {
      return InterleaveLower(d, lane(first), lane(first + 1));
    } else {
      return lane(first);
    }
  }
}

}  // namespace firstcontact::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
