#include <firstcontact/haptic_devices/detail/space_mouse_rates.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <firstcontact/haptic_devices/detail/quiet_state.h>

namespace firstcontact::detail {
namespace {

/// Computes the fraction of full scale: 0 in the dead zone, then linear to 1.
double share_of_scale(double count, const SpaceMouseOptions& options) {
  const double size = std::abs(count);
  if (size <= options.dead_zone) {
    return 0.0;
  }
  const double share = (size - options.dead_zone) / (options.full_scale - options.dead_zone);
  return std::copysign(std::min(share, 1.0), count);
}

}  // namespace

void SpaceMouseRates::take_motion(const std::array<std::int32_t, 6>& axes, std::int64_t now_ns) {
  std::array<double, 6> shares{};
  sample_.deflection = 0.0;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    shares[axis] = share_of_scale(axes[axis], options_);
    if (shares[axis] != 0.0) {
      sample_.deflection = std::max(sample_.deflection, std::abs(axes[axis]) / options_.full_scale);
    }
  }
  if (axes != axes_ || sample_.state.status != DeviceStatus::live) {
    axes_ = axes;
    sample_.changed_ns = now_ns;
  }
  // The daemon has y up and z away from the user; D has y away and z up. Rotations are right-handed
  // about the directions of x, y and away, as in the helpers of libspnav.
  DeviceState& state = sample_.state;
  state.linear_rate = options_.max_linear_rate * Eigen::Vector3d(shares[0], shares[2], shares[1]);
  state.angular_rate = options_.max_angular_rate * Eigen::Vector3d(shares[3], shares[5], shares[4]);
}

bool SpaceMouseRates::take(const SpacenavEvent& event, std::int64_t now_ns) {
  DeviceState& state = sample_.state;
  switch (event.type) {
    case SpacenavEventType::motion:
      take_motion(event.axes, now_ns);
      break;
    case SpacenavEventType::press:
    case SpacenavEventType::release: {
      if (event.value >= 32) {
        return false;
      }
      const std::uint32_t bit = std::uint32_t{1} << event.value;
      state.buttons =
          event.type == SpacenavEventType::press ? state.buttons | bit : state.buttons & ~bit;
      break;
    }
    case SpacenavEventType::device_removed:
      lost();
      return true;
    case SpacenavEventType::device_added:
      connected();
      return true;
    case SpacenavEventType::protocol:
    case SpacenavEventType::other:
      return false;
  }
  state.status = DeviceStatus::live;
  state.time_ns = now_ns;
  ++state.sequence;
  return true;
}

void SpaceMouseRates::connected() {
  sample_.state = quiet(sample_.state, DeviceStatus::waiting);
  sample_.deflection = 0.0;
}

void SpaceMouseRates::lost() {
  sample_.state = quiet(sample_.state, DeviceStatus::lost);
  sample_.deflection = 0.0;
}

DeviceState state_at(const SpaceMouseSample& sample, std::int64_t now_ns,
                     const SpaceMouseOptions& options) noexcept {
  DeviceState state = sample.state;
  if (state.status != DeviceStatus::live || sample.deflection == 0.0) {
    return state;
  }
  if (now_ns - state.time_ns > options.hold_ns) {
    return quiet(state, DeviceStatus::silent);
  }
  if (sample.deflection < options.drift_below &&
      now_ns - sample.changed_ns > options.drift_after_ns) {
    state.linear_rate.setZero();
    state.angular_rate.setZero();
  }
  return state;
}

}  // namespace firstcontact::detail
