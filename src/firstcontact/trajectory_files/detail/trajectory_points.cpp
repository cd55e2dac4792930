#include <firstcontact/trajectory_files/detail/trajectory_points.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <firstcontact/text/quantity.h>
#include <firstcontact/text/write_json.h>
#include <firstcontact/trajectory_files/detail/fixed_joints.h>

namespace firstcontact::detail {

TrajectoryPoints::TrajectoryPoints(std::vector<std::string> joint_names) {
  trajectory_.joint_names = std::move(joint_names);
}

void TrajectoryPoints::add(TrajectoryPoint point) {
  if (!empty()) {
    const TrajectoryPoint& last = trajectory_.points.back();
    if (point.time == last.time) {
      require_same(point, last);
      first_repeated_ = repeated_ == 0 ? point.time : first_repeated_;
      ++repeated_;
      return;
    }
    if (!(point.time > last.time)) {
      throw std::invalid_argument("expected a time later than the one before, " +
                                  write_json(last.time) + " s, got " + write_json(point.time) +
                                  " s");
    }
  }
  trajectory_.points.push_back(std::move(point));
}

void TrajectoryPoints::require_same(const TrajectoryPoint& point,
                                    const TrajectoryPoint& last) const {
  const auto require = [&](const std::vector<double>& here, const std::vector<double>& before,
                           const char* what) {
    for (std::size_t k = 0; k < std::min(here.size(), before.size()); ++k) {
      if (here[k] != before[k]) {
        throw std::invalid_argument(
            "expected one point at " + write_json(point.time) + " s, got a second one with " +
            what + " " + write_json(here[k]) + " of " + in_quotes(trajectory_.joint_names.at(k)) +
            " in place of " + write_json(before[k]));
      }
    }
  };
  require(point.positions, last.positions, "position");
  require(point.velocities, last.velocities, "velocity");
  require(point.accelerations, last.accelerations, "acceleration");
}

void TrajectoryPoints::leave_out(std::size_t column) {
  const auto at = static_cast<std::ptrdiff_t>(column);
  trajectory_.joint_names.erase(trajectory_.joint_names.begin() + at);
  for (TrajectoryPoint& point : trajectory_.points) {
    for (std::vector<double>* numbers :
         {&point.positions, &point.velocities, &point.accelerations}) {
      if (!numbers->empty()) {
        numbers->erase(numbers->begin() + at);
      }
    }
  }
}

Trajectory TrajectoryPoints::take(const RobotModel& robot, const std::string& source) {
  constexpr double kStill = 1e-6;  // [rad or m]  What six digits leave.
  std::vector<std::string> fixed;
  for (std::size_t k = trajectory_.joint_names.size(); k-- > 0;) {
    const std::string name = trajectory_.joint_names[k];
    if (!names_fixed_joint(robot, name)) {
      continue;
    }
    const double begin = first().positions.at(k);
    for (const TrajectoryPoint& point : trajectory_.points) {
      if (!(std::abs(point.positions.at(k) - begin) <= kStill)) {
        throw std::invalid_argument("expected joint " + in_quotes(name) +
                                    " at rest, as it is fixed in the URDF, got " +
                                    write_json(begin) + ", then " + write_json(point.positions[k]));
      }
    }
    fixed.push_back(name);
    leave_out(k);
  }
  if (trajectory_.joint_names.empty()) {
    throw std::invalid_argument("expected a joint that moves, got fixed ones alone");
  }
  if (!fixed.empty()) {
    trajectory_.warnings.push_back(source + ": " + fixed_joints_warning(std::move(fixed)));
  }
  if (repeated_ > 0) {
    trajectory_.warnings.push_back(
        source + ": " +
        (repeated_ == 1 ? "a point stands twice, at "
                        : std::to_string(repeated_) + " points stand twice, the first at ") +
        quantity(first_repeated_, "s") + "; taken once");
  }
  return std::move(trajectory_);
}

}  // namespace firstcontact::detail
