/// @file
/// A list of close pairs of features that does not grow with how many there are.

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

/// Takes pairs as they are found, some of them more than once. As long as there are few, all are
/// listed. Of many only those that the list may be left with are kept, and their number counted.
/// Counting very many would take long: it ends, and with it the search for those that are not
/// among the nearest.
class CloseList {
 public:
  /// @param pairs  where the list is; what it holds is dropped
  /// @param most   of them that are asked for
  CloseList(std::vector<ClosePair>& pairs, std::size_t most);

  /// Begins anew.
  void clear();

  void add(const ClosePair& pair);

  /// [m]  What is farther need not be added.
  [[nodiscard]] double reach() const { return reach_; }

  /// Ends it: `pairs` holds what is kept. How many pairs of features came; none where all are
  /// listed.
  [[nodiscard]] std::optional<ContactCount> finish();

 private:
  struct FeaturesHash {
    std::size_t operator()(const std::array<std::uint64_t, 2>& features) const;
  };

  void select(const ClosePair& pair);

  std::vector<ClosePair>& pairs_;
  std::size_t most_;
  double reach_ = std::numeric_limits<double>::infinity();
  std::optional<ContactSelection<ClosePair>> selection_;  // Where there are many.
  std::unordered_set<std::array<std::uint64_t, 2>, FeaturesHash> counted_;
};

}  // namespace firstcontact::detail
