/// @file
/// A list of close pairs of features with bounded memory.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_set>
#include <vector>

#include <firstcontact/query/contact_selection.h>
#include <firstcontact/query/detail/workspace_data.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact::detail {

/// A feature as a number, in the order of types and indices.
[[nodiscard]] std::uint64_t number_of(const Feature& feature);

/// The rank by which a pair of features is chosen.
[[nodiscard]] ContactRank rank_of(const ClosePair& pair);

/// Takes pairs as they are found, some of them more than once.
///
/// As long as there are few, all are listed. If there are many, the list keeps only those that may
/// remain, and counts all. Counting very many would take long, so it ends. The search for pairs
/// that are not among the nearest then ends, too.
class CloseList {
 public:
  /// @param pairs  place of the list; its contents are dropped
  /// @param most   number of pairs that are asked for
  CloseList(std::vector<ClosePair>& pairs, std::size_t most);

  /// Drops all pairs.
  void clear();

  void add(const ClosePair& pair);

  /// [m]  Pairs that are farther apart need not be added.
  [[nodiscard]] double reach() const { return reach_; }

  /// Ends the list: `pairs` holds those that are kept. Returns the number of all; none where all
  /// are listed.
  [[nodiscard]] std::optional<ContactCount> finish();

 private:
  struct FeaturesHash {
    std::size_t operator()(const std::array<std::uint64_t, 2>& features) const;
  };

  void select(const ClosePair& pair);

  std::vector<ClosePair>& pairs_;
  std::size_t most_;
  double reach_ = std::numeric_limits<double>::infinity();
  std::optional<ContactSelection<ClosePair>> selection_;  // Only where there are many.
  std::unordered_set<std::array<std::uint64_t, 2>, FeaturesHash> counted_;
};

}  // namespace firstcontact::detail
