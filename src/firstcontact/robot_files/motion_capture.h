/// @file
/// Captured motion of a figure: a skeleton, its poses frame by frame, and what moves between them.

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/robot/robot_motion.h>

namespace firstcontact {

/// A bone, frame B: it turns about its origin against the bone that it hangs on.
struct Bone {
  std::string name;
  std::size_t parent = 0;  ///< Index of a bone before this one; the root's is its own.
  Pose X_PB = {};          ///< The pose in the parent at zero rotation; the identity for the root.
  std::vector<Eigen::Vector3d> ends;  ///< [m]  Points of B that the bone reaches from its origin.
  bool turns = true;                  ///< Else the bone is rigid in its parent.
};

/// One captured pose.
struct CaptureFrame {
  Eigen::Vector3d root_position = Eigen::Vector3d::Zero();  ///< [m]  In the capture's frame C.
  /// The rotation of each bone from its zero rotation; that of the root in C.
  std::vector<Eigen::Quaterniond> rotations;
};

/// Bones, the root first, and their poses at equal steps of time.
struct MotionCapture {
  std::string name;
  std::vector<Bone> bones;
  double frame_time = 0.0;  ///< [s]  > 0.
  std::vector<CaptureFrame> frames;
};

/// The thickness of a figure.
///
/// A bone is a capsule from its origin to each end. A bone without ends is a sphere.
struct FigureOptions {
  double slenderness = 0.25;      ///< [-]  Radius by length.
  double least_radius = 0.02;     ///< [m]
  double greatest_radius = 0.09;  ///< [m]
};

/// Makes a robot whose links are the bones of a figure and whose joints are balls.
///
/// Links have the names of bones, and capsules and spheres as collision geometry. A joint has the
/// name of the bone that it carries.
///
/// @throws std::invalid_argument  no bone, a doubled name, a bone that hangs on none before it, an
///                                option out of its range
[[nodiscard]] FIRSTCONTACT_API RobotModel make_figure(const MotionCapture& capture,
                                                      const FigureOptions& options = {});

/// Makes the motion of a figure from one frame to a later one, over the step t in [0, 1].
///
/// Between neighbouring frames every bone turns against its parent at a constant angular velocity
/// by the shortest rotation. The root's origin goes at a constant velocity.
///
/// @param figure  as make_figure made it from the same bones
/// @param X_WC    places the capture in the world; captures often have y up
/// @throws std::invalid_argument if there are no such frames, or they do not fit the figure
[[nodiscard]] FIRSTCONTACT_API RobotMotion capture_motion(const RobotModel& figure,
                                                          const MotionCapture& capture,
                                                          std::size_t first, std::size_t last,
                                                          const Pose& X_WC = {});

}  // namespace firstcontact
