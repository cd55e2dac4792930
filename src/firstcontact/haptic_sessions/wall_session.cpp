#include <firstcontact/haptic_sessions/wall_session.h>

#include <ctime>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <deque>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include <firstcontact/haptic_devices/mail_slot.h>
#include <firstcontact/haptic_sessions/detail/real_time.h>
#include <firstcontact/haptic_sessions/detail/session_periods.h>
#include <firstcontact/haptic_sessions/detail/target_lead.h>
#include <firstcontact/haptic_sessions/detail/tick_ring.h>

namespace firstcontact {
namespace {

using WallClock = std::chrono::steady_clock;

constexpr int kForcePriority = 80;
constexpr int kContactPriority = 60;
/// [-]  Rest after a cycle, of the processor time that it took. Linux lets the real-time threads of
/// a processor run for 95 % of a second (sched_rt_runtime_us), and then stops them for the rest:
/// for 50 ms. The force loop has a processor of its own where the system grants one.
constexpr double kRestOfCycle = 1.0 / 16.0;
constexpr std::size_t kRing = 1U << 14;  // [ticks]  4 s at 4 kHz.

std::int64_t cpu_now_ns() noexcept {
  timespec now{};
  (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

void sleep_until_ns(std::int64_t at_ns) {
  std::this_thread::sleep_until(WallClock::time_point(std::chrono::nanoseconds(at_ns)));
}

/// The targets that the devices want at the end of a cycle, as the force loop hands them to the
/// contact loop.
struct HandedTargets {
  std::uint64_t sequence = 0;
  std::int64_t time_ns = 0;
  std::array<Pose, kMostTools> targets = {};
  std::uint32_t joint_count = 0;
  std::array<double, kMostHapticJoints> joints = {};
};

/// The data that both threads and the caller share.
struct SharedSession {
  MailSlot<HapticContactSet> sets;
  MailSlot<HandedTargets> targets;
  detail::TickRing<ForceTick> ticks{kRing};
  std::mutex cycles_mutex;  // For the contact loop and the caller alone.
  std::deque<std::pair<HapticCycle, std::int64_t>> cycles;
  std::atomic<bool> is_over{false};
  std::atomic<bool> force_is_done{false};
  std::array<std::exception_ptr, 2> failures;  // Those of the force loop, then of the contact loop.

  /// Runs a thread's work. An exception ends the session, and is passed to the caller.
  template <class Work>
  void guard(std::size_t thread, const Work& work) noexcept {
    try {
      work();
    } catch (...) {
      failures[thread] = std::current_exception();
      is_over = true;
    }
  }
};

/// The force loop's thread.
class ForceThread {
 public:
  ForceThread(SharedSession& shared, ForceLoop& loop, std::span<Device* const> devices,
              std::vector<detail::TargetLead> leads, const detail::SessionPeriods& periods,
              std::int64_t empty_ns, std::int64_t duration_ns, bool real_time,
              WallSessionReport& report)
      : shared_(shared),
        loop_(loop),
        devices_(devices),
        leads_(std::move(leads)),
        lead_(1e-9 * static_cast<double>(periods.cycle_ns)),
        period_ns_(periods.force_ns),
        empty_ns_(empty_ns),
        duration_ns_(duration_ns),
        real_time_(real_time),
        report_(report) {}

  void run() {
    shared_.guard(0, [this] { run_loop(); });
    for (Device* device : devices_) {
      device->command({}, steady_now_ns());
    }
    shared_.is_over = true;
    shared_.force_is_done = true;
  }

 private:
  void run_loop() {
    if (real_time_) {
      report_.granted.force_fifo = detail::take_real_time_priority(kForcePriority);
      report_.granted.force_processor = detail::bind_to_processor(0);
    }
    run_empty();
    const std::int64_t begin = steady_now_ns();
    std::int64_t next = begin;
    while (next - begin < duration_ns_ && !shared_.is_over.load(std::memory_order_relaxed)) {
      sleep_until_ns(next);
      const std::int64_t now = steady_now_ns();
      report_.tick_delay.add(now - next);
      report_.late_ticks += now - next > period_ns_ ? 1U : 0U;
      make_tick(now);
      next += period_ns_;
      const std::int64_t behind = steady_now_ns() - next;
      if (behind > period_ns_) {  // Ticks whose time has passed are skipped.
        const std::int64_t skipped = behind / period_ns_;
        report_.skipped_ticks += static_cast<std::uint64_t>(skipped);
        next += skipped * period_ns_;
      }
    }
  }

  void run_empty() {
    std::int64_t next = steady_now_ns();
    const std::int64_t end = next + empty_ns_;
    while (next < end && !shared_.is_over.load(std::memory_order_relaxed)) {
      sleep_until_ns(next);
      report_.empty_delay.add(steady_now_ns() - next);
      next += period_ns_;
    }
  }

  void make_tick(std::int64_t now) {
    const std::int64_t cpu = cpu_now_ns();
    std::array<DeviceState, kMostTools> states;
    for (std::size_t k = 0; k < devices_.size(); ++k) {
      states[k] = devices_[k]->read(now);
    }
    const HapticContactSet& set = shared_.sets.newest();
    const ForceTick& tick = loop_.tick(now, set, std::span(states.data(), devices_.size()));
    HandedTargets handed{.sequence = ++sequence_, .time_ns = now};
    for (std::size_t k = 0; k < devices_.size(); ++k) {
      devices_[k]->command(tick.tools[k].command, now);
      leads_[k].watch(now, tick.tools[k]);
      handed.targets[k] = leads_[k].target_in(detail::is_rubbing(set, k) ? 0.0 : lead_);
    }
    handed.joint_count = tick.joints;
    handed.joints = tick.joint_targets;
    shared_.targets.put(handed);
    shared_.ticks.push(tick);
    const std::int64_t took = cpu_now_ns() - cpu;
    report_.tick_cpu.add(took);
    report_.tick_cpu_by_contacts[std::bit_width(tick.contacts)].add(took);
    report_.tick_wall.add(steady_now_ns() - now);
    ++report_.ticks;
  }

  SharedSession& shared_;
  ForceLoop& loop_;
  std::span<Device* const> devices_;
  std::vector<detail::TargetLead> leads_;
  double lead_;  // [s]
  std::int64_t period_ns_;
  std::int64_t empty_ns_;
  std::int64_t duration_ns_;
  bool real_time_;
  WallSessionReport& report_;
  std::uint64_t sequence_ = 0;
};

/// The contact loop's thread.
class ContactThread {
 public:
  ContactThread(SharedSession& shared, ContactLoop& loop, std::int64_t period_ns,
                const WallSessionOptions& wall, WallSessionReport& report)
      : shared_(shared), loop_(loop), period_ns_(period_ns), wall_(wall), report_(report) {}

  void run() {
    shared_.guard(1, [this] { run_loop(); });
  }

 private:
  void run_loop() {
    if (wall_.real_time) {
      report_.granted.contact_fifo = detail::take_real_time_priority(kContactPriority);
      report_.granted.contact_processor = detail::bind_to_processor(1);
    }
    std::int64_t next = steady_now_ns();
    while (!shared_.is_over.load(std::memory_order_relaxed)) {
      sleep_until_ns(next);
      const std::int64_t cpu = cpu_now_ns();
      const HandedTargets handed = shared_.targets.newest();
      if (handed.sequence > 0) {
        make_cycle(handed);
      }
      next = std::max(next + period_ns_, steady_now_ns() + rest_after(cpu_now_ns() - cpu));
    }
  }

  /// [ns]  The least time until the next cycle, after one that took `cpu` of processor time.
  [[nodiscard]] std::int64_t rest_after(std::int64_t cpu) const {
    return report_.granted.contact_fifo ? std::llround(kRestOfCycle * static_cast<double>(cpu)) : 0;
  }

  void make_cycle(const HandedTargets& handed) {
    const std::int64_t cpu = cpu_now_ns();
    const std::int64_t begin = steady_now_ns();
    count_delay(begin);
    const WallClock::time_point deadline(std::chrono::nanoseconds(begin + period_ns_));
    const HapticCycle& cycle =
        loop_.advance({.poses = std::span(handed.targets).first(loop_.scene().tools.size()),
                       .joints = std::span(handed.joints).first(handed.joint_count)},
                      1e-9 * static_cast<double>(period_ns_), handed.time_ns, deadline);
    report_.cycle_wall.add(steady_now_ns() - begin);
    const std::int64_t took = cpu_now_ns() - cpu;
    report_.cycle_cpu.add(took);
    if (wall_.contact_delay_ns > 0) {
      sleep_until_ns(steady_now_ns() + wall_.contact_delay_ns);
    }
    HapticContactSet set = loop_.contact_set();
    set.lasted_ns = begin + period_ns_ - handed.time_ns;
    set.checksum = checksum_of(set);
    shared_.sets.put(set);
    ++report_.cycles;
    const std::lock_guard lock(shared_.cycles_mutex);
    shared_.cycles.emplace_back(cycle, handed.time_ns);
    shared_.cycles.back().first.processor_time = 1e-9 * static_cast<double>(took);
  }

  /// Counts the time by which courses fall behind the wall clock: they move on by a period a cycle.
  void count_delay(std::int64_t begin) {
    if (!std::ranges::any_of(loop_.scene().bodies,
                             [](const HapticBody& body) { return body.course.has_value(); })) {
      return;
    }
    report_.behind_ns += begin_ ? begin - *begin_ - period_ns_ : 0;
    begin_ = begin;
  }

  SharedSession& shared_;
  ContactLoop& loop_;
  std::int64_t period_ns_;
  const WallSessionOptions& wall_;
  WallSessionReport& report_;
  std::optional<std::int64_t> begin_;  // [ns]  Begin of the last cycle.
};

/// Hands the new ticks and cycles to the caller.
void hand_over(SharedSession& shared, const std::function<void(const ForceTick&)>& on_tick,
               const std::function<void(const HapticCycle&, std::int64_t)>& on_cycle) {
  ForceTick tick;
  // At most as many as the ring has room for: a caller that is too slow must still see the stop.
  for (std::size_t k = 0; k < kRing && shared.ticks.pop(tick); ++k) {
    if (on_tick) {
      on_tick(tick);
    }
  }
  std::deque<std::pair<HapticCycle, std::int64_t>> cycles;
  {
    const std::lock_guard lock(shared.cycles_mutex);
    cycles.swap(shared.cycles);
  }
  for (const auto& [cycle, time_ns] : cycles) {
    if (on_cycle) {
      on_cycle(cycle, time_ns);
    }
  }
}

/// Puts the contacts at the start as those of a tick before the first one. The first tick would
/// otherwise have no set, and be stale.
void put_contacts_at_start(const ContactLoop& contacts, std::int64_t empty_ns,
                           std::int64_t period_ns, SharedSession& shared) {
  HapticContactSet set = contacts.contact_set();
  set.stamp_ns = steady_now_ns() + empty_ns - period_ns;
  set.checksum = checksum_of(set);
  shared.sets.put(set);
}

/// The mappings of a session, each with the abilities of its device.
std::vector<DeviceMapping> mappings_of(const HapticScene& scene,
                                       const HapticSessionOptions& options,
                                       std::span<Device* const> devices) {
  std::vector<DeviceMapping> mappings = complete_mappings(scene, options.mappings);
  for (std::size_t k = 0; k < mappings.size(); ++k) {
    mappings[k].device = devices[k]->capabilities();
  }
  return mappings;
}

/// Ends both threads, even where the caller's functions throw.
class RunningThreads {
 public:
  RunningThreads(SharedSession& shared, ForceThread& force, ContactThread& contact)
      : shared_(shared),
        contact_([&contact] { contact.run(); }),
        force_([&force] { force.run(); }) {}
  ~RunningThreads() {
    shared_.is_over = true;
    force_.join();
    contact_.join();
  }
  RunningThreads(const RunningThreads&) = delete;
  RunningThreads& operator=(const RunningThreads&) = delete;

 private:
  SharedSession& shared_;
  std::thread contact_;
  std::thread force_;
};

}  // namespace

WallSessionReport run_wall_session(
    HapticScene scene, const HapticSessionOptions& options, std::span<Device* const> devices,
    const WallSessionOptions& wall, const std::function<void(const ForceTick&)>& on_tick,
    const std::function<void(const HapticCycle&, std::int64_t)>& on_cycle,
    const std::stop_token& stop) {
  if (!(wall.duration > 0.0 && wall.duration <= 1e9 && wall.empty_duration >= 0.0) ||
      wall.contact_delay_ns < 0) {
    throw std::invalid_argument(
        "WallSessionOptions: the duration must be > 0 and at most 1e9 s, the empty duration and "
        "the delay >= 0");
  }
  if (devices.size() != scene.tools.size()) {
    throw std::invalid_argument("a device for each tool was expected");
  }
  HapticSessionOptions without_latency = options;
  without_latency.contact_latency_ns = 0;
  const detail::SessionPeriods periods = detail::session_periods(without_latency);
  const std::vector<DeviceMapping> mappings = mappings_of(scene, options, devices);
  ForceLoop forces(scene, mappings, options.forces);
  ContactLoop contacts(std::move(scene), options.contacts);
  const auto shared = std::make_unique<SharedSession>();
  WallSessionReport report;
  report.granted.locked_memory = wall.real_time && detail::lock_memory();
  {
    const auto duration_ns = static_cast<std::int64_t>(1e9 * wall.duration);
    const auto empty_ns =
        static_cast<std::int64_t>(1e9 * std::min(wall.empty_duration, wall.duration));
    put_contacts_at_start(contacts, empty_ns, periods.force_ns, *shared);
    ForceThread force(*shared, forces, devices, {mappings.begin(), mappings.end()}, periods,
                      empty_ns, duration_ns, wall.real_time, report);
    ContactThread contact(*shared, contacts, periods.cycle_ns, wall, report);
    const RunningThreads threads(*shared, force, contact);
    while (!shared->force_is_done) {
      hand_over(*shared, on_tick, on_cycle);
      if (stop.stop_requested()) {
        shared->is_over = true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  hand_over(*shared, on_tick, on_cycle);
  report.unread_ticks = shared->ticks.dropped();
  if (report.granted.locked_memory) {
    detail::unlock_memory();
  }
  for (const std::exception_ptr& failure : shared->failures) {
    if (failure) {
      std::rethrow_exception(failure);
    }
  }
  return report;
}

}  // namespace firstcontact
