/// @file
/// The state of a contact loop, and its steps.

#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <firstcontact/geometry/shape_bounds.h>
#include <firstcontact/haptics/contact_loop.h>
#include <firstcontact/haptics/detail/constants.h>
#include <firstcontact/haptics/detail/contact_coordinates.h>
#include <firstcontact/haptics/detail/contact_finder.h>
#include <firstcontact/haptics/detail/contact_reduction.h>
#include <firstcontact/haptics/detail/god_object_plan.h>
#include <firstcontact/haptics/detail/last_round.h>
#include <firstcontact/haptics/detail/pair_proof.h>
#include <firstcontact/haptics/detail/round_damping.h>
#include <firstcontact/haptics/detail/tool_links.h>
#include <firstcontact/motion/detail/straight_parts.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/query/placed_shape.h>

namespace firstcontact {

/// The implementation of a contact loop. It starts in contact_loop.cpp. Its cycles are in
/// contact_cycle.cpp, its plans in contact_plan.cpp, the links of its tools in tool_motion.cpp.
class ContactLoop::Implementation {
 public:
  Implementation(HapticScene scene, const ContactLoopOptions& options);

  const HapticCycle& advance(const HapticTargets& targets, double dt, std::int64_t stamp_ns,
                             const std::optional<Deadline>& deadline);

  HapticScene scene_;
  double distance_ = 0.0;  // [m]
  double time_ = 0.0;      // [s]
  std::vector<Pose> poses_;
  std::vector<double> joints_;  // [rad or m]
  HapticContactSet set_;

 private:
  using Vector3d = Eigen::Vector3d;
  using Displacement = detail::Displacement;

  [[nodiscard]] std::size_t tools() const { return scene_.tools.size(); }
  [[nodiscard]] const HapticBody& body_of(std::size_t member) const {
    return scene_.bodies[member - tools()];
  }
  [[nodiscard]] std::size_t first_link() const { return tools() + scene_.bodies.size(); }
  [[nodiscard]] bool is_body(std::size_t member) const {
    return member >= tools() && member < first_link();
  }
  [[nodiscard]] bool has_course(std::size_t member) const {
    return is_body(member) && body_of(member).course.has_value();
  }
  [[nodiscard]] bool stands(std::size_t member) const {
    return is_body(member) && !has_course(member);
  }
  /// The link that is a member; -1 for others.
  [[nodiscard]] int link_of(std::size_t member) const {
    return member < first_link() ? -1 : static_cast<int>(links_with_shape_[member - first_link()]);
  }
  /// The tool that is a member or to which it belongs; -1 for bodies.
  [[nodiscard]] int tool_of(std::size_t member) const;
  /// [-]  Time of the courses at a time of the session.
  [[nodiscard]] double share(double time) const { return std::min(1.0, time / scene_.duration); }
  [[nodiscard]] Vector3d centre(std::size_t tool) const {
    return poses_[tool].position + poses_[tool].rotation.normalized() * scene_.tools[tool].p_BC;
  }

  /// [m]  Distance from the centre of a tool to its farthest point.
  [[nodiscard]] double lever(std::size_t tool) const {
    const HapticTool& its = scene_.tools[tool];
    return (its.shape.bounds().centre - its.p_BC).norm() + members_[tool].reach;
  }

  void begin_members();
  void begin_links();
  void begin_pairs();
  [[nodiscard]] double least_reach() const;
  void measure_joints();
  void require_start();
  [[nodiscard]] std::string name_of(std::size_t member) const;
  void find_contacts();
  void number(HapticTouch& touch, std::size_t other, std::size_t tool) const;
  void set_frames();
  void set_link_frames();
  [[nodiscard]] std::size_t pieces_of(const detail::ToolDisplacements& ways) const;
  [[nodiscard]] double part_within_turn(const detail::ToolDisplacements& ways) const;
  void set_link_motions(const detail::ToolDisplacements& ways);
  void begin_cycle(double dt);
  [[nodiscard]] detail::ToolDisplacements wanted(const HapticTargets& targets, double part) const;
  [[nodiscard]] double gain_of(const detail::ToolDisplacements& ways) const;
  [[nodiscard]] double straight_slot(double slot) const;
  void set_courses(double slot);
  [[nodiscard]] const detail::ReducedContacts& reduced_touches();
  [[nodiscard]] detail::PlannedTouch planned(const HapticTouch& of) const;
  [[nodiscard]] detail::GodObjectPlan plan(const detail::ToolDisplacements& wanted,
                                           bool has_friction = true);
  [[nodiscard]] detail::GodObjectPlan plan_within_turn(const detail::ToolDisplacements& wanted);
  [[nodiscard]] detail::GodObjectPlan plan_or_part(const detail::ToolDisplacements& ways);
  [[nodiscard]] detail::GodObjectPlan plan_round(const detail::ToolDisplacements& ways);
  double execute(const detail::GodObjectPlan& plan, double slot, double dt,
                 const std::optional<Deadline>& deadline);
  double execute_piece(const detail::ToolDisplacements& ways, double slot, double dt,
                       const std::optional<Deadline>& deadline);
  void append_piece(std::size_t member, const Displacement& way, double part, double to);
  void require_targets(const HapticTargets& targets, double dt) const;
  [[nodiscard]] bool gains(const detail::GodObjectPlan& plan,
                           const detail::ToolDisplacements& ways) const;
  /// [m]  A smaller gain is not made.
  [[nodiscard]] double least_gain() const { return detail::kLeastGain * distance_; }
  void slow_courses();
  [[nodiscard]] bool goes_on_after(const detail::GodObjectPlan& plan, double made, bool is_end);
  [[nodiscard]] std::optional<Deadline> deadline_of_proofs() const;
  [[nodiscard]] bool make_round(const HapticTargets& targets, double dt);
  void begin_wait();
  void rest_until(double dt);
  void note_sliding(const detail::GodObjectPlan& plan, double part_of_cycle);
  void set_surface(HapticContact& contact, double dt) const;
  void end_cycle(double dt, std::int64_t stamp_ns);
  void publish(std::int64_t stamp_ns);
  [[nodiscard]] double size_of_cycle() const;

  ContactLoopOptions options_;
  std::vector<detail::HapticMember> members_;
  std::vector<std::optional<PlacedShape>> placed_;
  std::vector<detail::HapticPair> pairs_;
  std::vector<detail::ScriptedMotion> bends_;  // Motions of all courses.
  detail::ToolLinks links_;
  std::vector<std::size_t> links_with_shape_;
  // [m]  For each joint the distance from its axis to the farthest point.
  std::vector<double> reaches_;
  // [m]  For each link the longest of these, of the joints on which it hangs.
  std::vector<double> levers_;
  double link_reach_ = 0.0;  // [m]  Distance from any tool's centre to its farthest point.
  std::vector<Pose> X_WL_;   // Poses that joints give the links.
  // Displacements of members over the next plan. A link goes to the place that its joints give it.
  std::vector<Displacement> courses_;
  std::vector<Displacement> ways_;  // Displacements of members over the piece of a plan.
  std::vector<Motion> motions_;
  detail::ContactFinder finder_{0.0};
  Workspace workspace_;
  FirstContactResult scratch_;
  bool is_found_ = false;  // Whether the contacts are those of the present poses.
  std::vector<HapticTouch> touches_;
  std::optional<detail::ReducedContacts> reduced_;  // The touches, once they are reduced.
  std::optional<Deadline> deadline_;                // Of the cycle.
  Deadline begun_;                                  // Begin of the cycle.
  double overtime_ = 0.0;  // [-]  Time of proofs after the deadline, by the time before it.
  std::vector<detail::PlannedTouch> planned_;
  detail::LastRound last_round_;
  detail::RoundDamping damping_;
  bool are_targets_still_ = false;  // Whether the targets are those of the last cycle.
  // Targets of the last cycle; empty before.
  std::vector<Pose> last_targets_;
  std::vector<double> last_joint_targets_;
  std::vector<HapticContact> last_on_courses_;  // Contacts of the last round with such bodies.
  std::vector<HapticTouch> left_;  // Touches of the last round, where the plan turned back.
  detail::ToolFrames frames_;
  bool has_moved_ = false;       // Whether a piece of this cycle was executed.
  bool may_part_ = true;         // False after a plan to part was in vain in this cycle.
  bool is_parting_ = false;      // Whether the plan only parts.
  double farthest_ = 0.0;        // [m]  Distance from the world's origin to which tools go.
  double rest_clearance_ = 0.0;  // [m]  Proven at the present poses.
  bool are_courses_moving_ = false;
  /// [-]  The share of the time of a round in which courses move on; less without room.
  double share_of_courses_ = 1.0;
  double now_ = 0.0;                      // [s]  Time since the cycle began.
  std::optional<double> wait_from_ = {};  // [s]  Time since then from which courses wait.
  HapticCycle cycle_;
};

}  // namespace firstcontact
