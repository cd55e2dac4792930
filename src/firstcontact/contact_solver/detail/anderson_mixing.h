/// @file
/// Fixed points of maps whose repetition alone does not converge.

#pragma once

#include <cstddef>
#include <deque>

#include <Eigen/Core>

namespace firstcontact::detail {

/// Finds x with change(x) = 0 from earlier guesses and their changes.
///
/// The changes of the last guesses are combined to the least one, and the next guess is the same
/// combination of the guesses after their changes (D. G. Anderson, "Iterative procedures for
/// nonlinear integral equations", Journal of the ACM 12 (1965); H. F. Walker, P. Ni, "Anderson
/// acceleration for fixed-point iterations", SIAM Journal on Numerical Analysis 49 (2011)). A
/// linear map of n unknowns takes n + 1 guesses, even where its repetition diverges.
class AndersonMixing {
 public:
  /// Computes the next guess.
  ///
  /// @returns  x + change where there was no guess before
  [[nodiscard]] Eigen::VectorXd next(const Eigen::VectorXd& x, const Eigen::VectorXd& change);

 private:
  static constexpr std::size_t kKept = 12;

  std::deque<Eigen::VectorXd> guesses_ = {};  // The newest guess is the last.
  std::deque<Eigen::VectorXd> changes_ = {};
};

}  // namespace firstcontact::detail
