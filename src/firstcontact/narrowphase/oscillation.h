/// @file
/// Bounds of how fast products of vectors that turn with two bodies can change.

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace firstcontact {

/// The lengths of a vector's parts along and across the axis that it turns about.
struct AxialParts {
  double along = 0.0;
  double across = 0.0;
};

/// Divides a vector into its parts along and across an axis.
///
/// @param axis  [-]  unit
inline AxialParts axial_parts(const Eigen::Vector3d& v, const Eigen::Vector3d& axis) {
  const double along = axis.dot(v);
  return {std::abs(along), (v - along * axis).norm()};
}

/// Bounds on the derivatives of U . V and U x V, where U turns about u_A at the rate w_A and V
/// about u_B at the rate w_B. They hold at every time, for any number of turns.
///
/// Derivation: U(t) = U_|| + Re(M e^{i w_A t}) with M = |U_across| (e - i e'). The vectors e, e'
/// and u_A are orthonormal. V is written likewise, with N. In the product of the turning parts,
///   Re(M e^{i a}) Re(N e^{i b}) = 1/2 Re(M N e^{i (a + b)}) + 1/2 Re(M conj(N) e^{i (a - b)}),
/// the scalar products are |M . N| = |U||V| (1 - c) and |M . conj(N)| = |U||V| (1 + c) with
/// c = u_A . u_B. The lengths of the vector products follow from Lagrange's identity. They are
/// |U||V| sqrt(4 - (1 + c)^2) and |U||V| sqrt(4 - (1 - c)^2). A part along an axis stands still.
/// Its scalar product with a part that turns about the other axis has the amplitude |u_A x u_B|.
/// Each derivative multiplies a term by its frequency.
class Oscillation {
 public:
  Oscillation() = default;

  /// Prepares bounds for two axes and rates.
  ///
  /// @param axis_A, axis_B  [-]  unit up to rounding
  /// @param rate_A, rate_B  [rad per step]  >= 0
  Oscillation(const Eigen::Vector3d& axis_A, double rate_A, const Eigen::Vector3d& axis_B,
              double rate_B)
      : axes_sine_(axis_A.cross(axis_B).norm() + kSlack) {
    const double c = axis_A.dot(axis_B);
    const double less = std::max(0.0, 1.0 - c) + kSlack;
    const double more = std::max(0.0, 1.0 + c) + kSlack;
    const double sum_cross = std::sqrt(std::max(0.0, 4.0 - more * more) + kSlack);
    const double difference_cross = std::sqrt(std::max(0.0, 4.0 - less * less) + kSlack);
    double A = 1.0;
    double B = 1.0;
    double sum = 0.5;
    double difference = 0.5;
    for (Order& order : orders_) {
      A *= rate_A;
      B *= rate_B;
      sum *= rate_A + rate_B;
      difference *= std::abs(rate_A - rate_B);
      order = {A, B, less * sum + more * difference,
               sum_cross * sum + difference_cross * difference};
    }
  }

  /// Bound of the k-th derivative of U . V, k = 1, 2, up to the rounding of a few operations.
  [[nodiscard]] double dot_derivative(std::size_t k, const AxialParts& U,
                                      const AxialParts& V) const {
    const Order& order = orders_[k - 1];
    return axes_sine_ * (order.B * U.along * V.across + order.A * U.across * V.along) +
           order.dot * U.across * V.across;
  }
  /// Bound of the length of the k-th derivative of U x V, up to the rounding of a few operations.
  [[nodiscard]] double cross_derivative(std::size_t k, const AxialParts& U,
                                        const AxialParts& V) const {
    const Order& order = orders_[k - 1];
    return order.B * U.along * V.across + order.A * U.across * V.along +
           order.cross * U.across * V.across;
  }

 private:
  static constexpr double kSlack = 0x1p-48;  // Covers the rounding of the axes.

  /// Powers of the rates, and the factors for products of turning parts that follow from them.
  struct Order {
    double A = 0.0;
    double B = 0.0;
    double dot = 0.0;
    double cross = 0.0;
  };

  std::array<Order, 2> orders_;
  double axes_sine_ = 0.0;
};

}  // namespace firstcontact
