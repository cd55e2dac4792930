#include "haptic_report.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

#include <firstcontact/haptics_files/haptic_log.h>

#include "quantity_text.h"
#include "terminal_text.h"

namespace firstcontact::app {
namespace {

std::string quantiles(const TimingHistogram& histogram) {
  const auto seconds = [](std::int64_t ns) { return time_text(1e-9 * static_cast<double>(ns)); };
  return fmt::format("median {}, p99 {}, p99.9 {}, greatest {}",
                     seconds(histogram.quantile_ns(0.5)), seconds(histogram.quantile_ns(0.99)),
                     seconds(histogram.quantile_ns(0.999)), seconds(histogram.greatest_ns()));
}

/// A line for each class of contacts that some tick had.
std::string contact_class_lines(const WallSessionReport& wall) {
  std::string text;
  for (std::size_t k = 0; k < kContactClasses; ++k) {
    const TimingHistogram& ticks = wall.tick_cpu_by_contacts[k];
    if (ticks.count() > 0) {
      const std::size_t most = std::min(least_contacts(k + 1) - 1, kMostHapticContacts);
      const std::string contacts = most == least_contacts(k)
                                       ? std::to_string(most)
                                       : fmt::format("{} to {}", least_contacts(k), most);
      text += answer_line("", fmt::format("{} ticks with {} contacts: {}", ticks.count(), contacts,
                                          quantiles(ticks)));
    }
  }
  return text;
}

std::string wall_text(const WallSessionReport& wall) {
  const RealTimeGrant& granted = wall.granted;
  const auto word = [](bool is) { return is ? "yes" : "no"; };
  return answer_line("real time",
                     fmt::format("force loop SCHED_FIFO {}, contact loop {}; own processors {} "
                                 "and {}; memory locked {}",
                                 word(granted.force_fifo), word(granted.contact_fifo),
                                 word(granted.force_processor), word(granted.contact_processor),
                                 word(granted.locked_memory))) +
         answer_line("tick CPU", quantiles(wall.tick_cpu)) + contact_class_lines(wall) +
         answer_line("tick late", quantiles(wall.tick_delay)) +
         answer_line("empty loop", fmt::format("{} ticks, late by {}", wall.empty_delay.count(),
                                               quantiles(wall.empty_delay))) +
         answer_line("cycle", quantiles(wall.cycle_wall)) +
         answer_line("missed",
                     fmt::format("{} ticks began more than a period late, {} were skipped{}",
                                 wall.late_ticks, wall.skipped_ticks,
                                 wall.unread_ticks == 0
                                     ? std::string()
                                     : fmt::format("; {} were not written, as that took too long",
                                                   wall.unread_ticks)));
}

}  // namespace

std::string device_text(const Device& device) {
  const DeviceCapabilities& is = device.capabilities();
  const DeviceCounts counts = device.counts();
  const std::string problem = device.problem();
  return fmt::format("{}{}{}: {} samples, {} missed, {} malformed{}{}", is.name,
                     is.id.empty() ? "" : " ", is.id, counts.samples, counts.missed,
                     counts.malformed, problem.empty() ? "" : "; ", problem);
}

std::string undriven_text(const Device& device) {
  const DeviceCapabilities& is = device.capabilities();
  const auto drives = [](const std::array<bool, 3>& axes) {
    return std::ranges::any_of(axes, [](bool axis) { return axis; });
  };
  const bool has_force = drives(is.driven.linear);
  const bool has_torque = drives(is.driven.angular);
  if (has_force && has_torque) {
    return {};
  }
  return fmt::format("the {} drives {}", is.name.empty() ? "device" : is.name,
                     has_force    ? "no torque"
                     : has_torque ? "no force"
                                  : "none of it");
}

void HapticReport::add(const ForceTick& tick, std::size_t tools) {
  ++ticks_;
  for (std::size_t k = 0; k < tools; ++k) {
    const ToolTick& tool = tick.tools[k];
    // Also forces that the device does not drive.
    force_ = std::max(force_, tool.asked.force_D.norm());
    torque_ = std::max(torque_, tool.asked.torque_D.norm());
    faults_ |= tool.faults;
    for (const double effort : tool.asked.grips) {
      effort_ = std::max(effort_, std::abs(effort));
    }
  }
  has_joints_ = tick.joints > 0;
}

void HapticReport::add(const HapticCycle& cycle) {
  ++cycles_;
  clearance_ = std::min(clearance_, cycle.clearance);
  time_lost_ += cycle.asked - cycle.lasted;
  contacts_ = std::max(contacts_, cycle.contacts);
  touching_ += cycle.contacts > 0 ? 1U : 0U;
  unfinished_ += cycle.is_converged ? 0U : 1U;
}

std::string HapticReport::text(const std::string& scene, bool is_stopped,
                               const std::string& undriven,
                               const std::optional<WallSessionReport>& wall) const {
  std::string text = fmt::format("{}: {}\n", visible(scene),
                                 is_stopped     ? "stopped early"
                                 : cycles_ == 0 ? "no cycle: nothing was felt"
                                                : "felt; no tool passed through anything");
  text += answer_line(
      "ticks", fmt::format("{} of the force loop, {} cycles of the contact loop", ticks_, cycles_));
  text += answer_line("apart", clearance_ > 0.0 ? apart_text(clearance_)
                                                : "not proven: places are too far for doubles");
  text += answer_line("contacts", fmt::format("in {} cycles, at most {}", touching_, contacts_));
  text += answer_line("force", fmt::format("at most {:.4g} N and {:.4g} N m{}{}", force_, torque_,
                                           undriven.empty() ? "" : "; ", undriven));
  if (has_joints_) {
    text +=
        answer_line("grips", fmt::format("at most {:.4g} J, as work from open to closed", effort_));
  }
  if (faults_ != 0) {
    text += answer_line("at times", fault_words(faults_));
  }
  if (unfinished_ > 0) {
    text += answer_line(
        "unfinished",
        fmt::format("{} cycles ended before the tool was where it could be", unfinished_));
  }
  text += answer_line("time lost", time_lost_ > 0.0
                                       ? time_text(time_lost_) +
                                             ": bodies waited for a tool, or turn too fast for the "
                                             "rounds of a cycle"
                                       : "none");
  if (wall && wall->behind_ns > 0) {
    text +=
        answer_line("behind", time_text(1e-9 * static_cast<double>(wall->behind_ns)) +
                                  ": bodies that move, as cycles took longer than their period");
  }
  return wall ? text + wall_text(*wall) : text;
}

}  // namespace firstcontact::app
