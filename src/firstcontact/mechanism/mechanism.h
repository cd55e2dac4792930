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
  Eigen::VectorXd positions;   ///< (position_count)  [rad or m]  Of poses: p, then q as w, x, y, z.
  Eigen::VectorXd velocities;  ///< (size)  [rad/s or m/s]  Of poses: v, then w; in J's axes.
};

/// The places of a joint's numbers in a MechanismState. A joint that mimics another has none of its
/// own.
struct MechanismJoint {
  std::size_t joint = 0;      ///< Of the model; its number of joints: the free base.
  Eigen::Index position = 0;  ///< The first of its positions,
  Eigen::Index positions = 1;
  Eigen::Index velocity = 0;  ///< and of its velocities.
  Eigen::Index velocities = 1;

  /// The first of the four positions that are a quaternion, of a joint that has one: its last four.
  [[nodiscard]] std::optional<Eigen::Index> quaternion() const {
    return positions == velocities ? std::nullopt : std::optional(position + positions - 4);
  }
};

/// The links of a mechanism at one instant. Spatial velocities are (v, w): of the point that moves
/// with the link and is at the reference point now, and angular. World axes.
struct MechanismInstant {
  using Spatial = Eigen::Matrix<double, 6, 1>;

  Eigen::Vector3d reference = Eigen::Vector3d::Zero();  ///< [m]
  std::vector<Pose> X_WL;                               ///< Of each link.
  std::vector<Spatial> velocity;                        ///< Of each link.
  std::vector<Spatial> bias;  ///< [per s^2]  Of each link: its acceleration at constant rates.
  /// (6, size)  The Jacobian of each link: velocity = J times the rates.
  std::vector<Eigen::Matrix<double, 6, Eigen::Dynamic>> J;
};

/// Energy and momentum of a mechanism.
struct MechanismMechanics {
  double kinetic_energy = 0.0;                                 ///< [J]
  double potential_energy = 0.0;                               ///< [J]  0 at the world's origin.
  double mass = 0.0;                                           ///< [kg]
  Eigen::Vector3d p_WC = Eigen::Vector3d::Zero();              ///< [m]  0 without mass.
  Eigen::Vector3d linear_momentum = Eigen::Vector3d::Zero();   ///< [kg m/s]
  Eigen::Vector3d angular_momentum = Eigen::Vector3d::Zero();  ///< [kg m^2/s]  About the origin.
};

/// Forces along the coordinates of a mechanism besides gravity, and coordinates that are driven.
struct MechanismDrive {
  Eigen::VectorXd forces = {};  ///< (size)  [N m or N]  Constant; empty: none.
  /// Coordinates whose velocity changes at a given rate, by whatever forces that takes.
  std::vector<Eigen::Index> driven = {};
  Eigen::VectorXd accelerations = {};  ///< (driven)  [rad/s^2 or m/s^2]  Constant.
};

/// The end of a motion under forces.
struct MechanismMotion {
  MechanismState end;
  Eigen::VectorXd impulses;  ///< (driven)  [N m s or N s]  On the driven coordinates, in all.
};

/// A tree of links under forces, M(q) dv/dt + b(q, v) = forces along the coordinates. Immutable.
///
/// The mass matrix is the sum of what each link adds, J^T I J; the bias forces are those that keep
/// all rates constant against gravity and inertia (R. Featherstone, "Rigid Body Dynamics
/// Algorithms", 2008, chapters 5 and 6). Joints that mimic others move along with them.
class FIRSTCONTACT_API Mechanism {
 public:
  /// Makes the mechanism of a robot.
  ///
  /// @param model      every link whose motion nothing heavier shares has its inertia
  /// @param X_WR       of the root link; where a free base starts from
  /// @param free_base  the root link is held by nothing
  /// @throws std::invalid_argument  names the link with an inertia that no body has
  Mechanism(RobotModel model, const Pose& X_WR, bool free_base);

  [[nodiscard]] const RobotModel& model() const { return model_; }
  [[nodiscard]] Eigen::Index size() const { return size_; }  ///< Number of velocities.
  [[nodiscard]] Eigen::Index position_count() const { return position_count_; }
  /// All joints that have numbers, in their order; the free base first.
  [[nodiscard]] const std::vector<MechanismJoint>& joints() const { return blocks_; }

  [[nodiscard]] bool has_free_base() const { return free_base_; }

  /// Requires that the mass matrix is definite at these positions.
  ///
  /// At others it may be singular, as where the axes of a wrist without masses between them align.
  ///
  /// @throws std::invalid_argument  names the joint that moves no mass
  void require_mass(const Eigen::VectorXd& positions) const;

  /// The state with all coordinates 0, all poses the identity, the free base where it starts from.
  [[nodiscard]] MechanismState rest() const;

  /// Positions after a displacement (size) [rad or m]: rotation vectors turn from the left.
  [[nodiscard]] Eigen::VectorXd moved(const Eigen::VectorXd& positions,
                                      const Eigen::VectorXd& displacement) const;

  /// Positions on the way between two, at constant rates; poses turn the shorter way.
  [[nodiscard]] Eigen::VectorXd between(const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                                        double share) const;

  [[nodiscard]] MechanismInstant at(const MechanismState& state) const;

  /// The mass matrix M(q), (size, size).
  [[nodiscard]] Eigen::MatrixXd mass_matrix(const MechanismInstant& instant) const;

  /// The inverse of a mass matrix (size, size). A singular one gives that of a definite one nearby.
  [[nodiscard]] static Eigen::MatrixXd inverse_mass(const Eigen::MatrixXd& mass_matrix);

  /// The forces along the coordinates that keep all rates constant, (size)  [N m or N].
  ///
  /// @param gravity  [m/s^2]
  [[nodiscard]] Eigen::VectorXd bias_forces(const MechanismInstant& instant,
                                            const Eigen::Vector3d& gravity) const;

  /// The state after a time in which gravity and inertia alone act.
  ///
  /// Method: Runge and Kutta's rule of fourth order in sub-steps. For poses it integrates
  /// the rotation vector from where the sub-step began (H. Munthe-Kaas, "High order Runge-Kutta
  /// methods on manifolds", Applied Numerical Mathematics 29 (1999)).
  ///
  /// @param dt  [s]
  [[nodiscard]] MechanismState after_free_motion(const MechanismState& state,
                                                 const Eigen::Vector3d& gravity, double dt) const;

  /// As after_free_motion(), under other forces too.
  [[nodiscard]] MechanismMotion after_driven_motion(const MechanismState& state,
                                                    const Eigen::Vector3d& gravity,
                                                    const MechanismDrive& drive, double dt) const;

  /// The velocities at other positions, nearby, with which every link goes on as it does in the
  /// state.
  ///
  /// They keep the kinetic energy. As nearly as joints let them, they keep each link's momentum and
  /// angular momentum about its centre (least squares in the kinetic metric; to first order the
  /// parallel transport of that metric). Where a link carries one that is far out or turns against
  /// it, the same numbers at other positions are another motion.
  [[nodiscard]] Eigen::VectorXd carried(const MechanismState& state,
                                        const Eigen::VectorXd& positions) const;

  /// The velocities with which a free base gives the mechanism these momenta; joints have those of
  /// the state.
  ///
  /// The change moves all links as one rigid body.
  ///
  /// @param linear   [kg m/s]
  /// @param angular  [kg m^2/s]  About the origin.
  [[nodiscard]] Eigen::VectorXd with_momenta(const MechanismState& state,
                                             const Eigen::Vector3d& linear,
                                             const Eigen::Vector3d& angular) const;

  [[nodiscard]] MechanismMechanics mechanics(const MechanismState& state,
                                             const Eigen::Vector3d& gravity) const;

 private:
  /// The part of a joint in the motion: numbers of its own, or a multiple of another's.
  struct Part {
    std::size_t block = kFixed;
    double multiplier = 1.0;
    double offset = 0.0;
  };
  static constexpr std::size_t kFixed = static_cast<std::size_t>(-1);

  void lay_out(bool free_base);
  void require_inertias() const;
  class Flight;

  [[nodiscard]] Eigen::VectorXd rates(const Eigen::VectorXd& displacement,
                                      const Eigen::VectorXd& velocities) const;
  void place(const MechanismState& state, std::size_t link, MechanismInstant& instant) const;

  RobotModel model_;
  Pose X_WR_;
  std::vector<MechanismJoint> blocks_;
  std::vector<Part> parts_;                          // Of each joint.
  std::vector<std::size_t> order_;                   // Links, parents first.
  std::vector<std::vector<Eigen::Index>> moved_by_;  // Of each link: the velocities that move it.
  Eigen::Index size_ = 0;
  Eigen::Index position_count_ = 0;
  bool free_base_;
};

}  // namespace firstcontact
