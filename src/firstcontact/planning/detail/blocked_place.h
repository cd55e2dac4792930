/// @file
/// What to tell of a place that is not free.

#pragma once

#include <optional>
#include <string>

#include <firstcontact/edges/edge_checker.h>

namespace firstcontact::detail {

/// [m]  The shortest straight way, of 26 directions, on which the first shape leaves the second one
/// for good: an upper bound of how deep the two are in each other. None where it was not found.
[[nodiscard]] std::optional<double> depth_of(const RobotScene& scene, const BodyPair& members);

/// A free place near to one that is not: on a straight way along an axis or in a random direction,
/// else the nearest of some thousand random places.
[[nodiscard]] std::optional<Configuration> free_place_near(const EdgeChecker& checker,
                                                           const Configuration& q);

/// One sentence: a pair, how deep it is, and the nearest free place that was found.
///
/// @param what  "the start is not free"
[[nodiscard]] std::string describe_pair(const EdgeChecker& checker, const Configuration& q,
                                        const BodyPair& pair, const std::string& what);

/// The same of the pair that blocks a place.
///
/// @param what  "the start"
[[nodiscard]] std::string describe_blocked(const EdgeChecker& checker, const Configuration& q,
                                           const std::string& what);

}  // namespace firstcontact::detail
