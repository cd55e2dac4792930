/// @file
/// Impulses of contacts that acted earlier in a step.

#pragma once

#include <algorithm>
#include <limits>
#include <map>
#include <vector>

#include <firstcontact/many_bodies/pair_rules.h>

namespace firstcontact::detail {

/// Adds impulses to the contacts at the same features, or else to the nearest ones on the same
/// pair.
///
/// @tparam Contact  has `bodies`, `feature_A`, `feature_B`, `point` and `impulse`
/// @param earlier   contacts that none takes on stay in it; all others are removed
/// @param farthest  [m]  distance from a contact within which others take its impulse on
template <typename Contact, typename Farthest>
void add_earlier_impulses(std::vector<Contact>& earlier, std::vector<Contact>& contacts,
                          const Farthest& farthest) {
  std::multimap<BodyPair, Contact*> of_pair;
  for (Contact& contact : contacts) {
    of_pair.emplace(contact.bodies, &contact);
  }
  std::erase_if(earlier, [&](const Contact& before) {
    Contact* nearest = nullptr;
    double least = farthest(before);
    const auto [first, end] = of_pair.equal_range(before.bodies);
    for (auto found = first; found != end && !before.impulse.isZero(0.0); ++found) {
      Contact& contact = *found->second;
      const bool is_same =
          contact.feature_A == before.feature_A && contact.feature_B == before.feature_B;
      const double apart = is_same ? -1.0 : (contact.point - before.point).norm();
      nearest = apart < least ? &contact : nearest;
      least = std::min(least, apart);
    }
    if (nearest != nullptr) {
      nearest->impulse += before.impulse;
    }
    return nearest != nullptr || before.impulse.isZero(0.0);
  });
}

/// Adds them at any distance.
template <typename Contact>
void add_earlier_impulses(std::vector<Contact>& earlier, std::vector<Contact>& contacts) {
  add_earlier_impulses(earlier, contacts,
                       [](const Contact&) { return std::numeric_limits<double>::infinity(); });
}

}  // namespace firstcontact::detail
