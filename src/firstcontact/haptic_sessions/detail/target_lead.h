/// @file
/// Extrapolation of a device's target to the time at which the contacts of a cycle are felt.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/haptics/contact_set.h>
#include <firstcontact/haptics/force_loop.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact::detail {

/// Extrapolates the target of one device by its velocity.
///
/// The velocity is that of the last two milliseconds, limited by the speed of the two before. So a
/// target at constant velocity is met, and one that was still is not extrapolated. Neither a jump
/// nor the step of an encoder is taken for a motion. The target stays where the device is not
/// engaged, sets rates, is faster than a hand, or gives too few samples.
///
/// Nothing is allocated.
class TargetLead {
 public:
  explicit TargetLead(const DeviceMapping& mapping) noexcept
      : scale_(mapping.scale), is_pose_(mapping.kind == DeviceKind::pose) {}

  /// Takes the next tick of the force loop.
  void watch(std::int64_t now_ns, const ToolTick& tick) noexcept;

  /// Computes the pose X_WB after `seconds`; the target of the last tick where it is not
  /// extrapolated.
  ///
  /// @param seconds  [s]  >= 0; more than 4 ms count as 4 ms
  [[nodiscard]] Pose target_in(double seconds) const noexcept;

 private:
  struct Sample {
    std::int64_t time_ns = 0;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // [m]
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  };
  struct Velocity {
    Eigen::Vector3d linear = Eigen::Vector3d::Zero();   // [m/s]  Of the centre.
    Eigen::Vector3d angular = Eigen::Vector3d::Zero();  // [rad/s]
  };

  void take(const Sample& sample) noexcept;
  [[nodiscard]] const Sample* sample_at(std::int64_t time_ns) const noexcept;
  [[nodiscard]] static Velocity between(const Sample& from, const Sample& to) noexcept;
  [[nodiscard]] std::optional<Velocity> velocity() const noexcept;

  static constexpr std::size_t kKept = 16;

  double scale_;
  bool is_pose_;
  std::array<Sample, kKept> kept_ = {};
  std::size_t count_ = 0;  // Number of samples that were kept since the engagement.
  std::int64_t now_ns_ = 0;
  bool has_newest_ = false;
  std::uint64_t sequence_ = 0;  // Sequence number of the newest sample.
  Sample newest_;
  Pose target_;                                       // The target of the last tick.
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();  // [m]  Its centre.
};

/// Whether a tool touches anything with friction. Then its target is not extrapolated. A god-object
/// that slides ahead of the device would be held there, and the felt friction would be too small.
[[nodiscard]] bool is_rubbing(const HapticContactSet& set, std::size_t tool) noexcept;

}  // namespace firstcontact::detail
