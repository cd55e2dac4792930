/// @file
/// Real numbers of the oracle: intervals of 256 bits (MPFI), rounded outwards.

#pragma once

#include <mpfi.h>

#include <cstddef>
#include <type_traits>

#include "support/vector3.h"

namespace firstcontact::oracle {

inline constexpr mpfr_prec_t kWidePrecision = 256;  // A multiple of the bits of a limb.

/// An interval that contains an exact real number.
class Wide {
 public:
  Wide() : Wide(0.0) {}
  Wide(double exact) : Wide(NoValue{}) {  // NOLINT: a double is a real number.
    mpfi_set_d(v_, exact);
  }
  Wide(const Wide& other) : Wide(NoValue{}) { mpfi_set(v_, other.v_); }
  Wide& operator=(const Wide& other) {
    mpfi_set(v_, other.v_);
    return *this;
  }
  ~Wide() = default;

  friend Wide operator+(const Wide& a, const Wide& b) { return a.binary(mpfi_add, b); }
  friend Wide operator-(const Wide& a, const Wide& b) { return a.binary(mpfi_sub, b); }
  friend Wide operator*(const Wide& a, const Wide& b) { return a.binary(mpfi_mul, b); }
  friend Wide operator/(const Wide& a, const Wide& b) { return a.binary(mpfi_div, b); }
  friend Wide operator-(const Wide& a) { return a.unary(mpfi_neg); }
  friend Wide sqrt(const Wide& a) { return a.unary(mpfi_sqrt); }
  friend Wide sin(const Wide& a) { return a.unary(mpfi_sin); }
  friend Wide cos(const Wide& a) { return a.unary(mpfi_cos); }
  friend Wide asin(const Wide& a) { return a.unary(mpfi_asin); }
  friend Wide atan2(const Wide& y, const Wide& x) { return y.binary(mpfi_atan2, x); }
  friend Wide square(const Wide& a) { return a.unary(mpfi_sqr); }

  /// [-]  Proven for every number of the interval.
  [[nodiscard]] bool is_positive() const { return mpfi_is_strictly_pos(v_) > 0; }
  [[nodiscard]] bool is_negative() const { return mpfi_is_strictly_neg(v_) > 0; }
  [[nodiscard]] bool is_zero() const { return mpfi_is_zero(v_) > 0; }

  [[nodiscard]] double lower() const { return mpfr_get_d(&v_->left, MPFR_RNDD); }
  [[nodiscard]] double upper() const { return mpfr_get_d(&v_->right, MPFR_RNDU); }
  [[nodiscard]] double nearest() const { return mpfi_get_d(v_); }

  /// Returns the middle, rounded, as the sum of three doubles.
  [[nodiscard]] Quad quad() const {
    mpfr_t rest;
    mpfr_init2(rest, kWidePrecision);
    mpfi_mid(rest, v_);
    Quad sum = 0;
    for (int i = 0; i < 3; ++i) {
      const double part = mpfr_get_d(rest, MPFR_RNDN);
      mpfr_sub_d(rest, rest, part, MPFR_RNDN);
      sum += static_cast<Quad>(part);
    }
    mpfr_clear(rest);
    return sum;
  }

  /// Returns 2^exponent times this, exactly.
  [[nodiscard]] Wide scaled(long exponent) const {
    Wide result{NoValue{}};
    mpfi_mul_2si(result.v_, v_, exponent);
    return result;
  }

 private:
  struct NoValue {};

  // The digits are stored in the object: millions of small heap blocks would dominate the oracle's
  // time.
  explicit Wide(NoValue) {
    mpfr_custom_init_set(&v_->left, MPFR_ZERO_KIND, 0, kWidePrecision, digits_[0]);
    mpfr_custom_init_set(&v_->right, MPFR_ZERO_KIND, 0, kWidePrecision, digits_[1]);
  }

  template <class Operation>
  Wide binary(Operation operation, const Wide& b) const {
    Wide result{NoValue{}};
    operation(result.v_, v_, b.v_);
    return result;
  }
  template <class Operation>
  Wide unary(Operation operation) const {
    Wide result{NoValue{}};
    operation(result.v_, v_);
    return result;
  }

  static constexpr std::size_t kDigits = kWidePrecision / (8 * sizeof(mp_limb_t));

  mp_limb_t digits_[2][kDigits];
  mpfi_t v_;
};

/// Returns the exact value of a quad.
inline Wide exact(Quad value) {
  Wide sum;
  for (int i = 0; i < 3; ++i) {
    const auto part = static_cast<double>(value);
    value -= static_cast<Quad>(part);
    sum = sum + Wide(part);
  }
  return sum;
}

template <class T>
Vector3<Wide> exact(const Vector3<T>& v) {
  if constexpr (std::is_same_v<T, double>) {
    return {Wide(v.x), Wide(v.y), Wide(v.z)};
  } else {
    return {exact(v.x), exact(v.y), exact(v.z)};
  }
}

inline Vector3<double> nearest(const Vector3<Wide>& v) {
  return {v.x.nearest(), v.y.nearest(), v.z.nearest()};
}

inline Vector3<Quad> quad(const Vector3<Wide>& v) { return {v.x.quad(), v.y.quad(), v.z.quad()}; }

inline Wide norm(const Vector3<Wide>& v) { return sqrt(square(v.x) + square(v.y) + square(v.z)); }

}  // namespace firstcontact::oracle
