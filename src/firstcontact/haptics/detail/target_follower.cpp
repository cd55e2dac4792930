#include <firstcontact/haptics/detail/target_follower.h>

#include <cmath>

#include <firstcontact/haptic_devices/detail/quiet_state.h>
#include <firstcontact/haptics/detail/god_object_plan.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// [m], [rad]  The most by which a device that sets rates is ahead of its god-object. A target far
/// behind a wall could not be felt.
constexpr double kMostLead = 0.02;
constexpr double kMostLeadOfTurn = 0.3;

bool has_button(const DeviceState& device, int button) noexcept {
  return button >= 0 && (device.buttons >> static_cast<unsigned>(button) & 1U) != 0;
}

bool is_sound(const DeviceState& device) noexcept {
  return are_grips(device) && device.X_DH.position.norm() <= kMostOfSample &&
         device.X_DH.rotation.coeffs().allFinite() && device.X_DH.rotation.squaredNorm() > 0.0 &&
         device.linear_rate.norm() <= kMostOfSample && device.angular_rate.norm() <= kMostOfSample;
}

Vector3d shortened(const Vector3d& vector, double most) noexcept {
  const double length = vector.norm();
  return length > most ? Vector3d(most / length * vector) : vector;
}

}  // namespace

Eigen::Quaterniond turn_by(const Vector3d& rotation_vector) noexcept {
  const double angle = rotation_vector.norm();
  if (!(angle > 0.0)) {
    return Eigen::Quaterniond::Identity();
  }
  Eigen::Quaterniond turn;
  turn.w() = std::cos(0.5 * angle);
  turn.vec() = std::sin(0.5 * angle) / angle * rotation_vector;
  return turn;
}

std::uint32_t TargetFollower::faults_of(const DeviceState& device) const noexcept {
  std::uint32_t faults = 0;
  if (device.status != DeviceStatus::live) {
    faults |= static_cast<std::uint32_t>(ForceFault::device);
  }
  if (!is_sound(device)) {
    faults |= static_cast<std::uint32_t>(ForceFault::not_finite);
  }
  if (has_button(device, mapping_.clutch_button) ||
      (mapping_.dead_man_button >= 0 && !has_button(device, mapping_.dead_man_button))) {
    faults |= static_cast<std::uint32_t>(ForceFault::disengaged);
  }
  return faults;
}

/// Moves the centre of a body by `way`, and turns the body about it to R_WB.
Pose TargetFollower::moved(const Pose& from, const Vector3d& way,
                           const Eigen::Quaterniond& R_WB) const noexcept {
  return {from.position + way + (from.rotation * p_BC_ - R_WB * p_BC_), R_WB};
}

Pose TargetFollower::mapped(const Pose& X_DH) const noexcept {
  const Eigen::Quaterniond& R_WD = mapping_.R_WD;
  const Eigen::Quaterniond turn = X_DH.rotation.normalized() * X_DH_.rotation.conjugate();
  return moved(X_WB_, mapping_.scale * (R_WD * (X_DH.position - X_DH_.position)),
               (R_WD * turn * R_WD.conjugate() * X_WB_.rotation).normalized());
}

void TargetFollower::drive(const DeviceState& device, const Pose& god_object,
                           double seconds) noexcept {
  const Eigen::Quaterniond& R_WD = mapping_.R_WD;
  const Vector3d way = seconds * mapping_.scale * (R_WD * device.linear_rate);
  const Pose at{god_object.position, god_object.rotation.normalized()};
  const Vector3d lead =
      shortened(centre_at(target_, p_BC_) + way - centre_at(at, p_BC_), kMostLead);
  const Eigen::Quaterniond turned =
      turn_by(seconds * (R_WD * device.angular_rate)) * target_.rotation;
  const Vector3d turn = shortened(turn_between(at.rotation, turned), kMostLeadOfTurn);
  target_ = moved(at, lead, (turn_by(turn) * at.rotation).normalized());
}

/// Ends an engagement: the target stays where the god-object is. A body that pushes the tool from
/// there moves it only as long as it touches.
void TargetFollower::disengage(bool moves_on, const Pose& god_object) noexcept {
  held_ = moves_on ? god_object : held_;
  target_ = held_;
  is_engaged_ = false;
  still_.forget();
}

void TargetFollower::follow(const DeviceState& device, const Pose& god_object, double seconds,
                            bool still_follows) noexcept {
  const bool was_engaged = is_engaged_;
  const bool moves_on = was_engaged || still_follows;
  faults_ = faults_of(device);
  if (faults_ != 0) {
    // A lost device keeps its references, so that its handle has the same meaning when it comes
    // back.
    is_rebased_ = is_rebased_ || faults_ == static_cast<std::uint32_t>(ForceFault::disengaged);
    disengage(moves_on, god_object);
    return;
  }
  if (!was_engaged) {
    is_engaged_ = true;
    const bool takes_handle = !has_begun_ && mapping_.begins_at_handle;
    if (is_rebased_ || takes_handle) {
      X_DH_ = {device.X_DH.position, device.X_DH.rotation.normalized()};
    }
    if (is_rebased_) {
      X_WB_ = {god_object.position, god_object.rotation.normalized()};
    }
    target_ = mapping_.kind == DeviceKind::rate ? god_object : target_;
    is_rebased_ = false;
    has_begun_ = true;
  }
  if (mapping_.kind == DeviceKind::rate) {
    drive(device, god_object, seconds);
  } else {
    target_ = mapped(still_.take(device.X_DH));
  }
  if (!target_.position.allFinite() || !(target_.rotation.squaredNorm() > 0.0)) {
    // Scale and position may be finite and their product not.
    faults_ = static_cast<std::uint32_t>(ForceFault::not_finite);
    disengage(moves_on, god_object);
  }
}

}  // namespace firstcontact::detail
