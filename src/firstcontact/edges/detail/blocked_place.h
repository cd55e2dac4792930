/// @file
/// The message about a place that is not free.

#pragma once

#include <functional>
#include <optional>
#include <string>

#include <firstcontact/edges/edge_checker.h>

namespace firstcontact::detail {

/// The test of which places are free.
struct PlaceTest {
  const PlanScene& scene;
  const EdgeCheckOptions& options;  ///< The options of the test.
  std::function<bool(const Configuration&)> is_free;
  double t = 0.0;  ///< [-]  Time at which a moving environment is taken.
};

/// The test of places by a checker, which outlives the result.
[[nodiscard]] PlaceTest test_of(const EdgeChecker& checker);

/// Describes a pair in one sentence: its depth, and the nearest free configuration that was found.
///
/// The depth is an upper bound: the shortest of 26 straight ways on which the first shape leaves
/// the second one for good. The place is on a straight way along an axis or in a random direction,
/// else the nearest of some thousand random places.
///
/// @param what  "the start is not free"
[[nodiscard]] std::string describe_pair(const PlaceTest& test, const Configuration& q,
                                        const BodyPair& pair, const std::string& what);

/// Describes the pair that blocks a place likewise.
///
/// @param what  "the start"
[[nodiscard]] std::string describe_blocked(const EdgeChecker& checker, const Configuration& q,
                                           const std::string& what);

/// Names the pair that blocks a place, without its depth and without a free place.
///
/// @param pair  none where it was not decided
/// @param what  "goal 3"
[[nodiscard]] std::string name_blocked(const PlanScene& scene, const std::optional<BodyPair>& pair,
                                       const std::string& what);

}  // namespace firstcontact::detail
