/// @file
/// The robots of an island: their joints in its contact problems, and the motion of their links.

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

/// A part of a step of a robot, without impacts.
struct RobotTrackPiece {
  double to = 0.0;  ///< [s]  Since the step began.
  MechanismState begin;
  MechanismState end;
  Eigen::VectorXd impact;  ///< [N m s or N s]  Impulses of motors on each coordinate, at the begin
                           ///< of the part.
  Eigen::VectorXd motors;  ///< Impulses of motors over the part.
};

/// The motion of a robot over a step, or over as much of it as could be proven free.
struct RobotTrack {
  std::size_t robot = 0;  ///< Index in the simulation model.
  std::vector<RobotTrackPiece> pieces = {};
};

/// The motion of a robot over a span without contacts, from which its contact problem starts.
struct RobotFlight {
  using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;

  bool is_known = false;
  /// Whether velocities at the end lead the robot, by Euler's implicit rule.
  ///
  /// Then inertia alone acts in the flight. Else all forces do, with the predicted ones of drives.
  bool by_end = false;
  MechanismState end = {};
  Eigen::VectorXd velocities = {};      ///< Without contacts and the changes of drives.
  Eigen::MatrixXd inverse_mass = {};    ///< At the end of the flight.
  std::vector<Jacobian> J = {};         ///< For each link body.
  std::vector<Pose> X_WB = {};          ///< Pose of each link body.
  std::vector<JointDrive> drives = {};  ///< Drives for the changes of impulses.
  std::vector<double> predicted = {};   ///< [N m s or N s]  Predicted impulse of each drive in the
                                        ///< flight.
  PositionRule rule = {};
  /// The effect of impulses of contacts in the flight on the velocities at its end; empty without
  /// any.
  ///
  /// A contact problem finds all of these impulses again, and starts without them.
  Eigen::VectorXd of_contacts = {};
};

/// Impulses on a link body, about its centre of mass.
struct LinkImpulse {
  std::size_t member = 0;                             ///< Index in the island.
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< [N s]
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< [N m s]
  bool is_inner = false;  ///< Whether another link of the same robot has the opposite impulse.
};

/// Impulses from outside of a robot, on all of its links.
struct OuterImpulse {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< [N s]
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< [N m s]  About the origin.
  bool acts = false;                                  ///< Whether any impulse acts.
  bool is_known = true;                               ///< False for velocities that were limited.
  bool touches = false;  ///< Whether contacts act, with other bodies or between its own links.
};

/// A force and a moment on a link body, constant over a span.
struct LinkLoad {
  std::size_t member = 0;                            ///< Index in the island.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< [N m]  About the origin of the world, with
                                                     ///< the link halfway.
  bool is_inner = false;  ///< Whether another link of the same robot has the opposite load.
};

/// The end of a robot's plan, and its velocities there.
struct RobotPlan {
  MechanismState end;
  Eigen::VectorXd motors = {};  ///< [N m s or N s]  On each coordinate; empty where no motor acts.
};

/// Robots whose links are members of one island.
///
/// Within a plan every link body moves at constant rates from its place to the one of its joints at
/// the plan's end. Between the ends joints come apart by the sagitta of an arc, which is of second
/// order in the plan's time. Where a plan is cut short, link bodies stay off by as much, and the
/// next plan makes up for it.
class IslandRobots {
 public:
  /// @param members  members of the island; all link bodies of a robot, or none
  /// @param bare     robots of the island without link bodies
  IslandRobots(const SimulationModel& model, const StepStart& start,
               const std::vector<std::size_t>& members, const std::vector<std::size_t>& bare = {});

  [[nodiscard]] bool empty() const { return robots_.empty(); }
  [[nodiscard]] bool has_motors() const;
  [[nodiscard]] bool has_motors(std::size_t robot) const;
  /// Whether any motor of a robot has a target, so that its force answers contacts.
  [[nodiscard]] bool has_answering_motors(std::size_t robot) const;
  /// Whether any motor of a robot has no bound.
  [[nodiscard]] bool has_rigid_motors(std::size_t robot) const;

  /// [s]  The longest span of a plan: in it no link turns by more than 0.1 rad at its present
  /// speed.
  ///
  /// So mass matrices and Jacobians change little in it. Infinite where nothing turns.
  [[nodiscard]] double longest_span() const;

  /// The role of a link body in a contact problem, with the present velocities of its robot.
  [[nodiscard]] ContactBody body(std::size_t member) const;

  /// The place and velocities of a member by its joints.
  [[nodiscard]] RigidState state(std::size_t member) const;

  /// The place of a member by its joints, a share of plans ahead.
  [[nodiscard]] Pose pose_ahead(std::size_t member, const std::vector<RobotPlan>& plans,
                                double share) const;

  /// [m, rad]  The move from the place of a link body to its present place by its joints.
  [[nodiscard]] Move drift(std::size_t member, const Pose& X_WB) const;

  /// Adds the mechanisms with their present motion.
  void add_mechanisms(ContactProblem& problem) const;

  [[nodiscard]] std::size_t size() const { return robots_.size(); }

  /// [m]  The place of a robot's free base; none for a base that is held.
  [[nodiscard]] std::optional<Eigen::Vector3d> free_base(std::size_t robot) const;

  /// Index here of the robot of a link body.
  [[nodiscard]] std::size_t robot_of(std::size_t member) const { return place_[member][0]; }

  /// The number of a link body among those of its robot, as flights have them.
  [[nodiscard]] std::size_t link_of(std::size_t member) const { return place_[member][1]; }

  /// Finds the flights over a span that are missing, or not of the wanted kind.
  ///
  /// @param by_end  for each robot whether velocities at the end lead it because of its drives
  /// @param loads   (size)  [N m or N]  constant forces along its coordinates; empty: none
  void fly(const PlanSpan& span, const std::vector<bool>& by_end,
           const std::vector<Eigen::VectorXd>& loads, std::vector<RobotFlight>& flights) const;

  /// [N m or N]  The forces along the coordinates of a robot from loads on its links.
  ///
  /// They are those halfway through a flight, or, without one, halfway on the present way.
  [[nodiscard]] Eigen::VectorXd forces_of(std::size_t robot, const std::vector<LinkLoad>& loads,
                                          const RobotFlight& flight, double span) const;

  /// Impulses on links of a robot as forces over a span, with the flight halfway.
  [[nodiscard]] std::vector<LinkLoad> loads_of(std::size_t robot,
                                               const std::vector<LinkImpulse>& impulses,
                                               const RobotFlight& flight, double span) const;

  /// [rad/s or m/s]  The effect of impulses on links of a robot on its velocities at the end of a
  /// flight.
  [[nodiscard]] Eigen::VectorXd change_by(std::size_t robot,
                                          const std::vector<LinkImpulse>& impulses,
                                          const RobotFlight& flight) const;

  /// [rad]  The turn in a flight of the link body of a robot that turns farthest.
  [[nodiscard]] double turn_of(std::size_t robot, const RobotFlight& flight) const;

  /// [m]  The centre of mass of a link body at the end of a flight.
  [[nodiscard]] Eigen::Vector3d centre_at_end(std::size_t member, const RobotFlight& flight) const;

  /// [rad or m]  The most by which changes of velocities in a flight move a coordinate.
  [[nodiscard]] double change_of_way(std::size_t robot, const RobotFlight& flight,
                                     double span) const {
    const Eigen::VectorXd change = flight.end.velocities - robots_[robot].state.velocities;
    return 0.5 * span * change.cwiseAbs().maxCoeff();
  }

  /// Sets velocities of mechanisms and of their links, and the drives of joints.
  ///
  /// They hold at the ends of flights, and so do masses and Jacobians. Coordinates of a link that a
  /// turning link carries change with the turn, so that at its begin the same numbers would mean
  /// something else.
  void set(const std::vector<RobotFlight>& flights, ContactProblem& problem) const;

  /// The robots that velocities at the end have to lead.
  ///
  /// These are robots whose contacts or limits allow no others, and those that a motor would lead
  /// elsewhere than contacts know.
  [[nodiscard]] std::vector<bool> led_by_end(const ContactProblem& problem,
                                             const ContactSolution& solution,
                                             const std::vector<RobotFlight>& flights,
                                             const std::vector<bool>& by_end,
                                             const PlanSpan& span) const;

  void add_drives_at_impact(ContactProblem& problem) const;

  /// Adds drives that keep displacements, instead of velocities, within the limits of joints.
  void add_stops(ContactProblem& problem) const;

  /// The ends of the plans of robots.
  ///
  /// As for bodies the mean of the velocities at both ends leads a robot, in addition to its
  /// flight. Motors that reach their targets are there. In flights by the end, velocities at the
  /// end lead. They also lead robots without drives where `by_end` is set. Velocities are carried
  /// from the end of the flight to there.
  ///
  /// @param by_end  for the problem's bodies: whether velocities at the end lead them
  /// @param outer   impulses that flights do not have, at the places of the problem
  [[nodiscard]] std::vector<RobotPlan> plan(const ContactProblem& problem,
                                            const ContactSolution& solution,
                                            const std::vector<RobotFlight>& flights,
                                            const std::vector<bool>& by_end,
                                            const std::vector<OuterImpulse>& outer,
                                            const PlanSpan& span) const;

  /// Gives robots with a free base the momenta that follow from gravity and impulses from outside.
  ///
  /// Where none of these acts, their centres of mass move as such momenta lead.
  ///
  /// @param outer  one for each robot
  void keep_momenta(const std::vector<OuterImpulse>& outer, double span,
                    std::vector<RobotPlan>& plans) const;

  /// Adds displacements of coordinates, in order of robots.
  void displace(const std::vector<Eigen::VectorXd>& by, std::vector<RobotPlan>& plans) const;

  /// Sets the moves that lead the link bodies to their places in a plan.
  ///
  /// @param made_up  [-]  the share of drift() that they make up for
  void set_moves(const std::vector<RobotPlan>& plans, const std::vector<RigidState>& states,
                 double span, double made_up, std::vector<Move>& moves) const;

  /// [-]  The share of plans that may be followed before a joint leaves its limits.
  [[nodiscard]] double share_within_limits(const std::vector<RobotPlan>& plans) const;

  /// Whether no joint takes or gives energy, now and at the ends of plans.
  [[nodiscard]] bool are_passive(const std::vector<RobotPlan>& plans) const;

  /// The present energy and momenta of a robot.
  [[nodiscard]] MechanismMechanics mechanics(std::size_t robot) const;
  /// The energy and momenta of a robot in another state.
  [[nodiscard]] MechanismMechanics mechanics(std::size_t robot, const MechanismState& state) const;

  /// Moves by a share of the way of a plan. `to` is the time since the step began.
  void move_to(const std::vector<RobotPlan>& plans, double share, double span, double to);

  /// [kg m^2]  Inertia of a floating robot about its centre of mass, as one body.
  [[nodiscard]] Eigen::Matrix3d inertia(std::size_t robot) const;

  /// Adds velocities to a floating robot as one body.
  ///
  /// They are v [m/s] at a point [m], about which it turns faster by w [rad/s].
  void move_faster(std::size_t robot, const Eigen::Vector3d& v, const Eigen::Vector3d& w,
                   const Eigen::Vector3d& point);

  /// Takes the velocities after the present impact, and the effect of motors on them.
  ///
  /// @param outer  one for each robot
  void take_velocities(const ContactSolution& solution, const std::vector<OuterImpulse>& outer);

  [[nodiscard]] std::vector<RobotTrack> take_tracks();

 private:
  using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;
  struct LinkMember {
    std::size_t member;
    const SimBody* body;
  };
  struct LinkPlace {
    Pose X_WB = {};   // Pose by the joints.
    Jacobian J = {};  // Jacobian of (v_WC, w_WB).
  };
  /// A robot in one state, as seen by its links.
  struct View {
    std::vector<LinkPlace> links = {};
    std::vector<Eigen::Matrix3Xd> turns = {};  // For each link, where there are no link bodies.
    Eigen::MatrixXd inverse_mass = {};
    Eigen::VectorXd bias = {};
    Eigen::VectorXd gravity_forces = {};
  };
  struct Robot {
    const SimRobot* robot;
    MechanismState state;
    std::vector<LinkMember> links = {};
    View now = {};
    Eigen::VectorXd impact = {};  // Impulses of motors since the last piece of the track.
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
  std::vector<std::array<std::size_t, 2>> place_;  // For each member the robot and the link body.
};

/// The state at a share of the way over a span [s] in which gravity acts.
///
/// A free base has the velocity for which momenta run from those of one end to those of the other.
[[nodiscard]] MechanismState part_of_way(const Mechanism& mechanism, const MechanismState& begin,
                                         const MechanismState& end, double share,
                                         const Eigen::Vector3d& gravity, double span);

}  // namespace firstcontact::detail
