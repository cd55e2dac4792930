/// @file
/// The motion of a robot over the step: every joint by its own path.

#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <firstcontact/articulated/coordinate_path.h>
#include <firstcontact/articulated/link_path.h>
#include <firstcontact/articulated/precise_transform.h>
#include <firstcontact/articulated/robot_model.h>
#include <firstcontact/math/export.h>
#include <firstcontact/motion/motion.h>

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

/// X_WL(t) of every link L of a robot, t in [0, 1]. Immutable.
class FIRSTCONTACT_API RobotMotion {
 public:
  /// @param joints  the motion of every joint that moves, by name; mimic joints follow theirs
  /// @param base    of the root link in the world
  /// @throws std::invalid_argument  names the joint: it has no motion, or one of another type; it
  /// is
  ///         fixed, mimics another, or is not of the robot; a joint that is not continuous is to
  ///         take the shortest way
  RobotMotion(RobotModel model, const std::map<std::string, JointMotion>& joints,
              Motion base = Motion::fixed());

  [[nodiscard]] const RobotModel& model() const { return model_; }

  /// In the world.
  [[nodiscard]] LinkMotion link(std::size_t link) const;

  /// In the frame of a link on which it hangs, or of itself.
  [[nodiscard]] LinkMotion link(std::size_t ancestor, std::size_t link) const;

  /// The piece of link(link) that holds t, the earlier one at a break.
  [[nodiscard]] LinkPath path(std::size_t link, double t) const;

  [[nodiscard]] RelativeLinkMotion relative(std::size_t A, std::size_t B) const;

 private:
  [[nodiscard]] LinkMotion along(std::span<const std::size_t> joints, bool from_world) const;

  RobotModel model_;
  std::vector<std::variant<std::monostate, CoordinatePath, PlanarPath, Motion>> joints_;
  Motion base_;
};

}  // namespace firstcontact
