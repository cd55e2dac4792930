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

/// A point at which two bodies touch. In the problem its velocity u is that of B's point relative
/// to A's, and its impulse r acts on B; both in the contact's frame: along the normal, then along
/// two tangents.
struct ContactPoint {
  std::array<std::size_t, 2> bodies = {};               ///< A, then B; not equal.
  Eigen::Vector3d arm_A = Eigen::Vector3d::Zero();      ///< [m]  p_CaP_W, from A's centre of mass.
  Eigen::Vector3d arm_B = Eigen::Vector3d::Zero();      ///< [m]  p_CbP_W
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();  ///< [-]  Rows: n_AB_W, two tangents; a
                                                        ///< rotation.
  double friction = 0.0;                                ///< [-]  Coulomb's coefficient; >= 0.
  /// [m/s]  The least normal velocity that a solution may have at the contact.
  ///
  /// It is 0 at a resting contact, that of Newton's law at an impact, and negative where the bodies
  /// still have a way to go.
  double least_normal_velocity = 0.0;
  /// [m/s]  The tangential velocity at which the contact sticks, along the two tangents.
  ///
  /// It is 0 between surfaces that move with their bodies. Friction acts on u_t minus it.
  Eigen::Vector2d sticking_velocity = Eigen::Vector2d::Zero();
  Eigen::Vector3d guess = Eigen::Vector3d::Zero();  ///< [N s]  To start from.
};

/// The role of a body as a link, which the coordinates of a mechanism move: (v, w) = J times their
/// rates.
struct MechanismLink {
  std::size_t mechanism = 0;
  Eigen::Matrix<double, 6, Eigen::Dynamic> J;
};

/// A body of a contact problem.
struct ContactBody {
  InverseInertia inverse_inertia = {};          ///< Zero of a body that nothing moves. Of a link
                                                ///< without meaning.
  Eigen::Vector3d v = Eigen::Vector3d::Zero();  ///< [m/s]    Of its centre of mass. Of a link not
                                                ///< read.
  Eigen::Vector3d w = Eigen::Vector3d::Zero();  ///< [rad/s]
  std::optional<MechanismLink> link = {};
};

/// Links that move together, by n coordinates [rad or m].
struct ContactMechanism {
  Eigen::MatrixXd inverse_mass;  ///< (n, n)  Of the kinetic metric; symmetric, definite.
  Eigen::VectorXd velocity;      ///< (n)  [rad/s or m/s]
};

/// A motor, a brake or a stop that acts on one coordinate of a mechanism.
///
/// Its impulse r makes the coordinate's velocity u meet u + compliance r = target, as far as its
/// bounds let it: beyond the target r is the least, short of it the greatest.
struct JointDrive {
  std::size_t mechanism = 0;
  std::size_t coordinate = 0;
  double target = 0.0;      ///< [rad/s or m/s]
  double compliance = 0.0;  ///< [rad/s for N m s, or m/s for N s]  >= 0
  double least = -std::numeric_limits<double>::infinity();    ///< [N m s or N s]
  double greatest = std::numeric_limits<double>::infinity();  ///< [N m s or N s]  >= least
  double guess = 0.0;                                         ///< [N m s or N s]  To start from.
};

/// The part of one body in a tie: its velocity (v, w) adds `row` times itself to that of the tie.
struct TieSide {
  std::size_t body = 0;
  Eigen::Matrix<double, 6, 1> row = Eigen::Matrix<double, 6, 1>::Zero();
};

/// A spring, a cable or one direction of a joint between two bodies.
///
/// Its velocity u is the sum of what its sides add, and its impulse r changes the momenta of a side
/// by row r. The law is that of JointDrive: u + compliance r = target, as far as the bounds of r
/// let it. A body that is held by the world has one side alone.
struct TieRow {
  std::vector<TieSide> sides = {};  ///< One or two, of different bodies.
  double target = 0.0;              ///< [m/s or rad/s]
  double compliance = 0.0;          ///< [m/s for N s, or rad/s for N m s]  >= 0
  double least = -std::numeric_limits<double>::infinity();    ///< [N s or N m s]
  double greatest = std::numeric_limits<double>::infinity();  ///< [N s or N m s]  >= least
  double guess = 0.0;                                         ///< [N s or N m s]  To start from.
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
  automatic,  ///< The cheaper one; motion where contact does not get there.
  contact,    ///< Unknown: the impulses. Block Gauss-Seidel, contact by contact, as the step
              ///< of nonsmooth conjugate gradients.
  motion,     ///< Unknown: the velocities. Newton's method on an augmented Lagrangian.
};

struct ProjectionOptions {
  double tolerance = 1e-9;  ///< [m/s]  Of the residual; > 0.
  ProjectionSpace space = ProjectionSpace::automatic;
  double of_hits = 0.0;  ///< [-]  Part of the residual of the guesses that may be left where that
                         ///< is beyond `hit`; >= 0.
  double hit = 0.0;      ///< [m/s]  >= 0.
  double enough = 0.0;   ///< [m/s]  A residual that sweeps may leave where an interior point would
                         ///< come next; >= 0. Half of it where ten sweeps less than halve the
                         ///< changes (and these are more than ten tolerances), or where the guesses
                         ///< leave more than ten times it.
  int sweeps = 200;      ///< At most, of all contacts, by Gauss-Seidel; > 0.
  int rounds = 12;       ///< At most, of the interior point; > 0.
};

struct ContactSolution {
  std::vector<ContactBody> bodies;  ///< With the velocities that contacts allow.
  std::vector<Eigen::VectorXd> mechanisms =
      {};                                      ///< [rad/s or m/s]  Likewise, of their coordinates.
  std::vector<Eigen::Vector3d> impulses = {};  ///< [N s]  r of each contact, in its frame.
  std::vector<double> drives = {};             ///< [N m s or N s]  r of each drive.
  std::vector<double> ties = {};               ///< [N s or N m s]  r of each tie.
  double residual = 0.0;  ///< [m/s]  See contact_residual(); above `allowed`: not converged.
  double allowed = 0.0;   ///< [m/s]  What the options let a residual be, `of_hits` and `enough`
                          ///< included.
  ProjectionSpace space = ProjectionSpace::contact;  ///< Where it was solved.
  int iterations = 0;                                ///< Sweeps and factorisations.
};

/// Projects velocities onto those that contacts and friction allow, in the kinetic metric.
///
/// The result is the velocity v with u_n >= least_normal_velocity that is nearest to the free one:
/// |v - v_free| is least in the kinetic metric M (Gauss' principle of least constraint; Redon,
/// Kheddar, Coquillart, "Gauss' least constraints principle and rigid body simulations", ICRA
/// 2002). Its multipliers are the normal impulses: M (v - v_free) = J^T r, 0 <= r_n, complementary
/// to u_n - least_normal_velocity >= 0. With friction an impulse lies in Coulomb's cone |r_t| <= mu
/// r_n, the round one. Where it is on the side of the cone, u_t points against r_t; where u_t is
/// not 0, it is on the side. Here u_t is the tangential velocity minus `sticking_velocity`. All
/// contacts count at once: impacts are simultaneous.
///
/// Drives and ties are projected along with the contacts: their impulses lie between their bounds,
/// and the energy of their compliances adds to what is least.
///
/// The velocities are unique without friction, the impulses only without redundant contacts.
///
/// Projected Gauss-Seidel: each contact is solved in turn, with all others held, until none
/// changes. After each sweep there and back the method goes on in the direction of the sweeps
/// before (M. Silcowitz, S. Niebe, K. Erleben, "A nonsmooth nonlinear conjugate gradient method for
/// interactive contact force problems", The Visual Computer 26 (2010)): r in K, u + mu |u_t| n in
/// its dual, orthogonal (De Saxce, Feng, "The bipotential method", Mathematical and Computer
/// Modelling 28 (1998)).
///
/// Augmented Lagrangian: the velocities minimise
///   1/2 |v - v_free|_M^2 + sum |proj_K(r_i - rho_i (u_i + mu |u_t| n))|^2 / (2 rho_i)
/// whose minimum gives the next r (method of multipliers). There is one equation for each degree of
/// freedom, however many contacts there are, and no loss where masses differ greatly. Where it
/// converges slowly |u_t| is an unknown, too (Alart, Curnier, "A mixed formulation for frictional
/// contact problems prone to Newton like solution methods", Computer Methods in Applied Mechanics
/// and Engineering 92 (1991)). Sweeps lead to other places to begin at. It ends early where the
/// impulses show that no velocities keep all contacts open (Farkas' lemma).
///
/// Choice: from 120 contacts on (300 where there are two for each velocity), without drives and
/// ties, an interior point comes before the augmented Lagrangian, in rounds. Each round solves the
/// convex problem in which |u_t| is what the round before left, and sweeps all contacts. Where a
/// part is enough, the automatic choice takes what its rounds leave. Where there are 300 contacts
/// and two for each velocity, it first solves a few alone, with all drives. The contacts that the
/// answer closes fastest join them, until none is left or these are no longer few.
///
/// @throws std::invalid_argument if an option is outside its range.
[[nodiscard]] FIRSTCONTACT_API ContactSolution
project_on_contacts(const ContactProblem& problem, const ProjectionOptions& options = {});

/// [m/s]  Computes how far a solution is from the laws of project_on_contacts().
///
/// It is the greatest over contacts of |r - proj_K(r - rho (u' + mu |u_t| n))| / rho.
/// There rho is the inverse of the contact's greatest response to an impulse (the largest of the
/// diagonal), and u' = u - (least_normal_velocity, sticking_velocity). Drives and ties count in the
/// same way, with the interval of their bounds as K. It is 0 exactly where all laws hold.
[[nodiscard]] FIRSTCONTACT_API double contact_residual(const ContactProblem& problem,
                                                       const ContactSolution& solution);

}  // namespace firstcontact
