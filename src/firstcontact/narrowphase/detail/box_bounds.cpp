#include <firstcontact/narrowphase/detail/box_bounds.h>

#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "firstcontact/narrowphase/detail/box_bounds.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <firstcontact/narrowphase/detail/box_directions.h>
#include <firstcontact/narrowphase/detail/box_lanes.h>
#include <firstcontact/narrowphase/detail/placed_boxes.h>

HWY_BEFORE_NAMESPACE();
namespace firstcontact::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <bool kDeforms, std::size_t kPairs>
HWY_INLINE void bound(const BoxFrame& frame, const NodePair (&pairs)[kPairs],
                      BoxBounds* const* bounds) {
  Placed<8 * kPairs> placed;
  place_centres<kDeforms, kPairs>(frame, pairs, placed);
  using D = hn::CappedTag<float, 8 * kPairs>;
  const Placer<D, kDeforms, kPairs> placer{D(), frame, pairs, placed};
  for (std::size_t first = 0; first < 8 * kPairs; first += hn::Lanes(placer.d)) {
    placer.place(first);
  }
  if constexpr (kPairs > 1) {
    // Compilers would keep the placed numbers in registers and shuffle them from there for each
    // pair. The processor does that while it loads, and has better use for its shuffle ports.
    asm volatile("" : : "r"(&placed) : "memory");
  }
  const Pairs<hn::CappedTag<float, 16>, kDeforms> lanes;
  HWY_UNROLL(2)
  for (std::size_t k = 0; k < kPairs; ++k) {
    bounds[k]->live = bounds[k]->far = bounds[k]->unsure = 0;
    bounds[k]->larger_a = bounds[k]->larger_b = 0;
    for (std::size_t first = 0; first < 16; first += hn::Lanes(lanes.d)) {
      lanes.bound(frame, placed, k, first, *bounds[k]);
    }
  }
}

void BoundBoxes(const BoxFrame& frame, const HierarchyNode& a, const HierarchyNode& b,
                BoxBounds& bounds) {
  const NodePair pairs[] = {{{{a, a}, {b, b}}}};
  BoxBounds* const all[] = {&bounds};
  bound<false>(frame, pairs, all);
}

void BoundTwice(const BoxFrame& frame, const HierarchyNode& a, const HierarchyNode& b,
                BoxBounds& bounds, const HierarchyNode& other_a, const HierarchyNode& other_b,
                BoxBounds& other_bounds) {
  const NodePair pairs[] = {{{{a, a}, {b, b}}}, {{{other_a, other_a}, {other_b, other_b}}}};
  BoxBounds* const all[] = {&bounds, &other_bounds};
  bound<false>(frame, pairs, all);
}

void BoundDeformingBoxes(const BoxFrame& frame, const HierarchyNode& a, const HierarchyNode& a_to,
                         const HierarchyNode& b, const HierarchyNode& b_to, BoxBounds& bounds) {
  const NodePair pairs[] = {{{{a, a_to}, {b, b_to}}}};
  BoxBounds* const all[] = {&bounds};
  bound<true>(frame, pairs, all);
}

}  // namespace firstcontact::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace firstcontact::detail {

HWY_EXPORT(BoundBoxes);
HWY_EXPORT(BoundTwice);
HWY_EXPORT(BoundDeformingBoxes);

void bound_boxes(const BoxFrame& frame, const HierarchyNode& a, const HierarchyNode& b,
                 BoxBounds& bounds) {
  HWY_DYNAMIC_DISPATCH(BoundBoxes)(frame, a, b, bounds);
}

void bound_boxes(const BoxFrame& frame, const HierarchyNode& a, const HierarchyNode& b,
                 BoxBounds& bounds, const HierarchyNode& other_a, const HierarchyNode& other_b,
                 BoxBounds& other_bounds) {
  HWY_DYNAMIC_DISPATCH(BoundTwice)(frame, a, b, bounds, other_a, other_b, other_bounds);
}

void bound_deforming_boxes(const BoxFrame& frame, const HierarchyNode& a, const HierarchyNode& a_to,
                           const HierarchyNode& b, const HierarchyNode& b_to, BoxBounds& bounds) {
  HWY_DYNAMIC_DISPATCH(BoundDeformingBoxes)(frame, a, a_to, b, b_to, bounds);
}

std::int64_t box_bounds_targets() { return HWY_TARGETS & hwy::SupportedTargets(); }

}  // namespace firstcontact::detail
#endif
