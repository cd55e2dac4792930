/// @file
/// The local planner in contact space: it slides, rolls and turns along contacts by proven edges.

#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/math/random_numbers.h>
#include <firstcontact/planning/detail/mover_contact_finder.h>
#include <firstcontact/planning/detail/plan_work.h>
#include <firstcontact/planning/detail/tangent_space.h>

namespace firstcontact::detail {

/// [-]  Of what is proven of a blocked edge: where slides begin.
inline constexpr double kShortOfContact = 0.98;

/// A way along contacts.
struct ContactWay {
  std::vector<Configuration> places;  ///< Behind the place where it begins; edges are proven.
  bool reaches_target = false;
  std::size_t active = 0;  ///< Contacts that held the last step back.
  bool is_near = false;    ///< Whether it ends no farther from a contact than the hover gap.
};

/// Moves along contacts. For one thread.
///
/// A step wants to go straight. Where that is blocked, contacts near the place constrain it
/// (contact_motion()), and what remains of the step is checked as an edge. The proven part of it is
/// taken, and the next step begins there. What was slid so far is repeated as a whole whenever that
/// is proven, too: along a groove or a thread steps so double, and a thread gives its screw away
/// without being asked for it.
///
/// S. Redon, M. Lin, "Practical local planning in the contact space", ICRA 2005. Ours are the gap
/// that is kept, and the repetition.
class ContactSteering {
 public:
  ContactSteering(PlanWork& work, const PlanScene& scene, double range);

  /// Goes towards a target until it is reached or nothing is gained.
  [[nodiscard]] ContactWay slide(const Configuration& from, const Configuration& target);

  /// Goes on in a direction, which is constant in axes that go with the mover, until it is held
  /// back or has come far.
  [[nodiscard]] ContactWay push(const Configuration& from, const Eigen::VectorXd& in_body);

  /// Leaves contacts as far as the hover gap.
  [[nodiscard]] ContactWay lift(const Configuration& from);

  /// Whether something is about as near as contacts that ways_out() looks at.
  [[nodiscard]] bool is_near(const Configuration& q);

  /// A direction for push(): along, about, or both, of the length of the range.
  [[nodiscard]] Eigen::VectorXd direction(RandomNumbers& random) const;

  /// Directions for push() of a body out of contacts, each in both senses: those that the contacts
  /// hold back least, then along and about its axes. None without contacts, and of robots.
  [[nodiscard]] std::vector<std::array<Eigen::VectorXd, 2>> ways_out(const Configuration& from);

 private:
  /// What a way wants: a target, or a direction.
  struct Aim {
    const Configuration* target = nullptr;
    Eigen::VectorXd in_body = {};
    double most = 0.0;  // [m]  Length of the way.
  };
  class Way;

  PlanWork& work_;
  TangentSpace tangents_;
  MoverContactFinder finder_;
  double range_;
  double hover_;
};

}  // namespace firstcontact::detail
