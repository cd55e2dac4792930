#include <firstcontact/haptic_sessions/detail/target_lead.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include <firstcontact/haptics/detail/god_object_plan.h>
#include <firstcontact/haptics/detail/target_follower.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

constexpr double kNanosecond = 1e-9;  // [s]

/// [ns]  Time over which a velocity is measured. With more, steps of an encoder matter less, and a
/// hand that brakes is extrapolated too far.
constexpr std::int64_t kHalf = 2'000'000;
/// [ns]  Distance of the samples that are kept, so that the ring holds both halves at any rate.
constexpr std::int64_t kApart = kHalf / 5;
/// [ns]  Greatest distance of a sample from the time for which it is sought.
constexpr std::int64_t kNear = kHalf / 2;

/// [m/s], [rad/s]  Greatest speeds of the handle. A faster motion is a jump, not of a hand.
constexpr double kFastest = 10.0;
constexpr double kFastestTurn = 100.0;

/// The newer of two velocities, limited to the length of the older one; 0 where they turn back.
Vector3d steady_part(const Vector3d& older, const Vector3d& newer) noexcept {
  if (!(older.dot(newer) > 0.0)) {
    return Vector3d::Zero();
  }
  return std::min(1.0, older.norm() / newer.norm()) * newer;
}

}  // namespace

void TargetLead::take(const Sample& sample) noexcept {
  if (has_newest_ && sample.time_ns < newest_.time_ns) {
    count_ = 0;  // Another clock: start again.
  }
  newest_ = sample;
  has_newest_ = true;
  if (count_ == 0 || sample.time_ns - kept_[(count_ - 1) % kKept].time_ns >= kApart) {
    kept_[count_++ % kKept] = sample;
  }
}

void TargetLead::watch(std::int64_t now_ns, const ToolTick& tick) noexcept {
  constexpr auto kAway = static_cast<std::uint32_t>(ForceFault::device) |
                         static_cast<std::uint32_t>(ForceFault::not_finite) |
                         static_cast<std::uint32_t>(ForceFault::disengaged);
  now_ns_ = now_ns;
  target_ = tick.target;
  centre_ = tick.centre;
  if ((tick.faults & kAway) != 0) {
    count_ = 0;
    has_newest_ = false;
    return;
  }
  if (!has_newest_ || tick.device.sequence != sequence_) {
    sequence_ = tick.device.sequence;
    take({tick.device.time_ns, tick.centre, tick.target.rotation});
  }
}

const TargetLead::Sample* TargetLead::sample_at(std::int64_t time_ns) const noexcept {
  const Sample* nearest = nullptr;
  std::int64_t least = kNear;
  for (std::size_t k = 0; k < std::min(count_, kKept); ++k) {
    const std::int64_t off = std::abs(kept_[k].time_ns - time_ns);
    if (off < least) {
      least = off;
      nearest = &kept_[k];
    }
  }
  return nearest;
}

TargetLead::Velocity TargetLead::between(const Sample& from, const Sample& to) noexcept {
  const double per_second = 1.0 / (kNanosecond * static_cast<double>(to.time_ns - from.time_ns));
  return {per_second * (to.centre - from.centre),
          per_second * turn_between(from.rotation, to.rotation)};
}

std::optional<TargetLead::Velocity> TargetLead::velocity() const noexcept {
  if (!is_pose_ || !has_newest_ || now_ns_ - newest_.time_ns > kHalf) {
    return std::nullopt;
  }
  const Sample* middle = sample_at(newest_.time_ns - kHalf);
  const Sample* oldest = sample_at(newest_.time_ns - 2 * kHalf);
  if (middle == nullptr || oldest == nullptr || !(middle->time_ns > oldest->time_ns) ||
      !(newest_.time_ns > middle->time_ns)) {
    return std::nullopt;
  }
  const Velocity older = between(*oldest, *middle);
  const Velocity newer = between(*middle, newest_);
  const Velocity steady{steady_part(older.linear, newer.linear),
                        steady_part(older.angular, newer.angular)};
  // Negated, so that values that are not finite are refused, too.
  if (!(steady.linear.norm() <= kFastest * scale_ && steady.angular.norm() <= kFastestTurn)) {
    return std::nullopt;
  }
  return steady;
}

Pose TargetLead::target_in(double seconds) const noexcept {
  const std::optional<Velocity> moves = velocity();
  if (!moves) {
    return target_;
  }
  const double ahead = std::clamp(seconds, 0.0, kNanosecond * static_cast<double>(2 * kHalf));
  Pose led = target_;
  led.position += ahead * moves->linear;
  if (moves->angular != Vector3d::Zero()) {
    const Eigen::Quaterniond turn = turn_by(ahead * moves->angular);
    const Vector3d p_BC_W = centre_ - target_.position;
    led.position += p_BC_W - turn * p_BC_W;
    led.rotation = (turn * led.rotation).normalized();
  }
  return led;
}

bool is_rubbing(const HapticContactSet& set, std::size_t tool) noexcept {
  const std::size_t count = std::min<std::size_t>(set.count, kMostHapticContacts);
  const auto number = static_cast<std::int32_t>(tool);
  return std::any_of(
      set.contacts.begin(), set.contacts.begin() + count, [number](const HapticContact& contact) {
        return contact.friction > 0.0 && (contact.tool == number || contact.other == number);
      });
}

}  // namespace firstcontact::detail
