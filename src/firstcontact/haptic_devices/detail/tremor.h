/// @file
/// The tremor of a hand: sums of sines along and about each axis.

#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/haptic_devices/detail/rotation_vector.h>
#include <firstcontact/haptic_devices/operator_path.h>

namespace firstcontact::detail {

/// A walk over the tremor in equal steps.
///
/// A step multiplies phasors, so it computes no sine. Each step adds an error of some 1e-16 of the
/// amplitude.
class TremorWalk {
 public:
  /// Begins a walk.
  ///
  /// @param tremor  sines along x, y, z, then about x, y, z: amplitude [m], [rad], frequency
  ///         [rad/s] and phase [rad]
  /// @param time    [s]  start of the walk
  /// @param step    [s]
  template <class Sine>
  TremorWalk(const std::array<std::array<Sine, 3>, 6>& tremor, double time, double step) noexcept {
    for (std::size_t axis = 0; axis < tremor.size(); ++axis) {
      for (std::size_t i = 0; i < tremor[axis].size(); ++i) {
        const Sine& sine = tremor[axis][i];
        const double angle = sine.frequency * time + sine.phase;
        const double turn = sine.frequency * step;
        phasors_[axis][i] = {sine.amplitude * std::sin(angle), sine.amplitude * std::cos(angle),
                             std::sin(turn), std::cos(turn), sine.frequency};
        still_ = still_ && sine.amplitude == 0.0;
      }
    }
  }

  /// Adds the tremor to a target, and goes one step on.
  void add_to(HandTarget& target) noexcept {
    if (still_) {
      return;
    }
    Eigen::Vector3d turn = Eigen::Vector3d::Zero();
    for (std::size_t axis = 0; axis < phasors_.size(); ++axis) {
      double offset = 0.0;
      double rate = 0.0;
      for (Phasor& phasor : phasors_[axis]) {
        offset += phasor.sine;
        rate += phasor.frequency * phasor.cosine;
        const double sine = phasor.sine * phasor.step_cosine + phasor.cosine * phasor.step_sine;
        phasor.cosine = phasor.cosine * phasor.step_cosine - phasor.sine * phasor.step_sine;
        phasor.sine = sine;
      }
      const auto i = static_cast<Eigen::Index>(axis % 3);
      if (axis < 3) {
        target.X_DH.position[i] += offset;
        target.velocity[i] += rate;
      } else {
        turn[i] = offset;
        target.angular_velocity[i] += rate;
      }
    }
    target.X_DH.rotation = rotation_of(turn) * target.X_DH.rotation;
  }

 private:
  struct Phasor {
    double sine = 0.0;
    double cosine = 0.0;
    double step_sine = 0.0;
    double step_cosine = 1.0;
    double frequency = 0.0;
  };

  std::array<std::array<Phasor, 3>, 6> phasors_{};
  bool still_ = true;
};

}  // namespace firstcontact::detail
