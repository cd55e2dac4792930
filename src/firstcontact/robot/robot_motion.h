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

/// How one joint moves: a coordinate; three of a planar joint; or X_JL(t) of a floating or ball
/// joint, whose translation stays zero in a ball joint.
using JointMotion = std::variant<CoordinatePath, PlanarPath, Motion>;

/// The path of a link in the frame F of an ancestor, piece by piece. Immutable.
class FIRSTCONTACT_API LinkMotion {
 public:
  explicit LinkMotion(std::vector<LinkPath> pieces);

  /// Of a free body in the world: questions about a robot and its surroundings have both alike.
  explicit LinkMotion(const Motion& X_WB);

  /// The motion of a frame that is fixed in the link, as that of a geometry: X_LG.
  [[nodiscard]] LinkMotion then(const PreciseTransform& X_LG) const;

  /// In order, without gaps, from 0 to 1.
  [[nodiscard]] std::span<const LinkPath> pieces() const { return pieces_; }

  /// The piece that contains t, the earlier one at a break.
  [[nodiscard]] const LinkPath& at(double t) const;

 private:
  std::vector<LinkPath> pieces_;
};

/// Two links in the frame of their last common ancestor: what they share has cancelled.
struct RelativeLinkMotion {
  LinkMotion A;
  LinkMotion B;
};

/// X_WL(t) of every link L of a robot, t in [0, 1]. Immutable and cheap to copy: copies share their
/// data, and the paths of links share those of joints.
class FIRSTCONTACT_API RobotMotion {
 public:
  /// @param joints  the motion of every joint that moves, by name; mimic joints follow theirs
  /// @param base    of the root link in the world
  /// @throws std::invalid_argument  names the joint: it has no motion, or one of another type; it
  ///         is fixed, mimics another, or is not of the robot; a joint that is not continuous is to
  ///         take the shortest way
  RobotMotion(RobotModel model, std::map<std::string, JointMotion> joints,
              Motion base = Motion::fixed());

  [[nodiscard]] const RobotModel& model() const { return model_; }

  /// In the world.
  [[nodiscard]] LinkMotion link(std::size_t link) const;

  /// In the frame of a link on which it hangs, or of itself.
  [[nodiscard]] LinkMotion link(std::size_t ancestor, std::size_t link) const;

  [[nodiscard]] RelativeLinkMotion relative(std::size_t A, std::size_t B) const;

  /// Of a link, in the world: the piece that holds t, the earlier one at a break. Costs as much as
  /// the chain of joints is long.
  [[nodiscard]] LinkPath path(std::size_t link, double t) const;

  /// The same in the frame of a link on which it hangs, or of itself.
  [[nodiscard]] LinkPath path(std::size_t ancestor, std::size_t link, double t) const;

  /// Of a joint, in the piece that holds t, the earlier one at a break: from the link that moves
  /// before it. Null for one that is fixed. Valid as long as this.
  [[nodiscard]] const JointPath* joint_path(std::size_t joint, double t) const;
  /// The same of the base, in the world.
  [[nodiscard]] const JointPath& base_path(double t) const;

  /// All times at which a piece of a joint's path, or of the base's, ends; 0 and 1 included.
  [[nodiscard]] std::span<const double> breaks() const;

  /// The pieces of a joint of one coordinate, those of a mimic joint by its own coordinate; empty
  /// for other joints.
  [[nodiscard]] std::vector<CoordinateSegment> coordinate(std::size_t joint) const;

  /// What was given for a joint; nothing of joints that are fixed or mimic others.
  [[nodiscard]] std::optional<JointMotion> given(std::size_t joint) const;

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
