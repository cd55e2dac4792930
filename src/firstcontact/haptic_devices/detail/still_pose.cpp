#include <firstcontact/haptic_devices/detail/still_pose.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/motion/detail/turn.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// [-]  More than the rounding of a step between two readings.
constexpr double kRoundingOfStep = 1e-6;
/// [-]  The most times that a reading has to turn back until it trembles.
constexpr std::size_t kMostTurns = 1U << 20U;
/// [steps]  Distance from the place where a tremble ended at which that is forgotten.
constexpr double kElsewhere = 100.0;

}  // namespace

double StillCoordinate::take(double reading, double step) noexcept {
  const double most = (1.0 + kRoundingOfStep) * step;
  // Negated, so that a reading that is not a number is taken as it is.
  if (!has_reading_ || !(reading - least_ <= most && greatest_ - reading <= most)) {
    if (has_reading_ && turns_ >= turns_of_tremble_) {
      turns_of_tremble_ = std::min(2 * turns_of_tremble_, kMostTurns);
      left_at_ = reading;
    } else if (!(std::abs(reading - left_at_) <= kElsewhere * step)) {
      turns_of_tremble_ = kFewestTurns;
    }
    has_reading_ = true;
    last_ = least_ = greatest_ = reading;
    turns_ = 0;
    before_ = {};
    now_ = {.sum = reading, .count = 1.0};
    return reading;
  }
  if (reading != last_) {
    const bool is_first = least_ == greatest_;
    const bool goes_up = reading > last_;
    const bool was_trembling = turns_ >= turns_of_tremble_;
    turns_ += !is_first && goes_up != goes_up_ ? 1 : 0;
    if (!was_trembling && turns_ >= turns_of_tremble_) {
      now_.sum += before_.sum;  // One stay on each side.
      now_.count += before_.count;
    } else if (!was_trembling) {
      before_ = now_;
      now_ = {};
    }
    goes_up_ = goes_up;
    last_ = reading;
    least_ = std::min(least_, reading);
    greatest_ = std::max(greatest_, reading);
  }
  now_.sum += reading;
  now_.count += 1.0;
  return turns_ >= turns_of_tremble_ ? now_.sum / now_.count : reading;
}

Pose StillPose::take(const Pose& X_DH) noexcept {
  Pose still = X_DH;
  for (std::size_t k = 0; k < 3 && step_ > 0.0; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    still.position[axis] = coordinates_[k].take(X_DH.position[axis], step_);
  }
  if (angular_step_ > 0.0) {
    const Vector3d read = nearest_turn(X_DH.rotation, Vector3d::Zero());
    Vector3d turned;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      turned[axis] = coordinates_[3 + k].take(read[axis], angular_step_);
    }
    still.rotation = turned == read ? X_DH.rotation : turn(turned);
  }
  return still;
}

void StillPose::forget() noexcept {
  for (StillCoordinate& coordinate : coordinates_) {
    coordinate.forget();
  }
}

}  // namespace firstcontact::detail
