#include <firstcontact/haptics/detail/contact_forces.h>

#include <algorithm>
#include <cmath>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

constexpr double kNanosecond = 1e-9;  // [s]

}  // namespace

ContactForces::ContactForces(const std::vector<HapticTool>& tools, const ToolLinks& links,
                             const ForceLoopOptions& options)
    : links_(&links), tools_(tools.size()), tolerance_(options.tolerance), pivots_(options.pivots) {
  const double first = tools[0].coupling.stiffness;
  weigh_joints(links, first, frames_);
  for (std::size_t k = 0; k < tools_; ++k) {
    const HapticCoupling& coupling = tools[k].coupling;
    frames_.lengths[k] = std::sqrt(coupling.angular_stiffness / coupling.stiffness);
    frames_.weights[k] = std::sqrt(coupling.stiffness / first);
    look_aheads_[k] = coupling.damping / coupling.stiffness;
    islands_.push_back(
        {ConeProjection(links.coordinates(), kMostHapticContacts + 2 * links.joints().size())});
  }
}

void ContactForces::take(const HapticContactSet& set) noexcept {
  frames_.p_WC = set.p_WC;
  frames_.axes = set.axes;
  frames_.joints = set.joints;
  for (Island& island : islands_) {
    island.cone.clear();
    island.count = 0;
  }
  widest_gap_ = 0.0;
  add_contacts(set);
  add_limits();
  for (std::size_t k = 0; k < tools_; ++k) {
    has_solved_[k] = has_solved_[k] && islands_[island_of(k)].count > 0;
  }
}

void ContactForces::add_contacts(const HapticContactSet& set) noexcept {
  const std::size_t count = std::min<std::size_t>(set.count, kMostHapticContacts);
  are_coupled_ = std::any_of(set.contacts.begin(), set.contacts.begin() + count,
                             [](const HapticContact& contact) {
                               return contact.other >= 0 && contact.other != contact.tool;
                             });
  for (std::size_t c = 0; c < count; ++c) {
    const HapticContact& contact = set.contacts[c];
    widest_gap_ = std::max(widest_gap_, contact.gap);
    Island& island = islands_[island_of(static_cast<std::size_t>(contact.tool))];
    island.contacts[island.count++] = c;
    island.cone.add(cone_contact(contact, frames_));
  }
}

/// [m]  Computes the tolerance of a projection. Small tools have small gaps, and are pressed by as
/// little. It is not less than the rounding of the ways to the targets.
double ContactForces::tolerance_for(const Coordinates& wanted) const noexcept {
  constexpr double kPartOfGap = 1e-3;
  constexpr double kRounding = 1e-12;
  const double farthest =
      std::abs(*std::ranges::max_element(wanted, {}, [](double way) { return std::abs(way); }));
  return std::min(tolerance_, std::max(kPartOfGap * widest_gap_, kRounding * farthest));
}

/// Adds the limits of joints to islands that have contacts: targets are within the limits.
void ContactForces::add_limits() noexcept {
  for (std::size_t joint = 0; joint < links_->joints().size(); ++joint) {
    Island& island = islands_[island_of(links_->tool_of_joint(joint))];
    for (const double side : {1.0, -1.0}) {
      if (island.count > 0 && has_limit(links_->joints()[joint], side)) {
        island.cone.add(limit_of_joint(joint, side, frames_));
      }
    }
  }
}

std::size_t ContactForces::tool_of(std::size_t coordinate) const noexcept {
  return coordinate < 6 * tools_ ? coordinate / 6 : links_->tool_of_joint(coordinate - 6 * tools_);
}

void ContactForces::shift_surfaces(const HapticContactSet& set, double seconds,
                                   Island& island) const noexcept {
  const double lasted = kNanosecond * static_cast<double>(set.lasted_ns);
  for (std::size_t k = 0; k < island.count; ++k) {
    const HapticContact& contact = set.contacts[island.contacts[k]];
    if (contact.surface_velocity == Vector3d::Zero()) {
      continue;
    }
    // A tool that slides stays while the surface moves on, from where the device was at the stamp.
    // One that is carried along goes back with the surface.
    const double along = contact.slides ? seconds + lasted : seconds;
    island.cone.set_shift(
        k, shift_of_surface(contact, felt_after(contact, seconds), felt_after(contact, along)));
  }
}

ContactForce ContactForces::project(const HapticContactSet& set, const Coordinates& wanted,
                                    double seconds) noexcept {
  ContactForce forces;
  for (std::size_t number = 0; number < islands_.size(); ++number) {
    if (islands_[number].count > 0) {
      add_island(set, wanted, seconds, number, forces);
    }
  }
  return forces;
}

void ContactForces::add_island(const HapticContactSet& set, const Coordinates& wanted,
                               double seconds, std::size_t number, ContactForce& forces) noexcept {
  Island& island = islands_[number];
  shift_surfaces(set, seconds, island);
  ConeProjectionResult found = island.cone.project(wanted, tolerance_for(wanted), pivots_);
  forces.pressing += found.pressing;
  forces.pivots += found.pivots;
  if (!found.is_solved && found.pressing > 0) {
    keep_last(set, wanted, seconds, number, found.force);
  }
  for (std::size_t i = 0; i < links_->coordinates(); ++i) {
    const std::size_t tool = tool_of(i);
    if (island_of(tool) == number) {
      forces.force[i] = found.force[i];
      solved_[i] = found.is_solved ? found.force[i] : solved_[i];
      has_solved_[tool] = has_solved_[tool] || found.is_solved;
      forces.is_solved[tool] = found.is_solved;
    }
  }
}

/// Whether a contact presses on the tool or the joint of a coordinate.
bool ContactForces::presses_on(const Island& island, std::size_t coordinate,
                               const Coordinates& wanted) const noexcept {
  const bool is_joint = coordinate >= 6 * tools_;
  return island.cone.presses_on(is_joint ? coordinate : coordinate / 6 * 6, is_joint ? 1 : 6,
                                wanted, tolerance_for(wanted));
}

/// Sets the force of an unsolved island to the last one that was solved, if there is one. Where no
/// contact presses the force is 0.
void ContactForces::keep_last(const HapticContactSet& set, const Coordinates& wanted,
                              double seconds, std::size_t number,
                              Coordinates& force) const noexcept {
  for (std::size_t i = 0; i < links_->coordinates(); ++i) {
    const std::size_t tool = tool_of(i);
    const bool is_felt = island_of(tool) == number && presses_on(islands_[number], i, wanted);
    const double last = has_solved_[tool] ? solved_[i] : force[i];
    force[i] = is_felt ? last : 0.0;
  }
  cut_to_springs(set, wanted, seconds, number, force);
}

/// Cuts a force to that of springs stretched to the targets, plus the path of the surfaces.
/// Without the cut, contacts that contradict each other could have any force.
void ContactForces::cut_to_springs(const HapticContactSet& set, const Coordinates& wanted,
                                   double seconds, std::size_t number,
                                   Coordinates& force) const noexcept {
  double squares_of_way = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < links_->coordinates(); ++i) {
    if (island_of(tool_of(i)) == number) {
      squares_of_way += wanted[i] * wanted[i];
      squares += force[i] * force[i];
    }
  }
  double surface = 0.0;
  const Island& island = islands_[number];
  for (std::size_t k = 0; k < island.count; ++k) {
    const HapticContact& contact = set.contacts[island.contacts[k]];
    surface =
        std::max(surface, std::abs(felt_after(contact, seconds)) * contact.surface_velocity.norm());
  }
  const double most = std::sqrt(squares_of_way) + surface;
  const double length = std::sqrt(squares);
  for (std::size_t i = 0; i < links_->coordinates() && length > most; ++i) {
    force[i] *= most / length;
  }
}

}  // namespace firstcontact::detail
