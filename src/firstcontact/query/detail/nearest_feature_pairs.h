/// @file
/// Pairs of features with the nearest points that were found, each once.

#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

#include <firstcontact/geometry/feature_table.h>
#include <firstcontact/moving_pairs/detail/contact_frame.h>
#include <firstcontact/query/detail/workspace_data.h>

namespace firstcontact::detail {

/// Two features by their numbers, and the triangles (of the hierarchies) where they were found.
struct FoundFeatures {
  std::size_t number_A;
  std::size_t number_B;
  std::size_t triangle_A;
  std::size_t triangle_B;
};

/// The nearest points that were found for each pair of features.
///
/// Among points that are as near, those of the first triangles in the meshes are kept. Among these
/// the first found are kept.
class NearestFeaturePairs {
 public:
  NearestFeaturePairs(const ContactFrame& frame, const FeatureTable& A, const FeatureTable& B,
                      std::vector<ClosePair>& pairs)
      : frame_(frame), A_(A), B_(B), pairs_(pairs) {}

  /// @param find  computes the closest points, where they are kept
  template <class Find>
  void add(const FoundFeatures& found, double distance, const Find& find) {
    std::uint64_t& found_word = found_[found.number_A][found.number_B / 64];
    const std::uint64_t bit = std::uint64_t{1} << (found.number_B % 64);
    std::uint16_t& place = places_[found.number_A * B_.index.size() + found.number_B];
    if ((found_word & bit) == 0) {
      found_word |= bit;
      place = static_cast<std::uint16_t>(pairs_.size());
      pairs_.push_back(pair_of(found, find()));
    } else if (comes_before(found, distance, pairs_[place])) {
      pairs_[place] = pair_of(found, find());
    }
  }

  /// Lists the pairs in the order of features.
  void list(std::vector<CloseKey>& keys) const {
    for (std::size_t a = 0; a < A_.index.size(); ++a) {
      for (std::size_t word = 0; word < found_[a].size(); ++word) {
        for (std::uint64_t left = found_[a][word]; left != 0; left &= left - 1) {
          const std::size_t b = 64 * word + static_cast<std::size_t>(std::countr_zero(left));
          keys.push_back({.pair = &pairs_[places_[a * B_.index.size() + b]]});
        }
      }
    }
  }

 private:
  static Feature feature(const FeatureTable& table, std::size_t number, std::uint32_t triangle) {
    const FeatureType type = number < table.first_edge   ? FeatureType::vertex
                             : number < table.first_face ? FeatureType::edge
                                                         : FeatureType::face;
    return {type, table.index[number], triangle};
  }

  [[nodiscard]] std::uint32_t in_mesh_A(const FoundFeatures& found) const {
    return frame_.A.hierarchy().triangle_index[found.triangle_A];
  }
  [[nodiscard]] std::uint32_t in_mesh_B(const FoundFeatures& found) const {
    return frame_.B.hierarchy().triangle_index[found.triangle_B];
  }

  [[nodiscard]] bool comes_before(const FoundFeatures& found, double distance,
                                  const ClosePair& other) const {
    if (distance != other.closest.distance) {
      return distance < other.closest.distance;
    }
    return std::tuple(in_mesh_A(found), in_mesh_B(found)) <
           std::tuple(other.feature_A.triangle, other.feature_B.triangle);
  }

  [[nodiscard]] ClosePair pair_of(const FoundFeatures& found,
                                  const ClosestFeatures& closest) const {
    return {feature(A_, found.number_A, in_mesh_A(found)),
            feature(B_, found.number_B, in_mesh_B(found)),
            static_cast<std::uint32_t>(found.triangle_A),
            static_cast<std::uint32_t>(found.triangle_B), closest};
  }

  const ContactFrame& frame_;
  const FeatureTable& A_;
  const FeatureTable& B_;
  std::vector<ClosePair>& pairs_;
  static constexpr std::size_t kNumbers = FeatureTable::kMostNumbers;
  std::array<std::array<std::uint64_t, (kNumbers + 63) / 64>, kNumbers> found_{};
  std::array<std::uint16_t, kNumbers * kNumbers> places_;  // Places of the found pairs.
};

}  // namespace firstcontact::detail
