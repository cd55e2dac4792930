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

/// [-]  Part of the proven part of a blocked edge; slides begin there.
inline constexpr double kShortOfContact = 0.98;

/// A way along contacts.
struct ContactWay {
  std::vector<Configuration> places;  ///< Places after the begin of the way; edges are proven.
  bool reaches_target = false;
  std::size_t active = 0;  ///< Number of contacts that held the last step back.
  bool is_near = false;    ///< Whether it ends no farther from a contact than the hover gap.
};

/// Moves along contacts. For one thread.
///
/// Each step first goes straight. Where that is blocked, contacts near the place constrain it
/// (contact_motion()), and the remaining step is checked as an edge. Its proven part is taken, and
/// the next step begins there. The whole slide so far is repeated whenever that is proven, too. So
/// steps double along a groove or a screw thread. On a screw thread the planner finds the screw by
/// itself.
///
/// Source: S. Redon, M. Lin, "Practical local planning in the contact space", ICRA 2005. Ours are
/// the gap that is kept, and the repetition.
class ContactSteering {
 public:
  ContactSteering(PlanWork& work, const PlanScene& scene, double range);

  /// Goes towards a target until it is reached or nothing is gained.
  [[nodiscard]] ContactWay slide(const Configuration& from, const Configuration& target);

  /// Goes on in a direction until the mover is held back or has come far.
  ///
  /// The direction is constant in axes that go with the mover.
  [[nodiscard]] ContactWay push(const Configuration& from, const Eigen::VectorXd& in_body);

  /// Leaves contacts as far as the hover gap.
  [[nodiscard]] ContactWay lift(const Configuration& from);

  /// Whether a contact is about as near as those that ways_out() uses.
  [[nodiscard]] bool is_near(const Configuration& q);

  /// A random direction for push(): along an axis, about one, or both, with the length of the
  /// range.
  [[nodiscard]] Eigen::VectorXd direction(RandomNumbers& random) const;

  /// Directions for push() of a body out of contacts, each in both senses.
  ///
  /// First come those that the contacts hold back least, then those along and about its axes. There
  /// are none without contacts, and for robots.
  [[nodiscard]] std::vector<std::array<Eigen::VectorXd, 2>> ways_out(const Configuration& from);

 private:
  /// The aim of a way: a target, or a direction.
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
