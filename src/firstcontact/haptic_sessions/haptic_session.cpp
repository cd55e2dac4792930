#include <firstcontact/haptic_sessions/haptic_session.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <firstcontact/haptic_sessions/detail/session_periods.h>
#include <firstcontact/haptic_sessions/detail/target_lead.h>

namespace firstcontact {

namespace detail {
namespace {

/// Rounds up to whole ticks, at least one.
std::int64_t whole_ticks(double ticks) {
  constexpr double kRounding = 1e-6;  // [ticks]  Rounding of a quotient of rates.
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(ticks - kRounding)));
}

}  // namespace

SessionPeriods session_periods(const HapticSessionOptions& options) {
  if (!(options.force_rate >= kLeastForceRate && options.force_rate <= 1e6)) {
    throw std::invalid_argument("HapticSessionOptions::force_rate must be in [100, 1e6] Hz");
  }
  if (!(options.contact_rate > 0.0 && options.contact_rate <= options.force_rate)) {
    throw std::invalid_argument(
        "HapticSessionOptions::contact_rate must be > 0 Hz and at most the force rate");
  }
  if (!(options.contact_latency_ns >= 0 && options.contact_latency_ns <= 10'000'000'000)) {
    throw std::invalid_argument(
        "HapticSessionOptions::contact_latency_ns must be 0 to 10,000,000,000");
  }
  constexpr double kSecond = 1e9;  // [ns]
  // A cycle begins with a tick, and contacts are felt in one. Ticks are counted by the requested
  // rates: a period is rounded to a nanosecond, and three rounded thirds of a millisecond do not
  // make one.
  const std::int64_t latency =
      whole_ticks(static_cast<double>(options.contact_latency_ns) / kSecond * options.force_rate);
  const std::int64_t cycle = whole_ticks(options.force_rate / options.contact_rate);
  SessionPeriods periods;
  periods.force_ns = std::llround(kSecond / options.force_rate);
  periods.latency_ns = latency * periods.force_ns;
  periods.cycle_ns = std::max(cycle, latency) * periods.force_ns;
  return periods;
}

double lead_of(const SessionPeriods& periods) {
  return 1e-9 * (static_cast<double>(periods.latency_ns) +
                 0.5 * static_cast<double>(periods.cycle_ns - periods.force_ns));
}

}  // namespace detail

std::vector<DeviceMapping> complete_mappings(const HapticScene& scene,
                                             const std::vector<DeviceMapping>& mappings) {
  if (mappings.size() > scene.tools.size()) {
    throw std::invalid_argument("there are more mappings than tools");
  }
  std::vector<DeviceMapping> all = mappings;
  all.resize(scene.tools.size());
  return all;
}

constexpr std::int64_t kLongestStall = 10'000'000'000;  // [ns]

class HapticSession::Implementation {
 public:
  Implementation(HapticScene scene, const HapticSessionOptions& options)
      : periods_(detail::session_periods(options)),
        forces_(scene, complete_mappings(scene, options.mappings), options.forces),
        contacts_(std::move(scene), options.contacts),
        set_(contacts_.contact_set()) {
    targets_.resize(contacts_.scene().tools.size());
    lead_ = detail::lead_of(periods_);
    for (const DeviceMapping& mapping : complete_mappings(contacts_.scene(), options.mappings)) {
      leads_.emplace_back(mapping);
    }
  }

  const ForceTick& step(std::span<const DeviceState> devices) {
    if (devices.size() != targets_.size()) {
      throw std::invalid_argument("a device state for each tool was expected");
    }
    if (is_running_ && now_ns_ >= ends_ns_) {
      set_ = contacts_.contact_set();
      is_running_ = false;
    }
    const ForceTick& tick = forces_.tick(now_ns_, set_, devices);
    cycle_ = nullptr;
    for (std::size_t k = 0; k < leads_.size(); ++k) {
      leads_[k].watch(now_ns_, tick.tools[k]);
    }
    if (!is_running_ && now_ns_ >= begins_ns_) {
      for (std::size_t k = 0; k < targets_.size(); ++k) {
        targets_[k] = leads_[k].target_in(detail::is_rubbing(set_, k) ? 0.0 : lead_);
      }
      cycle_ = &contacts_.advance(
          {.poses = targets_, .joints = std::span(tick.joint_targets).first(tick.joints)},
          1e-9 * static_cast<double>(periods_.cycle_ns), now_ns_);
      is_running_ = true;
      ends_ns_ = now_ns_ + periods_.latency_ns + stall_ns_;
      begins_ns_ = now_ns_ + periods_.cycle_ns + stall_ns_;
      stall_ns_ = 0;
    }
    now_ns_ += periods_.force_ns;
    return tick;
  }

  void stall_contacts(std::int64_t stall_ns) {
    if (!(stall_ns >= 0 && stall_ns <= kLongestStall)) {
      throw std::invalid_argument(
          "HapticSession::stall_contacts: the time must be >= 0 and at most 1e10 ns");
    }
    // Without a cycle that runs, the next one begins on time, and ends later.
    (is_running_ ? ends_ns_ : stall_ns_) += stall_ns;
    begins_ns_ += is_running_ ? stall_ns : 0;
  }

  detail::SessionPeriods periods_;
  ForceLoop forces_;
  ContactLoop contacts_;
  HapticContactSet set_;
  const HapticCycle* cycle_ = nullptr;
  std::int64_t now_ns_ = 0;

 private:
  double lead_ = 0.0;  // [s]
  std::vector<detail::TargetLead> leads_;
  std::vector<Pose> targets_;
  bool is_running_ = false;
  std::int64_t ends_ns_ = 0;
  std::int64_t begins_ns_ = 0;
  std::int64_t stall_ns_ = 0;
};

HapticSession::HapticSession(HapticScene scene, const HapticSessionOptions& options)
    : implementation_(std::make_unique<Implementation>(std::move(scene), options)) {}
HapticSession::~HapticSession() = default;
HapticSession::HapticSession(HapticSession&&) noexcept = default;
HapticSession& HapticSession::operator=(HapticSession&&) noexcept = default;

const ForceTick& HapticSession::step(std::span<const DeviceState> devices) {
  return implementation_->step(devices);
}
const HapticCycle* HapticSession::cycle() const { return implementation_->cycle_; }
void HapticSession::stall_contacts(std::int64_t stall_ns) {
  implementation_->stall_contacts(stall_ns);
}
std::int64_t HapticSession::time_ns() const { return implementation_->now_ns_; }
std::int64_t HapticSession::force_period_ns() const { return implementation_->periods_.force_ns; }
std::int64_t HapticSession::cycle_period_ns() const { return implementation_->periods_.cycle_ns; }
const ContactLoop& HapticSession::contacts() const { return implementation_->contacts_; }
const HapticContactSet& HapticSession::contact_set() const { return implementation_->set_; }

}  // namespace firstcontact
