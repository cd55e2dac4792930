/// @file
/// Fixed points of maps that repeats alone do not find.

#pragma once

#include <cstddef>
#include <deque>

#include <Eigen/Core>

namespace firstcontact::detail {

/// Finds x with change(x) = 0 from what guesses of it led to before.
///
/// The changes of the last guesses are combined to the least one, and the next guess is where the
/// same combination of guesses leads (D. G. Anderson, "Iterative procedures for nonlinear integral
/// equations", Journal of the ACM 12 (1965); H. F. Walker, P. Ni, "Anderson acceleration for
/// fixed-point iterations", SIAM Journal on Numerical Analysis 49 (2011)). A linear map of n
/// unknowns takes n + 1 guesses, also one whose repeats grow.
class AndersonMixing {
 public:
  /// @returns  the next guess; x + change where there was none before
  [[nodiscard]] Eigen::VectorXd next(const Eigen::VectorXd& x, const Eigen::VectorXd& change);

 private:
  static constexpr std::size_t kKept = 12;

  std::deque<Eigen::VectorXd> guesses_ = {};  // The newest last.
  std::deque<Eigen::VectorXd> changes_ = {};
};

}  // namespace firstcontact::detail
