/// @file
/// What to tell of a place that is not free.

#pragma once

#include <functional>
#include <string>

#include <firstcontact/edges/edge_checker.h>

namespace firstcontact::detail {

/// Decides which places are free.
struct PlaceTest {
  const PlanScene& scene;
  const EdgeCheckOptions& options;  ///< Those by which it decides.
  std::function<bool(const Configuration&)> is_free;
  double t = 0.0;  ///< [-]  Where the surroundings move, they are where they are then.
};

/// The test of places by a checker, which outlives it.
[[nodiscard]] PlaceTest test_of(const EdgeChecker& checker);

/// One sentence: a pair, how deep it is, and the nearest free place that was found.
///
/// The depth is that of the shortest straight way, of 26 directions, on which the first shape
/// leaves the second one for good: an upper bound. The place is on a straight way along an axis or
/// in a random direction, else the nearest of some thousand random places.
///
/// @param what  "the start is not free"
[[nodiscard]] std::string describe_pair(const PlaceTest& test, const Configuration& q,
                                        const BodyPair& pair, const std::string& what);

/// The same of the pair that blocks a place.
///
/// @param what  "the start"
[[nodiscard]] std::string describe_blocked(const EdgeChecker& checker, const Configuration& q,
                                           const std::string& what);

}  // namespace firstcontact::detail
