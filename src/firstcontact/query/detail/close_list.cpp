#include <firstcontact/query/detail/close_list.h>

#include <algorithm>

namespace firstcontact::detail {
namespace {

/// Number of pairs that are listed as they come, some of them several times: 5 MB.
constexpr std::size_t kFew = std::size_t{1} << 15;

/// Number of pairs that are counted: 10 MB, and a tenth of a second to find them.
constexpr std::size_t kMostCounted = std::size_t{1} << 18;

}  // namespace

std::uint64_t number_of(const Feature& feature) {
  return static_cast<std::uint64_t>(feature.type) << 32 | feature.index;
}

ContactRank rank_of(const ClosePair& pair) {
  return {{number_of(pair.feature_A), number_of(pair.feature_B)},
          pair.closest.distance,
          0.5 * (pair.closest.p_A + pair.closest.p_B)};
}

std::size_t CloseList::FeaturesHash::operator()(
    const std::array<std::uint64_t, 2>& features) const {
  constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15U;
  const std::uint64_t hash = (features[0] * kOdd ^ features[1]) * kOdd;
  return static_cast<std::size_t>(hash ^ hash >> 32);
}

CloseList::CloseList(std::vector<ClosePair>& pairs, std::size_t most) : pairs_(pairs), most_(most) {
  clear();
}

void CloseList::clear() {
  pairs_.clear();
  selection_.reset();
  counted_.clear();
  reach_ = std::numeric_limits<double>::infinity();
}

void CloseList::add(const ClosePair& pair) {
  if (selection_) {
    select(pair);
    return;
  }
  pairs_.push_back(pair);
  if (pairs_.size() > std::max(kFew, most_)) {
    selection_.emplace(most_);
    for (const ClosePair& listed : pairs_) {
      select(listed);
    }
    pairs_.clear();
  }
}

void CloseList::select(const ClosePair& pair) {
  const ContactRank rank = rank_of(pair);
  selection_->add(rank, pair);
  const std::size_t most_counted = std::max(kMostCounted, most_);
  if (counted_.size() <= most_counted) {
    counted_.insert(rank.features);
    if (counted_.size() <= most_counted) {
      return;
    }
    selection_->forget_far();
  }
  reach_ = selection_->reach();
}

std::optional<ContactCount> CloseList::finish() {
  if (!selection_) {
    return std::nullopt;
  }
  pairs_ = selection_->take();
  const std::size_t most_counted = std::max(kMostCounted, most_);
  const bool is_exact = counted_.size() <= most_counted;
  return ContactCount{std::min(counted_.size(), most_counted), is_exact};
}

}  // namespace firstcontact::detail
