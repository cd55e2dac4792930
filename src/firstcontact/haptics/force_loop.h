/// @file
/// The force loop: the forces on the hand, tick by tick, from the newest set of contacts.

#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/haptic_devices/device.h>
#include <firstcontact/haptics/contact_set.h>
#include <firstcontact/haptics/haptic_scene.h>
#include <firstcontact/math/export.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact {

/// A value of a device that moves joints of its tool: at 0 they are open, at 1 closed.
struct GripMapping {
  struct Joint {
    std::size_t joint = 0;  ///< Index of the joint of the tool.
    double open = 0.0;      ///< [rad or m]  Position where the value is 0.
    double closed = 0.0;    ///< [rad or m]  Position where the value is 1.
  };
  std::vector<Joint> joints;
  /// Button that closes the grip while it is pressed, else the grip opens; -1: by the device.
  int button = -1;
  double seconds = 0.5;  ///< [s]  Time from open to closed by the button; > 0.
};

/// The map from the pose of a device's handle H to the pose of the body B of its tool.
///
/// The motion of the handle from a reference pose is turned by R_WD, and its translation is scaled.
/// The map adds it to the reference pose of the body, at first the start of the tool. The
/// translation moves the centre of the tool, and the tool turns about its centre. When the
/// clutch is let go, the poses of handle and god-object become the references. So a clutch never
/// moves a tool through a wall.
struct DeviceMapping {
  DeviceKind kind = DeviceKind::pose;
  Eigen::Quaterniond R_WD = Eigen::Quaterniond::Identity();
  double scale = 1.0;             ///< [-]  Motion of the tool per motion of the handle; > 0.
  Pose X_DH = {};                 ///< Reference pose of the handle at the start.
  bool begins_at_handle = false;  ///< Whether the first live pose is the reference instead.
  /// Button that keeps the tool in place without a force while it is pressed; -1: none.
  int clutch_button = -1;
  int dead_man_button = -1;  ///< Button that does the same while it is not pressed; -1: none.
  /// Mappings of the device's values in order; at most kMostGrips.
  std::vector<GripMapping> grips = {};
  /// The device, whose abilities limit commands; without one, commands are as they are asked for.
  /// While its reading trembles by a step of its resolution, the target is the mean of readings.
  std::optional<DeviceCapabilities> device = {};
};

/// The limits of the force on a hand, for any scene.
struct HapticLimits {
  double force = 10.0;           ///< [N]  Length of the force; >= 0.
  double torque = 0.5;           ///< [N m]  Length of the torque; >= 0.
  double force_slew = 20'000.0;  ///< [N/s]  Rate of change of the force; > 0.
  double torque_slew = 1'000.0;  ///< [N m/s]  Rate of change of the torque; > 0.
  /// [J]  Effort of each grip; >= 0. It changes by at most 2000 times this a second.
  double grip_effort = 1.0;
  std::int64_t fresh_ns = 50'000'000;   ///< [ns]  Age up to which a contact set acts in full.
  std::int64_t stale_ns = 150'000'000;  ///< [ns]  Age from which it acts no more; >= fresh_ns.
  std::int64_t ramp_ns = 200'000'000;   ///< [ns]  Time over which forces grow after an engagement.
};

/// The options of a force loop.
struct ForceLoopOptions {
  HapticLimits limits = {};
  /// [m]  Tolerance of the projection; > 0. Where the widest gap of the contacts is below
  /// 1000 times this, a thousandth of the gap.
  double tolerance = 1e-9;
  int pivots = 64;  ///< Most pivots of the projection; > 0.
};

/// A reason why a force is not that of the spring. Bits of ToolTick::faults.
enum class ForceFault : std::uint32_t {
  device = 1,  ///< The device is waiting, silent, lost or ended: the force is 0 at once.
  /// A number of the device is not finite, or beyond 1e6 [m, m/s, rad/s]: the force is 0 at once.
  not_finite = 2,
  disengaged = 4,  ///< The clutch or the dead man's button disengages the tool.
  ramping = 8,     ///< Less than the ramp has passed since the last engagement.
  stale = 16,      ///< The contact set is older than fresh.
  limited = 32,    ///< The force or the torque was cut to its limit.
  slewed = 64,     ///< The change of the force or the torque was cut to its limit.
  unsolved = 128,  ///< The projection ended before its tolerance.
  unproven = 256,  ///< The tool stays, as no part of its motion could be proven.
};

/// The words of `ForceFault` in files, in its order.
inline constexpr std::array<const char*, 9> kForceFaultWords{"device",  "not_finite", "disengaged",
                                                             "ramping", "stale",      "limited",
                                                             "slewed",  "unsolved",   "unproven"};

/// A tick of one tool.
struct ToolTick {
  DeviceState device;
  Pose target;                                         ///< The pose X_WB that the device wants.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();    ///< [m]  Centre of the tool there, world.
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();   ///< [N]    Of the spring, at that centre.
  Eigen::Vector3d torque_W = Eigen::Vector3d::Zero();  ///< [N m]  About that centre.
  double scale = 1.0;  ///< [-]  DeviceMapping::scale: the device feels this times the force.
  /// The force and the torque for the device, with components that it does not drive.
  ForceCommand asked = {};
  /// The same, cut to what the device drives (DeviceMapping::device).
  ForceCommand command = {};
  std::uint32_t faults = 0;  ///< Bits of ForceFault.
  /// [-]  Values of grips in force: by the device, or by buttons.
  std::array<double, kMostGrips> grips{};

  /// [N]  The force on the device, world axes.
  [[nodiscard]] Eigen::Vector3d device_force_W() const { return scale * force_W; }
};

/// A tick of the force loop.
struct ForceTick {
  std::int64_t time_ns = 0;
  std::array<ToolTick, kMostTools> tools = {};
  std::uint32_t joints = 0;  ///< Number of joints of all tools.
  /// [rad or m]  Positions that devices want.
  std::array<double, kMostHapticJoints> joint_targets = {};
  /// [N m or N]  Efforts of contacts that are felt.
  std::array<double, kMostHapticJoints> joint_efforts = {};
  std::uint64_t set = 0;       ///< Sequence number of the contact set; 0 for none.
  std::int64_t age_ns = 0;     ///< [ns]  Age of the contact set.
  std::uint32_t contacts = 0;  ///< Number of contacts of the set.
  std::uint32_t pressing = 0;  ///< Number of contacts that press, with limits of joints.
  std::uint32_t pivots = 0;
};

/// Computes forces from device poses and the newest contact set.
///
/// A force is that of the spring between the target and the place to which contacts let the
/// god-object go. It is the sum of contact forces in Coulomb's cones. It is exactly 0 where no
/// contact presses, however far the god-object lags behind. With damping, target and surfaces are
/// extrapolated by damping / stiffness seconds, so that forces stay in the cones. The effort of a
/// joint is that of its own spring likewise.
///
/// Tools that do not touch each other are solved each for itself. Contacts may contradict each
/// other, or need more pivots (ForceFault::unsolved). Then the force that was solved last stays
/// where contacts press. It is cut to the length of the springs' stretch, plus the path of
/// the surfaces.
///
/// tick() allocates nothing, takes no lock, and makes no system call; its work is bounded.
class FIRSTCONTACT_API ForceLoop {
 public:
  /// Makes the loop of a scene.
  ///
  /// @param mappings  one for each tool
  /// @throws std::invalid_argument if a number is out of its range
  ForceLoop(const HapticScene& scene, const std::vector<DeviceMapping>& mappings,
            const ForceLoopOptions& options = {});
  ~ForceLoop();
  ForceLoop(ForceLoop&&) noexcept;
  ForceLoop& operator=(ForceLoop&&) noexcept;

  /// Runs a tick.
  ///
  /// @param now_ns   never less than before
  /// @param devices  one for each tool
  const ForceTick& tick(std::int64_t now_ns, const HapticContactSet& set,
                        std::span<const DeviceState> devices) noexcept;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace firstcontact
