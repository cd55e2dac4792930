/// @file
/// Robots of Python: models, trajectories, and scenes that wait for a trajectory.

#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include <pybind11/pybind11.h>

#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene/trajectory.h>

#include "motion.h"
#include "scene.h"

namespace firstcontact::python {

/// A robot of a file, without shapes.
struct HeldRobotModel {
  RobotFile file;
  RobotModel model;
};

/// The file that an argument names: a path, or an object that was read from one and has its path.
///
/// @param name  name of the argument
/// @param what  the expected kind: "a RobotModel, or the path of a URDF"
/// @throws pybind11::type_error
std::filesystem::path path_of(const pybind11::object& value, const std::string& name,
                              const std::string& what);

/// Reads positions by the names of coordinates.
///
/// They are a mapping, the name of a state of the SRDF, or a sequence of both, of which later ones
/// prevail.
///
/// @throws pybind11::type_error, std::invalid_argument
JointPositions positions_from(const pybind11::object& value, const SceneRobot& robot);

/// One robot and its environment: all of a scene except the trajectory.
class HeldRobotScene {
 public:
  /// @param scene  with one robot, which rests
  HeldRobotScene(Scene scene, std::shared_ptr<ShapeCache> shapes);

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] SceneRobot& robot() { return scene_.robots.front(); }
  [[nodiscard]] const SceneRobot& robot() const { return scene_.robots.front(); }

  /// The members that a name means; the robot's links also by their own names.
  [[nodiscard]] std::vector<std::size_t> members(const std::string& name) const;

  /// A link of the robot, by its number.
  [[nodiscard]] std::size_t link(const std::string& name) const;

  /// A motion that takes the duration of any trajectory.
  void add(const std::string& name, const Shape& shape, const RecordedMotion& X_WB);

  void attach(SceneAttachment attachment);
  void ignore(const std::string& name, const std::string& other);
  void set_margin(const std::string& name, const std::string& other, double margin);

  /// The scene while the robot follows a trajectory; without one it rests.
  [[nodiscard]] std::shared_ptr<HeldScene> along(const Trajectory* trajectory,
                                                 const std::string& id) const;

  [[nodiscard]] pybind11::tuple state() const;
  static HeldRobotScene from_state(const pybind11::tuple& state);

 private:
  /// Adds data in memory to the digest of the input, as files count.
  void note(const pybind11::object& said);

  Scene scene_;
  std::shared_ptr<ShapeCache> shapes_;
  std::set<std::size_t> in_step_time_;    // Bodies whose waypoints are in [0, 1].
  std::optional<double> fixed_duration_;  // [s]  Of surroundings that take all of it to move.
};

using RobotSceneClass = pybind11::class_<HeldRobotScene, std::shared_ptr<HeldRobotScene>>;

/// The scene of a trajectory as Python gives it: a Trajectory, the path of one, or None.
std::shared_ptr<HeldScene> scene_along(const HeldRobotScene& scene,
                                       const pybind11::object& trajectory);

/// Defines its method `check`, which asks as firstcontact.check does.
void bind_check_along(RobotSceneClass& type);

}  // namespace firstcontact::python
