#include <firstcontact/moving_pairs/detail/lane_times.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "firstcontact/moving_pairs/detail/lane_times.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace firstcontact::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<std::int32_t, 16>;

HWY_INLINE std::int32_t least_of(hn::Vec<D> least) {
  return hn::GetLane(hn::MinOfLanes(D(), least));
}

std::int32_t Prove(std::int32_t* codes, const float* time, float shift, unsigned live) {
  const D d;
  const hn::Rebind<float, D> df;
  const auto none = hn::Set(d, LaneTime::kNone);
  const auto lane_bits = hn::Set(d, 15);
  auto least = none;
  for (std::size_t first = 0; first < 16; first += hn::Lanes(d)) {
    const auto code = hn::Load(d, codes + first);
    // The sum and the product may both be rounded up.
    const auto before =
        hn::Mul(hn::Add(hn::BitCast(df, hn::AndNot(lane_bits, code)), hn::Set(df, shift)),
                hn::Set(df, 1.0f - 0x1p-22f));
    // The codes of numbers that are not negative sort like the numbers.
    const auto longest =
        hn::Max(hn::BitCast(d, before), hn::BitCast(d, hn::Load(df, time + first)));
    const auto lane = hn::Iota(d, static_cast<std::int32_t>(first));
    const std::uint8_t bits[8] = {static_cast<std::uint8_t>(live >> first),
                                  static_cast<std::uint8_t>(live >> first >> 8)};
    const auto proven = hn::IfThenElse(hn::LoadMaskBits(d, bits),
                                       hn::Or(hn::AndNot(lane_bits, longest), lane), none);
    hn::Store(proven, d, codes + first);
    least = hn::Min(least, proven);
  }
  return least_of(least);
}

std::int32_t Drop(std::int32_t* codes, int lane) {
  const D d;
  const auto none = hn::Set(d, LaneTime::kNone);
  auto least = none;
  for (std::size_t first = 0; first < 16; first += hn::Lanes(d)) {
    const auto done = hn::Eq(hn::Iota(d, static_cast<std::int32_t>(first)), hn::Set(d, lane));
    const auto left = hn::IfThenElse(done, none, hn::Load(d, codes + first));
    hn::Store(left, d, codes + first);
    least = hn::Min(least, left);
  }
  return least_of(least);
}

}  // namespace firstcontact::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace firstcontact::detail {

HWY_EXPORT(Prove);
HWY_EXPORT(Drop);

LaneTime prove(LaneTimes& lanes, const float* time, float shift, unsigned live) {
  return LaneTime(HWY_DYNAMIC_DISPATCH(Prove)(lanes.codes.data(), time, shift, live));
}

LaneTime drop(LaneTimes& lanes, int lane) {
  return LaneTime(HWY_DYNAMIC_DISPATCH(Drop)(lanes.codes.data(), lane));
}

}  // namespace firstcontact::detail
#endif
