/// @file
/// Scenes of Python.

#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <pybind11/pybind11.h>

#include <firstcontact/robot/limit_report.h>
#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/scene_files/write_result.h>

namespace firstcontact::python {

/// The options of a question, in place of the scene's.
struct OtherOptions {
  std::optional<double> margin;     ///< [m]
  std::optional<double> tolerance;  ///< [m]
  std::optional<double> deadline;   ///< [s]
  std::optional<ContactState> contacts;

  [[nodiscard]] bool any() const { return margin || tolerance || deadline || contacts; }
};

/// A scene that loads its meshes when they are needed, so that a scene from another process is
/// small.
class HeldScene {
 public:
  explicit HeldScene(Scene scene,
                     std::shared_ptr<ShapeCache> shapes = std::make_shared<ShapeCache>());

  [[nodiscard]] const Scene& scene() const { return scene_; }

  /// Loads the scene. Runs without the GIL, as other threads may be loading. Throws as
  /// load_scene().
  [[nodiscard]] const LoadedScene& loaded() const;

  /// Another scene that shares the meshes of files with this one.
  [[nodiscard]] std::shared_ptr<HeldScene> sharing(Scene scene) const;

  /// The scene with other options; shares the meshes of files.
  ///
  /// @throws std::invalid_argument on a deadline outside its range
  [[nodiscard]] std::shared_ptr<HeldScene> with(const OtherOptions& options) const;

 private:
  Scene scene_;
  std::shared_ptr<ShapeCache> shapes_;
  mutable std::mutex mutex_;
  mutable std::optional<LoadedScene> loaded_;
};

/// The answer of a scene, and the data that its page needs.
struct HeldResult {
  std::shared_ptr<HeldScene> scene;
  SceneResult answer;
  bool all_pairs = false;
  std::optional<SamplingReport> sampling = {};
};

/// Calls HeldScene::loaded() for a thread that holds the GIL.
const LoadedScene& loaded_without_gil(const HeldScene& scene);

/// Makes a LimitViolation of firstcontact/_tuples.py.
///
/// @param duration  [s]  of the motion that leaves the limit
pybind11::object limit_tuple(const SceneRobot& robot, const LimitViolation& violation,
                             double duration);

using ResultClass = pybind11::class_<HeldResult, std::shared_ptr<HeldResult>>;

/// Adds the methods that draw a result: its page and the curve of its gap.
void bind_result_page(ResultClass& type);

}  // namespace firstcontact::python
