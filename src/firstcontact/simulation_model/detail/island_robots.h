/// @file
/// The robots of an island: what their joints add to its contact problems, and where links go.

#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/mechanism/mechanism.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/simulation_model/detail/joint_law.h>
#include <firstcontact/simulation_model/detail/move.h>

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

/// The motion of a robot over a span without contacts, from which its contact problem starts.
struct RobotFlight {
  using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;

  bool is_known = false;
  /// Whether velocities at the end lead the robot, by Euler's implicit rule. Then inertia alone
  /// acts in the flight. Else all forces do, with those of drives as they were predicted.
  bool by_end = false;
  MechanismState end = {};
  Eigen::VectorXd velocities = {};      ///< Without contacts and the changes of drives.
  Eigen::MatrixXd inverse_mass = {};    ///< At the end, as
  std::vector<Jacobian> J = {};         ///< of each link body, and
  std::vector<Pose> X_WB = {};          ///< where it is.
  std::vector<JointDrive> drives = {};  ///< Of the changes of impulses.
  std::vector<double> predicted = {};   ///< [N m s or N s]  Impulses in the flight, of each drive.
  PositionRule rule = {};
  /// What impulses of contacts in the flight did to the velocities at its end; empty: there are
  /// none. A contact problem finds all of these impulses again, and starts without them.
  Eigen::VectorXd of_contacts = {};
};

/// Impulses on a link body, about its centre of mass.
struct LinkImpulse {
  std::size_t member = 0;                             ///< Of the island.
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< [N s]
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< [N m s]
};

/// Impulses of what is not of a robot, on all of its links.
struct OuterImpulse {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< [N s]
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< [N m s]  About the origin.
  bool acts = false;                                  ///< Any does.
  bool is_known = true;  ///< Of velocities that were limited they are not.
  bool touches = false;  ///< Contacts act, with what is not of it or between its own links.
};

/// A force and a moment on a link body, constant over a span.
struct LinkLoad {
  std::size_t member = 0;                            ///< Of the island.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< [N m]  About the origin of the world,
                                                     ///< where the link is halfway.
};

/// Where a plan leads a robot, and how fast it is there.
struct RobotPlan {
  MechanismState end;
  Eigen::VectorXd motors = {};  ///< [N m s or N s]  On each coordinate; empty where none acts.
};

/// Robots whose links are members of one island.
///
/// Within a plan every link body moves at constant rates from where it is to where the
/// joints have it at the plan's end. Between the ends joints come apart by the sagitta of an arc, a
/// quantity of second order in the plan's time. Where a plan is cut short, link bodies stay off by
/// as much, and the next plan makes up for it.
class IslandRobots {
 public:
  /// @param members  of the island; all link bodies of a robot, or none
  /// @param bare     robots of the island without link bodies
  IslandRobots(const SimulationModel& model, const StepStart& start,
               const std::vector<std::size_t>& members, const std::vector<std::size_t>& bare = {});

  [[nodiscard]] bool empty() const { return robots_.empty(); }
  [[nodiscard]] bool has_motors() const;
  [[nodiscard]] bool has_motors(std::size_t robot) const;

  /// [s]  The longest span of a plan: in it no link turns by more than 0.1 rad at its speed of
  /// now.
  ///
  /// So mass matrices and Jacobians change little in it. Infinite where nothing turns.
  [[nodiscard]] double longest_span() const;

  /// How a link body takes part in a contact problem; velocities are those
  /// of its robot now.
  [[nodiscard]] ContactBody body(std::size_t member) const;

  /// Where the joints have a member, and how it moves.
  [[nodiscard]] RigidState state(std::size_t member) const;

  /// Where the joints have a member a share of plans ahead.
  [[nodiscard]] Pose pose_ahead(std::size_t member, const std::vector<RobotPlan>& plans,
                                double share) const;

  /// [m, rad]  From where a link body is to where its joints have it now.
  [[nodiscard]] Move drift(std::size_t member, const Pose& X_WB) const;

  /// Adds the mechanisms as they move now.
  void add_mechanisms(ContactProblem& problem) const;

  [[nodiscard]] std::size_t size() const { return robots_.size(); }

  /// [m]  Where the free base of a robot is; nothing of one that is held.
  [[nodiscard]] std::optional<Eigen::Vector3d> free_base(std::size_t robot) const;

  /// The robot of a link body, here.
  [[nodiscard]] std::size_t robot_of(std::size_t member) const { return place_[member][0]; }

  /// The number of a link body among those of its robot, as flights have them.
  [[nodiscard]] std::size_t link_of(std::size_t member) const { return place_[member][1]; }

  /// Finds the flights over a span that are not known, or not of the kind that is wanted.
  ///
  /// @param by_end  of each robot: what drives its joints makes velocities at the end lead it
  /// @param loads   (size)  [N m or N]  constant forces along its coordinates; empty: none
  void fly(const PlanSpan& span, const std::vector<bool>& by_end,
           const std::vector<Eigen::VectorXd>& loads, std::vector<RobotFlight>& flights) const;

  /// [N m or N]  The forces along the coordinates of a robot that loads on its links are, halfway
  /// through a flight; where that is not known, halfway on the way of now.
  [[nodiscard]] Eigen::VectorXd forces_of(std::size_t robot, const std::vector<LinkLoad>& loads,
                                          const RobotFlight& flight, double span) const;

  /// Impulses on links of a robot as forces over a span, where a flight is halfway.
  [[nodiscard]] std::vector<LinkLoad> loads_of(std::size_t robot,
                                               const std::vector<LinkImpulse>& impulses,
                                               const RobotFlight& flight, double span) const;

  /// [rad/s or m/s]  What impulses on links of a robot do to its velocities where a flight ends.
  [[nodiscard]] Eigen::VectorXd change_by(std::size_t robot,
                                          const std::vector<LinkImpulse>& impulses,
                                          const RobotFlight& flight) const;

  /// [rad or m]  How far the changes of velocities in a flight lead a coordinate, at most.
  [[nodiscard]] double change_of_way(std::size_t robot, const RobotFlight& flight,
                                     double span) const {
    const Eigen::VectorXd change = flight.end.velocities - robots_[robot].state.velocities;
    return 0.5 * span * change.cwiseAbs().maxCoeff();
  }

  /// Sets velocities of mechanisms and of their links, and what drives joints.
  ///
  /// They hold where flights end, and so do masses and Jacobians: coordinates of a link that a
  /// turning one carries change with the turn, so that at its begin the same numbers say something
  /// else.
  void set(const std::vector<RobotFlight>& flights, ContactProblem& problem) const;

  /// Which robots velocities at the end have to lead: those of which contacts or limits allow no
  /// others, and those that a motor would lead elsewhere than contacts know.
  [[nodiscard]] std::vector<bool> led_by_end(const ContactProblem& problem,
                                             const ContactSolution& solution,
                                             const std::vector<RobotFlight>& flights,
                                             const std::vector<bool>& by_end,
                                             const PlanSpan& span) const;

  void add_drives_at_impact(ContactProblem& problem) const;

  /// Adds what keeps displacements in place of velocities within the limits of joints.
  void add_stops(ContactProblem& problem) const;

  /// Where each robot gets. As of bodies the mean of the velocities at both ends leads it, on top
  /// of what the flight did, and motors that reach their targets are there. In flights by the end,
  /// and where `by_end` says so of a robot that nothing drives, velocities at the end lead.
  /// Velocities are carried from where the flight leads to there.
  ///
  /// @param by_end  of the problem's bodies: velocities at the end lead them
  [[nodiscard]] std::vector<RobotPlan> plan(const ContactProblem& problem,
                                            const ContactSolution& solution,
                                            const std::vector<RobotFlight>& flights,
                                            const std::vector<bool>& by_end,
                                            const std::vector<OuterImpulse>& outer,
                                            const PlanSpan& span) const;

  /// Gives robots with a free base the momenta that gravity and impulses from outside make of
  /// theirs. Where none of these acts, their centres of mass get where such momenta lead.
  ///
  /// @param outer  of each robot
  void keep_momenta(const std::vector<OuterImpulse>& outer, double span,
                    std::vector<RobotPlan>& plans) const;

  /// Adds displacements of coordinates, in order of robots.
  void displace(const std::vector<Eigen::VectorXd>& by, std::vector<RobotPlan>& plans) const;

  /// Sets the moves that lead the link bodies to where a plan has them.
  ///
  /// @param made_up  [-]  the share of drift() that they make up for
  void set_moves(const std::vector<RobotPlan>& plans, const std::vector<RigidState>& states,
                 double span, double made_up, std::vector<Move>& moves) const;

  /// [-]  How far plans may be followed before a joint leaves its limits.
  [[nodiscard]] double share_within_limits(const std::vector<RobotPlan>& plans) const;

  /// Whether no joint takes or gives energy, now and where plans end.
  [[nodiscard]] bool are_passive(const std::vector<RobotPlan>& plans) const;

  /// The energy and the momenta of a robot now, or in another state.
  [[nodiscard]] MechanismMechanics mechanics(std::size_t robot) const;
  [[nodiscard]] MechanismMechanics mechanics(std::size_t robot, const MechanismState& state) const;

  /// Goes a share of the way to a plan. `to` is the time since the step began.
  void move_to(const std::vector<RobotPlan>& plans, double share, double span, double to);

  /// [kg m^2]  Of a floating robot about its centre of mass, as one body.
  [[nodiscard]] Eigen::Matrix3d inertia(std::size_t robot) const;

  /// Lets a floating robot move faster as one body, from where it moved to: by v [m/s] at a point
  /// [m] about which it turns faster by w [rad/s].
  void move_faster(std::size_t robot, const Eigen::Vector3d& v, const Eigen::Vector3d& w,
                   const Eigen::Vector3d& point);

  /// Takes the velocities of the impact now, and what motors did to them.
  ///
  /// @param outer  of each robot
  void take_velocities(const ContactSolution& solution, const std::vector<OuterImpulse>& outer);

  [[nodiscard]] std::vector<RobotTrack> take_tracks();

 private:
  using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;
  struct LinkMember {
    std::size_t member;
    const SimBody* body;
  };
  struct LinkPlace {
    Pose X_WB = {};   // As the joints have it.
    Jacobian J = {};  // Of (v_WC, w_WB).
  };
  /// A robot in one state.
  struct View {
    std::vector<LinkPlace> links = {};
    std::vector<Eigen::Matrix3Xd> turns = {};  // Of each link, where there are no link bodies.
    Eigen::MatrixXd inverse_mass = {};
    Eigen::VectorXd bias = {};
    Eigen::VectorXd gravity_forces = {};
  };
  struct Robot {
    const SimRobot* robot;
    MechanismState state;
    std::vector<LinkMember> links = {};
    View now = {};
    Eigen::VectorXd impact = {};  // Of motors, since the last piece of the track.
    RobotTrack track = {};
  };

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  [[nodiscard]] View view_of(const Robot& robot, const MechanismState& state) const;
  [[nodiscard]] RobotFlight flight_of(std::size_t robot, const PlanSpan& span,
                                      const Eigen::VectorXd& load) const;
  [[nodiscard]] RobotFlight flight_by_end(std::size_t robot, const PlanSpan& span,
                                          const Eigen::VectorXd& load) const;
  static void take_links(std::vector<LinkPlace>& links, RobotFlight& flight);
  [[nodiscard]] std::vector<double> drives_of(std::size_t robot, const ContactProblem& problem,
                                              const ContactSolution& solution) const;
  [[nodiscard]] Eigen::VectorXd impulses_of(std::size_t robot, std::size_t motors,
                                            const ContactProblem& problem,
                                            const ContactSolution& solution) const;
  [[nodiscard]] Eigen::VectorXd balanced(std::size_t robot, const RobotFlight& flight,
                                         const OuterImpulse& outer, const Eigen::VectorXd& v) const;
  [[nodiscard]] Eigen::VectorXd mean_positions(std::size_t robot, const RobotFlight& flight,
                                               const Eigen::VectorXd& v, double span) const;
  [[nodiscard]] Eigen::VectorXd placement(std::size_t robot, const RobotFlight& flight,
                                          const std::vector<double>& drives,
                                          const Eigen::VectorXd& v,
                                          const Eigen::VectorXd& positions,
                                          const PlanSpan& span) const;
  [[nodiscard]] bool jumps(std::size_t robot, const RobotFlight& flight,
                           const std::vector<double>& drives, const Eigen::VectorXd& v,
                           const Eigen::VectorXd& positions, const PlanSpan& span) const;
  [[nodiscard]] const LinkPlace& place_of(std::size_t member) const;

  const SimulationModel& model_;
  std::vector<Robot> robots_;
  std::vector<std::array<std::size_t, 2>> place_;  // Of each member: robot and link body.
};

/// The state at a share of the way over a span [s] in which gravity acts.
///
/// A free base has the velocity that makes momenta run from those of the one end to those of the
/// other.
[[nodiscard]] MechanismState part_of_way(const Mechanism& mechanism, const MechanismState& begin,
                                         const MechanismState& end, double share,
                                         const Eigen::Vector3d& gravity, double span);

}  // namespace firstcontact::detail
