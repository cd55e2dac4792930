/// @file
/// The verifier's own course of a robot: every coordinate over the scene, and the links.

#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <firstcontact/math/interval_vector.h>
#include <firstcontact/robot/robot_model.h>
#include <firstcontact/robot/tracking_error.h>
#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/verification/detail/chain_motion.h>
#include <firstcontact/verification/detail/coordinate_course.h>
#include <firstcontact/verification/detail/rigid_motion.h>

namespace firstcontact::detail {

using CoveredMotions = std::vector<std::shared_ptr<const CoveredMotion>>;

/// The turnings of coordinates by their names, where they differ from the trajectory's.
using Turnings = std::map<std::string, Turning>;

/// The course of a robot over a scene. Its motions refer to it, so it is not moved.
class RobotCourse {
 public:
  /// @param duration  [s]  of the scene
  /// @throws UncertainMotion, std::invalid_argument
  RobotCourse(const SceneRobot& robot, double duration, const Turnings& turnings = {});
  RobotCourse(const RobotCourse&) = delete;
  RobotCourse& operator=(const RobotCourse&) = delete;

  /// The times at which pieces of coordinates, or of the base, end; with 0 and 1.
  [[nodiscard]] const std::vector<double>& breaks() const { return breaks_; }

  [[nodiscard]] bool has_tracking_errors() const { return has_tracking_errors_; }

  /// The link farthest from the root on which both links hang; one of them if the other hangs on
  /// it.
  [[nodiscard]] std::size_t common_ancestor(std::size_t link, std::size_t other) const;

  /// The motions of a point of a link, one after another, over a window of time.
  ///
  /// @param frame  the link from which they are seen, on which the other one hangs; or the world
  /// @param X_LP   transform of the pivot in the link
  [[nodiscard]] CoveredMotions motions(std::optional<std::size_t> frame, std::size_t link,
                                       const IntervalTransform& X_LP, double from, double to) const;

 private:
  /// The course of a joint: its angle and its slides, or its free motion.
  struct JointCourse {
    IntervalTransform X_PJ;
    IntervalVector3 axis;
    std::optional<CoordinateCourse> angle = {};
    std::vector<IntervalVector3> directions = {};
    std::vector<CoordinateCourse> slides = {};
    TrackingError error = {};
    /// The pieces of a floating joint's motion; empty for other joints, and where it rests.
    std::vector<std::shared_ptr<const RigidMotion>> free = {};
  };

  void add_joint(const SceneRobot& robot, std::size_t joint, double duration,
                 const Turnings& turnings);
  static void float_freely(const SceneRobot& robot, std::size_t joint, double duration,
                           JointCourse& course);
  [[nodiscard]] TrackingError error_of(const SceneRobot& robot, std::size_t joint) const;
  [[nodiscard]] std::vector<std::size_t> joints_between(std::optional<std::size_t> frame,
                                                        std::size_t link) const;

  RobotModel model_;
  std::vector<JointCourse> joints_;
  std::vector<std::shared_ptr<const RigidMotion>> base_;
  std::vector<double> breaks_;
  bool has_tracking_errors_ = false;
};

}  // namespace firstcontact::detail
