/// @file
/// Points and vectors of body B as seen from body A, and how fast what A sees can change.

#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/math/fast_sine_cosine.h>
#include <firstcontact/narrowphase/elementary_contact.h>

namespace firstcontact::detail {

/// Factors that outweigh the roundings of the few operations in a bound.
inline constexpr double kUp = 1.0 + 0x1p-40;

/// How far both bodies have turned.
struct Turns {
  double tau;
  SineCosine A;
  SineCosine B;
};

inline Turns turns_at(const ElementaryMotion& motion, double t) {
  const double tau = t - motion.t_begin();
  return {tau, fast_sine_cosine(motion.A().rate * tau), fast_sine_cosine(motion.B().rate * tau)};
}

/// v in A's axes at the start of the piece, once A has turned: Rot(u_A, -angle) v.
inline Eigen::Vector3d turned_back(const Eigen::Vector3d& axis, const SineCosine& angle,
                                   const Eigen::Vector3d& v) {
  return angle.cosine * v + ((1.0 - angle.cosine) * axis.dot(v)) * axis -
         angle.sine * axis.cross(v);
}

/// A vector v(tau) = constant + tau drift + cos(w_B tau) cosine + sin(w_B tau) sine of body B in
/// world axes: a point's position from A's pivot, or a difference of two points.
struct SeenVector {
  Eigen::Vector3d constant;
  Eigen::Vector3d drift;
  Eigen::Vector3d cosine;
  Eigen::Vector3d sine;
  double swing;  ///< Length of the turning part.

  struct State {
    Eigen::Vector3d value;  ///< In A's axes.
    Eigen::Vector3d rate;   ///< Of v in the world, in A's axes: A's own turning is not in it.
  };

  [[nodiscard]] State at(const ElementaryMotion& motion, const Turns& turns) const {
    const double w = motion.B().rate;
    const Eigen::Vector3d value =
        constant + turns.tau * drift + turns.B.cosine * cosine + turns.B.sine * sine;
    const Eigen::Vector3d rate = drift + (w * turns.B.cosine) * sine - (w * turns.B.sine) * cosine;
    return {turned_back(motion.A().axis, turns.A, value),
            turned_back(motion.A().axis, turns.A, rate)};
  }
};

/// @param v  of body B, in world axes at the start of the piece
inline SeenVector seen_vector(const ElementaryMotion& motion, const Eigen::Vector3d& v) {
  const Eigen::Vector3d& u = motion.B().axis;
  const Eigen::Vector3d along = u.dot(v) * u;
  const Eigen::Vector3d across = v - along;
  return {along, Eigen::Vector3d::Zero(), across, u.cross(v), across.norm()};
}

/// @param r_B  lever of a point of B, in world axes at the start of the piece
inline SeenVector seen_point(const ElementaryMotion& motion, const Eigen::Vector3d& r_B) {
  SeenVector seen = seen_vector(motion, r_B);
  seen.constant += motion.offset();
  seen.drift = motion.drift();
  return seen;
}

/// The lengths of a vector's parts along and across an axis.
struct Parts {
  double along;
  double across;
};

inline Parts parts(const Eigen::Vector3d& v, const Eigen::Vector3d& axis) {
  const double along = axis.dot(v);
  return {std::abs(along), (v - along * axis).norm()};
}

/// How products of an A-turning and a B-turning vector oscillate.
///
/// Derivation: U(t) = U_|| + Re(M e^{i w_A t}) with M = U_across (e - i e'), e, e' and u_A
/// orthonormal, likewise V with N. In the product of the turning parts,
///   Re(M e^{i a}) Re(N e^{i b}) = 1/2 Re(M N e^{i (a + b)}) + 1/2 Re(M conj(N) e^{i (a - b)}),
/// the scalar products are |M . N| = |U||V| (1 - c) and |M . conj(N)| = |U||V| (1 + c), with
/// c = u_A . u_B; the lengths of the vector products follow from Lagrange's identity as
/// |U||V| sqrt(4 - (1 + c)^2) and |U||V| sqrt(4 - (1 - c)^2). A derivative multiplies each term by
/// its frequency. The bounds hold at every time.
class Oscillation {
 public:
  explicit Oscillation(const ElementaryMotion& motion)
      : wA_(motion.A().rate), wB_(motion.B().rate), axes_sine_(motion.axes_sine() + kSlack) {
    const double c = motion.axes_cosine();
    const double sum = wA_ + wB_;
    const double difference = std::abs(wA_ - wB_);
    const double less = std::max(0.0, 1.0 - c) + kSlack;
    const double more = std::max(0.0, 1.0 + c) + kSlack;
    dot_ = 0.5 * (less * sum * sum + more * difference * difference);
    const double sum_cross = 0.5 * std::sqrt(std::max(0.0, 4.0 - more * more) + kSlack);
    const double difference_cross = 0.5 * std::sqrt(std::max(0.0, 4.0 - less * less) + kSlack);
    cross_rate_ = sum_cross * sum + difference_cross * difference;
    cross_ = sum_cross * sum * sum + difference_cross * difference * difference;
  }

  /// Bound of |(U . V)''|.
  [[nodiscard]] double of_dot(const Parts& U, const Parts& V) const {
    return axes_sine_ * (wB_ * wB_ * U.along * V.across + wA_ * wA_ * U.across * V.along) +
           dot_ * U.across * V.across;
  }
  /// Bound of |(U x V)'|.
  [[nodiscard]] double rate_of_cross(const Parts& U, const Parts& V) const {
    return wB_ * U.along * V.across + wA_ * U.across * V.along + cross_rate_ * U.across * V.across;
  }
  /// Bound of |(U x V)''|.
  [[nodiscard]] double of_cross(const Parts& U, const Parts& V) const {
    return wB_ * wB_ * U.along * V.across + wA_ * wA_ * U.across * V.along +
           cross_ * U.across * V.across;
  }

 private:
  static constexpr double kSlack = 0x1p-48;  // For the rounding of the axes.

  double wA_;
  double wB_;
  double axes_sine_;
  double dot_;
  double cross_rate_;
  double cross_;
};

}  // namespace firstcontact::detail
