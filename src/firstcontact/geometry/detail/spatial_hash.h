/// @file
/// A spatial hash: places by their cells.

#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/math/cell_hash.h>

namespace firstcontact::detail {

/// Finds the places that are near a given one.
class SpatialHash {
 public:
  /// Makes an empty spatial hash.
  ///
  /// @param reach  [m]  near means no farther than this; > 0
  explicit SpatialHash(double reach) : reach_(reach) {}

  /// Adds a place.
  ///
  /// @param key  of the caller
  void add(const Eigen::Vector3d& place, std::size_t key) {
    if (count_ < kFew) {
      few_[count_] = {place, key};
    } else {
      if (count_ == kFew) {
        for (const Place& before : few_) {
          cells_[cell_of(before.place)].push_back(before.key);
        }
      }
      cells_[cell_of(place)].push_back(key);
    }
    ++count_;
  }

  /// Calls use(key) for all near places, and some others; for a place as often as it was added.
  template <class Use>
  void for_each_near(const Eigen::Vector3d& place, const Use& use) const {
    if (count_ <= kFew) {
      for (std::size_t k = 0; k < count_; ++k) {
        use(few_[k].key);
      }
      return;
    }
    const Cell middle = cell_of(place);
    for (std::int64_t x = -1; x <= 1; ++x) {
      for (std::int64_t y = -1; y <= 1; ++y) {
        for (std::int64_t z = -1; z <= 1; ++z) {
          const auto found = cells_.find({middle[0] + x, middle[1] + y, middle[2] + z});
          if (found != cells_.end()) {
            for (const std::size_t key : found->second) {
              use(key);
            }
          }
        }
      }
    }
  }

 private:
  /// [places]  Greatest number for which all are visited, without cells.
  static constexpr std::size_t kFew = 24;

  struct Place {
    Eigen::Vector3d place;
    std::size_t key;
  };
  using Cell = std::array<std::int64_t, 3>;
  /// Finds the cell of a place. Cells are a little wider than the reach, for rounding of places up
  /// to 2^42 of it.
  [[nodiscard]] Cell cell_of(const Eigen::Vector3d& place) const {
    constexpr double kWider = 1.0 + 0x1p-10;
    Cell cell{};
    for (int i = 0; i < 3; ++i) {
      cell[static_cast<std::size_t>(i)] = cell_along(place[i], kWider * reach_);
    }
    return cell;
  }

  double reach_;
  std::size_t count_ = 0;
  std::array<Place, kFew> few_;  // The first places.
  // All places, where they are more than kFew.
  std::unordered_map<Cell, std::vector<std::size_t>, CellHash> cells_;
};

}  // namespace firstcontact::detail
