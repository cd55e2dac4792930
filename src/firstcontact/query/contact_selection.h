/// @file
/// The nearest of very many contacts, and some of every region, for a list with a limit.

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/math/cell_hash.h>

namespace firstcontact {

/// The features of a contact, which name it, and the numbers by which contacts are chosen.
struct ContactRank {
  std::array<std::uint64_t, 2> features = {};       ///< A number for the feature of each body.
  double distance = 0.0;                            ///< [m]
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< [m]  Point between the closest points.

  /// Orders by distance, the nearest first; exchanging the bodies changes nothing.
  friend bool operator<(const ContactRank& x, const ContactRank& y) {
    const auto key = [](const ContactRank& r) {
      const auto [low, high] = std::minmax(r.features[0], r.features[1]);
      return std::tuple(r.distance, low, high, r.place.x(), r.place.y(), r.place.z(),
                        r.features[0]);
    };
    return key(x) < key(y);
  }
};

/// Keeps a limited number of the contacts that it is given.
///
/// At most half of the kept contacts are the nearest of each cube of a grid. The cubes are as small
/// as this number allows. Their edge is the least power of two [m] for which no more of them hold
/// contacts. All others are the nearest contacts of all. So the choice does not depend on the order
/// in which contacts come. A contact that comes several times counts once.
///
/// Memory is linear in the number of contacts that are kept.
template <class Item>
class ContactSelection {
 public:
  /// @param most  >= 1
  explicit ContactSelection(std::size_t most)
      : most_(most), most_cells_(most / 2), most_held_(std::max(most, kFewHeld)) {
    most_held_ += std::min(most_held_, std::numeric_limits<std::size_t>::max() - most_held_);
  }

  void add(const ContactRank& rank, const Item& item) {
    add_to_cell(rank, item);
    if (!(rank.distance > reach_)) {
      nearest_.push_back({rank, item});
      if (nearest_.size() == most_held_) {
        forget_far();
      }
    }
  }

  /// [m]  A contact that is farther than this is not among the nearest. Infinite as long as there
  /// is room.
  [[nodiscard]] double reach() const { return reach_; }

  /// Drops contacts that are not among the nearest so far, so that reach() is the least.
  void forget_far() {
    keep_once(nearest_);
    if (nearest_.size() > most_) {
      std::nth_element(nearest_.begin(), nearest_.begin() + static_cast<std::ptrdiff_t>(most_ - 1),
                       nearest_.end(), by_rank);
      nearest_.resize(most_);
    }
    if (nearest_.size() == most_) {
      reach_ = std::max_element(nearest_.begin(), nearest_.end(), by_rank)->rank.distance;
    }
  }

  /// The contacts that are kept, in no order of meaning. Nothing may be added afterwards.
  [[nodiscard]] std::vector<Item> take() {
    std::vector<Entry> spread;
    for (auto& [cell, entry] : cells_) {
      spread.push_back(std::move(entry));
    }
    keep_once(spread);
    forget_far();
    std::sort(nearest_.begin(), nearest_.end(), by_rank);
    std::vector<Item> kept;
    for (Entry& entry : nearest_) {
      const bool is_spread = std::binary_search(spread.begin(), spread.end(), entry, by_features);
      if (kept.size() + spread.size() < most_ && !is_spread) {
        kept.push_back(std::move(entry.item));
      }
    }
    for (Entry& entry : spread) {
      kept.push_back(std::move(entry.item));
    }
    return kept;
  }

 private:
  struct Entry {
    ContactRank rank;
    Item item;
  };
  using Cell = std::array<std::int64_t, 3>;

  static constexpr std::size_t kFewHeld = 64;
  static constexpr double kFinest = 0x1p-30;  // [m]  The least edge of cubes.
  /// A shift that makes the numbers of cubes positive, so that all are in one of the largest.
  ///
  /// Cubes of some size then hold the origin, which bodies are often near.
  static constexpr std::int64_t kShift = 0x15555555555555;

  static bool by_rank(const Entry& x, const Entry& y) { return x.rank < y.rank; }
  static bool by_features(const Entry& x, const Entry& y) {
    return x.rank.features < y.rank.features;
  }

  /// Sorts entries by features, and leaves the first by rank of those that are the same contact.
  static void keep_once(std::vector<Entry>& entries) {
    std::sort(entries.begin(), entries.end(), [](const Entry& x, const Entry& y) {
      return x.rank.features != y.rank.features ? by_features(x, y) : by_rank(x, y);
    });
    const auto same = [](const Entry& x, const Entry& y) {
      return x.rank.features == y.rank.features;
    };
    entries.erase(std::unique(entries.begin(), entries.end(), same), entries.end());
  }

  void add_to_cell(const ContactRank& rank, const Item& item) {
    if (most_cells_ == 0) {
      return;
    }
    Cell cell;
    for (int k = 0; k < 3; ++k) {
      cell[static_cast<std::size_t>(k)] = (cell_along(rank.place[k], kFinest) + kShift) >> level_;
    }
    const auto [found, is_new] = cells_.try_emplace(cell, Entry{rank, item});
    if (!is_new && rank < found->second.rank) {
      found->second = {rank, item};
    }
    while (cells_.size() > most_cells_) {
      coarsen();
    }
  }

  /// Doubles the edge of the cubes.
  void coarsen() {
    ++level_;
    std::unordered_map<Cell, Entry, CellHash> coarse;
    for (auto& [cell, entry] : cells_) {
      const Cell around = {cell[0] >> 1, cell[1] >> 1, cell[2] >> 1};
      const auto [found, is_new] = coarse.try_emplace(around, entry);
      if (!is_new && entry.rank < found->second.rank) {
        found->second = std::move(entry);
      }
    }
    cells_ = std::move(coarse);
  }

  std::size_t most_;
  std::size_t most_cells_;
  std::size_t most_held_;  // Number of contacts held before the far ones are dropped.
  std::vector<Entry> nearest_;
  double reach_ = std::numeric_limits<double>::infinity();
  std::unordered_map<Cell, Entry, CellHash> cells_;
  int level_ = 0;  // Edges are kFinest times 2 to the power of this.
};

}  // namespace firstcontact
