/// @file
/// The check of places at an end of a path, before the search.

#pragma once

#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/planning/plan_path.h>
#include <firstcontact/scene/contact_pair.h>

namespace firstcontact::detail {

class TimedEdges;

/// Tells which places are free at an end of a path, as the search has it.
///
/// Where something else moves, that is at the time 0, or at the end of the duration.
class EndCheck {
 public:
  /// @param plan       outlives this
  /// @param start      where contact pairs are measured
  /// @param tolerance  [m]  of the search
  /// @param stop       ends checks as undecided
  /// @throws std::invalid_argument if a contact pair is not tested, or touches at the start
  EndCheck(const PlanScene& plan, const Configuration& start, PathEnd at, double tolerance,
           const std::stop_token& stop);
  ~EndCheck();

  [[nodiscard]] bool is_free(const Configuration& q);

  /// Describes the pair that blocks a place, its depth, and the nearest free configuration that was
  /// found.
  ///
  /// @param what  "the start"
  [[nodiscard]] std::string describe(const Configuration& q, const std::string& what);

  /// Names the pair that blocks a place, which takes no longer than a check.
  [[nodiscard]] std::string describe_briefly(const Configuration& q, const std::string& what);

 private:
  /// Words for the time of the end, where something else moves.
  [[nodiscard]] std::string at_time() const;

  const PlanScene& plan_;
  EdgeCheckOptions options_;
  double t_ = 0.0;                      // [s]  Where something else moves.
  std::optional<EdgeChecker> checker_;  // Where all else rests.
  std::unique_ptr<TimedEdges> edges_;   // Where something else moves.
};

}  // namespace firstcontact::detail
