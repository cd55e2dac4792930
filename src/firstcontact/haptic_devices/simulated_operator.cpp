#include <firstcontact/haptic_devices/simulated_operator.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <firstcontact/haptic_devices/detail/handle_dynamics.h>
#include <firstcontact/haptic_devices/detail/quiet_state.h>
#include <firstcontact/haptic_devices/detail/rotation_vector.h>
#include <firstcontact/haptic_devices/detail/tremor.h>
#include <firstcontact/math/random_numbers.h>

namespace firstcontact {
namespace {

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
constexpr double kSubstepsOfRead = 100.0;
constexpr double kMostSubsteps = 4e6;

void require_range(bool holds, const char* what) {
  if (!holds) {
    throw std::invalid_argument(std::string("SimulatedOperatorOptions: ") + what);
  }
}

bool not_negative(double value) { return value >= 0.0 && std::isfinite(value); }

void check(const HandOptions& hand) {
  require_range(not_negative(hand.stiffness) && not_negative(hand.angular_stiffness),
                "stiffnesses of the hand must be >= 0");
  require_range(not_negative(hand.damping) && not_negative(hand.angular_damping),
                "dampings of the hand must be >= 0");
  require_range(not_negative(hand.mass) && not_negative(hand.inertia),
                "mass and inertia of the hand must be >= 0");
  require_range(hand.max_force >= 0.0 && hand.max_torque >= 0.0,
                "greatest force and torque of the hand must be >= 0");
  require_range(not_negative(hand.tremor) && not_negative(hand.angular_tremor),
                "tremors must be >= 0");
  require_range(hand.tremor_frequencies[0] >= 0.0 &&
                    hand.tremor_frequencies[1] >= hand.tremor_frequencies[0] &&
                    hand.tremor_frequencies[1] <= 1000.0,
                "tremor_frequencies must be least and greatest, from 0 to 1000");
}

void check(const MechanismOptions& mechanism) {
  require_range(mechanism.mass > 0.0 && std::isfinite(mechanism.mass) && mechanism.inertia > 0.0 &&
                    std::isfinite(mechanism.inertia),
                "mass and inertia of the mechanism must be > 0");
  require_range(not_negative(mechanism.damping) && not_negative(mechanism.angular_damping),
                "dampings of the mechanism must be >= 0");
  require_range(not_negative(mechanism.friction) && not_negative(mechanism.angular_friction),
                "frictions of the mechanism must be >= 0");
  require_range(mechanism.max_force >= 0.0 && mechanism.max_torque >= 0.0,
                "greatest force and torque of the mechanism must be >= 0");
}

void check(const ChannelOptions& channel) {
  constexpr std::int64_t kLongest = 10'000'000;
  require_range(not_negative(channel.resolution) && not_negative(channel.angular_resolution),
                "resolutions must be >= 0");
  for (const std::int64_t delay :
       {channel.sensor_delay_ns, channel.command_delay_ns, channel.jitter_ns}) {
    require_range(delay >= 0 && delay <= kLongest, "delays and jitter must be from 0 to 10 ms");
  }
}

void check(const FingerOptions& fingers) {
  require_range(fingers.grips >= 0 && fingers.grips <= static_cast<int>(kMostGrips),
                "grips must be from 0 to 16");
  require_range(fingers.period > 0.0 && std::isfinite(fingers.period) &&
                    std::abs(fingers.closed) <= detail::kMostOfSample,
                "the period of fingers must be > 0, and closed at most 1e6");
}

void check(const std::vector<HandRelease>& releases) {
  double last = -std::numeric_limits<double>::infinity();
  for (const HandRelease& release : releases) {
    require_range(release.begin > last && release.begin < release.end,
                  "releases must be in order and apart from each other");
    last = release.end;
  }
}

const SimulatedOperatorOptions& checked(const SimulatedOperatorOptions& options) {
  check(options.hand);
  check(options.mechanism);
  check(options.channel);
  check(options.fingers);
  check(options.releases);
  require_range(options.substep > 0.0, "substep must be > 0");
  return options;
}

DeviceCapabilities operator_capabilities(const SimulatedOperatorOptions& options) {
  const MechanismOptions& mechanism = options.mechanism;
  DeviceCapabilities result;
  result.name = "simulated operator";
  result.id = "seed " + std::to_string(options.seed);
  result.sensed = DegreesOfFreedom::all();
  result.driven = DegreesOfFreedom::all();
  result.buttons = 1;
  result.grips = options.fingers.grips;
  result.max_grip_effort =
      options.fingers.grips > 0 ? std::numeric_limits<double>::infinity() : 0.0;
  result.max_force = mechanism.max_force;
  result.max_torque = mechanism.max_torque;
  result.max_stiffness = std::numeric_limits<double>::infinity();
  result.max_angular_stiffness = std::numeric_limits<double>::infinity();
  result.max_damping = std::numeric_limits<double>::infinity();
  result.max_angular_damping = std::numeric_limits<double>::infinity();
  result.damping = mechanism.damping;
  result.angular_damping = mechanism.angular_damping;
  result.friction = mechanism.friction;
  result.angular_friction = mechanism.angular_friction;
  result.resolution = options.channel.resolution;
  result.angular_resolution = options.channel.angular_resolution;
  return result;
}

/// Converts to nanoseconds; a time longer than 100 years becomes 100 years.
std::int64_t nanoseconds(double seconds) {
  return static_cast<std::int64_t>(std::ceil(std::clamp(seconds, -3e9, 3e9) * 1e9));
}

/// Rounds as an encoder of this step does.
Eigen::Vector3d rounded(const Eigen::Vector3d& vector, double step) {
  return step > 0.0 ? Eigen::Vector3d(step * (vector / step).array().round().matrix()) : vector;
}

}  // namespace

SimulatedOperator::SimulatedOperator(const SimulatedOperatorOptions& options)
    : options_(checked(options)),
      capabilities_(operator_capabilities(options)),
      path_(options.path),
      random_(options.seed == 0 ? 1 : options.seed) {
  RandomNumbers random(options.seed);
  const HandOptions& hand = options.hand;
  for (std::size_t axis = 0; axis < tremor_.size(); ++axis) {
    // n sines of amplitude a have the root mean square a sqrt(n / 2).
    const double amplitude = (axis < 3 ? hand.tremor : hand.angular_tremor) *
                             std::sqrt(2.0 / static_cast<double>(tremor_[axis].size()));
    for (Sine& sine : tremor_[axis]) {
      sine.amplitude = amplitude;
      sine.frequency = 2.0 * std::numbers::pi *
                       random.uniform(hand.tremor_frequencies[0], hand.tremor_frequencies[1]);
      sine.phase = random.uniform(0.0, 2.0 * std::numbers::pi);
    }
  }
  for (int k = 0; k < options.fingers.grips; ++k) {
    grip_rates_[static_cast<std::size_t>(k)] =
        2.0 * std::numbers::pi / (options.fingers.period * random.uniform(0.7, 1.3));
  }
  for (const HandRelease& release : options.releases) {
    releases_.push_back({nanoseconds(release.begin), nanoseconds(release.end)});
  }
  truth_.target = path_.at(0.0, piece_);
  truth_.X_DH = truth_.target.X_DH;
  update_hold();
}

const DeviceCapabilities& SimulatedOperator::capabilities() const noexcept { return capabilities_; }

void SimulatedOperator::update_hold() noexcept {
  const std::int64_t elapsed = now_ns_ - origin_ns_;
  while (release_ < releases_.size() && elapsed >= releases_[release_].end_ns) {
    ++release_;
  }
  const bool held = release_ == releases_.size() || elapsed < releases_[release_].begin_ns;
  if (held == truth_.held) {
    return;
  }
  // The mass of the hand joins and leaves at the speed of the handle; its energy is the hand's.
  truth_.held = held;
  const double kinetic = 0.5 * options_.hand.mass * truth_.velocity.squaredNorm() +
                         0.5 * options_.hand.inertia * truth_.angular_velocity.squaredNorm();
  energy_.hand_work += held ? kinetic : -kinetic;
}

std::int64_t SimulatedOperator::next_event_ns() const noexcept {
  std::int64_t next = kNever;
  const auto consider = [&](std::int64_t event_ns) {
    if (event_ns > now_ns_) {
      next = std::min(next, event_ns);
    }
  };
  consider(force_until_ns_);
  if (pending_count_ > 0) {
    consider(pending_[first_pending_].begin_ns);
  }
  if (release_ < releases_.size()) {
    consider(origin_ns_ + releases_[release_].begin_ns);
    consider(origin_ns_ + releases_[release_].end_ns);
  }
  return next;
}

void SimulatedOperator::integrate(double duration, std::int64_t steps) noexcept {
  const HandOptions& hand = options_.hand;
  const MechanismOptions& mechanism = options_.mechanism;
  const bool held = truth_.held;
  const detail::HandleLaw linear{mechanism.mass + (held ? hand.mass : 0.0),
                                 held ? hand.stiffness : 0.0,
                                 held ? hand.damping : 0.0,
                                 hand.max_force,
                                 mechanism.damping,
                                 mechanism.friction};
  const detail::HandleLaw angular{mechanism.inertia + (held ? hand.inertia : 0.0),
                                  held ? hand.angular_stiffness : 0.0,
                                  held ? hand.angular_damping : 0.0,
                                  hand.max_torque,
                                  mechanism.angular_damping,
                                  mechanism.angular_friction};
  const double h = duration / static_cast<double>(steps);
  const double begin = time_;
  detail::HandleEnergy energy;
  Eigen::Vector3d& p = truth_.X_DH.position;
  Eigen::Quaterniond& R = truth_.X_DH.rotation;
  Eigen::Vector3d& v = truth_.velocity;
  Eigen::Vector3d& w = truth_.angular_velocity;
  detail::TremorWalk tremor(tremor_, begin + 0.5 * h, h);
  for (std::int64_t step = 0; step < steps; ++step) {
    HandTarget target = path_.at(begin + (static_cast<double>(step) + 0.5) * h, piece_);
    tremor.add_to(target);
    p += 0.5 * h * v;
    R = detail::rotation_of(0.5 * h * w) * R;
    v = detail::new_rate(linear, v, target.X_DH.position - p, target.velocity, force_.force_D, h,
                         energy);
    w = detail::new_rate(angular, w, detail::vector_of(target.X_DH.rotation * R.conjugate()),
                         target.angular_velocity, force_.torque_D, h, energy);
    p += 0.5 * h * v;
    R = detail::rotation_of(0.5 * h * w) * R;
  }
  R.normalize();
  energy_.command_work += energy.command_work;
  energy_.hand_work += energy.hand_work;
  energy_.dissipated += energy.dissipated;
}

void SimulatedOperator::advance(std::int64_t to_ns) noexcept {
  const double whole = static_cast<double>(to_ns - now_ns_) * 1e-9;
  const double steps =
      std::clamp(std::ceil(whole / options_.substep), kSubstepsOfRead, kMostSubsteps);
  while (now_ns_ < to_ns) {
    while (pending_count_ > 0 && pending_[first_pending_].begin_ns <= now_ns_) {
      force_ = pending_[first_pending_].force;
      force_until_ns_ = pending_[first_pending_].begin_ns + kCommandLifetimeNs;
      first_pending_ = (first_pending_ + 1) % kDepth;
      --pending_count_;
    }
    if (force_until_ns_ <= now_ns_) {
      force_ = {};
    }
    const std::int64_t end_ns = std::min(to_ns, next_event_ns());
    const double duration = static_cast<double>(end_ns - now_ns_) * 1e-9;
    integrate(duration, static_cast<std::int64_t>(std::ceil(steps * duration / whole)));
    now_ns_ = end_ns;
    time_ = static_cast<double>(now_ns_ - origin_ns_) * 1e-9;
    update_hold();
  }
  truth_.target = path_.at(time_, piece_);
  detail::TremorWalk(tremor_, time_, 0.0).add_to(truth_.target);
}

std::int64_t SimulatedOperator::random_delay(std::int64_t delay_ns) noexcept {
  if (options_.channel.jitter_ns == 0) {
    return delay_ns;
  }
  // The generator of G. Marsaglia, "Xorshift RNGs", Journal of Statistical Software 8 (2003).
  random_ ^= random_ << 13;
  random_ ^= random_ >> 7;
  random_ ^= random_ << 17;
  return delay_ns + static_cast<std::int64_t>(
                        random_ % static_cast<std::uint64_t>(options_.channel.jitter_ns));
}

void SimulatedOperator::take_sample(std::int64_t now_ns) noexcept {
  DeviceState& sample = samples_[taken_ % kDepth];
  const ChannelOptions& channel = options_.channel;
  sample.X_DH.position = rounded(truth_.X_DH.position, channel.resolution);
  sample.X_DH.rotation = channel.angular_resolution > 0.0
                             ? detail::rotation_of(rounded(detail::vector_of(truth_.X_DH.rotation),
                                                           channel.angular_resolution))
                             : truth_.X_DH.rotation;
  sample.time_ns = now_ns;
  sample.sequence = ++taken_;
  sample_count_.store(taken_, std::memory_order_relaxed);
  for (std::size_t k = 0; k < static_cast<std::size_t>(options_.fingers.grips); ++k) {
    sample.grips[k] = 0.5 * options_.fingers.closed * (1.0 - std::cos(grip_rates_[k] * time_));
  }
  sample.buttons = truth_.held ? 1 : 0;
  sample.status = DeviceStatus::live;
}

DeviceState SimulatedOperator::read(std::int64_t now_ns) noexcept {
  if (!started_) {
    started_ = true;
    origin_ns_ = now_ns;
    now_ns_ = now_ns;
    take_sample(now_ns);
  } else if (now_ns > now_ns_) {
    advance(now_ns);
    take_sample(now_ns);
  }
  const std::int64_t newest_ns = now_ns_ - random_delay(options_.channel.sensor_delay_ns);
  const std::uint64_t oldest = taken_ > kDepth ? taken_ - kDepth + 1 : 1;
  std::uint64_t sequence = taken_;
  while (sequence > std::max(oldest, returned_) &&
         samples_[(sequence - 1) % kDepth].time_ns > newest_ns) {
    --sequence;
  }
  const DeviceState& sample = samples_[(sequence - 1) % kDepth];
  if (returned_ == 0 && sample.time_ns > newest_ns) {
    return {};
  }
  returned_ = std::max(returned_, sequence);
  return samples_[(returned_ - 1) % kDepth];
}

void SimulatedOperator::command(const ForceCommand& command, std::int64_t now_ns) noexcept {
  PendingCommand next;
  next.begin_ns = std::max(now_ns, now_ns_) + random_delay(options_.channel.command_delay_ns);
  next.force = limited(command, capabilities_);
  if (pending_count_ > 0) {
    const PendingCommand& last = pending_[(first_pending_ + pending_count_ - 1) % kDepth];
    next.begin_ns = std::max(next.begin_ns, last.begin_ns);
  }
  // A loop that sends faster than commands take effect replaces the newest command.
  pending_count_ = std::min(pending_count_ + 1, kDepth);
  pending_[(first_pending_ + pending_count_ - 1) % kDepth] = next;
}

DeviceCounts SimulatedOperator::counts() const {
  return {sample_count_.load(std::memory_order_relaxed), 0, 0, 1};
}

std::string SimulatedOperator::problem() const { return {}; }

OperatorEnergy SimulatedOperator::energy() const noexcept {
  OperatorEnergy energy = energy_;
  const bool held = truth_.held;
  energy.kinetic = 0.5 * (options_.mechanism.mass + (held ? options_.hand.mass : 0.0)) *
                       truth_.velocity.squaredNorm() +
                   0.5 * (options_.mechanism.inertia + (held ? options_.hand.inertia : 0.0)) *
                       truth_.angular_velocity.squaredNorm();
  return energy;
}

OperatorTruth SimulatedOperator::truth() const noexcept { return truth_; }

}  // namespace firstcontact
