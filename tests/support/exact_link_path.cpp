#include "support/exact_link_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "support/exact_motion.h"

namespace firstcontact::oracle {
namespace {

constexpr double kUp = 1.0 + 0x1p-30;  // Covers the rounding of all sums of a bound.

Matrix3<Wide> identity() {
  Matrix3<Wide> R;
  R.column = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
  return R;
}

Vector3<Wide> unit(const Vector3<double>& v) {
  const Vector3<Wide> w = exact(v);
  return (Wide(1.0) / norm(w)) * w;
}

using Polynomial = std::vector<Wide>;

/// p + s (x - node) q, by coefficients.
Polynomial horner_step(const Wide& p, const Wide& node, const Polynomial& q) {
  Polynomial sum(q.size() + 1);
  sum[0] = p;
  for (std::size_t j = 0; j < q.size(); ++j) {
    sum[j] = sum[j] - node * q[j];
    sum[j + 1] = sum[j + 1] + q[j];
  }
  return sum;
}

/// Values and derivatives at both ends; the polynomial through them by Newton's divided differences
/// with repeated nodes, in x = t - t_begin.
Polynomial hermite(const std::vector<Wide>& begin, const std::vector<Wide>& end,
                   const Wide& duration) {
  const std::size_t orders = begin.size();
  const std::size_t n = 2 * orders;
  const auto is_begin = [&](std::size_t i) { return i < orders; };
  const auto node = [&](std::size_t i) { return is_begin(i) ? Wide(0.0) : duration; };
  std::vector<Wide> row;
  for (std::size_t i = 0; i < n; ++i) {
    row.push_back(is_begin(i) ? begin[0] : end[0]);
  }
  std::vector<Wide> first = {row[0]};  // For each order, the divided difference over nodes 0 to k.
  double factorial = 1.0;
  for (std::size_t k = 1; k < n; ++k) {
    factorial *= static_cast<double>(k);
    for (std::size_t i = 0; i + k < n; ++i) {
      row[i] = is_begin(i) == is_begin(i + k) ? (is_begin(i) ? begin[k] : end[k]) / Wide(factorial)
                                              : (row[i + 1] - row[i]) / (node(i + k) - node(i));
    }
    first.push_back(row[0]);
  }
  Polynomial sum = {first[n - 1]};
  for (std::size_t k = n - 1; k-- > 0;) {
    sum = horner_step(first[k], node(k), sum);
  }
  return sum;
}

/// Whole turns that the shortest way leaves out, as an angle.
Wide turns_between(double from, double to) {
  return Wide(std::round((to - from) / (2.0 * std::numbers::pi))) * Wide(4.0) * asin(Wide(1.0));
}

/// Those of all ways until position k.
Wide turns_until(const CoordinateInput& q, std::size_t k) {
  Wide sum(0.0);
  for (std::size_t i = 0; i < k; ++i) {
    sum = sum + turns_between(q.positions[i], q.positions[i + 1]);
  }
  return sum;
}

std::vector<Wide> values(const CoordinateInput& q, std::size_t k) {
  std::vector<Wide> all = {q.positions[k]};
  if (q.kind != CoordinateKind::linear) {
    all.emplace_back(q.velocities[k]);
  }
  if (q.kind == CoordinateKind::quintic) {
    all.emplace_back(q.accelerations[k]);
  }
  return all;
}

/// The piece that holds from t_begin on.
ExactPolynomial piece_of(const CoordinateInput& q, double t_begin) {
  if (q.kind == CoordinateKind::polynomial) {
    return {0.0, {q.coefficients.begin(), q.coefficients.end()}};
  }
  const std::size_t last = q.times.size() - 1;
  if (t_begin < q.times[0] || t_begin >= q.times[last]) {
    return {t_begin, {q.positions[t_begin < q.times[0] ? 0 : last]}};
  }
  std::size_t k = 0;
  while (q.times[k + 1] <= t_begin) {
    ++k;
  }
  std::vector<Wide> begin = values(q, k);
  std::vector<Wide> end = values(q, k + 1);
  if (q.shortest) {
    begin[0] = begin[0] - turns_until(q, k);
    end[0] = end[0] - turns_until(q, k + 1);
  }
  return {q.times[k], hermite(begin, end, Wide(q.times[k + 1]) - Wide(q.times[k]))};
}

ExactPolynomial scaled(const Wide& factor, ExactPolynomial q) {
  for (Wide& c : q.coefficients) {
    c = factor * c;
  }
  return q;
}

/// Unit vectors along x and y, turned by the shortest rotation that takes z to n (Rodrigues).
std::array<Vector3<Wide>, 2> planar_directions(const Vector3<Wide>& n) {
  const Vector3<Wide> w{-n.y, n.x, Wide(0.0)};  // z x n: sine times the axis of rotation.
  std::array<Vector3<Wide>, 2> directions{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}};
  for (Vector3<Wide>& v : directions) {
    v = n.z * v + cross(w, v) + ((Wide(1.0) / (Wide(1.0) + n.z)) * dot(w, v)) * w;
  }
  return directions;
}

const MotionPiece& piece_at(const std::vector<MotionPiece>& pieces, double t_begin) {
  std::size_t k = 0;
  while (k + 1 < pieces.size() && pieces[k + 1].t_begin <= t_begin) {
    ++k;
  }
  return pieces[k];
}

/// Upper bounds of the sizes of a coordinate and its first two derivatives over a window of time:
/// with b_j the coefficients about its middle and r its half width, the k-th derivative is at most
/// the sum over j >= k of j! / (j - k)! |b_j| r^(j - k).
std::array<double, 3> size_bounds(const ExactPolynomial& q, double t_from, double t_to) {
  const double middle = 0.5 * (t_from + t_to) - q.t_begin;
  const double r = 0.5 * (t_to - t_from) * kUp + 0x1p-50;
  const std::size_t n = q.coefficients.size();
  std::array<double, 3> bounds = {};
  for (std::size_t j = 0; j < n; ++j) {
    double sum = 0.0;  // b_j, and what rounding may have changed in it.
    double size = 0.0;
    double choose = 1.0;
    for (std::size_t i = j; i < n; ++i) {
      const double term =
          choose * q.coefficients[i].nearest() * std::pow(middle, static_cast<double>(i - j));
      sum += term;
      size += std::abs(term);
      choose = choose * static_cast<double>(i + 1) / static_cast<double>(i + 1 - j);
    }
    const double b = std::abs(sum) + size * (kUp - 1.0);
    double factor = 1.0;
    for (std::size_t k = 0; k < 3 && k <= j; ++k) {
      bounds[k] += kUp * factor * b * std::pow(r, static_cast<double>(j - k));
      factor *= static_cast<double>(j - k);
    }
  }
  return bounds;
}

double length_bound(const Vector3<Wide>& v) { return norm(v).upper(); }

void add_breaks(std::vector<double>& breaks, const MotionInput& motion) {
  for (const MotionPiece& piece : motion_pieces(motion, {0.0, 0.0, 0.0})) {
    breaks.push_back(piece.t_begin);
  }
}

}  // namespace

Wide ExactPolynomial::value(const Wide& t) const {
  const Wide x = t - Wide(t_begin);
  Wide sum;
  for (std::size_t j = coefficients.size(); j-- > 0;) {
    sum = sum * x + coefficients[j];
  }
  return sum;
}

Wide ExactPolynomial::rate(const Wide& t) const {
  const Wide x = t - Wide(t_begin);
  Wide sum;
  for (std::size_t j = coefficients.size(); j-- > 1;) {
    sum = sum * x + Wide(static_cast<double>(j)) * coefficients[j];
  }
  return sum;
}

ExactLinkState ExactLinkPath::state(const Wide& t) const {
  struct Point {
    Vector3<Wide> p, v;
  };
  // The origin and the ends of the link's axes, seen from one link after the other.
  std::array<Point, 4> points;
  for (std::size_t k = 1; k < 4; ++k) {
    points[k].p = identity().column[k - 1];
  }
  for (auto step = steps_.rbegin(); step != steps_.rend(); ++step) {
    const bool turns = !step->angle.coefficients.empty();
    const Wide angle = turns ? step->angle.value(t) : Wide(0.0);
    const Wide rate = turns ? step->angle.rate(t) : Wide(0.0);
    const Wide cosine = cos(angle);
    const Wide sine = sin(angle);
    const auto rotated = [&](const Vector3<Wide>& v) {
      const Vector3<Wide> along = dot(step->axis, v) * step->axis;
      return along + cosine * (v - along) + sine * cross(step->axis, v);
    };
    Vector3<Wide> offset = step->base;
    Vector3<Wide> offset_rate;
    for (const Slide& slide : step->slides) {
      offset = offset + slide.coordinate.value(t) * slide.direction;
      offset_rate = offset_rate + slide.coordinate.rate(t) * slide.direction;
    }
    for (Point& point : points) {
      Vector3<Wide> p = point.p;
      Vector3<Wide> v = point.v;
      if (step->starts_turned) {
        p = step->lever + step->start * p;
        v = step->start * v;
      }
      if (turns) {
        p = rotated(p);
        v = rotated(v) + rate * cross(step->axis, p);
      }
      point.p = step->position + step->R * (offset + p);
      point.v = step->R * (offset_rate + v);
    }
  }
  ExactLinkState state{points[0].p, points[0].v, {}, {}};
  for (std::size_t k = 0; k < 3; ++k) {
    state.R.column[k] = points[k + 1].p - points[0].p;
    state.spin.column[k] = points[k + 1].v - points[0].v;
  }
  return state;
}

/// Derivation: of y turned by an angle q about a unit axis, |y'| grows by at most |q'| |y| and
/// |y''| by 2 |q'| |y'| + (|q''| + q'^2) |y|; a slide adds its own derivatives.
double ExactLinkPath::acceleration_bound(double radius, double t_from, double t_to) const {
  double reach = radius;
  double speed = 0.0;
  double acceleration = 0.0;
  for (auto step = steps_.rbegin(); step != steps_.rend(); ++step) {
    reach = (reach + step->lever_length) * kUp;
    const auto [angle, w, e] = size_bounds(step->angle, t_from, t_to);
    acceleration = (acceleration + 2.0 * w * speed + (e + w * w) * reach) * kUp;
    speed = (speed + w * reach) * kUp;
    reach = (reach + step->step_length) * kUp;
    for (const Slide& slide : step->slides) {
      const auto [size, rate, bend] = size_bounds(slide.coordinate, t_from, t_to);
      reach = (reach + slide.length * size) * kUp;
      speed = (speed + slide.length * rate) * kUp;
      acceleration = (acceleration + slide.length * bend) * kUp;
    }
  }
  return acceleration;
}

class ExactLinkPathBuilder {
 public:
  /// @param t_begin  where the piece of time begins
  ExactLinkPathBuilder(const RobotInput& robot, double t_begin)
      : robot_(robot), t_begin_(t_begin) {}

  /// The path of a link in the frame of an ancestor; in the world where none is given.
  ExactLinkPath path(std::optional<std::size_t> ancestor, std::size_t link) {
    if (!ancestor) {
      add_motion({}, robot_.base);
    }
    for (const std::size_t joint : joints_between(robot_, ancestor.value_or(0), link)) {
      add(robot_.joints[joint]);
    }
    for (Step& step : path_.steps_) {
      step.step_length = length_bound(step.position) + length_bound(step.base);
      step.lever_length = length_bound(step.lever);
      for (ExactLinkPath::Slide& slide : step.slides) {
        slide.length = length_bound(slide.direction);
      }
    }
    return std::move(path_);
  }

 private:
  using Step = ExactLinkPath::Step;

  static Step at(const PoseInput& X_PJ) {
    MotionInput rest;
    rest.poses = {X_PJ};
    const MotionPiece piece = motion_pieces(rest, {0.0, 0.0, 0.0}).front();
    Step step;
    step.position = piece.pivot;
    step.R = piece.R;
    step.axis = identity().column[0];
    step.start = identity();
    return step;
  }

  void add_motion(const PoseInput& X_PJ, const MotionInput& motion) {
    const MotionPiece piece = piece_at(motion_pieces(motion, {0.0, 0.0, 0.0}), t_begin_);
    const Wide per_time = Wide(1.0) / (Wide(piece.t_end) - Wide(piece.t_begin));
    Step step = at(X_PJ);
    step.base = piece.pivot;
    step.slides = {{piece.travel, {piece.t_begin, {Wide(0.0), per_time}}}};
    step.lever = piece.lever;
    step.start = piece.R;
    step.starts_turned = true;
    if (!piece.angle.is_zero()) {
      step.axis = piece.axis;
      step.angle = {piece.t_begin, {Wide(0.0), per_time * piece.angle}};
    }
    path_.steps_.push_back(std::move(step));
  }

  [[nodiscard]] ExactPolynomial coordinate(const JointInput& joint, std::size_t index) const {
    if (!joint.mimic) {
      return piece_of(joint.coordinates[index], t_begin_);
    }
    ExactPolynomial q =
        scaled(joint.mimic->multiplier, coordinate(robot_.joints[joint.mimic->joint], 0));
    q.coefficients[0] = q.coefficients[0] + Wide(joint.mimic->offset);
    return q;
  }

  void add(const JointInput& joint) {
    if (joint.kind == JointKind::floating || joint.kind == JointKind::ball) {
      add_motion(joint.X_PJ, joint.motion);
      return;
    }
    Step step = at(joint.X_PJ);
    if (joint.kind != JointKind::fixed) {
      step.axis = unit(joint.axis);
    }
    switch (joint.kind) {
      case JointKind::revolute:
      case JointKind::continuous:
        step.angle = coordinate(joint, 0);
        break;
      case JointKind::prismatic:
        step.slides = {{step.axis, coordinate(joint, 0)}};
        break;
      case JointKind::screw:
        step.angle = coordinate(joint, 0);
        step.slides = {{step.axis, scaled(joint.pitch, step.angle)}};
        break;
      case JointKind::planar: {
        const auto [x, y] = planar_directions(step.axis);
        step.slides = {{x, coordinate(joint, 0)}, {y, coordinate(joint, 1)}};
        step.angle = coordinate(joint, 2);
        break;
      }
      case JointKind::fixed:
      case JointKind::floating:
      case JointKind::ball:
        break;
    }
    path_.steps_.push_back(std::move(step));
  }

  const RobotInput& robot_;
  double t_begin_;
  ExactLinkPath path_;
};

std::vector<double> break_times(const RobotCase& c) {
  std::vector<double> breaks = {0.0, 1.0};
  for (const RobotInput& robot : c.robots) {
    add_breaks(breaks, robot.base);
    for (const JointInput& joint : robot.joints) {
      add_breaks(breaks, joint.motion);
      for (const CoordinateInput& q : joint.coordinates) {
        breaks.insert(breaks.end(), q.times.begin(), q.times.end());
      }
    }
  }
  std::sort(breaks.begin(), breaks.end());
  breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
  return breaks;
}

std::array<ExactLinkPath, 2> exact_link_paths(const RobotCase& c, double t_begin) {
  std::optional<std::size_t> ancestor;
  if (c.A.robot == c.B.robot) {
    ancestor = common_ancestor(c.robots[c.A.robot], c.A.link, c.B.link);
  }
  const auto path = [&](const LinkInput& link) {
    return ExactLinkPathBuilder(c.robots[link.robot], t_begin).path(ancestor, link.link);
  };
  return {path(c.A), path(c.B)};
}

}  // namespace firstcontact::oracle
