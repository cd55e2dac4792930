/// @file
/// The scene of a planned path in which its movers run through all waypoints.

#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <firstcontact/motion/pose.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/verification/detail/robot_course.h>

namespace firstcontact {
struct PlannedPath;
}

namespace firstcontact::detail {

/// The error that a path contradicts itself or its scene. One sentence.
class BrokenPath : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The scene in which the movers run through all waypoints: at their times, else one edge a second.
class MovingScene {
 public:
  /// @param path  outlives this
  /// @throws BrokenPath; as load_scene_of()
  explicit MovingScene(const PlannedPath& path);

  [[nodiscard]] const LoadedScene& loaded() const { return loaded_; }
  [[nodiscard]] const std::map<std::size_t, Turnings>& turnings() const { return turnings_; }

  /// The body that moves; none where robots move alone.
  [[nodiscard]] std::optional<std::size_t> body() const { return body_; }

  /// Whether a member moves along edges.
  [[nodiscard]] bool moves(std::size_t member) const { return moves_.at(member); }

  /// Whether a column of the waypoints is a number of a floating joint's quaternion.
  [[nodiscard]] bool is_rotation(std::size_t column) const { return is_rotation_.at(column); }

  /// The columns of the quaternion whose first number is this column; none for other columns.
  [[nodiscard]] std::optional<std::array<std::size_t, 4>> rotation_columns(
      std::size_t column) const;

  /// The pose of the body in a row of the path, bit for bit.
  [[nodiscard]] std::array<double, 7> body_numbers(const std::vector<double>& row) const;

  /// Whether a column of the waypoints is a number of the body's pose.
  [[nodiscard]] bool is_of_body(std::size_t column) const;

  /// [s]  The time of a waypoint.
  [[nodiscard]] double time(std::size_t waypoint) const;

 private:
  void require_times() const;
  void move_robots();
  void move_joint(std::size_t column, SceneRobot& robot, std::size_t number,
                  const std::string& name);
  void find_body();
  void find_rotations();
  void find_moving(const SceneRobot& robot, std::size_t number);
  void move_body();
  void require_begin(const Pose& pose) const;

  const PlannedPath& path_;
  LoadedScene loaded_;
  std::map<std::size_t, Turnings> turnings_;
  std::vector<bool> moves_;        // For each member.
  std::vector<bool> is_rotation_;  // For each column, where robots move.
  std::map<std::size_t, std::array<std::size_t, 4>> rotations_;  // By their first column.
  std::optional<std::size_t> body_ = {};
  std::array<std::size_t, 7> body_columns_ = {0, 1, 2, 3, 4, 5, 6};  // Where a body moves.
};

}  // namespace firstcontact::detail
