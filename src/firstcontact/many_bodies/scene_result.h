/// @file
/// The answer of many members, which are bodies or links of robots, and that of each pair of them.

#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/math/export.h>
#include <firstcontact/query/closest_approach.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact {

/// A stretch of time that may be in contact. Outside of its intervals a pair is proven free.
///
/// At `enter` the pair is within margin + tolerance. The pair is proven free before it, back to the
/// `leave` of the interval before. `leave` is sampled, not proven: a sample within margin +
/// tolerance lies in [leave - resolution, leave]. The pair may come apart for less than twice the
/// resolution; such gaps may be counted to the interval around them.
struct ContactInterval {
  double enter = 0.0;  ///< [-]
  double leave = 1.0;  ///< [-]
  /// The reason why the interval was not searched to its end; nothing is known in it after `enter`.
  UndecidedReason reason = UndecidedReason::none;
};

/// The first contact of a pair of members, and the other answers that were requested for it.
struct PairAnswer : FirstContactResult {
  BodyPair members = {};
  /// [m]  The distance at which contact begins. For links it includes both paddings, and the effect
  /// of the tracking errors at t.
  double margin = 0.0;
  /// Intervals of contact, in order, where requested.
  std::vector<ContactInterval> intervals = {};
  /// Closest approach over all times that are tested, where requested.
  std::optional<ClosestApproach> closest = {};
};

/// The answer of all pairs of members that are tested.
///
/// No pair is in contact before `t`, the time of the deciding pair. The clearance is a lower bound
/// of every pair's distance up to t. Tolerance and enclosure error are the greatest of the pairs
/// that were searched.
struct SceneResult : Outcome {
  /// Index into `pairs` of the deciding pair: the earliest contact, ties by their order. None when
  /// free.
  std::optional<std::size_t> first = {};
  /// Index into `pairs` of the pair that comes closest, where requested.
  std::optional<std::size_t> closest = {};
  /// Every tested pair where that was requested; else those that determine `t`, and the closest
  /// pair where requested. In the order of members.
  std::vector<PairAnswer> pairs = {};
  WorkCount work = {};  ///< Work for all pairs that were searched.
};

/// Finds the pair that decides the answer of all; among equal ones the first. None where all are
/// free.
[[nodiscard]] FIRSTCONTACT_API std::optional<std::size_t> deciding_pair(
    std::span<const PairAnswer> pairs);

/// Finds the pair that comes closest, among those with a closest approach. None where there is no
/// such pair.
///
/// If several pairs touch, it is the first in time.
[[nodiscard]] FIRSTCONTACT_API std::optional<std::size_t> closest_pair(
    std::span<const PairAnswer> pairs);

}  // namespace firstcontact
