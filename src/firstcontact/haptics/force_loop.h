/// @file
/// The force loop: what the hand feels, tick by tick, from the newest set of contacts.

#pragma once

#include <array>
#include <cstdint>
#include <memory>
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
    std::size_t joint = 0;  ///< Of the tool.
    double open = 0.0;      ///< [rad or m]
    double closed = 0.0;    ///< [rad or m]
  };
  std::vector<Joint> joints;
  int button = -1;       ///< While it is pressed the grip closes, else it opens; -1: by the device.
  double seconds = 0.5;  ///< [s]  > 0  From open to closed by the button.
};

/// Where a device's handle H puts the body B of its tool.
///
/// The handle's way from a reference pose is turned by R_WD, its translation scaled, and added to
/// the reference pose of the body: at first the start of the tool. When the clutch is let go, the
/// references are where handle and god-object are then. So a clutch never leads through a wall.
struct DeviceMapping {
  DeviceKind kind = DeviceKind::pose;
  Eigen::Quaterniond R_WD = Eigen::Quaterniond::Identity();
  double scale = 1.0;             ///< [-]  > 0  The tool goes so much farther than the handle.
  Pose X_DH = {};                 ///< Reference of the handle at the start.
  bool begins_at_handle = false;  ///< The first live pose is the reference instead.
  int clutch_button = -1;    ///< While it is pressed the tool stays and no force acts; -1: none.
  int dead_man_button = -1;  ///< Unless it is pressed the same holds; -1: none.
  std::vector<GripMapping> grips = {};  ///< At most kMostGrips: of the device's values in order.
};

/// The limits of what a hand may feel, whatever the scene.
struct HapticLimits {
  double force = 10.0;           ///< [N]  >= 0  Length of the force.
  double torque = 0.5;           ///< [N m]  >= 0
  double force_slew = 20'000.0;  ///< [N/s]  > 0
  double torque_slew = 1'000.0;  ///< [N m/s]  > 0
  double grip_effort = 1.0;      ///< [J]  >= 0  Of each grip; its slew is 2000 of it a second.
  std::int64_t fresh_ns = 50'000'000;   ///< [ns]  A contact set of this age acts in full...
  std::int64_t stale_ns = 150'000'000;  ///< [ns]  ...and one of that age no more; >= fresh_ns.
  std::int64_t ramp_ns = 200'000'000;   ///< [ns]  Forces grow so long after an engagement.
};

struct ForceLoopOptions {
  HapticLimits limits = {};
  double tolerance = 1e-9;  ///< [m]  > 0  Of the projection.
  int pivots = 64;          ///< > 0  Of the projection, at most.
};

/// Why a force is not that of the spring. Bits of ToolTick::faults.
enum class ForceFault : std::uint32_t {
  device = 1,      ///< The device is waiting, silent, lost or ended: the force is 0 at once.
  not_finite = 2,  ///< A number of the device is not finite: the force is 0 at once.
  disengaged = 4,  ///< By the clutch or the dead man's button.
  ramping = 8,     ///< Since the last engagement less than the ramp has passed.
  stale = 16,      ///< The contact set is older than fresh.
  limited = 32,    ///< The force or the torque was cut to its limit.
  slewed = 64,     ///< Its change was.
  unsolved = 128,  ///< The projection ended before its tolerance.
};

/// Their words in files, in this order.
inline constexpr std::array<const char*, 8> kForceFaultWords{
    "device", "not_finite", "disengaged", "ramping", "stale", "limited", "slewed", "unsolved"};

/// A tick of one tool.
struct ToolTick {
  DeviceState device;
  Pose target;                                         ///< X_WB that the device asks for.
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();   ///< [N]    At the target's origin.
  Eigen::Vector3d torque_W = Eigen::Vector3d::Zero();  ///< [N m]  About it.
  ForceCommand asked = {};    ///< The same for the device, also what it does not drive.
  ForceCommand command = {};  ///< That, cut in a wall session to what the device drives.
  std::uint32_t faults = 0;   ///< Bits of ForceFault.
  std::array<double, kMostGrips> grips{};  ///< [-]  In force: of the device, or by buttons.
};

/// A tick of the force loop.
struct ForceTick {
  std::int64_t time_ns = 0;
  std::array<ToolTick, kMostTools> tools = {};
  std::uint32_t joints = 0;                                  ///< Of all tools.
  std::array<double, kMostHapticJoints> joint_targets = {};  ///< [rad or m]  As devices ask.
  std::array<double, kMostHapticJoints> joint_efforts = {};  ///< [N m or N]  Of contacts, felt.
  std::uint64_t set = 0;                                     ///< Its sequence; 0 for none.
  std::int64_t age_ns = 0;                                   ///< Of the set.
  std::uint32_t contacts = 0;                                ///< Of the set.
  std::uint32_t pressing = 0;                                ///< Limits of joints count, too.
  std::uint32_t pivots = 0;
};

/// Computes forces from device poses and the newest contact set.
///
/// A force is that of the spring between the target and where contacts would let the god-object be:
/// the sum of contact forces in Coulomb's cones. It is exactly 0 where no contact presses, however
/// far the god-object lags behind. With damping the target and surfaces are where they will be
/// after damping / stiffness seconds, so that forces stay in the cones. An effort of a joint is
/// that of its own spring likewise.
///
/// Contacts may contradict each other, or need more pivots (ForceFault::unsolved). Then the last
/// force stays that was solved. It is cut to the length of the springs' stretch, plus the way of
/// surfaces.
///
/// tick() allocates nothing, takes no lock, and makes no system call; its work is bounded.
class FIRSTCONTACT_API ForceLoop {
 public:
  /// @param mappings  one for each tool
  /// @throws std::invalid_argument if a number is out of its range
  ForceLoop(const HapticScene& scene, const std::vector<DeviceMapping>& mappings,
            const ForceLoopOptions& options = {});
  ~ForceLoop();
  ForceLoop(ForceLoop&&) noexcept;
  ForceLoop& operator=(ForceLoop&&) noexcept;

  /// @param now_ns   never less than before
  /// @param devices  one for each tool
  const ForceTick& tick(std::int64_t now_ns, const HapticContactSet& set,
                        std::span<const DeviceState> devices) noexcept;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace firstcontact
