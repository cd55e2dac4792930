// A cycle of the contact loop: plans, proofs, pieces.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Geometry>

#include <firstcontact/geometry/shape_bounds.h>
#include <firstcontact/haptics/detail/constants.h>
#include <firstcontact/haptics/detail/contact_listing.h>
#include <firstcontact/haptics/detail/contact_loop_implementation.h>
#include <firstcontact/haptics/detail/haptic_scene_check.h>
#include <firstcontact/math/float_environment.h>

namespace firstcontact {
namespace {

bool are_equal(const Pose& a, const Pose& b) {
  return a.position == b.position && a.rotation.coeffs() == b.rotation.coeffs();
}

}  // namespace

/// [s]  Finds the part of a slot in which all courses are straight, to half the contact distance.
double ContactLoop::Implementation::straight_slot(double slot) const {
  const double begin = time_ + now_;
  const double from = share(begin);
  const double to = share(begin + slot);
  if (wait_from_ || bends_.empty() || !(from < to)) {
    return slot;
  }
  const std::vector<double> ends =
      detail::straight_parts(bends_, from, to, detail::kBendOfCourse * distance_);
  if (ends.empty()) {
    return detail::kShareOfWildCourse * slot;
  }
  const double straight = ends.front() * scene_.duration - begin;
  const bool is_whole = ends.front() == to && slot - straight <= detail::kLeastRestOfRound * slot;
  return is_whole ? slot : std::clamp(straight, detail::kLeastRestOfRound * slot, slot);
}

/// Sets the displacements of the bodies with courses in a part of the cycle: from their present
/// places to their courses at its end.
void ContactLoop::Implementation::set_courses(double slot) {
  for (std::size_t m = tools(); m < first_link(); ++m) {
    courses_[m] = {};
    if (has_course(m) && !wait_from_) {
      const Motion& course = *body_of(m).course;
      const double from = share(time_ + now_);
      const double to = share(time_ + now_ + slot);
      courses_[m].translation = course.pose(to).position - poses_[m].position;
      courses_[m].rotation_vector =
          detail::rotation_along(course, from, to, poses_[m].rotation.normalized());
    }
  }
}

void ContactLoop::Implementation::append_piece(std::size_t member, const Displacement& way,
                                               double part, double to) {
  for (HapticMemberMotion& motion : cycle_.members) {
    if (motion.member == member) {
      motion.pieces.push_back({.to = to,
                               .X_WB = poses_[member],
                               .translation = part * way.translation,
                               .rotation_vector = part * way.rotation_vector});
    }
  }
}

/// Executes the plan as far as it is proven, in pieces where links move.
///
/// @returns  [-]  the fraction of it that was executed
double ContactLoop::Implementation::execute(const detail::GodObjectPlan& plan, double slot,
                                            double dt, const std::optional<Deadline>& deadline) {
  detail::ToolDisplacements whole = plan.displacements;
  for (std::size_t joint = 0; joint < joints_.size(); ++joint) {
    // Limits are kept only to the residual of the plan.
    const HapticJoint& limits = links_.joints()[joint];
    whole.joints[joint] =
        std::clamp(joints_[joint] + whole.joints[joint], limits.lower, limits.upper) -
        joints_[joint];
  }
  const std::size_t pieces = pieces_of(whole);
  if (pieces == 1) {
    return execute_piece(whole, slot, dt, deadline);
  }
  const double part = 1.0 / static_cast<double>(pieces);
  const detail::ToolDisplacements ways = whole.part(part);
  const double end = slot == dt - now_ ? dt : now_ + slot;
  for (std::size_t m = tools(); m < first_link(); ++m) {
    courses_[m].translation *= part;
    courses_[m].rotation_vector *= part;
  }
  for (std::size_t k = 0; k < pieces; ++k) {
    const double made =
        execute_piece(ways, (end - now_) / static_cast<double>(pieces - k), dt, deadline);
    if (made < 1.0) {
      return (static_cast<double>(k) + made) * part;
    }
  }
  return 1.0;
}

/// Executes a piece of a plan as far as it is proven.
double ContactLoop::Implementation::execute_piece(const detail::ToolDisplacements& ways,
                                                  double slot, double dt,
                                                  const std::optional<Deadline>& deadline) {
  for (std::size_t m = 0; m < first_link(); ++m) {
    ways_[m] = m < tools() ? ways[m] : courses_[m];
  }
  for (std::size_t m = 0; m < members_.size(); ++m) {
    if (m == first_link()) {
      set_link_motions(ways);
    }
    if (stands(m)) {
      continue;
    }
    const Displacement& way = ways_[m];
    const ConstantRatePiece piece{
        .X_WB = poses_[m], .translation = way.translation, .rotation_vector = way.rotation_vector};
    motions_[m] = Motion::constant_rates(std::span(&piece, 1),
                                         m < tools() ? scene_.tools[m].p_BC : Vector3d::Zero());
  }
  const detail::ProvenPart proven =
      detail::prove_plan(members_, motions_, pairs_, distance_, deadline, workspace_, scratch_);
  cycle_.is_late = cycle_.is_late || proven.is_late;
  cycle_.is_unproven = cycle_.is_unproven || proven.is_unproven;
  const double to = proven.t == 1.0 && slot == dt - now_ ? dt : now_ + proven.t * slot;
  if (!(to > now_)) {
    return 0.0;
  }
  for (std::size_t m = 0; m < members_.size(); ++m) {
    if (stands(m)) {
      continue;
    }
    append_piece(m, ways_[m], proven.t, to);
    poses_[m] = motions_[m].pose(proven.t);
    placed_[m].reset();
  }
  for (std::size_t joint = 0; joint < joints_.size(); ++joint) {
    const HapticJoint& limits = links_.joints()[joint];
    joints_[joint] =
        std::clamp(joints_[joint] + proven.t * ways.joints[joint], limits.lower, limits.upper);
  }
  rest_clearance_ = proven.clearance;
  cycle_.clearance = std::min(cycle_.clearance, proven.clearance);
  now_ = to;
  has_moved_ = true;
  is_found_ = false;
  set_frames();
  return proven.t;
}

void ContactLoop::Implementation::begin_cycle(double dt) {
  now_ = 0.0;
  wait_from_.reset();
  may_part_ = true;
  share_of_courses_ = 1.0;
  cycle_.index += 1;
  cycle_.asked = dt;
  cycle_.lasted = 0.0;
  cycle_.clearance = rest_clearance_;
  cycle_.rounds = 0;
  cycle_.is_converged = false;
  cycle_.is_late = false;
  cycle_.is_unproven = false;
  has_moved_ = false;
  cycle_.residual = 0.0;
  cycle_.members.clear();
  last_on_courses_.clear();
  are_courses_moving_ = false;
  for (std::size_t m = 0; m < members_.size(); ++m) {
    if (!stands(m)) {
      cycle_.members.push_back({.member = m});
    }
    are_courses_moving_ = are_courses_moving_ || (has_course(m) && time_ < scene_.duration);
  }
}

/// Lets courses wait for the rest of the cycle, if there is any: only tools move in it.
void ContactLoop::Implementation::begin_wait() {
  wait_from_ = now_;
  are_courses_moving_ = false;
}

/// Lets all members rest until the end of the cycle. Courses that are not over wait.
void ContactLoop::Implementation::rest_until(double dt) {
  if (are_courses_moving_ && now_ < dt) {
    begin_wait();
  }
  if (now_ < dt) {
    for (const HapticMemberMotion& motion : cycle_.members) {
      append_piece(motion.member, {}, 0.0, dt);
    }
    now_ = dt;
  }
}

/// [m]  The size to which the rounding of pieces is relative.
double ContactLoop::Implementation::size_of_cycle() const {
  double size = 0.0;
  for (const HapticMemberMotion& motion : cycle_.members) {
    for (const HapticPiece& piece : motion.pieces) {
      size = std::max(size, piece.X_WB.position.norm() + piece.translation.norm() +
                                (1.0 + piece.rotation_vector.norm()) *
                                    (members_[motion.member].reach +
                                     members_[motion.member].shape.bounds().centre.norm()));
    }
  }
  return size;
}

/// Notes which contacts with bodies that have courses slide in a round.
void ContactLoop::Implementation::note_sliding(const detail::GodObjectPlan& plan,
                                               double part_of_cycle) {
  last_on_courses_.clear();
  for (const detail::PlannedTouch& touch : planned_) {
    const HapticContact& contact = *touch.contact;
    if (contact.body < 0 || !has_course(tools() + static_cast<std::size_t>(contact.body))) {
      continue;
    }
    const Vector3d u = detail::displacement_at(touch, plan.displacements, frames_);
    const double slip = (u - contact.normal.dot(u) * contact.normal).norm();
    last_on_courses_.push_back(contact);
    last_on_courses_.back().slides = slip > detail::kSlideOfCycle * distance_ * part_of_cycle;
  }
}

/// Sets the velocity of a body with a course at a contact, and whether the tool slides there.
void ContactLoop::Implementation::set_surface(HapticContact& contact, double dt) const {
  const std::size_t member = tools() + static_cast<std::size_t>(contact.body);
  contact.surface_velocity.setZero();
  for (const HapticMemberMotion& motion : cycle_.members) {
    if (motion.member == member && !motion.pieces.empty()) {
      // The velocity in this cycle, waiting included; the body may have turned several times.
      Displacement way{.translation =
                           poses_[member].position - motion.pieces.front().X_WB.position};
      for (const HapticPiece& piece : motion.pieces) {
        way.rotation_vector += piece.rotation_vector;
      }
      contact.surface_velocity = way.at(contact.point - poses_[member].position) / dt;
    }
  }
  double nearest = std::numeric_limits<double>::infinity();
  for (const HapticContact& before : last_on_courses_) {
    const double apart = (before.point - contact.point).norm();
    if (before.tool == contact.tool && before.link == contact.link && before.body == contact.body &&
        apart < nearest) {
      nearest = apart;
      contact.slides = before.slides;
    }
  }
}

void ContactLoop::Implementation::end_cycle(double dt, std::int64_t stamp_ns) {
  find_contacts();
  for (HapticTouch& touch : touches_) {
    if (touch.contact.body >= 0) {
      set_surface(touch.contact, dt);
    }
  }
  cycle_.is_unproven = cycle_.is_unproven && !has_moved_;
  overtime_ = cycle_.is_unproven ? std::min(2.0 * overtime_ + 1.0, detail::kMostOvertime)
                                 : (cycle_.is_late ? overtime_ : 0.5 * overtime_);
  cycle_.lasted = wait_from_.value_or(dt);
  time_ += cycle_.lasted;
  for (HapticMemberMotion& motion : cycle_.members) {
    motion.X_WB = poses_[motion.member];
  }
  cycle_.clearance = std::max(0.0, cycle_.clearance - detail::kRoundingOfPieces * size_of_cycle());
  cycle_.contacts = touches_.size();
  cycle_.joints = joints_;
  set_.lasted_ns = std::llround(1e9 * dt);
  publish(stamp_ns);
}

void ContactLoop::Implementation::require_targets(const HapticTargets& targets, double dt) const {
  detail::require_haptic(targets.poses.size() == tools(), "a target for each tool was expected");
  detail::require_haptic(targets.joints.empty() || targets.joints.size() == joints_.size(),
                         "a target for each joint was expected, or none");
  detail::require_haptic(dt > 0.0 && std::isfinite(dt), "dt must be > 0 s");
  for (const Pose& target : targets.poses) {
    detail::require_haptic(detail::is_finite_pose(target), "a target is not finite");
  }
  for (const double target : targets.joints) {
    detail::require_haptic(std::isfinite(target), "the target of a joint is not finite");
  }
}

/// Whether the plan of a round brings the tools nearer to `ways` by more than a round is worth.
bool ContactLoop::Implementation::gains(const detail::GodObjectPlan& plan,
                                        const detail::ToolDisplacements& ways) const {
  const bool is_further = cycle_.rounds > 1 && !is_parting_;
  const double enough = is_further ? options_.least_gain * gain_of(ways) : 0.0;
  return gain_of(plan.displacements) > std::max(least_gain(), enough);
}

/// The next round moves courses by a smaller share of its time, or lets them wait.
void ContactLoop::Implementation::slow_courses() {
  share_of_courses_ *= detail::kShareWithoutRoom;
  if (share_of_courses_ < detail::kLeastShareOfCourses) {
    begin_wait();
  }
}

/// Whether a further round may bring the tools nearer to their targets.
///
/// @param made    [-]  the part of the plan that was proven and executed
/// @param is_end  whether the plan was to go on to the end of the cycle
bool ContactLoop::Implementation::goes_on_after(const detail::GodObjectPlan& plan, double made,
                                                bool is_end) {
  // Where courses move, a plan to the end of the cycle is the last one.
  const bool is_last_plan = are_courses_moving_ && is_end;
  const bool is_there = made == 1.0 && !plan.is_shortened && (!plan.is_pressed || is_last_plan);
  cycle_.is_converged = is_there;
  if (is_parting_ && made == 0.0) {  // The device may lead the tool out nevertheless.
    may_part_ = false;
    return true;
  }
  if (are_courses_moving_) {
    return made > 0.0;
  }
  return !is_there && made * gain_of(plan.displacements) > 1e-3 * least_gain();
}

/// The time at which proofs end: the deadline, or later after cycles in which nothing could be
/// proven by then. A cycle that is too long is better than a tool that stays for ever.
std::optional<ContactLoop::Deadline> ContactLoop::Implementation::deadline_of_proofs() const {
  if (!deadline_) {
    return {};
  }
  const std::chrono::duration<double> more =
      overtime_ * std::max(*deadline_ - begun_, Deadline::duration::zero());
  return *deadline_ + std::chrono::duration_cast<Deadline::duration>(more);
}

/// Makes one plan and executes it as far as it is proven free. Returns whether another may gain.
bool ContactLoop::Implementation::make_round(const HapticTargets& targets, double dt) {
  const double left = dt - now_;
  find_contacts();
  ++cycle_.rounds;
  const bool is_last = cycle_.rounds == options_.rounds;
  const double straight = straight_slot(left);
  const double share = are_courses_moving_ ? share_of_courses_ : 1.0;
  double slot = (touches_.empty() || is_last ? 1.0 : 0.5) * share * straight;
  set_courses(slot);
  const detail::ToolDisplacements ways =
      wanted(targets, are_courses_moving_ && slot < left && !is_last ? (now_ + slot) / dt : 1.0);
  detail::GodObjectPlan plan = plan_round(ways);
  const bool is_worth = gains(plan, ways);
  if (!is_worth && !are_courses_moving_) {
    cycle_.is_converged = true;
    return false;
  }
  if (!is_worth && slot < straight && share_of_courses_ == 1.0) {  // Only courses move.
    slot = straight;
    set_courses(slot);
    plan = plan_within_turn(ways);
  }
  if (are_courses_moving_ &&
      !detail::keeps_apart(plan, frames_, planned_, detail::kSlackOfRoom * distance_)) {
    slow_courses();
    return true;
  }
  // The rest of the plan has time of its own.
  if (touches_.empty() && !is_last && plan.part < 1.0) {
    slot *= plan.part;
    set_courses(slot);
  }
  note_sliding(plan, slot / dt);
  plan.displacements = plan.displacements.part(plan.damping);
  const double made = execute(plan, slot, dt, deadline_of_proofs());
  return goes_on_after(plan, made, slot == left);
}

const HapticCycle& ContactLoop::Implementation::advance(const HapticTargets& targets, double dt,
                                                        std::int64_t stamp_ns,
                                                        const std::optional<Deadline>& deadline) {
  require_targets(targets, dt);
  const FloatEnvironmentGuard guard;
  deadline_ = deadline;
  begun_ = std::chrono::steady_clock::now();
  begin_cycle(dt);
  are_targets_still_ = std::ranges::equal(targets.poses, last_targets_, are_equal) &&
                       std::ranges::equal(targets.joints, last_joint_targets_);
  bool goes_on = true;
  while (goes_on && cycle_.rounds < options_.rounds && now_ < dt) {
    if (deadline && cycle_.rounds > 0 && std::chrono::steady_clock::now() >= *deadline) {
      cycle_.is_late = true;
      break;
    }
    goes_on = make_round(targets, dt);
  }
  rest_until(dt);
  last_targets_.assign(targets.poses.begin(), targets.poses.end());
  last_joint_targets_.assign(targets.joints.begin(), targets.joints.end());
  end_cycle(dt, stamp_ns);
  return cycle_;
}

void ContactLoop::Implementation::publish(std::int64_t stamp_ns) {
  set_.sequence += 1;
  set_.stamp_ns = stamp_ns;
  set_.tools = static_cast<std::uint32_t>(tools());
  set_.is_unproven = cycle_.is_unproven;
  detail::list_contacts(touches_, reduced_touches(), frames_, tools(), options_, set_,
                        cycle_.touches);
  cycle_.angle = set_.angle;
  for (std::size_t k = 0; k < tools(); ++k) {
    set_.X_WB[k] = poses_[k];
    set_.p_WC[k] = frames_.p_WC[k];
  }
  set_.joint_count = static_cast<std::uint32_t>(joints_.size());
  set_.link_count = static_cast<std::uint32_t>(links_.nodes().size());
  set_.joints = frames_.joints;
  set_.axes = frames_.axes;
  set_.checksum = checksum_of(set_);
}

}  // namespace firstcontact
