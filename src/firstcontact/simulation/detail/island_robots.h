/// @file
/// The robots of an island: what their joints add to its contact problems, and where links go.

#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/robot/mechanism.h>
#include <firstcontact/simulation/detail/move.h>

namespace firstcontact::detail {

struct SimBody;
struct SimRobot;
struct StepStart;
struct SimulationModel;

/// A part of a step of a robot without impacts.
struct RobotTrackPiece {
  double to = 0.0;  ///< [s]  Since the step began.
  MechanismState begin;
  MechanismState end;
  Eigen::VectorXd impact;  ///< [N m s or N s]  Of motors, on each coordinate, at its begin,
  Eigen::VectorXd motors;  ///< and over it.
};

/// How a robot moves over a step, or over as much of it as could be proven free.
struct RobotTrack {
  std::size_t robot = 0;  ///< Of the world.
  std::vector<RobotTrackPiece> pieces = {};
};

/// Where a plan leads a robot, and how fast it is there.
struct RobotPlan {
  MechanismState end;
  Eigen::VectorXd motors = {};  ///< [N m s or N s]  On each coordinate; empty where none acts.
};

/// Robots whose links are members of one island.
///
/// Within a plan every piece of a link moves at constant rates from where it is to where the
/// joints have it at the plan's end. Between the ends joints come apart by the sagitta of an arc, a
/// quantity of second order in the plan's time. Where a plan is cut short, pieces stay off by as
/// much, and the next plan makes up for it.
class IslandRobots {
 public:
  /// @param members  of the island; all pieces of a robot's links, or none
  IslandRobots(const SimulationModel& model, const StepStart& start,
               const std::vector<std::size_t>& members);

  [[nodiscard]] bool empty() const { return robots_.empty(); }
  [[nodiscard]] bool has_motors() const;

  /// [s]  The longest span of a plan: in it no link turns by more than 0.1 rad at its speed of
  /// now.
  ///
  /// So mass matrices and Jacobians change little in it. Infinite where nothing turns.
  [[nodiscard]] double longest_span() const;

  /// How a member that is a piece of a link takes part in a contact problem; velocities are those
  /// of its robot now.
  [[nodiscard]] ContactBody body(std::size_t member) const;

  /// Where the joints have a member, and how it moves.
  [[nodiscard]] RigidState state(std::size_t member) const;

  /// [m, rad]  From where a piece is to where its joints have it now.
  [[nodiscard]] Move drift(std::size_t member, const Pose& X_WB) const;

  /// Adds the mechanisms as they move now.
  void add_mechanisms(ContactProblem& problem) const;

  /// Free motion over a span: velocities of mechanisms and of their links, and what drives joints.
  /// They hold where it ends, and so do masses and Jacobians: coordinates of a link that a turning
  /// one carries change with the turn, so that at its begin the same numbers say something else.
  ///
  /// @param from  [s]  since the simulation began
  /// @returns  where each robot would be, by inertia alone where anything drives a joint
  [[nodiscard]] std::vector<RobotPlan> fly(ContactProblem& problem, double from, double span) const;

  void add_drives_at_impact(ContactProblem& problem) const;

  /// Adds what keeps displacements in place of velocities within the limits of joints.
  void add_stops(ContactProblem& problem) const;

  /// Where each robot gets. As of bodies the mean of the velocities at both ends leads it, on top
  /// of what free motion did. Where anything drives a joint, those at the end do, on top of what
  /// inertia alone did. Velocities are carried from where free motion leads to there.
  ///
  /// @param by_end  of the problem's bodies: velocities at the end lead them
  [[nodiscard]] std::vector<RobotPlan> plan(const ContactProblem& problem,
                                            const ContactSolution& solution,
                                            const std::vector<RobotPlan>& free,
                                            const std::vector<bool>& by_end, double span) const;

  /// Adds displacements of coordinates, in order of robots.
  void displace(const std::vector<Eigen::VectorXd>& by, std::vector<RobotPlan>& plans) const;

  /// Sets the moves that lead the members that are pieces of links to where a plan has them.
  void set_moves(const std::vector<RobotPlan>& plans, const std::vector<RigidState>& states,
                 double span, std::vector<Move>& moves) const;

  /// [-]  How far plans may be followed before a joint leaves its limits.
  [[nodiscard]] double share_within_limits(const std::vector<RobotPlan>& plans) const;

  /// Goes a share of the way to a plan. `to` is the time since the step began.
  void move_to(const std::vector<RobotPlan>& plans, double share, double to);

  /// Takes the velocities of the impact now, and what motors did to them.
  void take_velocities(const ContactSolution& solution);

  [[nodiscard]] std::vector<RobotTrack> take_tracks();

 private:
  using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;
  struct Piece {
    std::size_t member;
    const SimBody* body;
  };
  struct PiecePlace {
    Pose X_WB = {};   // As the joints have it.
    Jacobian J = {};  // Of (v_WC, w_WB).
  };
  /// A robot in one state.
  struct View {
    std::vector<PiecePlace> pieces = {};
    Eigen::MatrixXd inverse_mass = {};
    Eigen::VectorXd gravity_forces = {};
  };
  struct Robot {
    const SimRobot* robot;
    MechanismState state;
    std::vector<Piece> pieces = {};
    View now = {};
    Eigen::VectorXd impact = {};  // Of motors, since the last piece of the track.
    RobotTrack track = {};
  };

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  [[nodiscard]] View view_of(const Robot& robot, const MechanismState& state) const;
  [[nodiscard]] Eigen::VectorXd impulses_of(std::size_t robot, std::size_t motors,
                                            const ContactProblem& problem,
                                            const ContactSolution& solution) const;
  [[nodiscard]] const PiecePlace& piece_of(std::size_t member) const;

  const SimulationModel& model_;
  std::vector<Robot> robots_;
  std::vector<std::array<std::size_t, 2>> place_;  // Of each member: robot and piece.
};

}  // namespace firstcontact::detail
