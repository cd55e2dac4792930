/// @file
/// Gauss' principle for bodies in contact: the velocities that contacts and friction allow.

#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// A point at which two bodies touch.
///
/// Its velocity u is that of B's point relative to A's. Its impulse r acts on B. Both are in the
/// contact's frame: along the normal, then along two tangents.
struct ContactPoint {
  std::array<std::size_t, 2> bodies = {};               ///< A, then B; not equal.
  Eigen::Vector3d arm_A = Eigen::Vector3d::Zero();      ///< [m]  p_CaP_W, from A's centre of mass.
  Eigen::Vector3d arm_B = Eigen::Vector3d::Zero();      ///< [m]  p_CbP_W, from B's centre of mass.
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();  ///< [-]  Rows: n_AB_W, two tangents; a
                                                        ///< rotation.
  double friction = 0.0;                                ///< [-]  Coulomb's coefficient; >= 0.
  /// [m/s]  The least normal velocity that a solution may have at the contact.
  /// It is 0 at a resting contact, and that of Newton's law at an impact. It is negative where a
  /// gap is left between the bodies.
  double least_normal_velocity = 0.0;
  /// [m/s]  The tangential velocity at which the contact sticks, along the two tangents.
  ///
  /// It is 0 between surfaces that move with their bodies. Friction acts on u_t minus it.
  Eigen::Vector2d sticking_velocity = Eigen::Vector2d::Zero();
  Eigen::Vector3d guess = Eigen::Vector3d::Zero();  ///< [N s]  The impulse to start from.
};

/// The role of a body as a link of a mechanism: (v, w) = J times the rates of the coordinates.
struct MechanismLink {
  std::size_t mechanism = 0;
  Eigen::Matrix<double, 6, Eigen::Dynamic> J;
};

/// A body of a contact problem.
struct ContactBody {
  /// Zero for a body that nothing moves. Not read for a link.
  InverseInertia inverse_inertia = {};
  /// [m/s]  Velocity of the centre of mass. Not read for a link.
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  Eigen::Vector3d w = Eigen::Vector3d::Zero();  ///< [rad/s]  Angular velocity. Not read for a link.
  std::optional<MechanismLink> link = {};
};

/// Links that move together, by n coordinates [rad or m].
struct ContactMechanism {
  Eigen::MatrixXd inverse_mass;  ///< (n, n)  Inverse of the kinetic metric; symmetric, definite.
  Eigen::VectorXd velocity;      ///< (n)  [rad/s or m/s]  Rates of the coordinates.
};

/// A motor, a brake or a stop that acts on one coordinate of a mechanism.
///
/// Its impulse r makes the coordinate's velocity u meet u + compliance r = target, as far as its
/// bounds permit. Where u stays beyond the target, r is `least`; where u stays short of it,
/// `greatest`.
struct JointDrive {
  std::size_t mechanism = 0;
  std::size_t coordinate = 0;
  double target = 0.0;      ///< [rad/s or m/s]  Velocity that the drive wants.
  double compliance = 0.0;  ///< [rad/s for N m s, or m/s for N s]  >= 0
  double least = -std::numeric_limits<double>::infinity();  ///< [N m s or N s]  Lower bound of r.
  /// [N m s or N s]  Upper bound of r; >= least
  double greatest = std::numeric_limits<double>::infinity();
  double guess = 0.0;  ///< [N m s or N s]  The impulse to start from.
};

/// The share of one body in a tie: `row` times its velocity (v, w) is added to that of the tie.
struct TieSide {
  std::size_t body = 0;
  Eigen::Matrix<double, 6, 1> row = Eigen::Matrix<double, 6, 1>::Zero();
};

/// A spring, a cable or one direction of a joint between two bodies.
///
/// Its velocity u is the sum of the shares of its sides. Its impulse r changes the momenta of a
/// side by row r. The law is that of JointDrive: u + compliance r = target, as far as the bounds of
/// r permit. A body that is held by the world has one side alone.
struct TieRow {
  std::vector<TieSide> sides = {};  ///< One or two, of different bodies.
  double target = 0.0;              ///< [m/s or rad/s]  Velocity that the tie wants.
  double compliance = 0.0;          ///< [m/s for N s, or rad/s for N m s]  >= 0
  double least = -std::numeric_limits<double>::infinity();  ///< [N s or N m s]  Lower bound of r.
  /// [N s or N m s]  Upper bound of r; >= least
  double greatest = std::numeric_limits<double>::infinity();
  double guess = 0.0;  ///< [N s or N m s]  The impulse to start from.
};

/// Bodies with the velocities that they would have without contacts, and the contacts.
struct ContactProblem {
  std::vector<ContactBody> bodies = {};
  std::vector<ContactPoint> contacts = {};
  std::vector<ContactMechanism> mechanisms = {};
  std::vector<JointDrive> drives = {};
  std::vector<TieRow> ties = {};
};

/// The space in which the problem is solved; the answer is the same.
enum class ProjectionSpace {
  automatic,  ///< The cheaper one; motion where contact does not converge.
  /// The impulses are unknown. Projected Gauss-Seidel, contact by contact, is the step of nonsmooth
  /// conjugate gradients.
  contact,
  motion,  ///< The velocities are unknown. Newton's method on an augmented Lagrangian.
};

/// The options of project_on_contacts().
struct ProjectionOptions {
  double tolerance = 1e-9;  ///< [m/s]  Greatest residual of a solution; > 0.
  ProjectionSpace space = ProjectionSpace::automatic;
  /// [-]  Share of the residual of the guesses that may be left, where that residual is above
  /// `hit`; >= 0.
  double of_hits = 0.0;
  double hit = 0.0;  ///< [m/s]  Residual of the guesses above which `of_hits` holds; >= 0.
  /// [m/s]  A residual that sweeps may leave where an interior point would come next; >= 0.  Half
  /// of it where the guesses leave more than ten times it. Half of it too where ten sweeps less
  /// than halve the changes, and the changes are more than ten tolerances.
  double enough = 0.0;
  int sweeps = 200;  ///< Most sweeps of all contacts by Gauss-Seidel; > 0.
  int rounds = 12;   ///< Most rounds of the interior point; > 0.
};

/// The answer of project_on_contacts().
struct ContactSolution {
  std::vector<ContactBody> bodies;  ///< The bodies with the velocities that contacts allow.
  /// [rad/s or m/s]  The velocities of mechanisms that contacts allow.
  std::vector<Eigen::VectorXd> mechanisms = {};
  /// [N s]  The impulse r of each contact, in its frame.
  std::vector<Eigen::Vector3d> impulses = {};
  std::vector<double> drives = {};  ///< [N m s or N s]  The impulse r of each drive.
  std::vector<double> ties = {};    ///< [N s or N m s]  The impulse r of each tie.
  double residual = 0.0;  ///< [m/s]  See contact_residual(); above `allowed`: not converged.
  /// [m/s]  The residual that the options permit, `of_hits` and `enough` included.
  double allowed = 0.0;
  ProjectionSpace space = ProjectionSpace::contact;  ///< The space in which it was solved.
  int iterations = 0;                                ///< Number of sweeps and factorisations.
};

/// Projects velocities onto those that contacts and friction allow, in the kinetic metric.
///
/// The result is the velocity v with u_n >= least_normal_velocity that is nearest to the free one:
/// |v - v_free| is least in the kinetic metric M (Gauss' principle of least constraint; Redon,
/// Kheddar, Coquillart, "Gauss' least constraints principle and rigid body simulations", ICRA
/// 2002). Its multipliers are the normal impulses: M (v - v_free) = J^T r, 0 <= r_n, complementary
/// to u_n - least_normal_velocity >= 0.
///
/// With friction an impulse lies in Coulomb's round cone |r_t| <= mu r_n. Where r is on the side of
/// the cone, u_t points against r_t. Where u_t is not 0, r is on the side. Here u_t is the
/// tangential velocity minus `sticking_velocity`. All contacts count at once: impacts are
/// simultaneous.
///
/// Drives and ties are projected along with the contacts. Their impulses lie between their bounds,
/// and the energy of their compliances adds to the minimised quantity.
///
/// Without friction the velocities are unique. The impulses are unique only without redundant
/// contacts. Where the laws leave a choice to few contacts, the automatic answer has impulses of
/// least norm. So a symmetric problem has a symmetric answer. Few means a sum of at most twelve: a
/// contact that slides counts one, a contact that sticks three. Friction that sticks goes with the
/// normal impulses where least norm alone would leave the cone. Guesses that solve the problem stay
/// as they are.
///
/// Projected Gauss-Seidel: each contact is solved in turn, with all others held, until none
/// changes. After each sweep there and back the method goes on in the direction of the sweeps
/// before (M. Silcowitz, S. Niebe, K. Erleben, "A nonsmooth nonlinear conjugate gradient method for
/// interactive contact force problems", The Visual Computer 26 (2010)). The law of a contact: r is
/// in K, u + mu |u_t| n in its dual, orthogonal to r (De Saxce, Feng, "The bipotential method",
/// Mathematical and Computer Modelling 28 (1998)).
///
/// Augmented Lagrangian: the velocities minimise
///   1/2 |v - v_free|_M^2 + sum |proj_K(r_i - rho_i (u_i + mu |u_t| n))|^2 / (2 rho_i)
/// whose minimum gives the next r (method of multipliers). There is one equation for each degree of
/// freedom, for any number of contacts. Great ratios of masses cost no speed. Where it converges
/// slowly |u_t| is an unknown, too (Alart, Curnier, "A mixed formulation for frictional contact
/// problems prone to Newton like solution methods", Computer Methods in Applied Mechanics and
/// Engineering 92 (1991)). Sweeps give other points to begin at. It ends early where the impulses
/// prove that no velocities keep all contacts open (Farkas' lemma).
///
/// Choice: from 120 contacts on, an interior point comes before the augmented Lagrangian, in
/// rounds. Where there are two contacts for each velocity, it does so from 300 on. It takes no
/// drives and ties. Each round solves the convex problem in which |u_t| is fixed at the value of
/// the round before, and then sweeps all contacts. Where `enough` is > 0, the automatic choice
/// takes the answer that these rounds leave. Where there are 300 contacts and two for each
/// velocity, it first solves a few alone, with all drives. The contacts that the answer closes
/// fastest join them, until none is left or they are no longer few.
///
/// @throws std::invalid_argument if an option is outside its range.
[[nodiscard]] FIRSTCONTACT_API ContactSolution
project_on_contacts(const ContactProblem& problem, const ProjectionOptions& options = {});

/// [m/s]  Computes by how much a solution violates the laws of project_on_contacts().
///
/// It is the greatest over contacts of |r - proj_K(r - rho (u' + mu |u_t| n))| / rho.
/// There rho is the inverse of the contact's greatest response to an impulse (the largest of the
/// diagonal), and u' = u - (least_normal_velocity, sticking_velocity). Drives and ties count in the
/// same way, with the interval of their bounds as K. It is 0 exactly where all laws hold.
[[nodiscard]] FIRSTCONTACT_API double contact_residual(const ContactProblem& problem,
                                                       const ContactSolution& solution);

}  // namespace firstcontact
