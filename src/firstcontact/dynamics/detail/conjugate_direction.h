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
class ConjugateDirection {
 public:
  /// @param weights  squared lengths are measured with; of each number of the state
  explicit ConjugateDirection(Eigen::VectorXd weights) : weights_(std::move(weights)) {}

  /// Before a pair of sweeps.
  void begin(const Eigen::VectorXd& state) { step_ = state; }

  /// After it; moves the state on.
  void end(Eigen::VectorXd& state) {
    step_ = state - step_;
    const double squared = weights_.dot(step_.cwiseAbs2());
    const double share = std::min(squared / last_, 1.0);
    last_ = squared;
    if (direction_.size() == 0 || !(weights_.dot(step_.cwiseProduct(direction_)) > 0.0)) {
      direction_ = step_;
      return;
    }
    direction_ *= share;
    state += direction_;
    direction_ += step_;
  }

 private:
  Eigen::VectorXd weights_;
  Eigen::VectorXd step_;
  Eigen::VectorXd direction_;
  double last_ = 0.0;
};

}  // namespace firstcontact::detail
