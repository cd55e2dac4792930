#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include <firstcontact/island/detail/island_plan.h>
#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/motion/detail/turn.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/contact_distances.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>

namespace firstcontact::detail {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// [m/s]  The slip up to which a contact counts as one that rolls. It is a fraction of the speed at
/// which the contact goes over both surfaces, and of the change that its curve makes.
double IslandPlanner::slip_of_rolling(std::size_t k) const {
  const ActingContact& acting = acting_[k];
  const std::array<ContactSide, 2> sides = mean_sides(k, last_->velocities.bodies);
  double slower = std::numeric_limits<double>::infinity();
  for (std::size_t s = 0; s < 2; ++s) {
    const Vector3d& now = s == 0 ? acting.now.arm_A : acting.now.arm_B;
    const Vector3d way = turn(-0.5 * span_ * sides[s].w) * acting.halfway.arms[s] - now;
    slower = std::min(slower, way.norm() / (0.5 * span_));
  }
  return kSlipOfRolling * slower + kSlipOfChange * acting.change.tail<2>().norm();
}

/// Whether a pair that slides now sticks from the first half of the plan on. The mean would let it
/// slide for half of the plan.
///
/// @param first,end  the contacts of the pair
bool IslandPlanner::stops_early(std::size_t first, std::size_t end) const {
  const double slow = least_speed();
  Vector3d friction = Vector3d::Zero();
  double most = 0.0;
  double slip = 0.0;
  double rolling = slow;  // Where one contact rolls, the bodies turn, and others slip as much.
  for (std::size_t k = first; k < end; ++k) {
    const ContactPoint& contact = problem_.contacts[k];
    const Vector3d& impulse = last_->velocities.impulses[k];
    const Vector3d at_end = relative_velocity(contact, last_->velocities.bodies);
    if ((at_end.tail<2>() - contact.sticking_velocity).norm() > slow) {
      return false;
    }
    if (impulse[0] > 0.0) {
      slip = std::max(slip, slip_before(k).norm());
      rolling = std::max(rolling, slip_of_rolling(k));
    }
    friction += contact.frame.bottomRows<2>().transpose() * impulse.tail<2>();
    most += contact.friction * impulse[0];
  }
  return slip > rolling && friction.norm() < 0.5 * most;
}

/// [m/s]  The slip of an acting contact when the plan begins.
Vector2d IslandPlanner::slip_before(std::size_t k) const {
  const ContactPoint& before = acting_[k].now;
  return relative_velocity(before, bodies_.bodies()).tail<2>() - before.sticking_velocity;
}

/// Turns the friction of contacts that slide throughout the plan against the mean of their slips.
/// Friction against the slip at the end alone is of first order where the slip turns. Returns
/// whether that changes any of them.
bool IslandPlanner::follow_slides() {
  const double slow = least_speed();
  bool is_changed = false;
  for (std::size_t k = 0; k < first_ahead_; ++k) {
    ActingContact& acting = acting_[k];
    ContactPoint& contact = problem_.contacts[k];
    if (!acts(k) || contact.friction == 0.0) {
      continue;
    }
    const Vector2d before = slip_before(k);
    const Vector2d end = relative_velocity(contact, last_->velocities.bodies).tail<2>() -
                         contact.sticking_velocity - acting.slip;
    const bool slides = last_->velocities.impulses[k][0] > 0.0 &&
                        end.dot(before) > kLeastOfSlip * before.squaredNorm();
    const double across = std::abs(before[0] * end[1] - before[1] * end[0]);
    const bool turns = slides && (acting.slip.any() || across > slow * end.norm());
    const Vector2d slip = turns ? before : Vector2d::Zero();
    if ((slip - acting.slip).norm() > slow) {
      contact.sticking_velocity += acting.slip - slip;
      acting.slip = slip;
      changed_.push_back(k);
      is_changed = true;
    }
  }
  return is_changed;
}

}  // namespace firstcontact::detail
