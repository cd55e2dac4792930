#include <firstcontact/geometry/detail/enclosing_ring.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <firstcontact/math/interval.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector2d;

constexpr double kPi = std::numbers::pi;

/// Counts the corners. Those of a regular polygon around a circle of radius 1 have the length 1 /
/// cos(pi / n).
std::size_t corner_count(double relative_excess) {
  const double half_angle = std::atan(std::sqrt(relative_excess * (2.0 + relative_excess)));
  return std::max<std::size_t>(3, static_cast<std::size_t>(std::ceil(kPi / half_angle)));
}

std::vector<Vector2d> regular_polygon(std::size_t count, double length) {
  std::vector<Vector2d> corners;
  for (std::size_t k = 0; k < count; ++k) {
    const double angle = 2.0 * kPi * static_cast<double>(k) / static_cast<double>(count);
    corners.emplace_back(length * std::cos(angle), length * std::sin(angle));
  }
  return corners;
}

/// Whether the segment from a to b turns about the origin to the left, outside of the circle.
bool is_outside(const Vector2d& a, const Vector2d& b, double radius) {
  const Interval ax(a.x()), ay(a.y()), bx(b.x()), by(b.y());
  const Interval twice_area = ax * by - ay * bx;
  const Interval length2 = sqr(bx - ax) + sqr(by - ay);
  return twice_area.lower() > 0.0 &&
         sqr(twice_area).lower() >= (sqr(Interval(radius)) * length2).upper();
}

/// Whether the polygon encloses the circle; false without corners.
bool encloses(const std::vector<Vector2d>& corners, double radius) {
  for (std::size_t k = 0; k < corners.size(); ++k) {
    if (!is_outside(corners[k], corners[(k + 1) % corners.size()], radius)) {
      return false;
    }
  }
  return !corners.empty();
}

double greatest_length(const std::vector<Vector2d>& corners) {
  double greatest = 0.0;
  for (const Vector2d& corner : corners) {
    greatest =
        std::max(greatest, sqrt(sqr(Interval(corner.x())) + sqr(Interval(corner.y()))).upper());
  }
  return greatest;
}

}  // namespace

EnclosingRing enclosing_ring(double radius, double excess) {
  // In units of the radius rounded to a power of two, so that nothing over- or underflows. A
  // little of the excess is kept for the rounding of the corners.
  int exponent = 0;
  const double unit_radius = std::frexp(radius, &exponent);
  const std::size_t count = corner_count(0.999 * excess / radius);
  double length = unit_radius / std::cos(kPi / static_cast<double>(count));
  EnclosingRing ring;
  // The corners and the test of short edges are off by some units in the last place.
  double growth = 0x1p-48;
  while (!encloses(ring.corners, unit_radius)) {
    length *= 1.0 + growth;
    growth *= 2.0;
    ring.corners = regular_polygon(count, length);
  }
  ring.excess = std::ldexp(
      (Interval(greatest_length(ring.corners)) - Interval(unit_radius)).upper(), exponent);
  for (Vector2d& corner : ring.corners) {
    corner = Vector2d(std::ldexp(corner.x(), exponent), std::ldexp(corner.y(), exponent));
  }
  return ring;
}

}  // namespace firstcontact::detail
