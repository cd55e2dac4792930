/// @file
/// Robots and bodies that move together over the step: the input of a check of robots.

#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/math/export.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/robot/robot_motion.h>
#include <firstcontact/robot/tracking_error.h>

namespace firstcontact {

struct DisabledPair;

/// A body that a link carries for a while, both by their numbers as members of the scene.
///
/// Before t_from the body keeps its own motion. Then it is rigidly fixed to the link. Its pose in
/// the link is frozen at t_from and rounded to doubles, which define the motion from then on. Or
/// X_LB gives that pose from the start on; then the body's own motion has no meaning. After t_to
/// the body rests where it is, rounded likewise.
struct Attachment {
  std::size_t body = 0;
  std::size_t link = 0;  ///< The link that holds the body; meanwhile the two are not tested.
  double t_from = 0.0;   ///< [-]  In [0, 1].
  double t_to = 1.0;     ///< [-]  In (t_from, 1].
  std::vector<std::size_t> touch_links = {};  ///< Links that are not tested against the body either
                                              ///< meanwhile.
  std::optional<Pose> X_LB = {};  ///< The pose of the body in the link from the start on; only with
                                  ///< t_from = 0.
};

/// One geometry of a member, in a frame G that is fixed in the member's frame M.
struct MemberGeometry {
  Shape shape;
  Pose X_MG = {};
};

/// A link of a robot, both by number.
struct RobotLink {
  std::size_t robot = 0;
  std::size_t link = 0;

  friend bool operator==(const RobotLink&, const RobotLink&) = default;
};

/// The motion of a body over a window of the step: as given, carried by a link, or at rest.
struct BodyStretch {
  struct Given {};
  struct Carried {
    RobotLink link;
    Pose X_LB;
  };
  struct Resting {
    Pose X_WB;
  };
  double t_begin = 0.0;  ///< [-]
  double t_end = 1.0;    ///< [-]
  std::variant<Given, Carried, Resting> how = {};
};

/// Bodies and robots with their motions over the step, t in [0, 1].
///
/// Anything that can touch is a *member*, numbered from 0 in the order of adding. A body is one
/// member, a robot as many as it has links. These rules determine the tested pairs of members and
/// their margins:
/// - Links of one robot are never tested if they are adjacent, or only fixed joints connect them.
///   Two bodies that both rest over the whole step are not tested either.
/// - rules() ignores pairs and gives margins.
/// - A link that holds a body, and touch links, are not tested against it meanwhile.
///
/// Members without geometry touch nothing. Names are unique; that of a link is "robot/link".
/// Functions throw std::invalid_argument on bad input, with the name of what is wrong.
class FIRSTCONTACT_API RobotScene {
 public:
  explicit RobotScene(PairRules rules = PairRules()) : rules_(std::move(rules)) {}

  /// Adds a body and returns its number as a member.
  ///
  /// A body that deforms (move_vertices) cannot be attached to a link.
  std::size_t add_body(std::string name, Shape shape, Motion X_WB = Motion::fixed());

  /// Adds a robot and returns its number, from 0.
  ///
  /// Its link k is the member first_member(robot) + k. Every collision geometry of the model must
  /// have its shape (LoadShapes).
  ///
  /// @param disabled  pairs of links that are not tested, as an SRDF has them
  std::size_t add_robot(std::string name, RobotMotion motion,
                        std::span<const DisabledPair> disabled = {});

  /// Sets another motion of the same robot.
  ///
  /// The rest of the scene stays as it is. The places of bodies that the robot carries are taken
  /// anew.
  void set_motion(std::size_t robot, RobotMotion motion);

  /// Attaches a body to a link. A body may be attached several times, one after the other.
  void attach(Attachment attachment);

  /// Thickens a member by a ball: adds to the margin of every pair that it is in.
  ///
  /// @param padding  [m]  >= 0
  void set_padding(std::size_t member, double padding);

  /// Holds a pair to a distance of its own, in place of its margin and of both paddings. A pair
  /// that is not tested stays so.
  ///
  /// @param distance  [m]  >= 0
  void hold_pair(const BodyPair& members, double distance);

  /// Sets the tracking error of a joint: its effect on a link adds to the margins of the link's
  /// pairs.
  ///
  /// A proof of freedom then holds for every motion of the robot whose coordinates stay within the
  /// errors of the nominal ones. For a floating or ball joint the error is that of the child's
  /// frame: its angle, and the displacement of its origin. Mimic joints follow theirs, errors
  /// included.
  void set_tracking_error(std::size_t robot, std::string_view joint, const TrackingError& error);

  [[nodiscard]] PairRules& rules() { return rules_; }  ///< The rules for pairs of members.
  [[nodiscard]] const PairRules& rules() const { return rules_; }

  [[nodiscard]] std::size_t size() const { return members_.size(); }  ///< Number of members.
  [[nodiscard]] const std::string& name(std::size_t member) const { return members_[member].name; }
  [[nodiscard]] std::optional<std::size_t> find_member(std::string_view name) const;
  [[nodiscard]] std::span<const MemberGeometry> geometries(std::size_t member) const {
    return members_[member].geometries;
  }
  [[nodiscard]] double padding(std::size_t member) const { return members_[member].padding; }
  /// The robot and the link that a member is; none for a body.
  [[nodiscard]] std::optional<RobotLink> robot_link(std::size_t member) const {
    return members_[member].link;
  }
  /// Whether a member is a body that never moves.
  [[nodiscard]] bool rests(std::size_t member) const { return members_[member].rests; }
  /// The motion that a body was given; it holds before the body is attached for the first time.
  [[nodiscard]] const Motion& body_motion(std::size_t member) const;
  /// The stretches of a body in order, without gaps, from 0 to 1.
  [[nodiscard]] std::span<const BodyStretch> stretches(std::size_t member) const;

  [[nodiscard]] std::size_t robot_count() const { return robots_.size(); }
  [[nodiscard]] const std::string& robot_name(std::size_t robot) const {
    return robots_[robot].name;
  }
  [[nodiscard]] const RobotMotion& robot_motion(std::size_t robot) const {
    return robots_[robot].motion;
  }
  [[nodiscard]] std::size_t first_member(std::size_t robot) const {
    return robots_[robot].first_member;
  }
  /// The tracking errors of a robot, one for each joint of the model.
  ///
  /// A mimic joint has the error of the joint that it follows times its multiplier.
  [[nodiscard]] std::vector<TrackingError> tracking_errors(std::size_t robot) const;

  /// All attachments, in order of body, then of time.
  [[nodiscard]] std::span<const Attachment> attachments() const { return attachments_; }

  /// [m]  The margin of a pair with both paddings, or the distance that it is held to; none where
  /// the pair is never tested.
  ///
  /// Tracking errors are left out. A pair with an attached body has a margin, though it may not be
  /// tested all the time.
  [[nodiscard]] std::optional<double> margin(const BodyPair& members) const;

  /// The paths that all checks of the scene share.
  ///
  /// A body has the pieces of its own motion. A link has the place of each of its geometries on the
  /// link that moves it, its rigid_root().
  [[nodiscard]] std::span<const std::shared_ptr<const JointPath>> paths(std::size_t member) const {
    return members_[member].paths;
  }

  /// The pose X_WM(t), rounded to doubles; t is clamped to [0, 1].
  [[nodiscard]] Pose pose(std::size_t member, double t) const;

  /// The pose of one of a member's geometries, by its number.
  [[nodiscard]] Pose geometry_pose(std::size_t member, std::size_t geometry, double t) const;

 private:
  struct Member {
    std::string name;
    std::vector<MemberGeometry> geometries;
    double padding = 0.0;
    std::optional<RobotLink> link;
    std::optional<Motion> motion = {};        // Only of a body.
    std::vector<BodyStretch> stretches = {};  // Only of a body.
    bool rests = false;                       // Whether it is a body that never moves.
    std::vector<std::shared_ptr<const JointPath>> paths = {};
  };
  struct Robot {
    std::string name;
    RobotMotion motion;
    std::size_t first_member = 0;
    std::vector<TrackingError> tracking_errors;
  };

  void require_member(std::size_t member) const;
  void require_robot(std::size_t robot) const;
  void require_new(const std::string& name) const;
  void divide_into_stretches(std::size_t body);

  std::vector<Member> members_;
  std::vector<Robot> robots_;
  std::vector<Attachment> attachments_;
  PairRules rules_;
  std::map<BodyPair, double> held_;  // [m]
};

}  // namespace firstcontact
