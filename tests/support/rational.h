/// @file
/// Exact rational numbers (GMP) for the oracle's templates.

#pragma once

#include <gmp.h>

#include "support/vector3.h"

namespace firstcontact::oracle {

/// Rational number; every operation returns a value, so that templates need no expression types.
///
/// In mpq_class an operation returns an expression instead.
class Rational {
 public:
  Rational() { mpq_init(q_); }
  Rational(double exact) : Rational() { mpq_set_d(q_, exact); }  // NOLINT: a double is rational.
  Rational(const Rational& other) : Rational() { mpq_set(q_, other.q_); }
  Rational& operator=(const Rational& other) {
    mpq_set(q_, other.q_);
    return *this;
  }
  ~Rational() { mpq_clear(q_); }

  friend Rational operator+(const Rational& a, const Rational& b) { return a.binary(mpq_add, b); }
  friend Rational operator-(const Rational& a, const Rational& b) { return a.binary(mpq_sub, b); }
  friend Rational operator*(const Rational& a, const Rational& b) { return a.binary(mpq_mul, b); }
  friend Rational operator/(const Rational& a, const Rational& b) { return a.binary(mpq_div, b); }
  friend Rational operator-(const Rational& a) { return Rational() - a; }
  friend bool operator<(const Rational& a, const Rational& b) { return mpq_cmp(a.q_, b.q_) < 0; }
  friend bool operator>(const Rational& a, const Rational& b) { return b < a; }
  friend bool operator>=(const Rational& a, const Rational& b) { return !(a < b); }
  friend bool operator==(const Rational& a, const Rational& b) {
    return mpq_equal(a.q_, b.q_) != 0;
  }

  [[nodiscard]] double nearest() const { return mpq_get_d(q_); }  ///< Rounds towards zero.

 private:
  template <class Operation>
  Rational binary(Operation operation, const Rational& b) const {
    Rational result;
    operation(result.q_, q_, b.q_);
    return result;
  }

  mpq_t q_;
};

inline Vector3<Rational> rational(const Vector3<double>& v) { return {v.x, v.y, v.z}; }

}  // namespace firstcontact::oracle
