#include <firstcontact/robot_check/detail/pair_contacts.h>

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <utility>

namespace firstcontact::detail {
namespace {

/// A feature of one of the member's geometries as a number.
std::uint64_t number_of(std::size_t geometry, const Feature& feature) {
  return static_cast<std::uint64_t>(geometry) << 34 |
         static_cast<std::uint64_t>(feature.type) << 32 | feature.index;
}

ContactRank rank_of(const Contact& found) {
  return {{number_of(found.geometries[0], found.feature_A),
           number_of(found.geometries[1], found.feature_B)},
          found.distance,
          0.5 * (found.p_WA + found.p_WB)};
}

}  // namespace

void PairContacts::clear() {
  all_.clear();
  selection_.reset();
}

void PairContacts::add(std::span<const Contact> contacts) {
  if (!selection_ && contacts.size() <= most_ - all_.size()) {
    all_.insert(all_.end(), contacts.begin(), contacts.end());
    return;
  }
  if (!selection_) {
    selection_.emplace(most_);
    add(std::exchange(all_, {}));
  }
  for (const Contact& contact : contacts) {
    selection_->add(rank_of(contact), contact);
  }
}

std::vector<Contact> PairContacts::take() {
  if (!selection_) {
    return std::move(all_);
  }
  std::vector<Contact> kept = selection_->take();
  std::sort(kept.begin(), kept.end(), [](const Contact& x, const Contact& y) {
    const auto key = [](const Contact& found) {
      return std::tuple(found.geometries, rank_of(found).features);
    };
    return key(x) < key(y);
  });
  return kept;
}

}  // namespace firstcontact::detail
