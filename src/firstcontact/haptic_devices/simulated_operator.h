/// @file
/// A simulated hand on a simulated device.

#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/haptic_devices/device.h>
#include <firstcontact/haptic_devices/operator_path.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// A hand: a mass on a spring and a damper whose other end follows the path with tremor.
struct HandOptions {
  double stiffness = 400.0;        ///< [N/m]       0 to 1500 for people.
  double damping = 10.0;           ///< [N s/m]
  double mass = 0.25;              ///< [kg]        Mass that moves with the handle.
  double max_force = 40.0;         ///< [N]         Greatest force of the spring.
  double angular_stiffness = 1.0;  ///< [N m/rad]
  double angular_damping = 0.01;   ///< [N m s/rad]
  double inertia = 1e-4;           ///< [kg m^2]    Inertia about each axis.
  double max_torque = 1.0;         ///< [N m]       Greatest torque of the spring.
  double tremor = 5e-5;            ///< [m]         Root mean square.
  double angular_tremor = 5e-4;    ///< [rad]       Root mean square.
  std::array<double, 2> tremor_frequencies = {8.0, 12.0};  ///< [Hz]  Least and greatest.
};

/// The mechanism of the simulated device.
struct MechanismOptions {
  double mass = 0.1;              ///< [kg]        > 0.
  double damping = 0.1;           ///< [N s/m]     The b of the declared class.
  double friction = 0.0;          ///< [N]         The f_c of the declared class.
  double inertia = 5e-5;          ///< [kg m^2]    > 0.
  double angular_damping = 1e-4;  ///< [N m s/rad]
  double angular_friction = 0.0;  ///< [N m]
  double max_force = 40.0;        ///< [N]
  double max_torque = 1.0;        ///< [N m]
};

/// The channel between the mechanism and the loop.
struct ChannelOptions {
  double resolution = 1e-5;  ///< [m]    Encoder step of the position; 0 for none.
  /// [rad]  Encoder step of the rotation vector; 0.003 degrees; 0 for none.
  double angular_resolution = 5e-5;
  std::int64_t sensor_delay_ns = 0;   ///< [ns]   A sample is at least this old.
  std::int64_t command_delay_ns = 0;  ///< [ns]   A command acts this much later.
  std::int64_t jitter_ns = 0;  ///< [ns]   Either delay is longer by a random time below this.
};

/// The fingers of the hand: they open and close, and do not yield to efforts.
struct FingerOptions {
  int grips = 0;        ///< Number of values that the device senses; 0 to kMostGrips.
  double period = 2.0;  ///< [s]  Time from open to open; > 0. Each grip has 0.7 to 1.3 of it.
  double closed = 1.0;  ///< [-]  Value at which the fingers turn back.
};

/// A stretch of time in which the hand lets go of the handle.
struct HandRelease {
  double begin = 0.0;  ///< [s]
  double end = 0.0;    ///< [s]  > begin; may be infinite.
};

/// The options of a simulated operator.
struct SimulatedOperatorOptions {
  HandOptions hand;
  MechanismOptions mechanism;
  ChannelOptions channel;
  FingerOptions fingers;
  std::vector<ViaPoint> path = {ViaPoint{}};  ///< Via points of the hand; see OperatorPath.
  std::vector<HandRelease> releases;          ///< In order, apart from each other.
  std::uint64_t seed = 1;                     ///< Seed of the tremor and the jitter.
  double substep = 2.5e-5;                    ///< [s]  Longest sub-step of the dynamics; > 0.
};

/// Energies since the begin [J].
///
/// Always kinetic = kinetic at the begin + command_work + hand_work - dissipated, up to rounding.
struct OperatorEnergy {
  double kinetic = 0.0;       ///< Energy of the handle, and of the hand while it holds on.
  double command_work = 0.0;  ///< Done by the commanded force. Positive: the loop gave energy.
  /// Done by the hand. Its own kinetic energy joins as it takes hold, and leaves as it lets go.
  double hand_work = 0.0;
  double dissipated = 0.0;  ///< Taken by the damping and the friction of the mechanism.
};

/// The exact state of the simulated handle, which no encoder rounds and no channel delays.
struct OperatorTruth {
  Pose X_DH;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< [m/s]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< [rad/s]
  HandTarget target;  ///< The target of the hand, tremor included.
  bool held = true;
};

/// A simulated hand on a simulated device, for loops in virtual or real time.
///
/// The handle is a rigid body of equal inertia about all axes. The hand pulls it towards its path.
/// The commanded force is held between commands. `read` advances the dynamics to its time in at
/// least 100 sub-steps, and in at most 4 million. Button 0 is pressed while the hand holds on. The
/// hand knows nothing of a scene: its path may lead through walls.
///
/// The usual sub-step is short beside the periods of hands. It is no shorter, as a read after a
/// pause would take as long as the pause on a slow processor, and make its loop late again.
///
/// Time 0 of the path is the first call of `read`. The same seed and the same calls give the same
/// numbers on one machine. The tremor has three sines along and about each axis.
///
/// Class of the device: `damping`, `friction` and `resolution` are declared in the capabilities.
class FIRSTCONTACT_API SimulatedOperator : public Device {
 public:
  /// Makes an operator that rests until the first call of `read`.
  ///
  /// @throws std::invalid_argument  if an option is outside its range
  explicit SimulatedOperator(const SimulatedOperatorOptions& options = {});

  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override;
  [[nodiscard]] DeviceState read(std::int64_t now_ns) noexcept override;
  void command(const ForceCommand& command, std::int64_t now_ns) noexcept override;
  [[nodiscard]] DeviceCounts counts() const override;
  [[nodiscard]] std::string problem() const override;

  [[nodiscard]] OperatorEnergy energy() const noexcept;
  [[nodiscard]] OperatorTruth truth() const noexcept;

 private:
  static constexpr std::size_t kDepth = 256;

  struct PendingCommand {
    std::int64_t begin_ns = 0;
    ForceCommand force;
  };
  struct Sine {
    double amplitude = 0.0;  // [m] or [rad]
    double frequency = 0.0;  // [rad/s]
    double phase = 0.0;      // [rad]
  };
  struct ReleaseTime {
    std::int64_t begin_ns = 0;  // Time since the begin of the path.
    std::int64_t end_ns = 0;
  };

  void advance(std::int64_t to_ns) noexcept;
  void integrate(double duration, std::int64_t steps) noexcept;
  void update_hold() noexcept;
  [[nodiscard]] std::int64_t next_event_ns() const noexcept;
  void take_sample(std::int64_t now_ns) noexcept;
  [[nodiscard]] std::int64_t random_delay(std::int64_t delay_ns) noexcept;

  SimulatedOperatorOptions options_;
  DeviceCapabilities capabilities_;
  OperatorPath path_;
  std::array<std::array<Sine, 3>, 6> tremor_{};  // Along x, y, z, then about them.
  std::array<double, kMostGrips> grip_rates_{};  // [rad/s]
  std::vector<ReleaseTime> releases_;
  std::uint64_t random_;

  bool started_ = false;
  std::int64_t origin_ns_ = 0;
  std::int64_t now_ns_ = 0;
  double time_ = 0.0;  // [s]  Path time of now_ns_.
  std::size_t piece_ = 0;
  std::size_t release_ = 0;  // Index of the first one that is not over.
  OperatorTruth truth_;
  OperatorEnergy energy_;

  ForceCommand force_;  // The command in effect.
  std::int64_t force_until_ns_ = 0;
  std::array<PendingCommand, kDepth> pending_{};
  std::size_t first_pending_ = 0;
  std::size_t pending_count_ = 0;

  std::array<DeviceState, kDepth> samples_{};
  std::uint64_t taken_ = 0;     // Samples so far; the newest is samples_[(taken_ - 1) % kDepth].
  std::uint64_t returned_ = 0;  // Sequence number that was returned last.
  std::atomic<std::uint64_t> sample_count_{0};  // taken_, for other threads.
};

}  // namespace firstcontact
