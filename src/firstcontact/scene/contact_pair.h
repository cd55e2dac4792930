/// @file
/// Pairs that may be in contact at an end of a planned path, and what the path keeps of them.

#pragma once

#include <array>

#include <firstcontact/many_bodies/pair_rules.h>

namespace firstcontact {

/// A rule for a pair that is in contact at one end of a path.
///
/// There the pair is closer than its margin, but apart by a distance d0 > 0. The rule holds the
/// pair to a share of d0 in place of its margin, as StartContacts::keep_half does. As d0 is above
/// 0, the two never pass into each other. All other pairs keep their margins.
enum class ContactPolicy {
  may_stay,  ///< Farther apart than half of d0 along the whole path. The pair may slide, leave and
             ///< return.
  not_deeper,  ///< Farther apart than 15/16 of d0 along the whole path.
  /// Farther apart than 15/16 of d0 along the one edge at that end. Along all other edges the pair
  /// keeps its margin.
  must_open,
};

/// The words of ContactPolicy in files, in this order.
inline constexpr std::array<const char*, 3> kContactPolicyWords{"may_stay", "not_deeper",
                                                                "must_open"};

/// [-]  The share of d0 that a pair is held to.
[[nodiscard]] constexpr double kept_share(ContactPolicy policy) {
  return policy == ContactPolicy::may_stay ? 0.5 : 0.9375;
}

/// An end of a path.
enum class PathEnd { start, goal };

/// The words of PathEnd in files, in this order.
inline constexpr std::array<const char*, 2> kPathEndWords{"start", "goal"};

/// A pair that may be in contact at an end of a path.
struct ContactPair {
  BodyPair members = {};  ///< Two members of the scene.
  ContactPolicy policy = ContactPolicy::may_stay;
  PathEnd at = PathEnd::start;  ///< The end at which d0 is measured; of several goals the least d0
                                ///< counts.
};

}  // namespace firstcontact
