#include <firstcontact/polygons/detail/exact_orientation.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include <firstcontact/math/double_double.h>

namespace firstcontact::detail {
namespace {

/// A sum of products without rounding: doubles of growing size whose bits do not overlap.
class ExactSum {
 public:
  ExactSum() { parts_.reserve(16); }

  void add_product(double a, double b) {
    const DoubleDouble product = two_product(a, b);
    add(product.lo);
    add(product.hi);
  }

  /// The part of the greatest size, which has the sign of the sum.
  ///
  /// It is the sum up to half a unit of its last place.
  [[nodiscard]] double value() const { return parts_.empty() ? 0.0 : parts_.back(); }

 private:
  /// Adds x by Shewchuk's Grow-Expansion, with zeros left out.
  void add(double x) {
    std::size_t kept = 0;
    for (const double part : parts_) {
      const DoubleDouble sum = two_sum(x, part);
      x = sum.hi;
      if (sum.lo != 0.0) {
        parts_[kept] = sum.lo;
        ++kept;
      }
    }
    parts_.resize(kept);
    if (x != 0.0) {
      parts_.push_back(x);
    }
  }

  std::vector<double> parts_;
};

int sign(double value) { return value > 0.0 ? 1 : value < 0.0 ? -1 : 0; }

int exact_orientation(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  ExactSum sum;
  sum.add_product(a.x, b.y);
  sum.add_product(-a.y, b.x);
  sum.add_product(b.x, c.y);
  sum.add_product(-b.y, c.x);
  sum.add_product(c.x, a.y);
  sum.add_product(-c.y, a.x);
  return sign(sum.value());
}

}  // namespace

int orientation(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  // Shewchuk's bound for orient2d, (3 + 16 u) u with u = 2^-53; products below kLeastSize may have
  // lost bits to underflow.
  constexpr double kError = 3.3306690738754716e-16;
  constexpr double kLeastSize = 1e-290;
  const double left = (a.x - c.x) * (b.y - c.y);
  const double right = (a.y - c.y) * (b.x - c.x);
  const double size = std::abs(left) + std::abs(right);
  const double difference = left - right;
  if (size > kLeastSize && std::abs(difference) > kError * size) {
    return sign(difference);
  }
  const bool left_is_zero = a.x == c.x || b.y == c.y;
  const bool right_is_zero = a.y == c.y || b.x == c.x;
  return left_is_zero && right_is_zero ? 0 : exact_orientation(a, b, c);
}

double twice_area(std::span<const PlanePoint> ring) {
  ExactSum sum;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const PlanePoint& a = ring[i];
    const PlanePoint& b = ring[i + 1 == ring.size() ? 0 : i + 1];
    sum.add_product(a.x, b.y);
    sum.add_product(-a.y, b.x);
  }
  return sum.value();
}

}  // namespace firstcontact::detail
