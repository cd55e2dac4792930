/// @file
/// Haptic devices: what a device can do, what it senses, and how a force is commanded.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include <Eigen/Core>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact {

/// The meaning of the numbers of a device.
enum class DeviceKind {
  pose,  ///< The handle is at a place: `DeviceState::X_DH`.
  rate,  ///< A deflected cap sets velocities: `DeviceState::linear_rate`, `angular_rate`.
};

/// [values]  The most values of grips that a device senses, such as the fingers of a hand.
inline constexpr std::size_t kMostGrips = 16;

/// The words of `DeviceKind` in files and messages, in its order.
inline constexpr std::array<const char*, 2> kDeviceKindWords{"pose", "rate"};

/// Flags of the six degrees of freedom, along and about the axes of the device frame D.
struct DegreesOfFreedom {
  std::array<bool, 3> linear{};   ///< Along x, y, z.
  std::array<bool, 3> angular{};  ///< About x, y, z.

  [[nodiscard]] static constexpr DegreesOfFreedom none() { return {}; }
  [[nodiscard]] static constexpr DegreesOfFreedom translation() { return {{true, true, true}, {}}; }
  [[nodiscard]] static constexpr DegreesOfFreedom all() {
    return {{true, true, true}, {true, true, true}};
  }
  [[nodiscard]] bool operator==(const DegreesOfFreedom&) const = default;
};

/// The abilities and limits of a device. They do not change while the device is open.
///
/// A limit that the maker does not state is infinite. A limit of an axis that is not driven is 0.
struct DeviceCapabilities {
  std::string name;  ///< Name of the model: "Inverse3".
  std::string id;    ///< Name of this specimen, as logs write it; may be empty.
  DeviceKind kind = DeviceKind::pose;
  /// The axes that the device senses. The others stay at the identity, or at rate 0.
  DegreesOfFreedom sensed;
  /// The axes that the device drives. Components of a command along others are dropped.
  DegreesOfFreedom driven;
  int buttons = 0;  ///< Number of buttons, at most 32.
  int grips = 0;  ///< Number of values of `DeviceState::grips` that it senses, at most kMostGrips.

  double max_force = 0.0;              ///< [N]          Greatest length of the force vector.
  double max_torque = 0.0;             ///< [N m]        Greatest length of the torque vector.
  double max_stiffness = 0.0;          ///< [N/m]
  double max_angular_stiffness = 0.0;  ///< [N m/rad]
  /// [J]          Greatest effort of each grip; 0 where none is driven.
  double max_grip_effort = 0.0;
  double max_damping = 0.0;          ///< [N s/m]
  double max_angular_damping = 0.0;  ///< [N m s/rad]

  /// [m]  Radius of a ball about the origin of D that the handle can reach everywhere.
  double workspace_radius = std::numeric_limits<double>::infinity();

  // The declared class of the device, for bounds of stable gains. 0 claims nothing.
  double damping = 0.0;           ///< [N s/m]      Own viscous damping of the mechanism, at least.
  double angular_damping = 0.0;   ///< [N m s/rad]
  double friction = 0.0;          ///< [N]          Own Coulomb friction of the mechanism, at least.
  double angular_friction = 0.0;  ///< [N m]
  double resolution = 0.0;        ///< [m]          Step of the encoders, at most.
  double angular_resolution = 0.0;  ///< [rad]

  /// [Hz]  Rate of new samples; 0 where it is not regular.
  double sample_rate = 0.0;

  /// [ns]  Age of a sample from which the status is `silent`; the greatest integer for never.
  std::int64_t silent_after_ns = std::numeric_limits<std::int64_t>::max();
};

/// The worth of a state. Only `live` states may move anything.
enum class DeviceStatus : std::uint8_t {
  waiting,  ///< Open, but no sample has come yet. The pose is the identity.
  live,     ///< A sample that is as young as the device promises.
  silent,   ///< The connection stands, but the last sample is older than `silent_after_ns`.
  lost,     ///< The device is gone, or its data make no sense any more. It may come back.
  ended,    ///< A recording is over. It will not come back.
};

/// The words of `DeviceStatus` in files and messages, in its order.
inline constexpr std::array<const char*, 5> kDeviceStatusWords{"waiting", "live", "silent", "lost",
                                                               "ended"};

/// One sample of a device.
///
/// All numbers are finite, and the quaternion is not zero, whatever the status. Where the status is
/// not `live`, the pose is that of the last sample, both rates are 0 and no button is pressed. So
/// a dead-man button is released when the device is lost.
struct DeviceState {
  /// The pose of the handle H in the device frame D. For a rate device the identity.
  Pose X_DH;
  /// [m/s]  Velocity in D: the one that a rate device sets, or the one of H's origin that a pose
  /// device measures. 0 where a pose device measures none.
  Eigen::Vector3d linear_rate = Eigen::Vector3d::Zero();
  /// [rad/s]  Angular velocity in D, by the same rules.
  Eigen::Vector3d angular_rate = Eigen::Vector3d::Zero();
  /// [ns]  Time at which the sample was taken, or else arrived, on the clock of `Device::read`.
  std::int64_t time_ns = 0;
  /// The number of the sample. Equal numbers are the same sample; a jump shows how many were
  /// missed.
  std::uint64_t sequence = 0;
  /// [-]  Bend of fingers, or closure of a gripper: 0 open, 1 closed. Values below 0 and above 1
  /// may occur.
  std::array<double, kMostGrips> grips{};
  /// The buttons: bit i is set while button i is pressed.
  std::uint32_t buttons = 0;
  DeviceStatus status = DeviceStatus::waiting;
};

/// The force that the device shall put on the user's hand.
struct ForceCommand {
  Eigen::Vector3d force_D = Eigen::Vector3d::Zero();   ///< [N]    At the origin of H, axes of D.
  Eigen::Vector3d torque_D = Eigen::Vector3d::Zero();  ///< [N m]  About the origin of H, axes of D.
  /// [J]  Effort on each grip: work per unit of its value; an effort below 0 opens it. A finger
  /// that moves s metres from 0 to 1 feels a force of effort / s.
  std::array<double, kMostGrips> grips{};
};

/// Counts of the events since a device was opened.
struct DeviceCounts {
  std::uint64_t samples = 0;      ///< New samples.
  std::uint64_t missed = 0;       ///< Samples that the source numbered and nobody received.
  std::uint64_t malformed = 0;    ///< Records that were dropped because they make no sense.
  std::uint64_t connections = 0;  ///< How often a connection was made.
};

/// A haptic device.
///
/// **Frames and units.** The device frame D is fixed to the base. It is right-handed, with x to the
/// right of the user, y away from the user and z up. Lengths are in metres, angles in radians,
/// times in nanoseconds, forces in newtons and torques in newton metres. A driver converts
/// whatever the hardware has.
///
/// **Time.** `now_ns` is the time of the tick. Real loops pass the steady clock (`steady_now_ns`);
/// loops in virtual time pass their own. It never decreases from call to call. Devices behind a
/// network stamp their samples by the steady clock, and so are for real loops only.
///
/// **Force loop.** `read` and `command` are called from one thread, the force loop, at 1 kHz to
/// 10 kHz. Both return at once: they allocate nothing, take no lock, make no system call that could
/// block, and throw nothing. A driver that must wait for hardware or a network does so in a thread
/// of its own, and hands states over by a `MailSlot`. `read` gives the newest sample, again and
/// again if there is no new one; it never waits for the next.
///
/// **Loss.** A lost device goes on to answer: see `DeviceState`. A driver that can open the device
/// again does so by itself. It then starts with a new connection, without a force.
///
/// **Safety.** A device limits each command to `max_force` and `max_torque`. It takes a component
/// that is not finite as a command of zero. It falls back to zero force by itself where no command
/// came for 100 ms. The destructor sets the force to zero before it lets the device go.
class FIRSTCONTACT_API Device {
 public:
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  virtual ~Device();

  /// The abilities and limits. The reference holds as long as the device.
  [[nodiscard]] virtual const DeviceCapabilities& capabilities() const noexcept = 0;

  /// Reads the newest sample at time `now_ns`. For the force loop.
  [[nodiscard]] virtual DeviceState read(std::int64_t now_ns) noexcept = 0;

  /// Commands the force from now on, until the next command. For the force loop. Devices that are
  /// not driven ignore it.
  virtual void command(const ForceCommand& command, std::int64_t now_ns) noexcept = 0;

  /// The counts up to now. For any thread; not for the force loop.
  [[nodiscard]] virtual DeviceCounts counts() const = 0;

  /// Describes in one sentence why the device is waiting or lost; empty if it is neither. For any
  /// thread; not for the force loop.
  [[nodiscard]] virtual std::string problem() const = 0;
};

/// The steady clock [ns], as real loops pass it to `Device::read`.
[[nodiscard]] FIRSTCONTACT_API std::int64_t steady_now_ns() noexcept;

/// Takes the components of a command that the device drives, however large; the others are 0.
[[nodiscard]] FIRSTCONTACT_API ForceCommand
driven_part(const ForceCommand& command, const DeviceCapabilities& capabilities) noexcept;

/// Limits a command to what the device drives: components along other axes are 0. The lengths are
/// at most `max_force` and `max_torque`, efforts of grips at most `max_grip_effort`. A number that
/// is not finite makes all 0.
[[nodiscard]] FIRSTCONTACT_API ForceCommand
limited(const ForceCommand& command, const DeviceCapabilities& capabilities) noexcept;

/// Lifetime of a command: a force lasts so long without a further one.
inline constexpr std::int64_t kCommandLifetimeNs = 100'000'000;

}  // namespace firstcontact
