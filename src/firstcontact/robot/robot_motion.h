/// @file
/// The motion of a robot over the step: every joint by its own path.

#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/robot/coordinate_path.h>
#include <firstcontact/robot/link_path.h>
#include <firstcontact/robot/precise_transform.h>
#include <firstcontact/robot/robot_model.h>

namespace firstcontact {

/// Three coordinates of a planar joint: along its x and y directions [m], and its angle [rad]. The
/// directions are those of J, turned by the shortest rotation that takes z to the joint's axis.
using PlanarPath = std::array<CoordinatePath, 3>;

/// The motion of one joint: one coordinate, three of a planar joint, or a Motion X_JL(t).
///
/// The last is that of a floating or ball joint; its translation stays zero in a ball joint.
using JointMotion = std::variant<CoordinatePath, PlanarPath, Motion>;

/// The path of a link in the frame F of an ancestor, piece by piece. Immutable.
class FIRSTCONTACT_API LinkMotion {
 public:
  explicit LinkMotion(std::vector<LinkPath> pieces);

  /// The motion of a free body in the world, so that queries treat bodies and links alike.
  explicit LinkMotion(const Motion& X_WB);

  /// The motion of a frame that is fixed in the link, as that of a geometry: X_LG.
  [[nodiscard]] LinkMotion then(const PreciseTransform& X_LG) const;

  /// The pieces in order, without gaps, from 0 to 1.
  [[nodiscard]] std::span<const LinkPath> pieces() const { return pieces_; }

  /// The piece that contains t, the earlier one at a break.
  [[nodiscard]] const LinkPath& at(double t) const;

 private:
  std::vector<LinkPath> pieces_;
};

/// The motions of two links in the frame of their last common ancestor.
///
/// Motion that both share has cancelled.
struct RelativeLinkMotion {
  LinkMotion A;
  LinkMotion B;
};

/// The motion X_WL(t) of every link L of a robot, t in [0, 1].
///
/// Immutable and cheap to copy: copies share their data, and the paths of links share those of
/// joints.
class FIRSTCONTACT_API RobotMotion {
 public:
  /// Gives a motion to each joint of a robot that moves, and to its base.
  ///
  /// @param joints  the motion of every joint that moves, by name; mimic joints follow theirs
  /// @param base    the motion of the root link in the world
  /// @throws std::invalid_argument  names the joint: it has no motion, or one of another type; it
  ///         is fixed, mimics another, or is not of the robot; a joint that is not continuous is
  ///         to take the shortest way
  RobotMotion(RobotModel model, std::map<std::string, JointMotion> joints,
              Motion base = Motion::fixed());

  /// Makes the same motion but for some joints, in a fraction of the time.
  ///
  /// @param joints  their indices and motions
  /// @throws std::invalid_argument  as the constructor
  [[nodiscard]] RobotMotion with(std::vector<std::pair<std::size_t, JointMotion>> joints) const;

  [[nodiscard]] const RobotModel& model() const { return model_; }

  /// The motion of a link in the world.
  [[nodiscard]] LinkMotion link(std::size_t link) const;

  /// The motion of a link in the frame of a link on which it hangs, or of itself.
  [[nodiscard]] LinkMotion link(std::size_t ancestor, std::size_t link) const;

  /// The motions of two links in the frame of their last common ancestor.
  [[nodiscard]] RelativeLinkMotion relative(std::size_t A, std::size_t B) const;

  /// The path of a link in the world, in the piece that holds t, the earlier one at a break.
  ///
  /// Its cost grows with the length of the chain of joints.
  [[nodiscard]] LinkPath path(std::size_t link, double t) const;

  /// The path of a link in the frame of a link on which it hangs, or of itself, in that piece.
  [[nodiscard]] LinkPath path(std::size_t ancestor, std::size_t link, double t) const;

  /// The path of a joint in the piece that holds t, the earlier one at a break; null for a fixed
  /// joint.
  ///
  /// The path starts at the link that moves before the joint. The pointer is valid as long as this
  /// object.
  [[nodiscard]] const JointPath* joint_path(std::size_t joint, double t) const;
  /// The path of the base in the world, in the piece that holds t, the earlier one at a break.
  [[nodiscard]] const JointPath& base_path(double t) const;

  /// All times at which a piece of a joint's path, or of the base's, ends; 0 and 1 included.
  [[nodiscard]] std::span<const double> breaks() const;

  /// The pieces of a joint of one coordinate, those of a mimic joint by its own coordinate; empty
  /// for other joints.
  [[nodiscard]] std::vector<CoordinateSegment> coordinate(std::size_t joint) const;

  /// The motion that was given for a joint; none for joints that are fixed or mimic others.
  [[nodiscard]] std::optional<JointMotion> given(std::size_t joint) const;

  /// The motion that was given for the base.
  [[nodiscard]] const Motion& base() const;

 private:
  struct Data;
  [[nodiscard]] LinkPath along(std::size_t frame, std::size_t link, double t,
                               bool from_world) const;
  [[nodiscard]] LinkMotion all_along(std::size_t frame, std::size_t link, bool from_world) const;

  RobotModel model_;
  std::shared_ptr<const Data> data_;
};

}  // namespace firstcontact
