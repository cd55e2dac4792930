#include <firstcontact/contact_solver/detail/graph_colouring.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include <firstcontact/contact_solver/detail/constants.h>
#include <firstcontact/contact_solver/detail/contact_rows.h>

namespace firstcontact::detail {
namespace {

/// Hands out the lanes of pair batches, from a given batch on; skips many full batches at once.
class FreeLanes {
 public:
  explicit FreeLanes(std::size_t lanes) : lanes_(lanes) {}

  /// Takes a free lane.
  ///
  /// @param count    of the pair's contacts
  /// @param may_use  whether the pair may be in a batch
  template <class MayUse>
  PairPlace take_from(std::size_t batch, std::size_t count, const MayUse& may_use) {
    const std::size_t found = likest_with_room(batch, count, may_use);
    while (used_.size() <= found) {
      next_.push_back(used_.size());
      used_.push_back(0);
      counts_.push_back(0);
    }
    const PairPlace place{found, used_[found]++};
    counts_[found] = std::max(counts_[found], count);
    if (used_[found] == lanes_) {
      next_[found] = found + 1;
    }
    return place;
  }

  [[nodiscard]] std::vector<std::size_t> take_counts() { return std::move(counts_); }

 private:
  /// Chooses among a few batches with room the one whose pairs have as many contacts, as it leaves
  /// no lane empty; else the first.
  template <class MayUse>
  std::size_t likest_with_room(std::size_t batch, std::size_t count, const MayUse& may_use) {
    std::optional<std::size_t> first;
    std::size_t found = first_with_room(batch);
    for (int look = 0; look < kLooks && found < used_.size(); found = first_with_room(found + 1)) {
      if (may_use(found)) {
        first = first.value_or(found);
        ++look;
        if (counts_[found] == count) {
          return found;
        }
      }
    }
    return first.value_or(found);
  }

  std::size_t first_with_room(std::size_t batch) {
    std::size_t found = batch;
    while (found < next_.size() && next_[found] != found) {
      found = next_[found];
    }
    while (batch < found && batch < next_.size()) {
      batch = std::exchange(next_[batch], found);
    }
    return found;
  }

  static constexpr int kLooks = 16;

  std::size_t lanes_;
  std::vector<std::size_t> next_;  // For each batch itself, or a later one where it is full.
  std::vector<std::size_t> used_;
  std::vector<std::size_t> counts_;
};

/// Calls use(first, count) for each pair in turn.
template <class Use>
void for_each_pair(const std::vector<ContactPoint>& contacts, const Use& use) {
  for (std::size_t first = 0; first < contacts.size();) {
    const std::size_t count = count_of_pair(contacts, first);
    use(first, count);
    first += count;
  }
}

GraphColouring place_in_order(const ContactProblem& problem, std::size_t lanes) {
  const std::vector<ContactPoint>& contacts = problem.contacts;
  GraphColouring placed;
  placed.places.resize(contacts.size());
  // For each body the batch after its last one.
  std::vector<std::size_t> next(problem.bodies.size(), 0);
  FreeLanes free(lanes);
  for_each_pair(contacts, [&](std::size_t first, std::size_t count) {
    const auto [a, b] = contacts[first].bodies;
    placed.places[first] =
        free.take_from(std::max(next[a], next[b]), count, [](std::size_t) { return true; });
    for (const std::size_t body : contacts[first].bodies) {
      next[body] = is_movable(problem.bodies[body]) ? placed.places[first].batch + 1 : 0;
    }
  });
  placed.counts = free.take_counts();
  return placed;
}

/// The batches of a body.
class BatchesOfBody {
 public:
  [[nodiscard]] bool has(std::size_t batch) const { return batch < is_in_.size() && is_in_[batch]; }
  /// The first batch without the body.
  [[nodiscard]] std::size_t first_without() const { return first_without_; }
  void add(std::size_t batch) {
    is_in_.resize(std::max(is_in_.size(), batch + 1), false);
    is_in_[batch] = true;
    while (has(first_without_)) {
      ++first_without_;
    }
  }

 private:
  std::vector<bool> is_in_;
  std::size_t first_without_ = 0;
};

/// Places each pair in the first batch without its bodies.
GraphColouring place_anyhow(const ContactProblem& problem, std::size_t lanes) {
  const std::vector<ContactPoint>& contacts = problem.contacts;
  GraphColouring placed;
  placed.places.resize(contacts.size());
  std::vector<BatchesOfBody> used(problem.bodies.size());
  FreeLanes free(lanes);
  for_each_pair(contacts, [&](std::size_t first, std::size_t count) {
    const auto [a, b] = contacts[first].bodies;
    const auto may_use = [&used, a = a, b = b](std::size_t batch) {
      return !used[a].has(batch) && !used[b].has(batch);
    };
    placed.places[first] =
        free.take_from(std::max(used[a].first_without(), used[b].first_without()), count, may_use);
    for (const std::size_t body : contacts[first].bodies) {
      if (is_movable(problem.bodies[body])) {
        used[body].add(placed.places[first].batch);
      }
    }
  });
  placed.counts = free.take_counts();
  return placed;
}

}  // namespace

double GraphColouring::fill(std::size_t lanes) const {
  const std::size_t batches = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
  return static_cast<double>(places.size()) / static_cast<double>(batches * lanes);
}

std::size_t count_of_pair(const std::vector<ContactPoint>& contacts, std::size_t first) {
  std::size_t count = 1;
  while (count < kMostOfPair && first + count < contacts.size() &&
         contacts[first + count].bodies == contacts[first].bodies) {
    ++count;
  }
  return count;
}

std::optional<GraphColouring> place_pairs(const ContactProblem& problem, std::size_t lanes,
                                          bool in_any_order) {
  GraphColouring placed = place_in_order(problem, lanes);
  if (in_any_order && placed.fill(lanes) < kGoodFill) {
    placed = place_anyhow(problem, lanes);
  }
  const double in_batch = placed.fill(lanes) * static_cast<double>(lanes);
  return in_batch < kLeastInBatch ? std::nullopt : std::optional(std::move(placed));
}

}  // namespace firstcontact::detail
