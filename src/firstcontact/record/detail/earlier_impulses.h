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
/// @param earlier  contacts of pairs that parted stay in it; all others are removed
template <typename Contact>
void add_earlier_impulses(std::vector<Contact>& earlier, std::vector<Contact>& contacts) {
  std::multimap<BodyPair, Contact*> of_pair;
  for (Contact& contact : contacts) {
    of_pair.emplace(contact.bodies, &contact);
  }
  std::erase_if(earlier, [&](const Contact& before) {
    Contact* nearest = nullptr;
    double least = std::numeric_limits<double>::infinity();
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

}  // namespace firstcontact::detail
