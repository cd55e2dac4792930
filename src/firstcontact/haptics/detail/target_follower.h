/// @file
/// Where a device wants its tool to be: mapping, clutch, and devices that set rates.

#pragma once

#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/haptics/force_loop.h>

namespace firstcontact::detail {

/// Follows one device.
class TargetFollower {
 public:
  TargetFollower(const DeviceMapping& mapping, const Pose& X_WB)
      : mapping_(mapping), X_DH_(mapping.X_DH), X_WB_(X_WB), target_(X_WB), held_(X_WB) {}

  /// @param god_object  where it is
  /// @param seconds     since the last tick
  void follow(const DeviceState& device, const Pose& god_object, double seconds) noexcept;

  [[nodiscard]] const Pose& target() const noexcept { return target_; }
  [[nodiscard]] bool is_engaged() const noexcept { return is_engaged_; }
  [[nodiscard]] std::uint32_t faults() const noexcept { return faults_; }
  [[nodiscard]] const DeviceMapping& mapping() const noexcept { return mapping_; }

 private:
  [[nodiscard]] std::uint32_t faults_of(const DeviceState& device) const noexcept;
  [[nodiscard]] Pose mapped(const Pose& X_DH) const noexcept;
  void disengage(bool was_engaged, const Pose& god_object) noexcept;
  void drive(const DeviceState& device, const Pose& god_object, double seconds) noexcept;

  DeviceMapping mapping_;
  Pose X_DH_;  // References.
  Pose X_WB_;
  Pose target_;
  Pose held_;  // The target while it is not engaged.
  bool is_engaged_ = false;
  bool has_begun_ = false;
  bool is_rebased_ = false;  // At the next engagement: the clutch was used.
  std::uint32_t faults_ = 0;
};

/// The turn by a rotation vector [rad].
[[nodiscard]] Eigen::Quaterniond turn_by(const Eigen::Vector3d& rotation_vector) noexcept;

}  // namespace firstcontact::detail
