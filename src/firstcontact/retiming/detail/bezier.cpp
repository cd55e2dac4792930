#include <firstcontact/retiming/detail/bezier.h>

#include <algorithm>
#include <cmath>

#include <firstcontact/retiming/timed_motion.h>

namespace firstcontact::detail {
namespace {

/// The derivative in time, from the differences of coefficients: it has `degree` times them per
/// length.
Bezier derivative(const Bezier& of, const Interval& seconds) {
  Bezier result;
  if (of.count == 1) {
    result.b[0] = Interval(0.0);
    return result;
  }
  result.count = of.count - 1;
  const Interval factor = Interval(static_cast<double>(result.count)) / seconds;
  for (std::size_t i = 0; i < result.count; ++i) {
    result.b[i] = factor * (of.b[i + 1] - of.b[i]);
  }
  return result;
}

/// The polynomial with these steps from each Bernstein coefficient of the position to the next.
///
/// Only one of the steps has the difference of the positions. The others stay small where it is
/// large. Derivation: Hermite's interpolation in Bernstein form, G. Farin, section 7.5.
Bezier way_by_steps(const std::array<Interval, 5>& steps, std::size_t count) {
  Bezier way;
  way.count = count + 1;
  way.b[0] = Interval(0.0);
  for (std::size_t i = 0; i < count; ++i) {
    way.b[i + 1] = way.b[i] + steps[i];
  }
  return way;
}

Bezier velocity_by_steps(const std::array<Interval, 5>& steps, std::size_t count,
                         const Interval& seconds) {
  Bezier velocity;
  velocity.count = count;
  const Interval factor = Interval(static_cast<double>(count)) / seconds;
  for (std::size_t i = 0; i < count; ++i) {
    velocity.b[i] = factor * steps[i];
  }
  return velocity;
}

constexpr int kDeepest = 40;
constexpr double kResolution = 1e-9;  // [-]  Relative resolution of a peak.

void climb(const Bezier& p, double begin, double end, int depth, Peak& best) {
  const auto look = [&](const Interval& value, double where) {
    const double least = std::max(value.lower(), -value.upper());  // A lower bound of the size.
    if (least > best.attained) {
      best.attained = least;
      best.where = where;
    }
  };
  look(p.first(), begin);
  look(p.last(), end);
  const double bound = p.magnitude();
  if (bound <= best.bound) {
    return;
  }
  // The result cannot be closer than the coefficients are wide. Negated, as widths may be infinite.
  const double close = best.attained * (1.0 + kResolution) + 2.0 * p.greatest_width();
  if (!(bound > close) || depth == kDeepest) {
    best.bound = bound;
    return;
  }
  const auto [left, right] = p.halves();
  const double middle = 0.5 * (begin + end);
  // The half that reaches higher comes first: then the other one is often left out.
  if (left.magnitude() >= right.magnitude()) {
    climb(left, begin, middle, depth + 1, best);
    climb(right, middle, end, depth + 1, best);
  } else {
    climb(right, middle, end, depth + 1, best);
    climb(left, begin, middle, depth + 1, best);
  }
}

}  // namespace

double Bezier::magnitude() const {
  double greatest = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    greatest = std::max(greatest, b[i].magnitude());
  }
  return greatest;
}

double Bezier::greatest_width() const {
  double greatest = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    greatest = std::max(greatest, b[i].width_bound());
  }
  return greatest;
}

std::array<Bezier, 2> Bezier::halves() const {
  std::array<Bezier, 2> result{*this, *this};
  std::array<Interval, 6> row = b;
  const Interval half(0.5);
  for (std::size_t k = 0; k < count; ++k) {
    result[0].b[k] = row[0];
    result[1].b[count - 1 - k] = row[count - 1 - k];
    for (std::size_t i = 0; i + k + 1 < count; ++i) {
      row[i] = half * (row[i] + row[i + 1]);
    }
  }
  return result;
}

SegmentRates segment_rates(const TimedPoint& from, const TimedPoint& to, std::size_t coordinate) {
  SegmentRates rates;
  rates.seconds = Interval(static_cast<double>(to.time - from.time)) / Interval(1e9);
  const Interval& T = rates.seconds;
  const Interval way =
      Interval(to.positions.at(coordinate)) - Interval(from.positions.at(coordinate));
  std::array<Interval, 5> steps{};
  std::size_t count = 1;
  if (from.velocities.empty()) {
    steps[0] = way;
  } else {
    const Interval v0(from.velocities.at(coordinate));
    const Interval v1(to.velocities.at(coordinate));
    if (from.accelerations.empty()) {
      count = 3;
      const Interval third = T / Interval(3.0);
      steps[0] = third * v0;
      steps[2] = third * v1;
      steps[1] = way - steps[0] - steps[2];
    } else {
      count = 5;
      const Interval fifth = T / Interval(5.0);
      const Interval twentieth = sqr(T) / Interval(20.0);
      const Interval bend0 = twentieth * Interval(from.accelerations.at(coordinate));
      const Interval bend1 = twentieth * Interval(to.accelerations.at(coordinate));
      steps[0] = fifth * v0;
      steps[1] = steps[0] + bend0;
      steps[3] = fifth * v1 - bend1;
      steps[4] = fifth * v1;
      steps[2] = way - Interval(2.0) * (steps[0] + steps[4]) - bend0 + bend1;
    }
  }
  rates.way = way_by_steps(steps, count);
  rates.velocity = velocity_by_steps(steps, count, T);
  rates.acceleration = derivative(rates.velocity, T);
  rates.jerk = derivative(rates.acceleration, T);
  return rates;
}

Peak peak(const Bezier& polynomial, double known) {
  Peak best{.attained = 0.0, .bound = known, .where = 0.0};
  climb(polynomial, 0.0, 1.0, 0, best);
  return best;
}

}  // namespace firstcontact::detail
