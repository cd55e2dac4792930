/// @file
/// Conjugate directions of pairs of sweeps.

#pragma once

#include <algorithm>
#include <utility>

#include <Eigen/Core>

namespace firstcontact::detail {

/// The direction of nonsmooth conjugate gradients (see project_on_contacts()), after Fletcher and
/// Reeves: the change by a pair of sweeps takes the place of the gradient.
///
/// It starts anew where the change points against the direction (B. O'Donoghue, E. Candes,
/// "Adaptive restart for accelerated gradient schemes", Foundations of Computational Mathematics 15
/// (2015)). It does not where the change only grew. Between redundant contacts impulses move over
/// in thousands of like steps.
///
/// @tparam State  a vector of numbers
template <class State>
class ConjugateDirection {
 public:
  using Number = typename State::Scalar;

  /// Makes a direction.
  ///
  /// @param weights  one for each number of the state; they weigh its square in squared lengths
  explicit ConjugateDirection(State weights) : weights_(std::move(weights)) {}

  /// Call it before a pair of sweeps.
  void begin(const State& state) { step_ = state; }

  /// Call it after the pair; it moves the state on.
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
