/// @file
/// Finds the nearest of many items by any metric, exactly as a scan of all of them does.

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace firstcontact::detail {

/// Items by their distances, to which others are added.
///
/// New items wait in a list. Once that is full, it becomes a vantage-point tree, together with all
/// trees that are no larger. So an item is sorted into a tree log2(n) times at most. A tree has the
/// distances of items from its vantage point in two halves. The triangle inequality then excludes
/// whole halves.
///
/// Source: P. Yianilos, "Data structures and algorithms for nearest neighbor search in general
/// metric spaces", SODA 1993. J. Bentley, J. Saxe, "Decomposable searching problems I", Journal of
/// Algorithms 1 (1980).
class NearestIndex {
 public:
  /// Adds an item. Items are counted in the order in which they are added.
  ///
  /// @param item     any number, unlike those before
  /// @param between  the distance of two items by their numbers; a metric but for rounding
  template <class Between>
  void add(std::size_t item, const Between& between) {
    waiting_.push_back({item, count_++});
    if (waiting_.size() < kMostWaiting) {
      return;
    }
    std::vector<Item> items = std::exchange(waiting_, {});
    while (!trees_.empty() && trees_.back().items.size() <= items.size()) {
      items.insert(items.end(), trees_.back().items.begin(), trees_.back().items.end());
      trees_.pop_back();
    }
    trees_.push_back({std::move(items), {}});
    Builder<Between>{trees_.back(), between}.build();
  }

  /// The item with the least distance; of several the one that was added first.
  ///
  /// @param to       the distance of an item to the place that is asked for
  /// @param accepts  whether an item counts
  template <class To, class Accepts>
  [[nodiscard]] std::optional<std::size_t> nearest(const To& to, const Accepts& accepts) const {
    const std::vector<std::size_t> found = nearest_few(1, to, accepts);
    return found.empty() ? std::nullopt : std::optional(found.front());
  }

  /// The items with the least distances, the nearest one first; at most `most` > 0 of them.
  template <class To, class Accepts>
  [[nodiscard]] std::vector<std::size_t> nearest_few(std::size_t most, const To& to,
                                                     const Accepts& accepts) const {
    Search<To, Accepts> search{to, accepts, most};
    for (const Item& item : waiting_) {
      search.take(item);
    }
    for (const Tree& tree : trees_) {
      search.visit(tree, {0, tree.items.size()});
    }
    std::vector<std::size_t> numbers;
    for (const Placed& placed : search.few) {
      numbers.push_back(placed.second.number);
    }
    return numbers;
  }

 private:
  static constexpr std::size_t kMostWaiting = 64;
  static constexpr std::size_t kLeaf = 8;
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  struct Item {
    std::size_t number = 0;
    std::size_t order = 0;
  };
  /// An item and its distance.
  using Placed = std::pair<double, Item>;
  static bool is_nearer(const Placed& a, const Placed& b) {
    return a.first < b.first || (a.first == b.first && a.second.order < b.second.order);
  }
  /// A range of the items of a tree. Its first one is the vantage point, unless it is a leaf.
  struct Range {
    std::size_t begin = 0;
    std::size_t end = 0;

    [[nodiscard]] std::size_t size() const { return end - begin; }
    [[nodiscard]] bool is_leaf() const { return size() <= kLeaf; }
    /// The near half and the far half of the items behind the vantage point.
    [[nodiscard]] std::array<Range, 2> halves() const {
      const std::size_t middle = begin + 1 + (size() - 1) / 2;
      return {{{begin + 1, middle}, {middle, end}}};
    }
  };
  /// Least and greatest distance of a half from its vantage point.
  struct Shell {
    double least = kNone;
    double greatest = 0.0;
  };
  struct Tree {
    std::vector<Item> items;
    std::vector<std::array<Shell, 2>> shells;  // At the place of each vantage point.
  };

  template <class Between>
  struct Builder {
    Tree& tree;
    const Between& between;

    void build() {
      tree.shells.assign(tree.items.size(), {});
      std::vector<Range> left{{0, tree.items.size()}};
      while (!left.empty()) {
        const Range range = left.back();
        left.pop_back();
        if (!range.is_leaf()) {
          divide(range);
          const auto halves = range.halves();
          left.insert(left.end(), halves.begin(), halves.end());
        }
      }
    }

    void divide(const Range& range) {
      const auto from = [&](const Item& vantage) {
        std::vector<Placed> placed;
        for (std::size_t k = range.begin; k < range.end; ++k) {
          placed.emplace_back(between(vantage.number, tree.items[k].number), tree.items[k]);
        }
        return placed;
      };
      // The item that is farthest from another one divides the rest well.
      std::vector<Placed> placed = from(tree.items[range.begin]);
      const Item vantage = std::max_element(placed.begin(), placed.end(), is_nearer)->second;
      placed = from(vantage);
      const auto self = std::find_if(placed.begin(), placed.end(), [&](const Placed& one) {
        return one.second.order == vantage.order;
      });
      std::iter_swap(placed.begin(), self);
      const auto halves = range.halves();
      const auto middle =
          std::next(placed.begin(), static_cast<std::ptrdiff_t>(halves[1].begin - range.begin));
      std::nth_element(std::next(placed.begin()), middle, placed.end(), is_nearer);
      for (std::size_t k = 0; k < placed.size(); ++k) {
        tree.items[range.begin + k] = placed[k].second;
        if (k > 0) {
          const bool is_far = range.begin + k >= halves[1].begin;
          Shell& shell = tree.shells[range.begin][is_far ? 1 : 0];
          shell.least = std::min(shell.least, placed[k].first);
          shell.greatest = std::max(shell.greatest, placed[k].first);
        }
      }
    }
  };

  template <class To, class Accepts>
  struct Search {
    const To& to;
    const Accepts& accepts;
    std::size_t most = 1;
    std::vector<Placed> few = {};  // In order.
    double least = kNone;          // Farther items do not count.

    double take(const Item& item) {
      const Placed placed{to(item.number), item};
      const bool is_full = few.size() == most;
      if ((!is_full || is_nearer(placed, few.back())) && accepts(item.number)) {
        if (is_full) {
          few.pop_back();
        }
        few.insert(std::upper_bound(few.begin(), few.end(), placed, is_nearer), placed);
        least = few.size() == most ? few.back().first : kNone;
      }
      return placed.first;
    }

    /// A lower bound of the distance of all items in a shell, by the triangle inequality.
    ///
    /// Slack covers the rounding of distances. Items beyond the least distance only cost time.
    [[nodiscard]] static double bound(const Shell& shell, double distance) {
      constexpr double kSlack = 1e-9;  // [-]  Of the distances that are compared.
      const double slack = kSlack * (distance + shell.greatest);
      return std::max(distance - shell.greatest, shell.least - distance) - slack;
    }

    void visit(const Tree& tree, const Range& range) {
      if (range.is_leaf()) {
        for (std::size_t k = range.begin; k < range.end; ++k) {
          take(tree.items[k]);
        }
        return;
      }
      const double distance = take(tree.items[range.begin]);
      const auto& shells = tree.shells[range.begin];
      const auto halves = range.halves();
      const std::array bounds{bound(shells[0], distance), bound(shells[1], distance)};
      const std::size_t first = bounds[1] < bounds[0] ? 1 : 0;
      for (const std::size_t half : {first, 1 - first}) {
        if (bounds[half] <= least) {
          visit(tree, halves[half]);
        }
      }
    }
  };

  std::size_t count_ = 0;
  std::vector<Item> waiting_;
  std::vector<Tree> trees_;  // The larger ones first.
};

}  // namespace firstcontact::detail
