/// @file
/// The pose of a handle that rests between two steps of its encoders.

#pragma once

#include <array>
#include <cstddef>

#include <firstcontact/motion/pose.h>

namespace firstcontact::detail {

/// A coordinate of a handle, whose reading trembles where the handle rests between two steps.
///
/// A reading trembles from the second time on that it turns back within a step. Then the value is
/// the mean of the readings, until one of them leaves the step. Any other reading is taken as it
/// is. So no motion is delayed that goes on, or that turns back once.
///
/// A handle that swings about a step without resting there leaves it again. Each time that a
/// tremble ends, the next one nearby takes twice as many turns. So such a handle comes to rest as
/// it would without this, and the energy of all ends grows only with the logarithm of time.
///
/// Energy: behind a spring of stiffness K the end of a tremble gives the hand at most K step^2. The
/// force differs by at most K step from that of the reading, and a reading that leaves the step is
/// taken at once. While a tremble lasts, the n-th reading changes the mean by less than step / n. A
/// band that the value lags behind would give the hand K step for each metre of motion.
class StillCoordinate {
 public:
  /// Takes a reading and returns the value of the coordinate.
  ///
  /// @param step  of the encoder, in the unit of the reading; > 0
  double take(double reading, double step) noexcept;

  void forget() noexcept { has_reading_ = false; }

 private:
  /// The readings since the handle crossed into the next step.
  struct Stay {
    double sum = 0.0;
    double count = 0.0;
  };

  static constexpr std::size_t kFewestTurns = 2;  // A stroke turns back once.

  bool has_reading_ = false;
  double last_ = 0.0;
  double least_ = 0.0;  // The readings since the last one that left a step.
  double greatest_ = 0.0;
  bool goes_up_ = false;   // The direction of the last change.
  std::size_t turns_ = 0;  // Times that a change turned back.
  std::size_t turns_of_tremble_ = kFewestTurns;
  double left_at_ = 0.0;  // The first reading after the last tremble.
  Stay before_;           // The stay before the present one.
  Stay now_;              // The present stay; all of the tremble, while there is one.
};

/// The pose of a handle of six coordinates: the position, and the rotation vector.
class StillPose {
 public:
  /// @param step  [m], angular_step [rad]  of the encoders; 0 where they are not declared. Then
  ///              readings are taken as they are
  StillPose(double step, double angular_step) noexcept : step_(step), angular_step_(angular_step) {}

  /// Takes the pose that the device gives, and returns that of the handle.
  [[nodiscard]] Pose take(const Pose& X_DH) noexcept;

  void forget() noexcept;

 private:
  double step_;
  double angular_step_;
  std::array<StillCoordinate, 6> coordinates_ = {};
};

}  // namespace firstcontact::detail
