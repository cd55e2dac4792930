/// @file
/// How pairs of sweeps go on in the direction of those before.

#pragma once

#include <algorithm>
#include <utility>

#include <Eigen/Core>

namespace firstcontact::detail {

/// The direction of nonsmooth conjugate gradients (see project_on_contacts()), after Fletcher and
/// Reeves: what a pair of sweeps changes takes the place of the gradient. It starts anew where that
/// points against the direction of before (B. O'Donoghue, E. Candes, "Adaptive restart for
/// accelerated gradient schemes", Foundations of Computational Mathematics 15 (2015)), not where it
/// merely grew: of redundant contacts impulses go over in thousands of like steps.
///
/// @tparam State  a vector of numbers
template <class State>
class ConjugateDirection {
 public:
  using Number = typename State::Scalar;

  /// @param weights  squared lengths are measured with; of each number of the state
  explicit ConjugateDirection(State weights) : weights_(std::move(weights)) {}

  /// Before a pair of sweeps.
  void begin(const State& state) { step_ = state; }

  /// After it; moves the state on.
  void end(State& state) {
    step_ = state - step_;
    const Number squared = weights_.dot(step_.cwiseAbs2());
    const Number share = std::min(squared / last_, Number(1));
    last_ = squared;
    if (direction_.size() == 0 || !(weights_.dot(step_.cwiseProduct(direction_)) > Number())) {
      direction_ = step_;
      return;
    }
    direction_ *= share;
    state += direction_;
    direction_ += step_;
  }

 private:
  State weights_;
  State step_;
  State direction_;
  Number last_ = 0;
};

}  // namespace firstcontact::detail
