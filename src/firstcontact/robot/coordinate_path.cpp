#include <firstcontact/robot/coordinate_path.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include <firstcontact/math/number_text.h>
#include <firstcontact/math/sine_cosine.h>

namespace firstcontact {
namespace {

constexpr std::size_t kCount = CoordinateSegment::kCoefficients;

/// 2 pi to 107 bits.
constexpr DoubleDouble kTurn{6.283185307179586, 2.4492935982947064e-16};

/// [-]  Covers a few dozen double-double operations, each within 2^-102 of sums of its operands.
constexpr double kConstructionError = 0x1p-96;

/// Pascal's triangle: binomials[j][k] is "j over k".
constexpr std::array<std::array<double, kCount>, kCount> binomials() {
  std::array<std::array<double, kCount>, kCount> rows{};
  for (std::size_t j = 0; j < kCount; ++j) {
    rows[j][0] = 1.0;
    for (std::size_t k = 1; k <= j; ++k) {
      rows[j][k] = rows[j - 1][k - 1] + rows[j - 1][k];
    }
  }
  return rows;
}
constexpr auto kBinomial = binomials();

DoubleDouble relative_time(const CoordinateSegment& segment, double t) {
  return two_sum(t, -segment.t_begin) / two_sum(segment.t_end, -segment.t_begin);
}

/// The k-th coefficient of the polynomial about s instead of about 0.
DoubleDouble shifted(const CoordinateSegment& segment, const DoubleDouble& s, std::size_t k) {
  DoubleDouble sum = 0.0;
  for (std::size_t j = segment.count; j-- > k;) {
    sum = sum * s + DoubleDouble(kBinomial[j][k]) * segment.a[j];
  }
  return sum;
}

/// The sum over j >= k of "j over k" |a_j|, which bounds the k-th coefficient about any s in [0,
/// 1].
double size_of(const CoordinateSegment& segment, std::size_t k) {
  double sum = 0.0;
  for (std::size_t j = k; j < segment.count; ++j) {
    sum += kBinomial[j][k] * std::abs(segment.a[j].hi);
  }
  return sum;
}

/// A bound of the error of `shifted`; binomial coefficients are at most 35.
double noise(const CoordinateSegment& segment, std::size_t k) {
  return 128.0 * segment.error + 0x1p-94 * size_of(segment, k);
}

CoordinateSegment at_rest(const DoubleDouble& position, double t_begin, double t_end) {
  CoordinateSegment segment;
  segment.t_begin = t_begin;
  segment.t_end = t_end;
  segment.a[0] = position;
  return segment;
}

[[noreturn]] void refuse(const std::string& message) {
  throw std::invalid_argument("CoordinatePath: " + message);
}

/// Throws if a condition fails. Planners make paths by the thousand, so no message is made before
/// it is needed.
void require(bool condition, const char* message) {
  if (!condition) {
    refuse(message);
  }
}

void require_numbers(std::span<const double> values, const char* name) {
  for (const double value : values) {
    // Negated, so that NaN is refused, too. sine_cosine() refuses greater angles.
    if (!(std::abs(value) <= kMaximumAngle)) {
      refuse(std::string(name) + " must be finite and at most 1e8 in size");
    }
  }
}

void require_times(std::span<const double> times) {
  for (std::size_t k = 0; k < times.size(); ++k) {
    require(times[k] >= 0.0 && times[k] <= 1.0, "times must lie in [0, 1]");
    require(times[k] == 0.0 || times[k] >= 1e-200, "times must be 0 or at least 1e-200");
    require(k == 0 || times[k - 1] < times[k], "times must increase strictly");
  }
}

/// Position, velocity and acceleration at both ends of a piece; scaled to s.
struct Ends {
  std::array<DoubleDouble, 3> begin;
  std::array<DoubleDouble, 3> end;
};

/// The polynomial of least degree with `orders` derivatives (position included) at both ends.
CoordinateSegment interpolate(const Ends& ends, std::size_t orders, double t_begin, double t_end) {
  const auto& [p0, v0, a0] = ends.begin;
  const auto& [p1, v1, a1] = ends.end;
  const DoubleDouble way = p1 - p0;
  CoordinateSegment s = at_rest(0.0, t_begin, t_end);
  s.count = 2 * orders;
  s.a[0] = p0;
  if (orders == 1) {
    s.a[1] = way;
  } else if (orders == 2) {
    s.a[1] = v0;
    s.a[2] = DoubleDouble(3.0) * way - DoubleDouble(2.0) * v0 - v1;
    s.a[3] = v0 + v1 - DoubleDouble(2.0) * way;
  } else {
    const DoubleDouble half_a0 = DoubleDouble(0.5) * a0;
    const DoubleDouble half_a1 = DoubleDouble(0.5) * a1;
    s.a[1] = v0;
    s.a[2] = half_a0;
    s.a[3] = DoubleDouble(10.0) * way - DoubleDouble(6.0) * v0 - DoubleDouble(4.0) * v1 -
             DoubleDouble(3.0) * half_a0 + half_a1;
    s.a[4] = DoubleDouble(-15.0) * way + DoubleDouble(8.0) * v0 + DoubleDouble(7.0) * v1 +
             DoubleDouble(3.0) * half_a0 - DoubleDouble(2.0) * half_a1;
    s.a[5] = DoubleDouble(6.0) * way - DoubleDouble(3.0) * (v0 + v1) - half_a0 + half_a1;
  }
  double size = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    size += std::abs(ends.begin[k].hi) + std::abs(ends.end[k].hi);
  }
  s.error = 64.0 * kConstructionError * size;
  return s;
}

/// The whole turns to take off a way, so that at most half a turn is left.
///
/// It is 0 for half a turn as doubles have it, so that this goes the way of its numbers.
double whole_turns(double way) {
  constexpr double kHalfTurn = 0.5 * kTurn.hi;
  if (std::abs(way) <= kHalfTurn) {
    return 0.0;
  }
  return std::copysign(std::ceil(std::abs(way) / kTurn.hi - 0.5), way);
}

/// Unwinds positions: whole turns that were taken off a way are also taken off all later positions.
///
/// That gives one path without jumps, which joints that mimic this one can follow.
class Winding {
 public:
  explicit Winding(Turning turning) : turning_(turning) {}

  void step(double from, double to) {
    if (turning_ == Turning::shortest) {
      turns_ += whole_turns(two_sum(to, -from).hi);
    }
  }

  [[nodiscard]] DoubleDouble unwound(double position) const {
    return DoubleDouble(position) - DoubleDouble(turns_) * kTurn;
  }

  /// [rad]  Bound of the error of `unwound`: 2 pi times an integer below 2^25.
  [[nodiscard]] double error() const { return kConstructionError * std::abs(turns_); }

 private:
  Turning turning_;
  double turns_ = 0.0;  // Number of turns taken off so far.
};

/// The pieces through points.
///
/// @param columns  positions, velocities, accelerations, as many as there are
std::vector<CoordinateSegment> through(std::span<const double> times,
                                       std::span<const std::span<const double>> columns,
                                       Turning turning) {
  require(!times.empty(), "at least one time is needed");
  require_times(times);
  constexpr std::array<const char*, 3> kNames = {"positions", "velocities", "accelerations"};
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (columns[c].size() != times.size()) {
      refuse(std::string(kNames[c]) + " must be as many as times, " + std::to_string(times.size()));
    }
    require_numbers(columns[c], kNames[c]);
  }
  std::vector<CoordinateSegment> segments;
  segments.reserve(times.size() + 1);
  if (times.front() > 0.0) {
    segments.push_back(at_rest(columns[0].front(), 0.0, times.front()));
  }
  Winding winding(turning);
  for (std::size_t k = 0; k + 1 < times.size(); ++k) {
    const DoubleDouble h = two_sum(times[k + 1], -times[k]);
    Ends ends;
    ends.begin[0] = winding.unwound(columns[0][k]);
    winding.step(columns[0][k], columns[0][k + 1]);
    ends.end[0] = winding.unwound(columns[0][k + 1]);
    DoubleDouble scale = 1.0;
    for (std::size_t c = 1; c < columns.size(); ++c) {
      scale = scale * h;
      ends.begin[c] = scale * DoubleDouble(columns[c][k]);
      ends.end[c] = scale * DoubleDouble(columns[c][k + 1]);
    }
    segments.push_back(interpolate(ends, columns.size(), times[k], times[k + 1]));
    segments.back().error += 64.0 * winding.error();
  }
  if (times.back() < 1.0) {
    segments.push_back(at_rest(winding.unwound(columns[0].back()), times.back(), 1.0));
    segments.back().error += winding.error();
  }
  if (segments.empty()) {
    segments.push_back(at_rest(columns[0].front(), 0.0, 1.0));
  }
  return segments;
}

CoordinateSegment scaled_polynomial(const std::vector<double>& coefficients, double t_begin,
                                    double t_end) {
  require(!coefficients.empty() && coefficients.size() <= kCount,
          "a polynomial has one to eight coefficients");
  CoordinateSegment segment = at_rest(0.0, t_begin, t_end);
  segment.count = coefficients.size();
  const DoubleDouble h = two_sum(t_end, -t_begin);
  DoubleDouble scale = 1.0;
  double size = 0.0;
  for (std::size_t j = 0; j < coefficients.size(); ++j) {
    require(std::abs(coefficients[j]) <= 1e60, "coefficients must be finite, at most 1e60 in size");
    segment.a[j] = scale * DoubleDouble(coefficients[j]);
    size += std::abs(segment.a[j].hi);
    scale = scale * h;
  }
  require(size <= kMaximumAngle, "a polynomial must stay below 1e8 in size");
  segment.error = kConstructionError * size;
  return segment;
}

}  // namespace

/// The state in doubles, for coordinates of a few turns at most.
///
/// Derivation, u = 2^-53: s is within 4 u of itself. That changes a term of n - 1 factors s by 4
/// (n - 1) u. Horner's scheme adds two roundings a term to the value, and as many again to each
/// further derivative. Coefficients are rounded. The constant a_0 is added exactly.
CoordinateSegment::State CoordinateSegment::quick_state(double t) const {
  const double unit = 6.0 * 0x1p-53 * static_cast<double>(count);
  const double per_length = 1.0 / (t_end - t_begin);
  const double s = (t - t_begin) * per_length;
  double way = 0.0;  // (q - a_0) / s
  double rate = 0.0;
  double half_acceleration = 0.0;
  std::array<double, 3> size{};
  for (std::size_t j = count; j-- > 1;) {
    half_acceleration = half_acceleration * s + rate;
    rate = rate * s + way;
    way = way * s + a[j].hi;
    for (std::size_t k = 0; k < 3; ++k) {
      size[k] += kBinomial[j][k] * std::abs(a[j].hi);
    }
  }
  half_acceleration = half_acceleration * s + rate;
  rate = rate * s + way;
  State state;
  state.value = two_sum(a[0].hi, a[0].lo + way * s);
  state.rate = rate * per_length;
  state.acceleration = 2.0 * half_acceleration * per_length * per_length;
  state.value_error = unit * size[0] + 0x1p-53 * std::abs(a[0].lo) + 2.0 * error;
  state.rate_error = (2.0 * unit * size[1] + 16.0 * error) * per_length;
  state.acceleration_error = (3.0 * unit * size[2] + 128.0 * error) * per_length * per_length;
  return state;
}

CoordinateSegment::State CoordinateSegment::state(double t) const {
  constexpr double kFewTurns = 16.0;
  return size_of(*this, 0) < kFewTurns ? quick_state(t) : precise_state(t);
}

CoordinateSegment::State CoordinateSegment::precise_state(double t) const {
  State state;
  const DoubleDouble s = relative_time(*this, t);
  const double per_length = 1.0 / (t_end - t_begin);
  state.value = shifted(*this, s, 0);
  const double rate = shifted(*this, s, 1).hi;
  const double half_acceleration = shifted(*this, s, 2).hi;
  state.rate = rate * per_length;
  state.acceleration = 2.0 * half_acceleration * per_length * per_length;
  state.value_error = 2.0 * (noise(*this, 0) + noise(*this, 1));
  state.rate_error = (0x1p-50 * std::abs(rate) + 2.0 * noise(*this, 1)) * per_length;
  state.acceleration_error =
      (0x1p-49 * std::abs(half_acceleration) + 4.0 * noise(*this, 2)) * per_length * per_length;
  return state;
}

CoordinateSegment::Bounds CoordinateSegment::bounds(double t_from, double t_to) const {
  const double per_length = 1.0 / (t_end - t_begin);
  const double middle = 0.5 * (t_from + t_to);
  const double half = std::max(t_to - middle, middle - t_from) * per_length * (1.0 + 0x1p-50);
  const DoubleDouble s = relative_time(*this, middle);
  std::array<double, kCount> size{};
  for (std::size_t j = 1; j < count; ++j) {
    size[j] = std::abs(shifted(*this, s, j).hi) + noise(*this, j);
  }
  std::array<double, 4> derivative{};
  double scale = 1.0;
  for (std::size_t k = 1; k < 4; ++k) {
    double sum = 0.0;
    for (std::size_t j = count; j-- > k;) {
      sum = sum * half + kBinomial[j][k] * size[j];
    }
    scale *= static_cast<double>(k) * per_length;  // k! / length^k
    derivative[k] = scale * sum * (1.0 + 0x1p-46);
  }
  return {derivative[1], derivative[2], derivative[3]};
}

double CoordinateSegment::size_bound() const {
  return (size_of(*this, 0) + error) * (1.0 + 0x1p-48);
}

CoordinateSegment CoordinateSegment::mimicked(double multiplier, double offset) const {
  CoordinateSegment result = *this;
  for (DoubleDouble& coefficient : result.a) {
    coefficient = DoubleDouble(multiplier) * coefficient;
  }
  result.a[0] = result.a[0] + DoubleDouble(offset);
  result.error = std::abs(multiplier) * error * (1.0 + 0x1p-50) +
                 kConstructionError * (size_of(result, 0) + std::abs(offset));
  return result;
}

double shortest_way(double from, double to) {
  const double way = to - from;
  return (two_sum(to, -from) - DoubleDouble(whole_turns(way)) * kTurn).value();
}

CoordinatePath::CoordinatePath(std::vector<CoordinateSegment> segments, Turning turning)
    : segments_(std::move(segments)), turning_(turning) {}

CoordinatePath CoordinatePath::constant(double position) {
  require_numbers({&position, 1}, "position");
  return {{at_rest(position, 0.0, 1.0)}, Turning::as_given};
}

CoordinatePath CoordinatePath::linear(std::span<const double> times,
                                      std::span<const double> positions, Turning turning) {
  const std::array<std::span<const double>, 1> columns{positions};
  return {through(times, columns, turning), turning};
}

CoordinatePath CoordinatePath::cubic(std::span<const double> times,
                                     std::span<const double> positions,
                                     std::span<const double> velocities, Turning turning) {
  const std::array<std::span<const double>, 2> columns{positions, velocities};
  return {through(times, columns, turning), turning};
}

CoordinatePath CoordinatePath::quintic(std::span<const double> times,
                                       std::span<const double> positions,
                                       std::span<const double> velocities,
                                       std::span<const double> accelerations, Turning turning) {
  const std::array<std::span<const double>, 3> columns{positions, velocities, accelerations};
  return {through(times, columns, turning), turning};
}

CoordinatePath CoordinatePath::polynomials(std::span<const double> times,
                                           std::span<const std::vector<double>> coefficients) {
  constexpr double kJump = 1e-6;  // [rad or m]  Files round their coefficients.
  require(times.size() >= 2, "at least two times are needed");
  require_times(times);
  require(coefficients.size() + 1 == times.size(), "polynomials must be one fewer than times");
  std::vector<CoordinateSegment> segments;
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    segments.push_back(scaled_polynomial(coefficients[k], times[k], times[k + 1]));
    if (k > 0) {
      const double before = segments[k - 1].state(times[k]).value.hi;
      if (!(std::abs(before - segments[k].a[0].hi) <= kJump)) {
        refuse("the coordinate jumps at time " + detail::shortest(times[k]) +
               "; let neighbouring pieces meet");
      }
    }
  }
  const double first = segments.front().a[0].hi;
  const double last = segments.back().state(times.back()).value.hi;
  if (times.front() > 0.0) {
    segments.insert(segments.begin(), at_rest(first, 0.0, times.front()));
  }
  if (times.back() < 1.0) {
    segments.push_back(at_rest(last, times.back(), 1.0));
  }
  return {std::move(segments), Turning::as_given};
}

}  // namespace firstcontact
