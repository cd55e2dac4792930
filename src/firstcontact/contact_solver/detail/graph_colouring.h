/// @file
/// Graph colouring: the pairs of bodies in contact that are solved at once.

#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <firstcontact/contact_solver/contact_problem.h>

namespace firstcontact::detail {

/// The place of a pair in batches.
struct PairPlace {
  std::size_t batch = 0;
  std::size_t lane = 0;
};

/// Pairs in lanes of batches. The pairs of a batch share no moving body.
struct GraphColouring {
  std::vector<PairPlace> places;    ///< Place of the first contact of each pair.
  std::vector<std::size_t> counts;  ///< For each batch the most contacts that a pair has.

  /// [-]  The fraction of the lanes that contacts fill.
  [[nodiscard]] double fill(std::size_t lanes) const;
};

/// Counts the contacts from one on that are taken as one pair: of the same bodies, four at most.
[[nodiscard]] std::size_t count_of_pair(const std::vector<ContactPoint>& contacts,
                                        std::size_t first);

/// Places all pairs so that each body meets its contacts in the order of the problem.
///
/// @param lanes         of a batch
/// @param in_any_order  gives up this order where chains of pairs would leave many lanes empty
/// @returns nothing where most stay empty
[[nodiscard]] std::optional<GraphColouring> place_pairs(const ContactProblem& problem,
                                                        std::size_t lanes, bool in_any_order);

}  // namespace firstcontact::detail
