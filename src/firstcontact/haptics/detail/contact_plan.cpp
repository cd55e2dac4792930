// The plans of a contact loop: where contacts let the tools go in a round.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/haptics/detail/constants.h>
#include <firstcontact/haptics/detail/contact_loop_implementation.h>
#include <firstcontact/haptics/detail/contact_reduction.h>
#include <firstcontact/haptics/detail/target_follower.h>

namespace firstcontact {

namespace {

/// [m]  Shortens a place to a distance from the origin.
Eigen::Vector3d within(double farthest, const Eigen::Vector3d& place) {
  const double length = place.norm();
  return length > farthest ? Eigen::Vector3d(farthest / length * place) : place;
}

}  // namespace

/// Computes the displacements to the targets, or to a fraction of the way from the targets of the
/// last cycle to these. So hands and courses move at the same time.
detail::ToolDisplacements ContactLoop::Implementation::wanted(const HapticTargets& targets,
                                                              double part) const {
  const double back = last_targets_.empty() ? 0.0 : 1.0 - part;
  detail::ToolDisplacements ways;
  for (std::size_t k = 0; k < targets.joints.size(); ++k) {
    const HapticJoint& joint = links_.joints()[k];
    const double before = last_joint_targets_.empty() ? targets.joints[k] : last_joint_targets_[k];
    const double target = targets.joints[k] + back * (before - targets.joints[k]);
    ways.joints[k] = std::clamp(target, joint.lower, joint.upper) - joints_[k];
  }
  for (std::size_t k = 0; k < tools(); ++k) {
    const Vector3d& p_BC = scene_.tools[k].p_BC;
    Eigen::Quaterniond R_WB = targets.poses[k].rotation.normalized();
    Vector3d target = within(farthest_, targets.poses[k].position + R_WB * p_BC);
    if (back > 0.0) {
      const Eigen::Quaterniond before = last_targets_[k].rotation.normalized();
      const Vector3d from = within(farthest_, last_targets_[k].position + before * p_BC);
      target += back * (from - target);
      R_WB = detail::turn_by(back * detail::turn_between(R_WB, before)) * R_WB;
    }
    ways[k].translation = target - centre(k);
    ways[k].rotation_vector = detail::turn_between(poses_[k].rotation, R_WB);
  }
  return ways;
}

double ContactLoop::Implementation::gain_of(const detail::ToolDisplacements& ways) const {
  double gain = 0.0;
  for (std::size_t k = 0; k < tools(); ++k) {
    gain = std::max(gain, ways[k].translation.norm() + ways[k].rotation_vector.norm() * lever(k));
  }
  for (std::size_t joint = 0; joint < joints_.size(); ++joint) {
    gain = std::max(gain, std::abs(ways.joints[joint]) * reaches_[joint]);
  }
  return gain;
}

/// Reduces the touches to those that projections take, once for each place of the tools.
const detail::ReducedContacts& ContactLoop::Implementation::reduced_touches() {
  if (!reduced_) {
    reduced_.emplace();
    if (touches_.size() > detail::kMostProjected) {
      std::vector<HapticContact> contacts;
      for (const HapticTouch& touch : touches_) {
        contacts.push_back(touch.contact);
      }
      reduced_ = detail::reduce_contacts(contacts, frames_, tools(), options_.angle,
                                         detail::kMostProjected, deadline_);
    } else {
      reduced_->kept.resize(touches_.size());
      std::iota(reduced_->kept.begin(), reduced_->kept.end(), std::size_t{0});
    }
  }
  return *reduced_;
}

detail::PlannedTouch ContactLoop::Implementation::planned(const HapticTouch& of) const {
  const HapticContact& contact = of.contact;
  detail::PlannedTouch touch{.contact = &contact,
                             .way = contact.gap - detail::kRestGap * distance_,
                             .friction = contact.friction};
  if (contact.body >= 0) {
    const std::size_t member = tools() + static_cast<std::size_t>(contact.body);
    touch.surface = courses_[member].at(contact.point - poses_[member].position);
  }
  const auto way_of_link = [&](std::size_t member) -> Vector3d {
    return courses_[member].at(contact.point - poses_[member].position);
  };
  if (contact.other_link >= 0) {
    touch.surface += way_of_link(of.members[0]);
  }
  if (contact.link >= 0) {
    touch.surface -= way_of_link(of.members[1]);
  }
  return touch;
}

detail::GodObjectPlan ContactLoop::Implementation::plan(const detail::ToolDisplacements& wanted,
                                                        bool has_friction) {
  planned_.clear();
  for (const std::size_t k : reduced_touches().kept) {
    planned_.push_back(planned(touches_[k]));
  }
  for (const HapticTouch& touch : left_) {
    planned_.push_back(planned(touch));
  }
  for (detail::PlannedTouch& touch : planned_) {
    touch.friction = has_friction ? touch.friction : 0.0;
  }
  detail::GodObjectPlan plan = detail::plan_god_objects(
      wanted, frames_, tools(), planned_, detail::kSolvedTo * distance_, deadline_.has_value());
  for (Displacement& way : plan.displacements.tools) {
    if (!way.translation.allFinite() || !way.rotation_vector.allFinite()) {
      way = {};
    }
  }
  for (double& way : plan.displacements.joints) {
    way = std::isfinite(way) ? way : 0.0;
  }
  cycle_.residual = std::max(cycle_.residual, plan.residual);
  return plan;
}

/// Plans a shorter displacement where contacts would turn a tool so far that its linear constraints
/// do not hold.
detail::GodObjectPlan ContactLoop::Implementation::plan_within_turn(
    const detail::ToolDisplacements& wanted) {
  detail::GodObjectPlan found = plan(wanted);
  double part = 1.0;
  for (std::size_t k = 0; k < tools() && found.is_pressed; ++k) {
    // The farthest point sinks by half of its lever times the square of the angle.
    const double most = std::sqrt(2.0 * detail::kSinkOfTurn * distance_ / lever(k));
    part = std::min(part, most / found.displacements[k].rotation_vector.norm());
  }
  if (found.is_pressed) {
    part = std::min(part, part_within_turn(found.displacements));
  }
  const double pieces = static_cast<double>(pieces_of(found.displacements)) * part;
  if (pieces > detail::kMostPiecesOfLinks) {
    part *= detail::kMostPiecesOfLinks / pieces;
  }
  if (!(part < 1.0)) {
    return found;
  }
  if (are_courses_moving_) {
    found = plan(wanted.part(part));
  } else {
    found.displacements = found.displacements.part(part);
  }
  found.is_shortened = true;
  found.part = part;
  return found;
}

/// Plans the displacement. Where touches are very near it plans only the way out of them, if there
/// is one. A tool that is pressed on without room would sink from round to round.
detail::GodObjectPlan ContactLoop::Implementation::plan_or_part(
    const detail::ToolDisplacements& ways) {
  const bool is_near = std::ranges::any_of(touches_, [&](const HapticTouch& touch) {
    return touch.contact.gap < detail::kPartBelow * distance_;
  });
  is_parting_ = false;
  if (is_near && may_part_ && !are_courses_moving_) {
    // Friction could hold the tool between two surfaces that lean towards each other.
    detail::GodObjectPlan parting = plan({}, false);
    if (gain_of(parting.displacements) > detail::kLeastParting * distance_) {
      is_parting_ = true;
      parting.is_shortened = true;
      return parting;
    }
  }
  return plan_within_turn(ways);
}

/// Plans a round. A plan that turns back is made again with the contacts of the round before as
/// well.
detail::GodObjectPlan ContactLoop::Implementation::plan_round(
    const detail::ToolDisplacements& ways) {
  left_.clear();
  detail::GodObjectPlan found = plan_or_part(ways);
  if (is_parting_ || are_courses_moving_ || !found.is_pressed) {
    last_round_.forget();
    if (!is_parting_) {
      damping_.reset();
    }
    return found;
  }
  if (last_round_.is_left_by(found.displacements, frames_, tools())) {
    left_ = last_round_.touches_left(poses_, touches_);
    found = plan_within_turn(ways);
  }
  last_round_.keep(poses_, touches_, found.displacements);
  // Without friction a tool does not creep, and most plans that turn back do so at new contacts.
  if (std::ranges::any_of(planned_, [](const auto& touch) { return touch.friction > 0.0; })) {
    found.damping = damping_.part_of(found.displacements, frames_, tools(),
                                     cycle_.rounds > 1 || are_targets_still_);
  }
  found.is_shortened = found.is_shortened || found.damping < 1.0;
  return found;
}

}  // namespace firstcontact
