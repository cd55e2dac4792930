/// @file
/// Validators of OMPL that sample edges and test the samples by FCL.

#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <queue>
#include <utility>

#include <ompl/base/MotionValidator.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateValidityChecker.h>

#include <firstcontact_ompl/proven_edges.h>

#include "benchmarks/planning/fcl_places.h"
#include "benchmarks/support/timing.h"

namespace firstcontact::benchmarks {

/// Time that a validator spent, and the number of edges it tested.
struct Spent {
  double ms = 0.0;
  std::size_t edges = 0;
};

/// Adds the time of a call to that spent.
template <class Call>
auto timed(Spent& spent, const Call& call) {
  const double begin = thread_time();
  auto answer = call();
  spent.ms += 1e-3 * (thread_time() - begin);
  ++spent.edges;
  return answer;
}

/// Tests samples of an edge by FCL: its end first, then by bisection, breadth first.
class SampledMotions : public ompl::base::MotionValidator {
 public:
  /// @param count  returns the number of steps of an edge
  using Count = std::function<int(const ompl::base::State*, const ompl::base::State*)>;
  SampledMotions(const ompl::base::SpaceInformationPtr& si, OmplStates states, FclPlaces& places,
                 Count count, Spent& spent)
      : MotionValidator(si),
        states_(std::move(states)),
        places_(places),
        count_(std::move(count)),
        spent_(spent) {}

  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to) const override {
    return timed(spent_, [&] { return is_free(from, to); });
  }
  /// Tests the samples from the start on, as OMPL's own validator does.
  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to,
                   std::pair<ompl::base::State*, double>& last) const override {
    return timed(spent_, [&] { return is_free(from, to, last); });
  }

 private:
  [[nodiscard]] bool is_free(const ompl::base::State* from, const ompl::base::State* to) const {
    const Configuration a = states_.read(from);
    const Configuration b = states_.read(to);
    if (places_.collide(b)) {
      return false;
    }
    const int count = count_(from, to);
    std::queue<std::pair<int, int>> open;
    if (count > 1) {
      open.push({1, count - 1});
    }
    Configuration q = a;
    while (!open.empty()) {
      const auto [low, high] = open.front();
      open.pop();
      const int middle = (low + high) / 2;
      for (std::size_t k = 0; k < q.size(); ++k) {
        q[k] = a[k] + (b[k] - a[k]) * middle / count;
      }
      if (places_.collide(q)) {
        return false;
      }
      if (low < middle) {
        open.push({low, middle - 1});
      }
      if (middle < high) {
        open.push({middle + 1, high});
      }
    }
    return true;
  }

  [[nodiscard]] bool is_free(const ompl::base::State* from, const ompl::base::State* to,
                             std::pair<ompl::base::State*, double>& last) const {
    const Configuration a = states_.read(from);
    const Configuration b = states_.read(to);
    const int count = std::max(1, count_(from, to));
    Configuration q = a;
    for (int k = 1; k <= count; ++k) {
      for (std::size_t j = 0; j < q.size(); ++j) {
        q[j] = a[j] + (b[j] - a[j]) * k / count;
      }
      if (places_.collide(k == count ? b : q)) {
        last.second = static_cast<double>(k - 1) / count;
        if (last.first != nullptr) {
          for (std::size_t j = 0; j < q.size(); ++j) {
            q[j] = a[j] + (b[j] - a[j]) * (k - 1) / count;
          }
          states_.write(q, last.first);
        }
        return false;
      }
    }
    return true;
  }

  OmplStates states_;
  FclPlaces& places_;
  Count count_;
  Spent& spent_;
};

class SampledStates : public ompl::base::StateValidityChecker {
 public:
  SampledStates(const ompl::base::SpaceInformationPtr& si, OmplStates states, FclPlaces& places)
      : StateValidityChecker(si), states_(std::move(states)), places_(places) {}

  bool isValid(const ompl::base::State* state) const override {
    return si_->satisfiesBounds(state) && !places_.collide(states_.read(state));
  }

 private:
  OmplStates states_;
  FclPlaces& places_;
};

}  // namespace firstcontact::benchmarks
