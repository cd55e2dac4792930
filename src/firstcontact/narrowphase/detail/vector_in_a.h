/// @file
/// Points and vectors of body B as seen from body A, at any time of the piece.

#pragma once

#include <array>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/math/fast_sine_cosine.h>
#include <firstcontact/narrowphase/elementary_contact.h>

namespace firstcontact::detail {

/// The angles by which both bodies have turned.
struct Turns {
  Turns(const ElementaryMotion& motion, double t) : tau(t - motion.t_begin) {
    const std::array<SineCosine, 2> turns =
        fast_sine_cosine(motion.A.rate * tau, motion.B.rate * tau);
    A = turns[0];
    B = turns[1];
  }

  /// The vector in A's axes: the turn about z is undone.
  [[nodiscard]] Eigen::Vector3d back(const Eigen::Vector3d& v) const {
    return {A.cosine * v.x() + A.sine * v.y(), A.cosine * v.y() - A.sine * v.x(), v.z()};
  }

  double tau;  ///< [-]  Since the start of the piece.
  SineCosine A;
  SineCosine B;
};

/// A vector of body B: a point's position from A's pivot, or the difference of two points,
///   v(tau) = constant + tau drift + cos(rate_B tau) cosine + sin(rate_B tau) sine.
struct VectorInA {
  Eigen::Vector3d constant;
  Eigen::Vector3d drift;
  Eigen::Vector3d cosine;
  Eigen::Vector3d sine;

  struct State {
    Eigen::Vector3d value;  ///< The vector in A's axes.
    Eigen::Vector3d rate;   ///< Rate of v in the world, in A's axes: A's own turning is not in it.
  };

  [[nodiscard]] State at(const Turns& turns, double rate_B) const {
    const Eigen::Vector3d value =
        constant + turns.tau * drift + turns.B.cosine * cosine + turns.B.sine * sine;
    const Eigen::Vector3d rate =
        drift + (rate_B * turns.B.cosine) * sine - (rate_B * turns.B.sine) * cosine;
    return {turns.back(value), turns.back(rate)};
  }
};

/// The rate of a vector in A, whose z axis turns at the rate w: p' = rate - w z x p.
inline Eigen::Vector3d relative_rate(const VectorInA::State& p, double w) {
  return {p.rate.x() + w * p.value.y(), p.rate.y() - w * p.value.x(), p.rate.z()};
}

/// The vector v of body B as a vector in A.
///
/// @param v  at the start of the piece
inline VectorInA seen_vector(const ElementaryMotion& motion, const Eigen::Vector3d& v) {
  const Eigen::Vector3d& u = motion.axis_B;
  const Eigen::Vector3d along = u.dot(v) * u;
  return {along, Eigen::Vector3d::Zero(), v - along, u.cross(v)};
}

/// A point of body B as a vector in A, from A's pivot.
///
/// @param lever  position of the point from B's pivot at the start of the piece
inline VectorInA seen_point(const ElementaryMotion& motion, const Eigen::Vector3d& lever) {
  VectorInA seen = seen_vector(motion, lever);
  seen.constant += motion.offset;
  seen.drift = motion.drift;
  return seen;
}

}  // namespace firstcontact::detail
