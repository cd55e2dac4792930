/// @file
/// The checks of a planner, counted, and the end of its time.

#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/planning/plan_path.h>

namespace firstcontact::detail {

class PlanWork {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param hasty  a checker of the same scene with less effort, for checks outside of thoroughly()
  PlanWork(const EdgeChecker& checker, const EdgeChecker& hasty, const PlanOptions& options,
           Clock::time_point begin, Clock::time_point end)
      : checker_(checker),
        hasty_(hasty),
        now_(&hasty),
        options_(options),
        begin_(begin),
        end_(end) {}
  PlanWork(const EdgeChecker& checker, const PlanOptions& options, Clock::time_point begin,
           Clock::time_point end)
      : PlanWork(checker, checker, options, begin, end) {}

  [[nodiscard]] const ConfigurationSpace& space() const { return checker_.space(); }
  [[nodiscard]] const PlanOptions& options() const { return options_; }
  [[nodiscard]] const PlanScene& scene() const { return checker_.scene(); }
  /// [m]  Distance beyond the margin within which a pair may count as blocked.
  [[nodiscard]] double kept() const {
    return checker_.options().extra_clearance + checker_.options().tolerance;
  }

  /// Checks an edge, with the fraction that is free.
  EdgeAnswer check(const Configuration& from, const Configuration& to);
  /// Whether the whole edge is free, which takes less work.
  bool is_free(const Configuration& from, const Configuration& to);
  bool is_free(const Configuration& q);

  /// Calls `call` with all the effort that checks may take.
  template <class Call>
  auto thoroughly(const Call& call) {
    struct Restore {
      const EdgeChecker*& now;
      const EdgeChecker* before;
      ~Restore() { now = before; }
    };
    const Restore restore{now_, std::exchange(now_, &checker_)};
    return call();
  }

  /// Whether the time is over, or the search is to end.
  [[nodiscard]] bool is_over() const;
  [[nodiscard]] double seconds() const;
  void report(std::size_t nodes, const std::optional<double>& cost);

  /// The statistics, with the pairs that blocked.
  [[nodiscard]] PlanStatistics statistics() const;
  PlanStatistics& counts() { return counts_; }

 private:
  void count(const EdgeAnswer& answer);

  const EdgeChecker& checker_;
  const EdgeChecker& hasty_;
  const EdgeChecker* now_;  // One of these two.
  const PlanOptions& options_;
  Clock::time_point begin_;
  Clock::time_point end_;
  PlanStatistics counts_;
  std::map<BodyPair, std::size_t> blocked_;
};

/// A time in the clock of a planner; at most 1e9 s.
[[nodiscard]] PlanWork::Clock::duration time_in_clock(double seconds);

/// The sum of the lengths of the edges.
[[nodiscard]] double cost_of(const ConfigurationSpace& space,
                             const std::vector<Configuration>& path);

}  // namespace firstcontact::detail
