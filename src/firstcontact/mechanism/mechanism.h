/// @file
/// A robot under forces: its coordinates, mass matrix and bias forces.

#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/robot/robot_model.h>

namespace firstcontact {

/// The positions and the velocities of a mechanism.
struct MechanismState {
  Eigen::VectorXd positions;  ///< (position_count)  [rad or m]  For poses: p, then q as w, x, y, z.
  Eigen::VectorXd velocities;  ///< (size)  [rad/s or m/s]  For poses: v, then w; in J's axes.
};

/// The indices of a joint's numbers in a MechanismState. A joint that mimics another has none of
/// its own.
struct MechanismJoint {
  /// Index of the joint in the model; the number of joints for the free base.
  std::size_t joint = 0;
  Eigen::Index position = 0;    ///< Index of its first position.
  Eigen::Index positions = 1;   ///< Number of its positions.
  Eigen::Index velocity = 0;    ///< Index of its first velocity.
  Eigen::Index velocities = 1;  ///< Number of its velocities.

  /// The index of the first of the four positions that are a quaternion. None for a joint without
  /// one. They are the last four.
  [[nodiscard]] std::optional<Eigen::Index> quaternion() const {
    return positions == velocities ? std::nullopt : std::optional(position + positions - 4);
  }
};

/// The links of a mechanism at one instant.
///
/// Spatial velocities are (v, w), in world axes. Here w is the angular velocity, and v the velocity
/// of the link's point that is at the reference point now.
struct MechanismInstant {
  using Spatial = Eigen::Matrix<double, 6, 1>;

  Eigen::Vector3d reference = Eigen::Vector3d::Zero();  ///< [m]  The reference point.
  std::vector<Pose> X_WL;                               ///< Pose of each link.
  std::vector<Spatial> velocity;                        ///< Spatial velocity of each link.
  std::vector<Spatial> bias;  ///< [per s^2]  Acceleration of each link at constant rates.
  /// (6, size)  The Jacobian of each link: velocity = J times the rates.
  std::vector<Eigen::Matrix<double, 6, Eigen::Dynamic>> J;
};

/// Energy and momentum of a mechanism.
struct MechanismMechanics {
  double kinetic_energy = 0.0;                     ///< [J]
  double potential_energy = 0.0;                   ///< [J]  0 at the world's origin.
  double mass = 0.0;                               ///< [kg]
  Eigen::Vector3d p_WC = Eigen::Vector3d::Zero();  ///< [m]  Centre of mass; 0 without mass.
  Eigen::Vector3d linear_momentum = Eigen::Vector3d::Zero();   ///< [kg m/s]
  Eigen::Vector3d angular_momentum = Eigen::Vector3d::Zero();  ///< [kg m^2/s]  About the origin.
};

/// Forces along the coordinates of a mechanism besides gravity, and coordinates that are driven.
struct MechanismDrive {
  Eigen::VectorXd forces = {};  ///< (size)  [N m or N]  Constant; empty for none.
  /// Coordinates whose velocity changes at a given rate, by the forces that this needs.
  std::vector<Eigen::Index> driven = {};
  Eigen::VectorXd accelerations = {};  ///< (driven)  [rad/s^2 or m/s^2]  Constant.
  /// (size)  [N m s/rad or N s/m]  Forces of this times the velocity oppose it; empty for none.
  Eigen::VectorXd damping = {};
};

/// The end of a motion under forces.
struct MechanismMotion {
  MechanismState end;
  /// (driven)  [N m s or N s]  Total impulses on the driven coordinates.
  Eigen::VectorXd impulses;
};

/// A tree of links under forces, M(q) dv/dt + b(q, v) = forces along the coordinates. Immutable.
///
/// The mass matrix is the sum of J^T I J over the links. The bias forces are those that keep all
/// rates constant against gravity and inertia (R. Featherstone, "Rigid Body Dynamics Algorithms",
/// 2008, chapters 5 and 6). Joints that mimic others move along with them.
class FIRSTCONTACT_API Mechanism {
 public:
  /// Makes the mechanism of a robot.
  ///
  /// @param model      a link needs an inertia where no heavier link shares its motion
  /// @param X_WR       pose of the root link; where a free base starts from
  /// @param free_base  whether nothing holds the root link
  /// @throws std::invalid_argument  names the link with an inertia that no body has
  Mechanism(RobotModel model, const Pose& X_WR, bool free_base);

  [[nodiscard]] const RobotModel& model() const { return model_; }
  [[nodiscard]] Eigen::Index size() const { return size_; }  ///< Number of velocities.
  [[nodiscard]] Eigen::Index position_count() const { return position_count_; }
  /// The joints that have numbers, in their order; the free base first.
  [[nodiscard]] const std::vector<MechanismJoint>& joints() const { return blocks_; }

  [[nodiscard]] bool has_free_base() const { return free_base_; }

  /// Requires that the mass matrix is definite at these positions.
  ///
  /// At other positions it may be singular, as where the axes of a wrist without masses between
  /// them align.
  ///
  /// @throws std::invalid_argument  names the joint that moves no mass
  void require_mass(const Eigen::VectorXd& positions) const;

  /// The state with all coordinates 0, all poses the identity, the free base where it starts from.
  [[nodiscard]] MechanismState rest() const;

  /// Computes the positions after a displacement (size) [rad or m]: rotation vectors turn from the
  /// left.
  [[nodiscard]] Eigen::VectorXd moved(const Eigen::VectorXd& positions,
                                      const Eigen::VectorXd& displacement) const;

  /// Interpolates between two positions at constant rates; poses turn the shorter way.
  [[nodiscard]] Eigen::VectorXd between(const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                                        double share) const;

  [[nodiscard]] MechanismInstant at(const MechanismState& state) const;

  /// The mass matrix M(q), (size, size).
  [[nodiscard]] Eigen::MatrixXd mass_matrix(const MechanismInstant& instant) const;

  /// Computes the inverse of a mass matrix (size, size). A singular one gives that of a definite
  /// one nearby.
  [[nodiscard]] static Eigen::MatrixXd inverse_mass(const Eigen::MatrixXd& mass_matrix);

  /// Computes the forces along the coordinates that keep all rates constant, (size)  [N m or N].
  ///
  /// @param gravity  [m/s^2]
  [[nodiscard]] Eigen::VectorXd bias_forces(const MechanismInstant& instant,
                                            const Eigen::Vector3d& gravity) const;

  /// Computes the state after a time in which gravity and inertia alone act.
  ///
  /// Method: Runge and Kutta's rule of fourth order in sub-steps. For poses it integrates
  /// the rotation vector from where the sub-step began (H. Munthe-Kaas, "High order Runge-Kutta
  /// methods on manifolds", Applied Numerical Mathematics 29 (1999)).
  ///
  /// @param dt  [s]
  [[nodiscard]] MechanismState after_free_motion(const MechanismState& state,
                                                 const Eigen::Vector3d& gravity, double dt) const;

  /// Computes the motion of after_free_motion() under other forces too.
  [[nodiscard]] MechanismMotion after_driven_motion(const MechanismState& state,
                                                    const Eigen::Vector3d& gravity,
                                                    const MechanismDrive& drive, double dt) const;

  /// Computes the velocities at other positions, nearby, with which every link goes on as in the
  /// state.
  ///
  /// They keep the kinetic energy. As nearly as joints permit, they keep each link's momentum and
  /// angular momentum about its centre. This is least squares in the kinetic metric; to first order
  /// it is the parallel transport of that metric. The same numbers at other positions would be
  /// another motion, for example where a link carries a far one, or one that turns against it.
  [[nodiscard]] Eigen::VectorXd carried(const MechanismState& state,
                                        const Eigen::VectorXd& positions) const;

  /// Computes the velocities with which a free base gives the mechanism these momenta. Joints keep
  /// the velocities of the state. The change moves all links as one rigid body.
  ///
  /// @param linear   [kg m/s]
  /// @param angular  [kg m^2/s]  About the origin.
  [[nodiscard]] Eigen::VectorXd with_momenta(const MechanismState& state,
                                             const Eigen::Vector3d& linear,
                                             const Eigen::Vector3d& angular) const;

  [[nodiscard]] MechanismMechanics mechanics(const MechanismState& state,
                                             const Eigen::Vector3d& gravity) const;

 private:
  /// The share of a joint in the motion: numbers of its own, or a multiple of another's.
  struct Part {
    std::size_t block = kFixed;
    double multiplier = 1.0;
    double offset = 0.0;
  };
  static constexpr std::size_t kFixed = static_cast<std::size_t>(-1);

  void lay_out(bool free_base);
  void require_inertias() const;
  class Flight;

  [[nodiscard]] double decay(const MechanismState& state, const Eigen::VectorXd& damping) const;
  [[nodiscard]] Eigen::VectorXd rates(const Eigen::VectorXd& displacement,
                                      const Eigen::VectorXd& velocities) const;
  void place(const MechanismState& state, std::size_t link, MechanismInstant& instant) const;

  RobotModel model_;
  Pose X_WR_;
  std::vector<MechanismJoint> blocks_;
  std::vector<Part> parts_;                          // One for each joint.
  std::vector<std::size_t> order_;                   // Links, parents first.
  std::vector<std::vector<Eigen::Index>> moved_by_;  // For each link the velocities that move it.
  Eigen::Index size_ = 0;
  Eigen::Index position_count_ = 0;
  bool free_base_;
};

}  // namespace firstcontact
