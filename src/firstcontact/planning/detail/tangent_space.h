/// @file
/// Small motions of a mover, as contacts constrain them.

#pragma once

#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact::detail {

/// A member that moves with the mover, at a place of it.
struct MovedMember {
  Pose X_WM;
  Eigen::Vector3d p_WR = Eigen::Vector3d::Zero();  ///< [m]  Its point of reference R.
  /// (6, n)  (v of R, w) = J dq; without sizes where the member does not move.
  Eigen::Matrix<double, 6, Eigen::Dynamic> J;
};

/// The motions dq that lead from a place, to first order, with a kinetic metric.
///
/// A body has the way of the centre of its hierarchy [m], then a rotation vector [rad], both in the
/// world. A robot has the ways of its coordinates [rad or m]. All of this steers a search only:
/// nothing that is proven rests on it.
class TangentSpace {
 public:
  explicit TangentSpace(const PlanScene& scene);

  [[nodiscard]] Eigen::Index size() const { return inverse_metric_.size(); }

  /// The diagonal of the inverse metric, in which length() is the norm.
  [[nodiscard]] const Eigen::VectorXd& inverse_metric() const { return inverse_metric_; }

  /// [m]  About how far points of the mover move, at most.
  [[nodiscard]] double length(const Eigen::VectorXd& dq) const;
  /// [m^2]  The product of which length() is the norm.
  [[nodiscard]] double product(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const;

  /// [m]  How far the mover's surface is from where it turns.
  [[nodiscard]] double reach() const { return reach_; }

  /// The motion that leads from one place to another.
  [[nodiscard]] Eigen::VectorXd difference(const Configuration& from,
                                           const Configuration& to) const;

  /// The place to which a motion leads, within the limits.
  [[nodiscard]] Configuration moved(const Configuration& q, const Eigen::VectorXd& dq) const;

  /// A motion in axes that go with the mover, and back: a screw is a constant one there.
  [[nodiscard]] Eigen::VectorXd in_body(const Configuration& q, const Eigen::VectorXd& dq) const;
  [[nodiscard]] Eigen::VectorXd in_world(const Configuration& q, const Eigen::VectorXd& dq) const;

  /// The motion between two places in axes that go with the mover, as rates of a screw: where a
  /// body turns about an axis of its frame, all steps of one screw are alike.
  [[nodiscard]] Eigen::VectorXd twist(const Configuration& from, const Configuration& to) const;

  /// The screw about or along an axis of the body's frame that is near a motion, both in axes that
  /// go with the body; none where it is near none, or of a robot.
  [[nodiscard]] std::optional<Eigen::VectorXd> about_an_axis(const Eigen::VectorXd& in_body) const;

  /// The place to which the screw leads that is near a motion, about or along an axis of the
  /// body's frame; none where the motion is near none, or of a robot.
  ///
  /// An edge turns a body about its origin. Only such screws are edges, and they are proven in few
  /// steps where surfaces slide on them.
  [[nodiscard]] std::optional<Configuration> screwed(const Configuration& q,
                                                     const Eigen::VectorXd& dq) const;

  /// The member of a body that is planned, at a place.
  [[nodiscard]] MovedMember moved_body(const Configuration& q) const;

 private:
  const ConfigurationSpace& space_;
  Eigen::Vector3d p_BC_ = Eigen::Vector3d::Zero();  // [m]  Of a body.
  double reach_ = 0.0;                              // [m]
  Eigen::VectorXd inverse_metric_;
};

}  // namespace firstcontact::detail
