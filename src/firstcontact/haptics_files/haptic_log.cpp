#include <firstcontact/haptics_files/haptic_log.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <concepts>
#include <span>
#include <string_view>
#include <utility>

namespace firstcontact {
namespace {

/// A line of numbers and words with commas between them.
class CsvLine {
 public:
  CsvLine& add(std::string_view word) {
    text_ += text_.empty() ? "" : ",";
    text_ += word;
    return *this;
  }
  /// Adds a number in its shortest form that reads back to the same number.
  template <class Number>
  requires std::integral<Number> || std::floating_point<Number> CsvLine& add(Number number) {
    std::array<char, 40> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    return add(std::string_view(digits.data(), static_cast<std::size_t>(end - digits.data())));
  }
  CsvLine& add(const Eigen::Vector3d& vector) {
    return add(vector.x()).add(vector.y()).add(vector.z());
  }
  CsvLine& add(std::span<const double> numbers) {
    for (const double number : numbers) {
      add(number);
    }
    return *this;
  }
  CsvLine& add(const Pose& pose) {
    const Eigen::Quaterniond& q = pose.rotation;
    return add(pose.position).add(q.w()).add(q.x()).add(q.y()).add(q.z());
  }
  [[nodiscard]] std::string take() { return std::move(text_) + "\n"; }

 private:
  std::string text_;
};

/// Names of columns, each behind a comma: "grip0" and so on.
std::string numbered(const char* name, std::size_t count) {
  std::string text;
  for (std::size_t k = 0; k < count; ++k) {
    text += std::string(",") + name + std::to_string(k);
  }
  return text;
}

}  // namespace

std::string fault_words(std::uint32_t faults) {
  std::string words;
  for (std::size_t k = 0; k < kForceFaultWords.size(); ++k) {
    if ((faults >> k & 1U) != 0) {
      words += words.empty() ? "" : "|";
      words += kForceFaultWords[k];
    }
  }
  return words;
}

GripColumns grip_columns(const HapticScene& scene, const HapticSessionOptions& options) {
  GripColumns columns;
  for (const DeviceMapping& mapping : options.mappings) {
    columns.grips = std::max(columns.grips, mapping.grips.size());
  }
  for (const HapticTool& tool : scene.tools) {
    columns.joints += tool.joints.size();
  }
  return columns;
}

std::string haptic_tick_header(const GripColumns& columns) {
  return "time_ns,tool,status,sequence,sample_ns,buttons,device_px,device_py,device_pz,device_qw,"
         "device_qx,device_qy,device_qz,target_px,target_py,target_pz,target_qw,target_qx,"
         "target_qy,target_qz,force_x,force_y,force_z,torque_x,torque_y,torque_z,command_fx,"
         "command_fy,command_fz,command_tx,command_ty,command_tz,faults,set,age_ns,contacts,"
         "pressing,pivots" +
         numbered("grip", columns.grips) + numbered("command_g", columns.grips) +
         numbered("target_j", columns.joints) + numbered("effort_j", columns.joints) + "\n";
}

std::string haptic_tick_lines(const ForceTick& tick, std::size_t tools,
                              const GripColumns& columns) {
  std::string lines;
  for (std::size_t k = 0; k < tools; ++k) {
    const ToolTick& tool = tick.tools[k];
    CsvLine line;
    line.add(tick.time_ns)
        .add(k)
        .add(kDeviceStatusWords.at(static_cast<std::size_t>(tool.device.status)))
        .add(tool.device.sequence)
        .add(tool.device.time_ns)
        .add(tool.device.buttons)
        .add(tool.device.X_DH)
        .add(tool.target)
        .add(tool.device_force_W())
        .add(tool.torque_W)
        .add(tool.command.force_D)
        .add(tool.command.torque_D)
        .add(std::string_view(fault_words(tool.faults)))
        .add(tick.set)
        .add(tick.age_ns)
        .add(tick.contacts)
        .add(tick.pressing)
        .add(tick.pivots);
    line.add(std::span(tool.grips).first(columns.grips))
        .add(std::span(tool.command.grips).first(columns.grips))
        .add(std::span(tick.joint_targets).first(columns.joints))
        .add(std::span(tick.joint_efforts).first(columns.joints));
    lines += line.take();
  }
  return lines;
}

std::string haptic_cycle_header(const GripColumns& columns) {
  return "cycle,time_ns,asked_s,lasted_s,clearance_m,rounds,converged,late,residual_m,contacts,"
         "angle_rad,processor_s" +
         numbered("joint", columns.joints) + "\n";
}

std::string haptic_cycle_line(const HapticCycle& cycle, std::int64_t time_ns) {
  CsvLine line;
  line.add(cycle.index)
      .add(time_ns)
      .add(cycle.asked)
      .add(cycle.lasted)
      .add(cycle.clearance)
      .add(cycle.rounds)
      .add(cycle.is_converged ? 1 : 0)
      .add(cycle.is_late ? 1 : 0)
      .add(cycle.residual)
      .add(cycle.contacts)
      .add(cycle.angle);
  if (cycle.processor_time) {
    line.add(*cycle.processor_time);
  } else {
    line.add("");
  }
  line.add(std::span(cycle.joints));
  return line.take();
}

std::string haptic_timing_csv(const WallSessionReport& report) {
  std::string text = "what,from_ns,count\n";
  const auto add = [&](std::string_view what, const TimingHistogram& histogram) {
    for (std::size_t k = 0; k < TimingHistogram::kBuckets; ++k) {
      if (histogram.count_of(k) > 0) {
        CsvLine line;
        line.add(what).add(TimingHistogram::begin_of(k)).add(histogram.count_of(k));
        text += line.take();
      }
    }
  };
  add("tick_cpu", report.tick_cpu);
  for (std::size_t k = 0; k < kContactClasses; ++k) {
    add("tick_cpu_contacts_" + std::to_string(least_contacts(k)), report.tick_cpu_by_contacts[k]);
  }
  add("tick_wall", report.tick_wall);
  add("tick_delay", report.tick_delay);
  add("empty_delay", report.empty_delay);
  add("cycle_wall", report.cycle_wall);
  add("cycle_cpu", report.cycle_cpu);
  return text;
}

}  // namespace firstcontact
