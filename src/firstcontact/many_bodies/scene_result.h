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

/// A stretch of time that may be in contact: outside of its intervals a pair is proven free.
///
/// At `enter` the pair is within margin + tolerance. The pair is proven free before it, back to the
/// `leave` of the interval before. `leave` is sampled, not proven: a sample within margin +
/// tolerance lies in [leave - resolution, leave]. Gaps in which the pair comes apart for less than
/// twice the resolution may be counted to the interval around them.
struct ContactInterval {
  double enter = 0.0;  ///< [-]
  double leave = 1.0;  ///< [-]
  /// Not none: the interval was not searched to its end, nothing is known in it after `enter`.
  UndecidedReason reason = UndecidedReason::none;
};

/// The first contact of a pair of members, and what else was asked of the pair.
struct PairAnswer : FirstContactResult {
  BodyPair members = {};
  /// [m]  Closer than this counts as contact. For links it includes both paddings, and the effect
  /// of the tracking errors about t.
  double margin = 0.0;
  std::vector<ContactInterval> intervals = {};  ///< Of contact, in order, where asked.
  std::optional<ClosestApproach> closest = {};  ///< Over all times that are tested, where asked.
};

/// The answer of all pairs of members that are tested.
///
/// No pair is in contact before `t`, which is that of the deciding pair. The clearance is a lower
/// bound of every pair's distance up to t. Tolerance and enclosure error are the greatest of the
/// pairs that were searched.
struct SceneResult : Outcome {
  /// Index into `pairs` of the one that decides `t`: the earliest, ties by their order. None when
  /// free.
  std::optional<std::size_t> first = {};
  /// Index into `pairs` of the one that comes closest, where that was asked.
  std::optional<std::size_t> closest = {};
  /// Every tested pair where that was asked, else those that decide `t`, and the closest one where
  /// that was asked; by the order of members.
  std::vector<PairAnswer> pairs = {};
  WorkCount work = {};  ///< Of all pairs that were searched.
};

/// The pair that decides what holds of all: of several that decide alike the first. None where all
/// are free.
[[nodiscard]] FIRSTCONTACT_API std::optional<std::size_t> deciding_pair(
    std::span<const PairAnswer> pairs);

/// The pair that comes closest, among those with a closest approach; none where there is no such
/// pair.
///
/// If several pairs touch, it is the first in time.
[[nodiscard]] FIRSTCONTACT_API std::optional<std::size_t> closest_pair(
    std::span<const PairAnswer> pairs);

}  // namespace firstcontact
