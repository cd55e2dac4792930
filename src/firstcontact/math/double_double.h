/// @file
/// Double-double arithmetic: an unevaluated sum of two doubles, about 106 bits.
///
/// For computations that need more than doubles: parameters of a motion, the difference of two
/// far-away positions. Error bounds (relative, u = 2^-53): addition 3 u^2, multiplication 5 u^2,
/// division 10 u^2, without overflow and underflow. Source: Joldes, Muller, Popescu, "Tight and
/// rigorous error bounds for basic building blocks of double-word arithmetic", ACM TOMS 44 (2017);
/// algorithms AccurateDWPlusDW, DWTimesDW, DWDivDW.

#pragma once

#include <array>
#include <cmath>

#include <Eigen/Core>

namespace firstcontact {

/// A double-double: hi + lo with |lo| <= ulp(hi) / 2.
struct DoubleDouble {
  double hi = 0.0;
  double lo = 0.0;

  constexpr DoubleDouble() = default;
  constexpr DoubleDouble(double value) : hi(value) {}  // NOLINT: doubles are exact members.
  constexpr DoubleDouble(double high, double low) : hi(high), lo(low) {}

  [[nodiscard]] double value() const { return hi; }
};

/// The exact sum a + b (Knuth).
inline DoubleDouble two_sum(double a, double b) {
  const double s = a + b;
  const double bb = s - a;
  return {s, (a - (s - bb)) + (b - bb)};
}

/// The exact sum where |a| >= |b| or a = 0 (Dekker).
inline DoubleDouble fast_two_sum(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}

/// The exact product a b (Dekker and Veltkamp, so that no FMA hardware is needed); |a|, |b| <
/// 2^996.
inline DoubleDouble two_product(double a, double b) {
  constexpr double kSplit = 134217729.0;  // 2^27 + 1
  const double ca = kSplit * a;
  const double ah = ca - (ca - a);
  const double al = a - ah;
  const double cb = kSplit * b;
  const double bh = cb - (cb - b);
  const double bl = b - bh;
  const double p = a * b;
  return {p, ((ah * bh - p) + ah * bl + al * bh) + al * bl};
}

inline DoubleDouble operator-(const DoubleDouble& a) { return {-a.hi, -a.lo}; }

inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble s = two_sum(a.hi, b.hi);
  const DoubleDouble t = two_sum(a.lo, b.lo);
  const DoubleDouble v = fast_two_sum(s.hi, s.lo + t.hi);
  return fast_two_sum(v.hi, t.lo + v.lo);
}

inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + (-b); }

inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble p = two_product(a.hi, b.hi);
  return fast_two_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}

inline DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
  const double q1 = a.hi / b.hi;
  const DoubleDouble r = a - b * DoubleDouble(q1);
  const double q2 = r.hi / b.hi;
  const DoubleDouble r2 = r - b * DoubleDouble(q2);
  const DoubleDouble q = fast_two_sum(q1, q2);
  return q + DoubleDouble(r2.hi / b.hi);
}

/// Square root of a >= 0; relative error below 8 u^2.
inline DoubleDouble sqrt(const DoubleDouble& a) {
  if (!(a.hi > 0.0)) {
    return {};
  }
  const double s = std::sqrt(a.hi);
  const DoubleDouble r = a - two_product(s, s);
  return fast_two_sum(s, r.hi / (2.0 * s));
}

/// A vector of double-doubles; only what motions need.
struct DoubleDoubleVector3 {
  std::array<DoubleDouble, 3> c;

  DoubleDoubleVector3() = default;
  DoubleDoubleVector3(DoubleDouble x, DoubleDouble y, DoubleDouble z) : c{x, y, z} {}
  explicit DoubleDoubleVector3(const Eigen::Vector3d& v) : c{v.x(), v.y(), v.z()} {}

  [[nodiscard]] Eigen::Vector3d value() const { return {c[0].hi, c[1].hi, c[2].hi}; }
};

inline DoubleDoubleVector3 operator+(const DoubleDoubleVector3& a, const DoubleDoubleVector3& b) {
  return {a.c[0] + b.c[0], a.c[1] + b.c[1], a.c[2] + b.c[2]};
}

inline DoubleDoubleVector3 operator-(const DoubleDoubleVector3& a, const DoubleDoubleVector3& b) {
  return {a.c[0] - b.c[0], a.c[1] - b.c[1], a.c[2] - b.c[2]};
}

inline DoubleDoubleVector3 operator*(const DoubleDouble& s, const DoubleDoubleVector3& a) {
  return {s * a.c[0], s * a.c[1], s * a.c[2]};
}

inline DoubleDouble dot(const DoubleDoubleVector3& a, const DoubleDoubleVector3& b) {
  return a.c[0] * b.c[0] + a.c[1] * b.c[1] + a.c[2] * b.c[2];
}

inline DoubleDoubleVector3 cross(const DoubleDoubleVector3& a, const DoubleDoubleVector3& b) {
  return {a.c[1] * b.c[2] - a.c[2] * b.c[1], a.c[2] * b.c[0] - a.c[0] * b.c[2],
          a.c[0] * b.c[1] - a.c[1] * b.c[0]};
}

inline DoubleDouble norm(const DoubleDoubleVector3& a) { return sqrt(dot(a, a)); }

}  // namespace firstcontact
