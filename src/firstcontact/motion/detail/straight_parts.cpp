#include <firstcontact/motion/detail/straight_parts.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <Eigen/Geometry>

#include <firstcontact/motion/detail/turn.h>

namespace firstcontact::detail {

using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

constexpr std::size_t kMostParts = 10'000;

/// [-]  Fraction of the step up to which two times are one, but for rounding.
constexpr double kSameTime = 4.0 * std::numeric_limits<double>::epsilon();

/// [rad]  Greatest angle at which the shortest turn to the motion's orientation turns as the motion
/// does.
constexpr double kShort = 3.0;

/// [rad]  A body that is turned away from its motion by more has fallen back behind it.
constexpr double kOffCourse = 1e-3;

/// [-]  The least fraction of a part that a division leaves: forces over no time are no forces.
constexpr double kLeastShare = 0.01;

Vector3d shortest_turn(const Quaterniond& from, const Quaterniond& to) {
  return nearest_turn(to * from.conjugate(), Vector3d::Zero());
}

/// The straight piece of a part, and its distance from the motion.
class Chord {
 public:
  Chord(const Motion& motion, double from, double to)
      : motion_(motion),
        from_(from),
        length_(to - from),
        begin_(motion.pose(from)),
        travel_(motion.pose(to).position - begin_.position),
        turn_(rotation_between(motion, from, to)) {}

  struct Distance {
    double place = 0.0;  ///< [m]  Distance of the origins.
    double angle = 0.0;  ///< [rad]  Angle between the orientations.
  };
  [[nodiscard]] Distance distance(double t) const {
    const double share = (t - from_) / length_;
    const Pose there = motion_.pose(t);
    return {(there.position - begin_.position - share * travel_).norm(),
            there.rotation.angularDistance(turn(share * turn_) * begin_.rotation)};
  }

  /// [rad per step]  The difference of the two rates in a piece of the motion.
  [[nodiscard]] double spin_difference(const ConstantRatePath& path) const {
    return (path.axis() * path.rate() - turn_ / length_).norm();
  }

 private:
  const Motion& motion_;
  double from_;
  double length_;
  Pose begin_;
  Vector3d travel_;
  Vector3d turn_;
};

/// The script that bends most over a part, and its bound.
struct Bend {
  double bound = 0.0;  ///< [m]
  std::size_t script = 0;
};

Bend greatest_bend(const std::vector<ScriptedMotion>& scripts, double from, double to) {
  Bend greatest;
  for (std::size_t k = 0; k < scripts.size(); ++k) {
    const double bound = bend_bound(scripts[k], from, to);
    if (!(bound <= greatest.bound)) {
      greatest = {bound, k};
    }
  }
  return greatest;
}

/// Finds the break of a motion that is nearest to the middle of a part, or else the middle.
double dividing_time(const Motion& motion, double from, double to) {
  const double middle = 0.5 * (from + to);
  const auto breaks = motion.breaks();
  const auto above = std::ranges::lower_bound(breaks, middle);
  double best = to;
  for (auto near = above == breaks.begin() ? above : above - 1;
       near != breaks.end() && near <= above; ++near) {
    best = std::abs(*near - middle) < std::abs(best - middle) ? *near : best;
  }
  const double least = kLeastShare * (to - from);
  return best > from + least && best < to - least ? best : middle;
}

}  // namespace

Vector3d rotation_between(const Motion& motion, double from, double to) {
  const auto breaks = motion.breaks();
  const auto piece = static_cast<std::size_t>(
      std::upper_bound(breaks.begin() + 1, breaks.end() - 1, from + kSameTime) - breaks.begin() -
      1);
  if (to <= breaks[piece + 1] + kSameTime) {
    const ConstantRatePath path = motion.path(piece, Vector3d::Zero());
    return path.axis() * (path.rate() * (to - from));
  }
  return shortest_turn(motion.pose(from).rotation, motion.pose(to).rotation);
}

Vector3d rotation_along(const Motion& motion, double from, double to, const Quaterniond& rotation) {
  const Vector3d along = rotation_between(motion, from, to);
  const Quaterniond there = motion.pose(to).rotation;
  const double angle = along.norm();
  const Vector3d beside = shortest_turn(turn(along) * rotation, there);
  if (angle < kShort || beside.norm() > kOffCourse) {
    return shortest_turn(rotation, there);
  }
  return along * (1.0 + along.dot(beside) / (angle * angle));
}

double bend_bound(const ScriptedMotion& script, double from, double to) {
  const auto breaks = script.motion.breaks();
  const auto first = std::upper_bound(breaks.begin() + 1, breaks.end() - 1, from) - 1;
  const Chord chord(script.motion, from, to);
  double place = 0.0;
  double angle = 0.0;
  Chord::Distance begin = chord.distance(from);
  for (auto piece = first; piece + 1 != breaks.end() && *piece < to; ++piece) {
    const double u = std::max(from, *piece);
    const double v = std::min(to, *(piece + 1));
    const ConstantRatePath path =
        script.motion.path(static_cast<std::size_t>(piece - breaks.begin()), Vector3d::Zero());
    const Chord::Distance end = chord.distance(v);
    const double sagitta = path.rate() * path.rate() * path.lever_length() * (v - u) * (v - u) / 8;
    place = std::max(place, std::max(begin.place, end.place) + sagitta);
    angle = std::max(
        angle, std::max(begin.angle, end.angle) + 0.5 * chord.spin_difference(path) * (v - u));
    begin = end;
  }
  return place + script.reach * angle;
}

std::vector<double> straight_parts(const std::vector<ScriptedMotion>& scripts, double from,
                                   double to, double tolerance) {
  std::vector<double> ends;
  std::vector<double> open{to};
  double begin = from;
  while (!open.empty()) {
    const double end = open.back();
    const Bend bend = greatest_bend(scripts, begin, end);
    if (bend.bound <= tolerance) {
      ends.push_back(end);
      begin = end;
      open.pop_back();
    } else if (ends.size() + open.size() >= kMostParts) {
      return {};
    } else {
      open.push_back(dividing_time(scripts[bend.script].motion, begin, end));
    }
  }
  return ends;
}

}  // namespace firstcontact::detail
