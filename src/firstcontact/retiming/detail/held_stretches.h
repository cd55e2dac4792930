/// @file
/// The stretches of a motion in which contact pairs are held, and their joint result.

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <firstcontact/many_bodies/scene_result.h>
#include <firstcontact/retiming/executed_proof.h>
#include <firstcontact/retiming/retiming_scene.h>
#include <firstcontact/retiming/timed_motion.h>

namespace firstcontact::detail {

/// A motion, cut where pairs open or where those at the goal begin to be held.
///
/// The cuts are points at which the motion rests. Each belongs to the stretches on both sides, so
/// that a pair keeps its margin where it has opened. A cut at an end of the motion makes a stretch
/// of one point. So does one where a pair has opened and from which on it is held again.
class HeldStretches {
 public:
  /// @param motion, holds  are referred to
  /// @throws std::invalid_argument if the motion does not rest where a pair has to be open, or a
  ///         pair is held at the goal before it has opened
  HeldStretches(const TimedMotion& motion, std::span<const RetimingHold> holds);

  [[nodiscard]] std::size_t size() const { return stretches_.size(); }

  /// [s]  Time of the first point of a stretch.
  [[nodiscard]] double begin(std::size_t stretch) const;
  /// [s]  Time of the last point of a stretch.
  [[nodiscard]] double end(std::size_t stretch) const;

  /// The points of a stretch, with times from 0 on. Between them the motion is the same.
  [[nodiscard]] TimedMotion motion(std::size_t stretch) const;

  /// The pairs that are held in a stretch.
  [[nodiscard]] std::vector<RetimingHold> holds(std::size_t stretch) const;

  /// The times from when to when each pair is held.
  [[nodiscard]] std::vector<ProvenHold> times() const;

 private:
  struct Stretch {
    std::size_t first = 0;  // Index of the first point.
    std::size_t last = 0;
  };
  /// Whether a pair is held until a cut and from there on.
  ///
  /// @throws std::invalid_argument if a pair is held at the goal before it has opened
  [[nodiscard]] bool is_held_on_both_sides(std::size_t cut) const;
  [[nodiscard]] Stretch held_points(const RetimingHold& hold) const;
  [[nodiscard]] double seconds(std::size_t point) const;

  const TimedMotion& motion_;
  std::span<const RetimingHold> holds_;
  std::vector<Stretch> stretches_;
};

/// The result of a stretch.
struct StretchResult {
  double begin = 0.0;  ///< [s]
  double end = 0.0;    ///< [s]
  SceneResult result;
};

/// Adds the result of the next stretch to that of the motion, which is free so far.
///
/// The result of a stretch that is the whole motion is taken as it is.
///
/// @param duration  [s]  of the motion
void append_result(StretchResult next, double duration, SceneResult& all);

}  // namespace firstcontact::detail
