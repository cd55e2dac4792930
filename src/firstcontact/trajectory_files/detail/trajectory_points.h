/// @file
/// Makes a trajectory of the points that a reader finds.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <firstcontact/scene/trajectory.h>

namespace firstcontact {
class RobotModel;
}

namespace firstcontact::detail {

/// Takes points in order of their times. A point that stands twice is taken once.
class TrajectoryPoints {
 public:
  /// @param joint_names  names for the numbers of every point; fixed joints among them
  explicit TrajectoryPoints(std::vector<std::string> joint_names);

  /// Adds a point.
  ///
  /// @throws std::invalid_argument  names the defect of its time: it is before the time of the last
  ///         point, or the two contradict each other
  void add(TrajectoryPoint point);

  [[nodiscard]] bool empty() const { return trajectory_.points.empty(); }
  [[nodiscard]] const TrajectoryPoint& first() const { return trajectory_.points.front(); }

  /// The trajectory of the joints that move, with a warning for columns that were left out.
  ///
  /// @param source  names the file in warnings
  /// @throws std::invalid_argument if a fixed joint moves, or no other is left
  [[nodiscard]] Trajectory take(const RobotModel& robot, const std::string& source);

 private:
  void require_same(const TrajectoryPoint& point, const TrajectoryPoint& last) const;
  void leave_out(std::size_t column);

  Trajectory trajectory_;
  std::size_t repeated_ = 0;
  double first_repeated_ = 0.0;  // [s]
};

}  // namespace firstcontact::detail
