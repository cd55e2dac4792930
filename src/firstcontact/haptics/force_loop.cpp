#include <firstcontact/haptics/force_loop.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <firstcontact/haptics/detail/contact_coordinates.h>
#include <firstcontact/haptics/detail/contact_forces.h>
#include <firstcontact/haptics/detail/god_object_plan.h>
#include <firstcontact/haptics/detail/grip_follower.h>
#include <firstcontact/haptics/detail/target_follower.h>
#include <firstcontact/haptics/detail/tool_links.h>

namespace firstcontact {
namespace {

using detail::Coordinates;
using Eigen::Vector3d;

constexpr double kNanosecond = 1e-9;  // [s]
// [-]  Greatest scale of a mapping, so that doubles resolve targets.
constexpr double kMostScale = 1e6;

/// [s]  Longest time of a tick in which forces grow: the loop does not make up for a longer pause.
/// It is the period of the lowest rate (kLeastForceRate).
constexpr double kLongestTick = 0.01;

/// [s]  Time over which velocities are smoothed, for damping.
constexpr double kSmoothing = 0.002;

std::uint32_t bit(ForceFault fault) noexcept { return static_cast<std::uint32_t>(fault); }

bool is_positive_number(double x) { return x > 0.0 && x < std::numeric_limits<double>::infinity(); }

void check_options(const HapticScene& scene, const std::vector<DeviceMapping>& mappings,
                   const ForceLoopOptions& options) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) {
      throw std::invalid_argument(what);
    }
  };
  require(!scene.tools.empty() && scene.tools.size() <= kMostTools,
          "a haptic scene has 1 or 2 tools");
  require(mappings.size() == scene.tools.size(), "each tool needs the mapping of its device");
  for (const HapticTool& tool : scene.tools) {
    require(is_positive_number(tool.coupling.stiffness) &&
                is_positive_number(tool.coupling.angular_stiffness),
            "HapticCoupling: stiffnesses must be > 0");
    require(tool.coupling.damping >= 0.0 && is_positive_number(1.0 + tool.coupling.damping),
            "HapticCoupling::damping must be >= 0");
  }
  for (const DeviceMapping& mapping : mappings) {
    require(is_positive_number(mapping.scale) && mapping.scale <= kMostScale,
            "DeviceMapping::scale must be > 0 and at most 1e6");
    require(is_positive_number(mapping.R_WD.squaredNorm()) &&
                is_positive_number(mapping.X_DH.rotation.squaredNorm()) &&
                mapping.X_DH.position.allFinite(),
            "DeviceMapping: its poses must be finite");
    require(mapping.clutch_button < 32 && mapping.dead_man_button < 32,
            "DeviceMapping: a device has at most 32 buttons");
  }
  for (std::size_t k = 0; k < mappings.size(); ++k) {
    detail::check_grips(mappings[k].grips, scene.tools[k]);
  }
  const HapticLimits& limits = options.limits;
  require(limits.force >= 0.0 && is_positive_number(1.0 + limits.force) && limits.torque >= 0.0 &&
              is_positive_number(1.0 + limits.torque),
          "HapticLimits: force and torque must be >= 0");
  require(limits.grip_effort >= 0.0 && is_positive_number(1.0 + limits.grip_effort),
          "HapticLimits::grip_effort must be >= 0");
  require(is_positive_number(limits.force_slew) && is_positive_number(limits.torque_slew),
          "HapticLimits: slews must be > 0");
  require(limits.fresh_ns >= 0 && limits.stale_ns >= limits.fresh_ns && limits.ramp_ns >= 0,
          "HapticLimits: 0 <= fresh_ns <= stale_ns, and ramp_ns >= 0");
  require(is_positive_number(options.tolerance) && options.pivots > 0,
          "ForceLoopOptions: tolerance and pivots must be > 0");
}

/// A force and its torque about a point.
struct Wrench {
  Vector3d force = Vector3d::Zero();   // [N]
  Vector3d torque = Vector3d::Zero();  // [N m]
};

/// [-]  The fraction of a vector that is no longer than `most`.
double part_within(double most, const Vector3d& vector) noexcept {
  const double length = vector.norm();
  return length > most ? most / length : 1.0;
}

/// Cuts both by the same fraction: so the wrench stays one of contacts. A limit of 0 removes its
/// part instead, as a device without torque still has its force.
bool cut_to(double force, double torque, Wrench& wrench) noexcept {
  const double by_force = force > 0.0 ? part_within(force, wrench.force) : 1.0;
  const double by_torque = torque > 0.0 ? part_within(torque, wrench.torque) : 1.0;
  const double part = std::min(by_force, by_torque);
  const bool is_left_out = (!(force > 0.0) && !wrench.force.isZero(0.0)) ||
                           (!(torque > 0.0) && !wrench.torque.isZero(0.0));
  wrench.force *= force > 0.0 ? part : 0.0;
  wrench.torque *= torque > 0.0 ? part : 0.0;
  return part < 1.0 || is_left_out;
}

/// Limits the change of a wrench, along the direction of the change.
bool slew_to(double force, double torque, const Wrench& before, Wrench& wrench) noexcept {
  const Vector3d change = wrench.force - before.force;
  const Vector3d turn = wrench.torque - before.torque;
  const double part = std::min(part_within(force, change), part_within(torque, turn));
  if (!(part < 1.0)) {
    return false;
  }
  wrench = {before.force + part * change, before.torque + part * turn};
  return true;
}

}  // namespace

namespace detail {

/// The state of a tool that is kept from tick to tick.
struct FeltTool {
  FeltTool(TargetFollower its, GripFollower of_grips)
      : follower(std::move(its)), grips(std::move(of_grips)) {}

  TargetFollower follower;
  GripFollower grips;
  Vector3d p_BC = Vector3d::Zero();  // [m]
  double stiffness = 0.0;            // [N/m]
  double look_ahead = 0.0;           // [s]  Damping by stiffness.
  double scale = 1.0;                // [-]
  std::optional<DeviceCapabilities> device = {};
  Eigen::Quaterniond R_DW = Eigen::Quaterniond::Identity();
  Pose last_target;
  bool has_last = false;
  Vector3d velocity = Vector3d::Zero();  // [m/s]  Velocity of the target, smoothed.
  Vector3d turning = Vector3d::Zero();   // [rad/s]  Angular velocity of the target, smoothed.
  bool is_felt = false;                  // Whether it was engaged in the last tick.
  double share = 0.0;                    // [-]  The fraction of its limited force that acts.
  std::optional<std::int64_t> left_ns;   // [ns]  End of the last engagement.
};

}  // namespace detail

class ForceLoop::Implementation {
 public:
  Implementation(const HapticScene& scene, const std::vector<DeviceMapping>& mappings,
                 const ForceLoopOptions& options)
      : options_(options),
        links_(std::make_unique<detail::ToolLinks>(scene.tools)),
        contacts_(scene.tools, *links_, options),
        first_stiffness_(scene.tools[0].coupling.stiffness) {
    tick_.joints = static_cast<std::uint32_t>(links_->joints().size());
    for (std::size_t joint = 0; joint < tick_.joints; ++joint) {
      tick_.joint_targets[joint] = links_->joints()[joint].start;
    }
    for (std::size_t k = 0; k < scene.tools.size(); ++k) {
      const HapticTool& tool = scene.tools[k];
      DeviceMapping mapping = mappings[k];
      mapping.R_WD.normalize();
      mapping.X_DH.rotation.normalize();
      const Pose start{tool.X_WB.position, tool.X_WB.rotation.normalized()};
      detail::FeltTool felt{detail::TargetFollower(mapping, start, tool.p_BC),
                            detail::GripFollower(mapping.grips, k, *links_)};
      felt.p_BC = tool.p_BC;
      felt.stiffness = tool.coupling.stiffness;
      felt.look_ahead = tool.coupling.damping / tool.coupling.stiffness;
      felt.scale = mapping.scale;
      felt.device = mapping.device;
      felt.R_DW = mapping.R_WD.conjugate();
      tools_.push_back(std::move(felt));
      tick_.tools[k].target = start;
      tick_.tools[k].scale = mapping.scale;
      tick_.tools[k].centre = detail::centre_at(start, tool.p_BC);
    }
  }

  const ForceTick& tick(std::int64_t now_ns, const HapticContactSet& set,
                        std::span<const DeviceState> devices) noexcept {
    const double passed =
        has_ticked_ ? std::max(0.0, kNanosecond * static_cast<double>(now_ns - tick_.time_ns))
                    : 0.0;
    const double seconds = std::min(passed, kLongestTick);
    has_ticked_ = true;
    tick_.time_ns = now_ns;
    tick_.set = set.sequence;
    tick_.age_ns = now_ns - set.stamp_ns;
    tick_.contacts = set.count;
    if (set.sequence != taken_) {
      taken_ = set.sequence;
      contacts_.take(set);
    }
    for (std::size_t k = 0; k < tools_.size() && k < devices.size(); ++k) {
      ToolTick& tick = tick_.tools[k];
      tick.device = devices[k];
      follow(k, devices[k], set, seconds);
      measure_velocity(tools_[k], passed);
    }
    const detail::ContactForce projected =
        contacts_.project(set, wanted(set), seconds_since(set, now_ns));
    tick_.pressing = static_cast<std::uint32_t>(projected.pressing);
    tick_.pivots = static_cast<std::uint32_t>(projected.pivots);
    for (std::size_t k = 0; k < tools_.size(); ++k) {
      if (!projected.is_solved[k]) {
        tick_.tools[k].faults |= bit(ForceFault::unsolved);
      }
      if (set.is_unproven) {
        tick_.tools[k].faults |= bit(ForceFault::unproven);
      }
      set_share(tools_[k], seconds, tick_.tools[k].faults);
      give_force(k, projected.force, seconds);
      give_efforts(k, projected.force, seconds);
      give_command(k);
    }
    return tick_;
  }

 private:
  /// Follows the device of a tool, and its grips.
  void follow(std::size_t k, const DeviceState& device, const HapticContactSet& set,
              double seconds) noexcept {
    detail::FeltTool& tool = tools_[k];
    ToolTick& tick = tick_.tools[k];
    const Pose god_object = set.sequence > 0 ? set.X_WB[k] : tick.target;
    const bool was_engaged = tool.follower.is_engaged();
    const bool still_follows = set.sequence > 0 && tool.left_ns && set.stamp_ns < *tool.left_ns;
    tool.follower.follow(device, god_object, seconds, still_follows);
    const bool is_engaged = tool.follower.is_engaged();
    if (was_engaged && !is_engaged) {
      tool.left_ns = tick_.time_ns;
    }
    tick.target = tool.follower.target();
    tick.centre = detail::centre_at(tick.target, tool.p_BC);
    tick.faults = tool.follower.faults();
    tool.grips.follow(device, is_engaged, set, seconds, still_follows, tick.grips,
                      tick_.joint_targets);
  }

  static void measure_velocity(detail::FeltTool& tool, double seconds) noexcept {
    const Pose& target = tool.follower.target();
    if (!tool.follower.is_engaged() || !tool.has_last || !(seconds > 0.0)) {
      tool.velocity.setZero();
      tool.turning.setZero();
    } else {
      const double part = seconds / (kSmoothing + seconds);
      const Vector3d way =
          detail::centre_at(target, tool.p_BC) - detail::centre_at(tool.last_target, tool.p_BC);
      tool.velocity += part * (way / seconds - tool.velocity);
      tool.turning +=
          part * (detail::turn_between(tool.last_target.rotation, target.rotation) / seconds -
                  tool.turning);
    }
    tool.last_target = target;
    tool.has_last = tool.follower.is_engaged();
  }

  /// [s]  Computes the time for which surfaces have moved on since the places in a set; negative
  /// while its cycle is not over. Surfaces of a set that is not fresh stop.
  [[nodiscard]] double seconds_since(const HapticContactSet& set,
                                     std::int64_t now_ns) const noexcept {
    const std::int64_t most = std::max(options_.limits.fresh_ns, set.lasted_ns);
    const std::int64_t age = std::clamp<std::int64_t>(now_ns - set.stamp_ns, 0, most);
    return kNanosecond * static_cast<double>(age - set.lasted_ns);
  }

  /// Computes the way from the places in a set to the targets, in the coordinates of the metric.
  [[nodiscard]] Coordinates wanted(const HapticContactSet& set) const noexcept {
    const detail::ToolFrames& frames = contacts_.frames();
    Coordinates wanted{};
    for (std::size_t k = 0; k < tools_.size(); ++k) {
      const detail::FeltTool& tool = tools_[k];
      // A tool that is not engaged is held by its spring: the other tool may push it.
      const Pose& target = tool.follower.target();
      const Vector3d way = tick_.tools[k].centre - set.p_WC[k] + tool.look_ahead * tool.velocity;
      const Vector3d turn = detail::turn_between(set.X_WB[k].rotation, target.rotation) +
                            tool.look_ahead * tool.turning;
      for (int i = 0; i < 3; ++i) {
        const auto at = 6 * k + static_cast<std::size_t>(i);
        wanted[at] = frames.weights[k] * way[i];
        wanted[at + 3] = frames.weights[k] * frames.lengths[k] * turn[i];
      }
    }
    for (std::size_t joint = 0; joint < links_->joints().size(); ++joint) {
      wanted[links_->coordinate_of(joint)] =
          frames.joint_weights[joint] * (tick_.joint_targets[joint] - set.joints[joint]);
    }
    return wanted;
  }

  /// [-]  The fraction of a force that the age of the set permits.
  [[nodiscard]] double share_of_age() const noexcept {
    const HapticLimits& limits = options_.limits;
    if (tick_.age_ns <= limits.fresh_ns) {
      return 1.0;
    }
    return tick_.age_ns >= limits.stale_ns
               ? 0.0
               : static_cast<double>(limits.stale_ns - tick_.age_ns) /
                     static_cast<double>(limits.stale_ns - limits.fresh_ns);
  }

  /// Sets the share of a tool. The share falls at once. It grows by the ramp: after an engagement,
  /// and where a set is fresh again.
  void set_share(detail::FeltTool& tool, double seconds, std::uint32_t& faults) const noexcept {
    if (!tool.follower.is_engaged()) {
      tool.is_felt = false;
      tool.share = 0.0;
      return;
    }
    const double ramp = kNanosecond * static_cast<double>(options_.limits.ramp_ns);
    const double growth = tool.is_felt ? seconds : 0.0;
    const double grown = ramp > 0.0 ? tool.share + growth / ramp : 1.0;
    const double allowed = share_of_age();
    faults |= allowed < 1.0 ? bit(ForceFault::stale) : 0U;
    faults |= grown < allowed ? bit(ForceFault::ramping) : 0U;
    tool.share = std::min(grown, allowed);
    tool.is_felt = true;
  }

  /// Whether a force ends at once, as the device is lost or a number is not finite.
  static bool ends_at_once(const ToolTick& tick) noexcept {
    constexpr std::uint32_t kAtOnce = static_cast<std::uint32_t>(ForceFault::device) |
                                      static_cast<std::uint32_t>(ForceFault::not_finite);
    return (tick.faults & kAtOnce) != 0;
  }

  /// Computes the wrench of contacts on a tool, about the centre of its target.
  [[nodiscard]] Wrench wrench_of(std::size_t k, const Coordinates& force) const noexcept {
    const detail::FeltTool& tool = tools_[k];
    Wrench wrench;
    if (!tool.follower.is_engaged()) {
      return wrench;
    }
    const detail::ToolFrames& frames = contacts_.frames();
    // Coordinates are weights times metres, and a unit of force is the first tool's stiffness.
    const double factor = tool.stiffness / frames.weights[k];
    for (int i = 0; i < 3; ++i) {
      const auto at = 6 * k + static_cast<std::size_t>(i);
      wrench.force[i] = factor * force[at];
      wrench.torque[i] = factor * frames.lengths[k] * force[at + 3];
    }
    return wrench;
  }

  void give_force(std::size_t k, const Coordinates& force, double seconds) noexcept {
    ToolTick& tick = tick_.tools[k];
    const detail::FeltTool& tool = tools_[k];
    if (ends_at_once(tick)) {
      set_force(tick, tool, Vector3d::Zero(), Vector3d::Zero());
      return;
    }
    const HapticLimits& limits = options_.limits;
    Wrench wrench = wrench_of(k, force);
    // The limits are those of the device, which feels the force times the scale.
    const bool is_limited = cut_to(limits.force / tool.scale, limits.torque, wrench);
    wrench.force *= tool.share;
    wrench.torque *= tool.share;
    const bool is_slewed =
        slew_to(limits.force_slew * seconds / tool.scale, limits.torque_slew * seconds,
                {tick.force_W, tick.torque_W}, wrench);
    tick.faults |= is_limited ? bit(ForceFault::limited) : 0U;
    tick.faults |= is_slewed ? bit(ForceFault::slewed) : 0U;
    if (!wrench.force.allFinite() || !wrench.torque.allFinite()) {
      tick.faults |= bit(ForceFault::not_finite);
      wrench = {};
    }
    set_force(tick, tool, wrench.force, wrench.torque);
  }

  static void set_force(ToolTick& tick, const detail::FeltTool& tool, const Vector3d& force_W,
                        const Vector3d& torque_W) noexcept {
    tick.force_W = force_W;
    tick.torque_W = torque_W;
    tick.asked.force_D = tool.scale * (tool.R_DW * force_W);
    tick.asked.torque_D = tool.R_DW * torque_W;
  }

  /// Computes the efforts of joints, and the efforts on the grips that move them.
  void give_efforts(std::size_t k, const Coordinates& force, double seconds) noexcept {
    ToolTick& tick = tick_.tools[k];
    const detail::FeltTool& tool = tools_[k];
    for (std::size_t joint = 0; joint < links_->joints().size(); ++joint) {
      if (links_->tool_of_joint(joint) == k) {
        const double effort = first_stiffness_ * contacts_.frames().joint_weights[joint] *
                              force[links_->coordinate_of(joint)];
        tick_.joint_efforts[joint] = std::isfinite(effort) ? effort : 0.0;
      }
    }
    const double most = options_.limits.grip_effort;
    constexpr double kSlew = 2000.0;  // [1/s]
    for (std::size_t grip = 0; grip < tool.grips.size(); ++grip) {
      double effort = tool.grips.effort(grip, tick_.joint_efforts);
      if (std::abs(effort) > most) {
        effort = std::clamp(effort, -most, most);
        tick.faults |= bit(ForceFault::limited);
      }
      effort *= tool.share;
      const double before = tick.asked.grips[grip];
      if (!ends_at_once(tick) && std::abs(effort - before) > kSlew * most * seconds) {
        effort =
            std::clamp(effort, before - kSlew * most * seconds, before + kSlew * most * seconds);
        tick.faults |= bit(ForceFault::slewed);
      }
      tick.asked.grips[grip] = effort;
    }
    for (std::size_t joint = 0; joint < links_->joints().size(); ++joint) {
      tick_.joint_efforts[joint] *= links_->tool_of_joint(joint) == k ? tool.share : 1.0;
    }
  }

  /// Cuts a command to what the device drives. Axes that it does not drive are no limit.
  void give_command(std::size_t k) noexcept {
    ToolTick& tick = tick_.tools[k];
    tick.command = tick.asked;
    if (tools_[k].device) {
      const ForceCommand driven = driven_part(tick.asked, *tools_[k].device);
      tick.command = limited(driven, *tools_[k].device);
      const bool is_limited = tick.command.force_D != driven.force_D ||
                              tick.command.torque_D != driven.torque_D ||
                              tick.command.grips != driven.grips;
      tick.faults |= is_limited ? bit(ForceFault::limited) : 0U;
    }
  }

  ForceLoopOptions options_;
  std::unique_ptr<detail::ToolLinks> links_;
  detail::ContactForces contacts_;
  double first_stiffness_ = 0.0;  // [N/m]
  std::vector<detail::FeltTool> tools_;
  std::uint64_t taken_ = 0;
  bool has_ticked_ = false;
  ForceTick tick_;
};

ForceLoop::ForceLoop(const HapticScene& scene, const std::vector<DeviceMapping>& mappings,
                     const ForceLoopOptions& options) {
  check_options(scene, mappings, options);
  implementation_ = std::make_unique<Implementation>(scene, mappings, options);
}
ForceLoop::~ForceLoop() = default;
ForceLoop::ForceLoop(ForceLoop&&) noexcept = default;
ForceLoop& ForceLoop::operator=(ForceLoop&&) noexcept = default;

const ForceTick& ForceLoop::tick(std::int64_t now_ns, const HapticContactSet& set,
                                 std::span<const DeviceState> devices) noexcept {
  return implementation_->tick(now_ns, set, devices);
}

}  // namespace firstcontact
