/// @file
/// The target that a device wants for its tool: mapping, clutch, and devices that set rates.

#pragma once

#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/haptic_devices/detail/still_pose.h>
#include <firstcontact/haptics/force_loop.h>

namespace firstcontact::detail {

/// [m]  Computes the place of a body's centre C.
[[nodiscard]] inline Eigen::Vector3d centre_at(const Pose& X_WB,
                                               const Eigen::Vector3d& p_BC) noexcept {
  return X_WB.position + X_WB.rotation * p_BC;
}

/// Follows one device. Its handle moves the centre C of the tool, and turns the tool about C.
class TargetFollower {
 public:
  TargetFollower(const DeviceMapping& mapping, const Pose& X_WB, const Eigen::Vector3d& p_BC)
      : mapping_(mapping),
        p_BC_(p_BC),
        still_(mapping.device ? mapping.device->resolution : 0.0,
               mapping.device ? mapping.device->angular_resolution : 0.0),
        X_DH_(mapping.X_DH),
        X_WB_(X_WB),
        target_(X_WB),
        held_(X_WB) {}

  /// Takes the state of the device at a tick.
  ///
  /// @param god_object     its pose
  /// @param seconds        since the last tick
  /// @param still_follows  whether the god-object comes from a cycle that began before the end of
  ///                       the engagement; then it is held where that cycle left it
  void follow(const DeviceState& device, const Pose& god_object, double seconds,
              bool still_follows = false) noexcept;

  [[nodiscard]] const Pose& target() const noexcept { return target_; }
  [[nodiscard]] bool is_engaged() const noexcept { return is_engaged_; }
  [[nodiscard]] std::uint32_t faults() const noexcept { return faults_; }
  [[nodiscard]] const DeviceMapping& mapping() const noexcept { return mapping_; }

 private:
  [[nodiscard]] std::uint32_t faults_of(const DeviceState& device) const noexcept;
  [[nodiscard]] Pose moved(const Pose& from, const Eigen::Vector3d& way,
                           const Eigen::Quaterniond& R_WB) const noexcept;
  [[nodiscard]] Pose mapped(const Pose& X_DH) const noexcept;
  void disengage(bool moves_on, const Pose& god_object) noexcept;
  void drive(const DeviceState& device, const Pose& god_object, double seconds) noexcept;

  DeviceMapping mapping_;
  Eigen::Vector3d p_BC_;  // [m]
  StillPose still_;
  Pose X_DH_;  // Reference pose of the handle.
  // Reference pose of the body.
  Pose X_WB_;
  Pose target_;
  Pose held_;  // The target while the device is not engaged.
  bool is_engaged_ = false;
  bool has_begun_ = false;
  // Whether the next engagement sets new references, as the clutch was used.
  bool is_rebased_ = false;
  std::uint32_t faults_ = 0;
};

/// The rotation by a rotation vector [rad].
[[nodiscard]] Eigen::Quaterniond turn_by(const Eigen::Vector3d& rotation_vector) noexcept;

}  // namespace firstcontact::detail
