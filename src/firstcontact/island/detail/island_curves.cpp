#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <firstcontact/island/detail/island_plan.h>
#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/contact_distances.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>

namespace firstcontact::detail {

using Eigen::Vector3d;

namespace {

ContactPoint moved(const ContactPoint& contact, const MovedContact& to) {
  ContactPoint there = contact;
  there.arm_A = to.arms[0];
  there.arm_B = to.arms[1];
  there.frame = to.frame;
  return there;
}

}  // namespace

ContactPoint by_mean(const ActingContact& acting) {
  ContactPoint contact = moved(acting.now, acting.halfway);
  contact.least_normal_velocity = acting.least;
  contact.sticking_velocity += acting.change_of_belt - acting.slip;
  if (acting.is_held) {
    contact.least_normal_velocity = kBackToRest * acting.least - acting.change[0];
    contact.sticking_velocity -= acting.change.tail<2>();
  }
  return contact;
}

ContactPoint along_way(const ActingContact& acting) {
  ContactPoint contact = moved(acting.now, acting.halfway);
  contact.least_normal_velocity = acting.least;
  contact.sticking_velocity += 0.5 * acting.change_of_belt;
  return contact;
}

/// Whether a contact is held on a curved surface, so that its place is known after its bodies
/// moved.
bool IslandPlanner::is_on_curve(std::size_t k) const {
  return acts(k) && acting_[k].is_round && acting_[k].is_held;
}

/// [m]  The distance of the surfaces, the pair's margin included.
double IslandPlanner::distance_of(const ManifoldPoint& touch) const {
  return touch.gap + state_.model.laws.margin(touch.bodies).value_or(0.0);
}

/// The bodies of a contact with the mean of the velocities at the begin and the end of the plan.
std::array<ContactSide, 2> IslandPlanner::mean_sides(std::size_t k,
                                                     const std::vector<ContactBody>& at_end) const {
  const ManifoldPoint& touch = touches_[k];
  std::array<ContactSide, 2> sides{side_of(touch, 0), side_of(touch, 1)};
  for (std::size_t s = 0; s < 2; ++s) {
    const ContactBody& end = at_end[bodies_.place(touch.bodies[s])];
    sides[s].v = 0.5 * (sides[s].v + end.v);
    sides[s].w = 0.5 * (sides[s].w + end.w);
  }
  return sides;
}

/// Turns contacts on curved surfaces by the velocities of the last solution in place of those of
/// now. Returns whether that changes any of them.
bool IslandPlanner::follow_curves() {
  const double slack = least_speed();
  const std::vector<ContactBody>& at_end = last_->velocities.bodies;
  bool is_changed = false;
  for (std::size_t k = 0; k < first_ahead_; ++k) {
    if (!is_on_curve(k)) {
      continue;
    }
    ActingContact& acting = acting_[k];
    std::array<ContactSide, 2> sides = mean_sides(k, at_end);
    const double distance = distance_of(touches_[k]);
    const MovedContact there = moved_contact(touches_[k], acting.now, distance, sides, span_);
    acting.halfway = moved_contact(touches_[k], acting.now, distance, sides, 0.5 * span_);
    for (std::size_t s = 0; s < 2; ++s) {
      const ContactBody& end = at_end[bodies_.place(touches_[k].bodies[s])];
      sides[s].v = end.v;
      sides[s].w = end.w;
    }
    acting.change = there.velocity(sides) - acting.halfway.velocity(sides);
    ContactPoint contact = by_mean(acting);
    contact.guess = problem_.contacts[k].guess;
    const auto excess = [&](const ContactPoint& row) {
      return normal_velocity(row, at_end) - row.least_normal_velocity;
    };
    if (std::abs(excess(contact) - excess(problem_.contacts[k])) > slack) {
      changed_.push_back(k);
      is_changed = true;
    }
    problem_.contacts[k] = contact;
  }
  return is_changed;
}

/// Whether a touch ahead is on the surface of a contact that follows its curve. Then the polygon of
/// a circle stands out there, and a displacement keeps away from it.
bool IslandPlanner::lifts(const PredictedContact& ahead) {
  const auto is_of_one_surface = [&](std::size_t k) {
    return touches_[k].bodies == ahead.touch.bodies && is_on_curve(k) &&
           touches_[k].normal.dot(ahead.touch.normal) >= kNearLine &&
           (share_curve(touches_[k], ahead.touch) || same_features(touches_[k], ahead.touch));
  };
  std::optional<std::size_t> nearest;
  double least = 0.0;
  for (std::size_t k = 0; k < first_ahead_ && !by_end_; ++k) {
    const double apart = (touches_[k].point - ahead.touch.point).norm();
    if (is_of_one_surface(k) && (!nearest || apart < least)) {
      nearest = k;
      least = apart;
    }
  }
  const bool presses = nearest && last_ && last_->velocities.impulses[*nearest][0] > 0.0;
  if (!presses || acting_[*nearest].lifts == kMostLifts) {
    return false;
  }
  ++acting_[*nearest].lifts;
  return true;
}

/// [m]  Bounds a displacement that keeps a contact on its curve: the path of the contact times the
/// turn of its normal, and a contact distance. The sagittas of the arcs of both points are added,
/// as flights have the effect of contacts on spins.
double IslandPlanner::most_from_curve(const MovedContact& there, std::size_t k,
                                      const std::array<ContactSide, 2>& sides) const {
  const ContactPoint& now = acting_[k].now;
  const double turn = (there.frame.row(0) - now.frame.row(0)).norm();
  double way = 0.0;
  double sagittas = 0.0;
  for (std::size_t s = 0; s < 2; ++s) {
    const Vector3d& w = sides[s].w;
    const Vector3d& arm = s == 0 ? now.arm_A : now.arm_B;
    way += span_ * (sides[s].v.norm() + w.norm() * arm.norm());
    sagittas += 0.5 * span_ * span_ * w.norm() * w.cross(arm).norm();
  }
  return state_.model.distances.least + way * turn + sagittas;
}

/// [m]  Computes this bound for velocities of bodies at the end.
double IslandPlanner::most_from_curve(std::size_t k, const std::vector<ContactBody>& at_end) const {
  const std::array<ContactSide, 2> sides = mean_sides(k, at_end);
  return most_from_curve(
      moved_contact(touches_[k], acting_[k].now, distance_of(touches_[k]), sides, span_), k, sides);
}

/// Adds displacements that keep pressed contacts on their curves. The plan's motion is along a
/// line, and the mean of velocities is only almost along the chord.
void IslandPlanner::keep_on_curves(Plan& plan) const {
  if (by_end_) {
    return;
  }
  const double tolerance = kPushTolerance * state_.model.distances.least;
  ContactProblem problem;
  double most = 0.0;  // [m]
  bool is_any = false;
  for (std::size_t k = 0; k < problem_.contacts.size(); ++k) {
    const ContactPoint& contact = problem_.contacts[k];
    ContactPoint kept{.bodies = contact.bodies,
                      .arm_A = contact.arm_A,
                      .arm_B = contact.arm_B,
                      .frame = contact.frame};
    const bool is_pressed = last_->velocities.impulses[k][0] > 0.0;
    const OffCurve off = is_pressed && is_on_curve(k) ? off_curve(k, plan) : OffCurve{};
    if (off.most > 0.0) {
      is_any = is_any || std::abs(off.missing) > tolerance;
      most = std::max(most, off.most);
      kept.least_normal_velocity = off.missing;
      problem.contacts.push_back(kept);
      // The gap must not grow either.
      kept.frame.topRows<2>() *= -1.0;
      kept.least_normal_velocity *= -1.0;
    }
    problem.contacts.push_back(kept);
  }
  if (!is_any) {
    return;
  }
  set_at_rest(problem);
  ContactSolution kept =
      project_on_contacts(problem, {.tolerance = tolerance,
                                    .enough = kPushEnough * state_.model.distances.least,
                                    .sweeps = kPushSweeps});
  limit_push(most, kept);
  displace(kept, plan);
}

/// Computes the missing distance of a contact after the plan. Nothing where the plan takes it too
/// far from its curve.
IslandPlanner::OffCurve IslandPlanner::off_curve(std::size_t k, const Plan& plan) const {
  const ManifoldPoint& touch = touches_[k];
  std::array<ContactSide, 2> sides{side_of(touch, 0), side_of(touch, 1)};
  for (std::size_t s = 0; s < 2; ++s) {
    const std::size_t place = bodies_.place(touch.bodies[s]);
    if (place < state_.size()) {
      sides[s].v = plan.moves[place].translation / span_;
      sides[s].w = plan.moves[place].rotation_vector / span_;
    }
  }
  if (!follows_curve(acting_[k].now, sides, span_) && !turns_on_corner(touch, sides, span_)) {
    return {};
  }
  const double distance = distance_of(touch);
  const MovedContact there = moved_contact(touch, acting_[k].now, distance, sides, span_);
  const double missing = kBackToRest * span_ * acting_[k].least - there.opened +
                         acting_[k].lifts * state_.model.distances.tolerance;
  const double most =
      most_from_curve(there, k, sides) + acting_[k].lifts * state_.model.distances.tolerance;
  return std::abs(missing) <= most ? OffCurve{missing, most} : OffCurve{};
}

}  // namespace firstcontact::detail
