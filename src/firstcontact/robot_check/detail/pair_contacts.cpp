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

ContactRank rank_of(const RobotContact& found) {
  const auto& [members, geometries, contact] = found;
  return {
      {number_of(geometries[0], contact.feature_A), number_of(geometries[1], contact.feature_B)},
      contact.distance,
      0.5 * (contact.p_WA + contact.p_WB)};
}

}  // namespace

void PairContacts::clear() {
  all_.clear();
  selection_.reset();
}

void PairContacts::add(std::span<const RobotContact> contacts) {
  if (!selection_ && contacts.size() <= most_ - all_.size()) {
    all_.insert(all_.end(), contacts.begin(), contacts.end());
    return;
  }
  if (!selection_) {
    selection_.emplace(most_);
    add(std::exchange(all_, {}));
  }
  for (const RobotContact& contact : contacts) {
    selection_->add(rank_of(contact), contact);
  }
}

std::vector<RobotContact> PairContacts::take() {
  if (!selection_) {
    return std::move(all_);
  }
  std::vector<RobotContact> kept = selection_->take();
  std::sort(kept.begin(), kept.end(), [](const RobotContact& x, const RobotContact& y) {
    const auto key = [](const RobotContact& found) {
      return std::tuple(found.geometries, rank_of(found).features);
    };
    return key(x) < key(y);
  });
  return kept;
}

}  // namespace firstcontact::detail
