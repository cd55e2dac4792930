/// @file
/// Pairs that are in contact at an end of a path: their distances, and the edge on which they open.

#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/math/random_numbers.h>
#include <firstcontact/planning/plan_path.h>
#include <firstcontact/scene/contact_pair.h>

namespace firstcontact::detail {

/// The place of an edge in a path, which decides whether pairs that must open are held.
enum class EdgePlace { inner, at_start, at_goal };

/// The distances that contact pairs are held to.
class ContactEnds {
 public:
  /// Measures the pairs of a scene.
  ///
  /// Pairs that are not in contact at their end are left out, with a warning.
  ///
  /// @param kept       [m]  distance that a search keeps beyond the margins
  /// @param tolerance  [m]  of the search
  /// @throws std::invalid_argument if a pair is not tested, or touches at its end, so that no
  ///         distance is left to hold. The message has the depth and the nearest free configuration
  ///         that was found
  ContactEnds(const PlanScene& plan, const Configuration& start,
              const std::vector<Configuration>& goals, double kept, double tolerance);

  [[nodiscard]] const std::vector<PlannedContact>& pairs() const { return pairs_; }
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

  /// Whether a pair must open at an end.
  [[nodiscard]] bool opens(PathEnd at) const;

  /// The pairs that are held along an edge, for the proof of a path.
  [[nodiscard]] std::vector<HeldPair> held(EdgePlace place) const;

  /// The pairs that are held in a search: to a little more, so that the proof finds its edges free.
  [[nodiscard]] std::vector<HeldPair> held_in_search(EdgePlace place) const;

 private:
  void measure(const PlanScene& plan, const ContactPair& pair,
               const std::vector<Configuration>& places, double kept, double tolerance);

  std::vector<PlannedContact> pairs_;
  std::vector<std::string> warnings_;
};

/// The question for an edge on which pairs open.
struct OpeningQuestion {
  const EdgeChecker& held;    ///< Checker of the edge.
  const EdgeChecker& strict;  ///< Checker of the place at which the edge ends, where all pairs are
                              ///< open.
  const Configuration& end;   ///< End of the path, where the pairs are in contact.
  PathEnd at = PathEnd::start;
  double first_step = 0.0;  ///< [m]  Length of the shortest way that is tried.
};

/// Looks for a free place that a straight edge joins to an end of the path.
///
/// It tries the axes and random directions, on ways that double. Shorter ways come first.
///
/// @param is_over  ends the search
[[nodiscard]] std::optional<Configuration> find_opening(const OpeningQuestion& question,
                                                        RandomNumbers& random,
                                                        const std::function<bool()>& is_over);

}  // namespace firstcontact::detail
