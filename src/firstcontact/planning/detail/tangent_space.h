/// @file
/// Small motions of a mover, which contacts constrain.

#pragma once

#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact::detail {

/// A member that moves with the mover, with the mover at a place.
struct MovedMember {
  Pose X_WM;
  Eigen::Vector3d p_WR = Eigen::Vector3d::Zero();  ///< [m]  Its point of reference R.
  /// (6, n)  (v of R, w) = J dq; without columns where the member does not move.
  Eigen::Matrix<double, 6, Eigen::Dynamic> J;
};

/// The motions dq that lead from a place, to first order, with a kinetic metric.
///
/// First come the changes of coordinates [rad or m]. Then each pose has the displacement of a point
/// [m] and a rotation vector [rad], in its frame. The point is the centre of a body's hierarchy, or
/// the origin of what a floating joint moves. This steers a search: no proof depends on it.
class TangentSpace {
 public:
  explicit TangentSpace(const PlanScene& scene);

  [[nodiscard]] Eigen::Index size() const { return inverse_metric_.size(); }

  /// The diagonal of the inverse metric, in which length() is the norm.
  [[nodiscard]] const Eigen::VectorXd& inverse_metric() const { return inverse_metric_; }

  /// [m]  About the greatest displacement of points of the mover.
  [[nodiscard]] double length(const Eigen::VectorXd& dq) const;
  /// [m^2]  The scalar product whose norm is length().
  [[nodiscard]] double product(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const;

  /// [m]  Distance of the mover's surface from where it turns.
  [[nodiscard]] double reach() const { return reach_; }

  /// The motion that leads from one place to another.
  [[nodiscard]] Eigen::VectorXd difference(const Configuration& from,
                                           const Configuration& to) const;

  /// The place to which a motion leads, within the limits.
  [[nodiscard]] Configuration moved(const Configuration& q, const Eigen::VectorXd& dq) const;

  /// The place that is a little beside another one along one number of a motion, limits or not.
  [[nodiscard]] Configuration beside(const Configuration& q, Eigen::Index number,
                                     double step) const;

  /// Transforms a motion to axes that go with the mover, where a screw is constant.
  [[nodiscard]] Eigen::VectorXd in_body(const Configuration& q, const Eigen::VectorXd& dq) const;
  /// Transforms a motion back to the world's axes.
  [[nodiscard]] Eigen::VectorXd in_world(const Configuration& q, const Eigen::VectorXd& dq) const;

  /// The motion between two places in axes that go with the mover, as rates of a screw.
  ///
  /// Where a body turns about an axis of its frame, all steps of one screw are alike.
  [[nodiscard]] Eigen::VectorXd twist(const Configuration& from, const Configuration& to) const;

  /// The screw about or along an axis of the body's frame near a motion; none where it is near
  /// none, or of a robot.
  ///
  /// Both are in axes that go with the body.
  [[nodiscard]] std::optional<Eigen::VectorXd> about_an_axis(const Eigen::VectorXd& in_body) const;

  /// The place to which the screw near a motion leads; none where there is no such screw, or for a
  /// robot. The screw is about or along an axis of the body's frame.
  ///
  /// An edge turns a body about its origin, so only such screws are edges. They are proven in few
  /// steps where surfaces slide on them.
  [[nodiscard]] std::optional<Configuration> screwed(const Configuration& q,
                                                     const Eigen::VectorXd& dq) const;

  /// The member of a planned body, with the body at a place.
  [[nodiscard]] MovedMember moved_body(const Configuration& q) const;

 private:
  /// The number of a pose's displacement in a motion.
  [[nodiscard]] Eigen::Index at(std::size_t pose) const;
  void move_pose(std::size_t pose, const Eigen::VectorXd& dq, Configuration& q) const;

  const ConfigurationSpace& space_;
  Eigen::Vector3d p_BC_ = Eigen::Vector3d::Zero();  // [m]  Only of a body alone.
  double reach_ = 0.0;                              // [m]
  Eigen::VectorXd inverse_metric_;
};

}  // namespace firstcontact::detail
