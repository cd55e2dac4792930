/// @file
/// Coulomb's cone K = {r : |r_t| <= mu r_n}, in a contact's frame (normal first).

#pragma once

#include <Eigen/Core>

namespace firstcontact::detail {

[[nodiscard]] Eigen::Vector3d project_on_cone(const Eigen::Vector3d& r, double friction);

/// A derivative of project_on_cone (where there are several, one of them). Symmetric, and neither
/// it nor the identity minus it has a negative eigenvalue.
[[nodiscard]] Eigen::Matrix3d cone_projection_derivative(const Eigen::Vector3d& r, double friction);

/// The impulse of one contact by itself: r in K with u = u_free + W r, such that 0 <= r_n
/// complementary to u_n >= 0, and either u_t = 0 or u_t points against r_t on the side of K.
///
/// Where the contact slides, r_t = -(A + alpha I)^-1 c with the tangential system A, c that is left
/// when u_n = 0, and alpha > 0 the root of |r_t| = mu r_n.
///
/// @param W  [1/kg]  symmetric, positive semidefinite; with no response to the normal: r = 0
[[nodiscard]] Eigen::Vector3d single_contact_impulse(const Eigen::Matrix3d& W,
                                                     const Eigen::Vector3d& u_free,
                                                     double friction);

}  // namespace firstcontact::detail
