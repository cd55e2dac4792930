/// @file
/// The motion that contacts allow: Gauss' principle of least constraint for a planner.

#pragma once

#include <cstddef>

#include <Eigen/Core>

#include <firstcontact/planning/detail/mover_contact_finder.h>
#include <firstcontact/planning/detail/tangent_space.h>

namespace firstcontact::detail {

/// A motion that contacts allow, to first order.
struct ContactMotion {
  Eigen::VectorXd dq;
  double gap = 0.0;        ///< [m]  Gap that all contacts are to have after the motion.
  std::size_t active = 0;  ///< Number of contacts that hold the motion back.
};

/// Projects a motion onto those that contacts allow, and leads away from contacts.
///
/// The result is the dq for which |dq - wanted|^2 + w (s - hover)^2 is least, in the metric of the
/// space, with gap_i + J_i dq >= s at every contact. The gap s is one more coordinate of the
/// contact problem. So there is an answer in any passage. Where the passage is narrower than twice
/// `hover`, the answer is in its middle.
///
/// Source: with s held at 0 the condition is J dq >= 0 of S. Redon, M. Lin, "Practical local
/// planning in the contact space", ICRA 2005.
///
/// @param hover  [m]  the gap that is wanted; > 0
[[nodiscard]] ContactMotion contact_motion(const TangentSpace& tangents, const ContactsAt& at,
                                           const Eigen::VectorXd& wanted, double hover);

}  // namespace firstcontact::detail
