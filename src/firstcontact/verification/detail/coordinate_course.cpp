#include <firstcontact/verification/detail/coordinate_course.h>

#include <algorithm>
#include <cmath>

namespace firstcontact::detail {
namespace {

/// An interval that contains 2 pi, between two neighbouring doubles.
constexpr Interval kWholeTurn(0x1.921fb54442d18p+2, 0x1.921fb54442d19p+2);

Interval times(double factor, const Interval& x) { return Interval(factor) * x; }

CoordinatePolynomial resting(double from, double to, const Interval& position) {
  CoordinatePolynomial piece{.from = from, .to = to};
  piece.a[0] = position;
  return piece;
}

/// Positions, and derivatives by s, at both ends of a piece.
struct PieceEnds {
  std::array<Interval, 3> begin;
  std::array<Interval, 3> end;
};

/// The polynomial of least degree with these positions and the first `derivatives` derivatives.
CoordinatePolynomial joining(const PieceEnds& ends, std::size_t derivatives, double from,
                             double to) {
  const auto& [p, v, a] = ends.begin;
  const auto& [q, w, b] = ends.end;
  const Interval way = q - p;
  CoordinatePolynomial piece = resting(from, to, p);
  piece.count = 2 * (derivatives + 1);
  if (derivatives == 0) {
    piece.a[1] = way;
    return piece;
  }
  piece.a[1] = v;
  if (derivatives == 1) {
    piece.a[2] = times(3.0, way) - times(2.0, v) - w;
    piece.a[3] = v + w - times(2.0, way);
    return piece;
  }
  piece.a[2] = times(0.5, a);
  piece.a[3] = times(10.0, way) - times(6.0, v) - times(4.0, w) - times(1.5, a) + times(0.5, b);
  piece.a[4] = times(-15.0, way) + times(8.0, v) + times(7.0, w) + times(1.5, a) - b;
  piece.a[5] = times(6.0, way) - times(3.0, v + w) - times(0.5, a) + times(0.5, b);
  return piece;
}

/// The whole turns to take off a way, so that at most half a turn is left.
///
/// Half a turn, as doubles have it, stays as it is.
double turns_beyond_half(double way) {
  constexpr double kTurn = 0x1.921fb54442d18p+2;
  if (std::abs(way) <= 0.5 * kTurn) {
    return 0.0;
  }
  return std::copysign(std::ceil(std::abs(way) / kTurn - 0.5), way);
}

}  // namespace

CoordinateWindow CoordinatePolynomial::around(double time, double half) const {
  if (count == 1) {
    return {.value = a[0], .size = a[0].magnitude()};
  }
  const Interval length = Interval(to) - Interval(from);
  const Interval s = time == to ? Interval(1.0) : (Interval(time) - Interval(from)) / length;
  // The coefficients about s, by repeated synthetic division.
  std::array<Interval, kMost> b = a;
  for (std::size_t k = 0; k + 1 < count; ++k) {
    for (std::size_t j = count - 1; j-- > k;) {
      b[j] = b[j] + s * b[j + 1];
    }
  }
  const Interval reach = Interval(half) / length;
  Interval size(0.0);
  Interval rate(0.0);
  Interval acceleration(0.0);
  for (std::size_t j = count; j-- > 0;) {
    const Interval magnitude(b[j].magnitude());
    const double n = static_cast<double>(j);
    size = size * reach + magnitude;
    if (j >= 1) {
      rate = rate * reach + times(n, magnitude);
    }
    if (j >= 2) {
      acceleration = acceleration * reach + times(n * (n - 1.0), magnitude);
    }
  }
  return {.value = b[0],
          .rate = b[1] / length,
          .size = size.upper(),
          .rate_size = (rate / length).upper(),
          .acceleration_size = (acceleration / sqr(length)).upper()};
}

CoordinateCourse::CoordinateCourse(double position)
    : pieces_{resting(0.0, 1.0, Interval(position))} {}

CoordinateCourse::CoordinateCourse(std::span<const double> times, std::span<const double> positions,
                                   std::span<const double> velocities,
                                   std::span<const double> accelerations, Turning turning) {
  const std::size_t derivatives = velocities.empty() ? 0U : (accelerations.empty() ? 1U : 2U);
  if (times.front() > 0.0) {
    pieces_.push_back(resting(0.0, times.front(), Interval(positions.front())));
  }
  double turns = 0.0;  // Number of turns taken off so far.
  const auto unwound = [&](std::size_t k) {
    return Interval(positions[k]) - Interval(turns) * kWholeTurn;
  };
  for (std::size_t k = 0; k + 1 < times.size(); ++k) {
    const Interval length = Interval(times[k + 1]) - Interval(times[k]);
    PieceEnds ends;
    ends.begin[0] = unwound(k);
    if (turning == Turning::shortest) {
      turns += turns_beyond_half(positions[k + 1] - positions[k]);
    }
    ends.end[0] = unwound(k + 1);
    if (derivatives >= 1) {
      ends.begin[1] = length * Interval(velocities[k]);
      ends.end[1] = length * Interval(velocities[k + 1]);
    }
    if (derivatives >= 2) {
      ends.begin[2] = sqr(length) * Interval(accelerations[k]);
      ends.end[2] = sqr(length) * Interval(accelerations[k + 1]);
    }
    pieces_.push_back(joining(ends, derivatives, times[k], times[k + 1]));
  }
  if (times.back() < 1.0 || pieces_.empty()) {
    pieces_.push_back(resting(std::min(times.back(), 1.0), 1.0, unwound(positions.size() - 1)));
  }
}

CoordinateCourse CoordinateCourse::scaled(double multiplier, double offset) const {
  CoordinateCourse result = *this;
  for (CoordinatePolynomial& piece : result.pieces_) {
    for (Interval& coefficient : piece.a) {
      coefficient = times(multiplier, coefficient);
    }
    piece.a[0] = piece.a[0] + Interval(offset);
  }
  return result;
}

const CoordinatePolynomial& CoordinateCourse::at(double t) const {
  const auto ends_before = [](const CoordinatePolynomial& piece, double time) {
    return piece.to < time;
  };
  return *std::lower_bound(pieces_.begin(), pieces_.end() - 1, t, ends_before);
}

}  // namespace firstcontact::detail
