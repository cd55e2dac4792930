/// @file
/// Coulomb's cone K = {r : |r_t| <= mu r_n}, in a contact's frame (normal first).

#pragma once

#include <Eigen/Core>

namespace firstcontact::detail {

/// Finds the point of the cone that is nearest to r.
[[nodiscard]] Eigen::Vector3d project_on_cone(const Eigen::Vector3d& r, double friction);

/// A derivative of project_on_cone; where several exist, one of them.
///
/// It is symmetric. Neither it nor the identity minus it has a negative eigenvalue.
[[nodiscard]] Eigen::Matrix3d cone_projection_derivative(const Eigen::Vector3d& r, double friction);

/// The response of one contact to its own impulse, prepared for many free velocities.
///
/// Its tangents are turned so that A = W_tt - W_tn W_nt / W_nn is diagonal. A is the tangential
/// system that is left where the normal velocity is held.
class ContactResponse {
 public:
  /// @param W  [1/kg]  symmetric, positive semidefinite, in the contact's frame
  explicit ContactResponse(const Eigen::Matrix3d& W);

  /// The rotation from the contact's frame to the frame with the turned tangents.
  [[nodiscard]] const Eigen::Matrix3d& turn() const { return turn_; }
  [[nodiscard]] const Eigen::Matrix3d& W() const { return W_; }  ///< [1/kg]  W in turned axes.
  [[nodiscard]] const Eigen::Vector2d& tangential() const { return a_; }  ///< [1/kg]  A's diagonal.
  [[nodiscard]] const Eigen::Vector2d& coupling() const { return coupling_; }  ///< [-]  W_tn / W_nn
  /// [1/kg]  The greatest entry of the diagonal; 0 where an impulse moves nothing.
  [[nodiscard]] double greatest() const { return greatest_; }

  /// Solves one contact by itself: r in K with u = u_free + W r. All numbers are turned.
  ///
  /// 0 <= r_n is complementary to u_n >= 0. Either u_t = 0, or r lies on the side of K and u_t
  /// points against r_t.
  ///
  /// Where the contact slides, r_t = -(A + alpha I)^-1 c with c the tangential velocity that is
  /// left when u_n = 0, and alpha > 0 the root of |r_t| = mu r_n.
  [[nodiscard]] Eigen::Vector3d impulse(const Eigen::Vector3d& u_free, double friction) const;

 private:
  [[nodiscard]] Eigen::Vector3d sliding(const Eigen::Vector3d& u_free, double friction) const;

  Eigen::Matrix3d turn_;
  Eigen::Matrix3d W_;
  Eigen::Matrix3d inverse_;   // [kg]
  Eigen::Vector2d a_;         // [1/kg]  Diagonal of A.
  Eigen::Vector2d coupling_;  // [-]  W_tn / W_nn
  double greatest_;
};

}  // namespace firstcontact::detail
