#include <firstcontact/simulation_model/detail/island_robots.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <firstcontact/mechanism/detail/spatial.h>
#include <firstcontact/motion/detail/turn.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/sim_body.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>
#include <firstcontact/simulation_model/detail/step_start.h>

namespace firstcontact::detail {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

Pose link_body_pose(const SimBody& body, const MechanismInstant& instant) {
  const Pose& X_WL = instant.X_WL[body.link_body->link];
  const Pose& X_LB = body.link_body->X_LB;
  return {X_WL.position + X_WL.rotation * X_LB.position,
          (X_WL.rotation * X_LB.rotation.normalized()).normalized()};
}

/// The move from one pose to another; among all turns the one nearest to `expected`.
Move move_between(const SimBody& body, const Pose& from, const Pose& to, const Vector3d& expected) {
  return {centre_of_mass(body.inertia, to) - centre_of_mass(body.inertia, from),
          nearest_turn(to.rotation * from.rotation.normalized().conjugate(), expected)};
}

}  // namespace

IslandRobots::IslandRobots(const SimulationModel& model, const StepStart& start,
                           const std::vector<std::size_t>& members,
                           const std::vector<std::size_t>& bare)
    : model_(model), place_(members.size(), {kNone, kNone}) {
  std::vector<std::size_t> numbers;  // Number in the simulation model, for each robot here.
  for (std::size_t k = 0; k < members.size(); ++k) {
    const SimBody& body = model.bodies[members[k]];
    if (!body.link_body) {
      continue;
    }
    const std::size_t number = body.link_body->robot;
    const auto found = std::ranges::find(numbers, number);
    const auto r = static_cast<std::size_t>(found - numbers.begin());
    if (found == numbers.end()) {
      numbers.push_back(number);
      robots_.push_back({.robot = &model.robots[number], .state = start.robots[number]});
      robots_.back().track.robot = number;
      robots_.back().impact = VectorXd::Zero(model.robots[number].mechanism.size());
    }
    place_[k] = {r, robots_[r].links.size()};
    robots_[r].links.push_back({.member = k, .body = &body});
  }
  for (const std::size_t number : bare) {
    robots_.push_back({.robot = &model.robots[number], .state = start.robots[number]});
    robots_.back().track.robot = number;
    robots_.back().impact = VectorXd::Zero(model.robots[number].mechanism.size());
  }
  for (Robot& robot : robots_) {
    robot.now = view_of(robot, robot.state);
  }
}

IslandRobots::View IslandRobots::view_of(const Robot& robot, const MechanismState& state) const {
  const Mechanism& mechanism = robot.robot->mechanism;
  const MechanismInstant instant = mechanism.at(state);
  View view;
  view.inverse_mass = Mechanism::inverse_mass(mechanism.mass_matrix(instant));
  view.bias = mechanism.bias_forces(instant, model_.gravity);
  view.gravity_forces = view.bias - mechanism.bias_forces(instant, Vector3d::Zero());
  if (robot.links.empty()) {
    for (const Jacobian& J : instant.J) {
      view.turns.emplace_back(J.bottomRows<3>());
    }
  }
  for (const LinkMember& piece : robot.links) {
    LinkPlace place{link_body_pose(*piece.body, instant), instant.J[piece.body->link_body->link]};
    const Vector3d arm = centre_of_mass(piece.body->inertia, place.X_WB) - instant.reference;
    for (Eigen::Index k = 0; k < place.J.cols(); ++k) {
      place.J.col(k).head<3>() += Vector3d(place.J.col(k).tail<3>()).cross(arm);
    }
    view.links.push_back(std::move(place));
  }
  return view;
}

bool IslandRobots::has_motors() const {
  return std::ranges::any_of(robots_,
                             [](const Robot& robot) { return robot.robot->motor_count() > 0; });
}

bool IslandRobots::has_motors(std::size_t r) const { return robots_[r].robot->motor_count() > 0; }

bool IslandRobots::has_answering_motors(std::size_t r) const {
  return std::ranges::any_of(robots_[r].robot->laws, [](const JointLaw& law) {
    return law.motor && law.motor->kind != JointMotor::Kind::torque;
  });
}

double IslandRobots::longest_span() const {
  double fastest = 0.0;  // [rad/s]
  for (const Robot& robot : robots_) {
    for (const LinkPlace& piece : robot.now.links) {
      const Vector3d w = piece.J.bottomRows<3>() * robot.state.velocities;
      fastest = std::max(fastest, w.norm());
    }
    for (const Eigen::Matrix3Xd& J : robot.now.turns) {
      fastest = std::max(fastest, Vector3d(J * robot.state.velocities).norm());
    }
  }
  return fastest > 0.0 ? kMostTurnOfLinks / fastest : std::numeric_limits<double>::infinity();
}

std::optional<Vector3d> IslandRobots::free_base(std::size_t r) const {
  return robots_[r].robot->mechanism.has_free_base()
             ? std::optional<Vector3d>(robots_[r].state.positions.head<3>())
             : std::nullopt;
}

const IslandRobots::LinkPlace& IslandRobots::place_of(std::size_t member) const {
  const auto& [robot, piece] = place_[member];
  return robots_[robot].now.links[piece];
}

ContactBody IslandRobots::body(std::size_t member) const {
  const std::size_t r = place_[member][0];
  const LinkPlace& piece = place_of(member);
  const Eigen::Matrix<double, 6, 1> V = piece.J * robots_[r].state.velocities;
  return {.v = V.head<3>(), .w = V.tail<3>(), .link = MechanismLink{r, piece.J}};
}

RigidState IslandRobots::state(std::size_t member) const {
  const ContactBody moving = body(member);
  return {place_of(member).X_WB, moving.v, moving.w};
}

Pose IslandRobots::pose_ahead(std::size_t member, const std::vector<RobotPlan>& plans,
                              double share) const {
  const auto& [r, piece] = place_[member];
  const Mechanism& mechanism = robots_[r].robot->mechanism;
  const MechanismState& end = plans[r].end;
  const MechanismState there{mechanism.between(robots_[r].state.positions, end.positions, share),
                             end.velocities};
  return link_body_pose(*robots_[r].links[piece].body, mechanism.at(there));
}

Move IslandRobots::drift(std::size_t member, const Pose& X_WB) const {
  const auto& [robot, piece] = place_[member];
  return move_between(*robots_[robot].links[piece].body, X_WB, place_of(member).X_WB,
                      Vector3d::Zero());
}

void IslandRobots::add_mechanisms(ContactProblem& problem) const {
  for (const Robot& robot : robots_) {
    problem.mechanisms.push_back({robot.now.inverse_mass, robot.state.velocities});
  }
}

void IslandRobots::add_drives_at_impact(ContactProblem& problem) const {
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    std::ranges::copy(robots_[r].robot->drives_at_impact(robots_[r].state, r),
                      std::back_inserter(problem.drives));
  }
}

void IslandRobots::add_stops(ContactProblem& problem) const {
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    std::ranges::copy(robots_[r].robot->stops(robots_[r].state, r),
                      std::back_inserter(problem.drives));
  }
}

/// [N m s or N s]  The impulse of each drive of a robot.
std::vector<double> IslandRobots::drives_of(std::size_t robot, const ContactProblem& problem,
                                            const ContactSolution& solution) const {
  std::vector<double> drives;
  for (std::size_t k = 0; k < problem.drives.size(); ++k) {
    if (problem.drives[k].mechanism == robot) {
      drives.push_back(solution.drives[k]);
    }
  }
  return drives;
}

/// [N m s or N s]  The effect of the motors of a robot, the first of its drives, on each
/// coordinate.
VectorXd IslandRobots::impulses_of(std::size_t robot, std::size_t motors,
                                   const ContactProblem& problem,
                                   const ContactSolution& solution) const {
  VectorXd impulses = VectorXd::Zero(robots_[robot].robot->mechanism.size());
  const auto first = std::ranges::find(problem.drives, robot, &JointDrive::mechanism);
  const auto begin = static_cast<std::size_t>(first - problem.drives.begin());
  for (std::size_t k = begin; k < begin + motors; ++k) {
    impulses[static_cast<Eigen::Index>(problem.drives[k].coordinate)] += solution.drives[k];
  }
  return impulses;
}

/// The velocities after contacts at the end of the flight, with the momenta of impulses from
/// outside.
///
/// Arms are those of the begin. At the end of the flight the two sides of a contact between two of
/// its links are apart, and their impulses would turn the robot as a whole.
VectorXd IslandRobots::balanced(std::size_t r, const RobotFlight& flight, const OuterImpulse& outer,
                                const VectorXd& v) const {
  const Mechanism& mechanism = robots_[r].robot->mechanism;
  if (!mechanism.has_free_base() || !outer.is_known || !outer.touches) {
    return v;
  }
  const MechanismMechanics before =
      mechanism.mechanics({flight.end.positions, flight.velocities}, model_.gravity);
  return mechanism.with_momenta({flight.end.positions, v}, before.linear_momentum + outer.linear,
                                before.angular_momentum + outer.angular);
}

/// The positions to which the mean of the velocities at both ends leads.
VectorXd IslandRobots::mean_positions(std::size_t r, const RobotFlight& flight, const VectorXd& v,
                                      double span) const {
  const VectorXd changed = v - flight.end.velocities;
  return robots_[r].robot->mechanism.moved(flight.end.positions, 0.5 * span * changed);
}

std::vector<bool> IslandRobots::led_by_end(const ContactProblem& problem,
                                           const ContactSolution& solution,
                                           const std::vector<RobotFlight>& flights,
                                           const std::vector<bool>& by_end,
                                           const PlanSpan& span) const {
  std::vector<bool> led(robots_.size(), false);
  std::vector<bool> touches(robots_.size(), false);
  for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
    for (const std::size_t place : problem.contacts[k].bodies) {
      if (problem.bodies[place].link && !solution.impulses[k].isZero(0.0)) {
        touches[problem.bodies[place].link->mechanism] = true;
      }
    }
  }
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    const Robot& robot = robots_[r];
    if (!robot.robot->is_driven() || flights[r].by_end) {
      led[r] = flights[r].by_end;
      continue;
    }
    led[r] = std::ranges::any_of(robot.links,
                                 [&](const LinkMember& piece) { return by_end[piece.member]; });
    std::vector<double> drives = drives_of(r, problem, solution);
    for (std::size_t k = 0; k < drives.size(); ++k) {
      const JointDrive& drive = flights[r].drives[k];
      const bool is_stop = std::isinf(drive.least) != std::isinf(drive.greatest);
      led[r] = led[r] || (is_stop && drives[k] != 0.0);
    }
    if (!led[r] && touches[r]) {
      const VectorXd& v = solution.mechanisms[r];
      const VectorXd positions = mean_positions(r, flights[r], v, span.length);
      const VectorXd way = placement(r, flights[r], drives, v, positions, span);
      led[r] = (way.size() > 0 &&
                way.cwiseAbs().maxCoeff() > kUnseenPlacement * model_.distances.least) ||
               jumps(r, flights[r], drives, v, positions, span);
    }
  }
  return led;
}

std::vector<RobotPlan> IslandRobots::plan(const ContactProblem& problem,
                                          const ContactSolution& solution,
                                          const std::vector<RobotFlight>& flights,
                                          const std::vector<bool>& by_end,
                                          const std::vector<OuterImpulse>& outer,
                                          const PlanSpan& span) const {
  std::vector<RobotPlan> plans;
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    const Robot& robot = robots_[r];
    const RobotFlight& flight = flights[r];
    const Mechanism& mechanism = robot.robot->mechanism;
    const VectorXd v = balanced(r, flight, outer[r], solution.mechanisms[r]);
    const bool end_leads = std::ranges::any_of(
        robot.links, [&](const LinkMember& piece) { return by_end[piece.member]; });
    const VectorXd changed = v - flight.end.velocities;
    VectorXd positions = flight.by_end
                             ? mechanism.moved(flight.end.positions, span.length * changed)
                         : end_leads ? mechanism.moved(robot.state.positions, span.length * v)
                                     : mean_positions(r, flight, v, span.length);
    const VectorXd velocities =
        changed.isZero(0.0) ? v : mechanism.carried({flight.end.positions, v}, positions);
    if (!flight.by_end && !flight.drives.empty()) {
      positions = mechanism.moved(
          positions, placement(r, flight, drives_of(r, problem, solution), v, positions, span));
    }
    VectorXd motors = impulses_of(r, robot.robot->motor_count(), problem, solution);
    for (std::size_t k = 0; k < robot.robot->motor_count(); ++k) {
      motors[static_cast<Eigen::Index>(flight.drives[k].coordinate)] += flight.predicted[k];
    }
    plans.push_back({{positions, velocities}, std::move(motors)});
  }
  return plans;
}

void IslandRobots::keep_momenta(const std::vector<OuterImpulse>& outer, double span,
                                std::vector<RobotPlan>& plans) const {
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    const Mechanism& mechanism = robots_[r].robot->mechanism;
    if (!mechanism.has_free_base() || !outer[r].is_known) {
      continue;
    }
    const OuterImpulse& impulse = outer[r];
    MechanismState& end = plans[r].end;
    const MechanismMechanics before = mechanism.mechanics(robots_[r].state, model_.gravity);
    MechanismMechanics after = mechanism.mechanics(end, model_.gravity);
    const Vector3d weight = before.mass * model_.gravity;
    const Vector3d linear = before.linear_momentum + span * weight + impulse.linear;
    if (!impulse.acts) {
      const Vector3d way = span * (before.linear_momentum + linear) / (2.0 * before.mass);
      end.positions.head<3>() += before.p_WC + way - after.p_WC;
      after.p_WC = before.p_WC + way;
    }
    const Vector3d angular = before.angular_momentum + impulse.angular +
                             span * (0.5 * (before.p_WC + after.p_WC)).cross(weight);
    end.velocities = mechanism.with_momenta(end, linear, angular);
  }
}

bool IslandRobots::are_passive(const std::vector<RobotPlan>& plans) const {
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    const SimRobot& robot = *robots_[r].robot;
    if (!robot.is_passive(robots_[r].state.positions) ||
        !robot.is_passive(plans[r].end.positions)) {
      return false;
    }
  }
  return true;
}

MechanismMechanics IslandRobots::mechanics(std::size_t robot) const {
  return mechanics(robot, robots_[robot].state);
}

MechanismMechanics IslandRobots::mechanics(std::size_t robot, const MechanismState& state) const {
  return robots_[robot].robot->mechanism.mechanics(state, model_.gravity);
}

void IslandRobots::displace(const std::vector<VectorXd>& by, std::vector<RobotPlan>& plans) const {
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    VectorXd& positions = plans[r].end.positions;
    positions = robots_[r].robot->mechanism.moved(positions, by[r]);
  }
}

void IslandRobots::set_moves(const std::vector<RobotPlan>& plans,
                             const std::vector<RigidState>& states, double span, double made_up,
                             std::vector<Move>& moves) const {
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    const Robot& robot = robots_[r];
    const MechanismInstant there = robot.robot->mechanism.at(plans[r].end);
    const VectorXd mean = 0.5 * (robot.state.velocities + plans[r].end.velocities);
    for (std::size_t k = 0; k < robot.links.size(); ++k) {
      const auto& [member, body] = robot.links[k];
      const Vector3d w = (robot.now.links[k].J * mean).tail<3>();
      moves[member] =
          move_between(*body, states[member].X_WB, link_body_pose(*body, there), span * w);
      if (made_up < 1.0) {
        const Move left = drift(member, states[member].X_WB).part(1.0 - made_up);
        moves[member].translation -= left.translation;
        moves[member].rotation_vector -= left.rotation_vector;
      }
    }
  }
}

double IslandRobots::share_within_limits(const std::vector<RobotPlan>& plans) const {
  double share = 1.0;
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    share = std::min(
        share, robots_[r].robot->share_within_limits(robots_[r].state, plans[r].end.positions));
  }
  return share;
}

void IslandRobots::move_to(const std::vector<RobotPlan>& plans, double share, double span,
                           double to) {
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    Robot& robot = robots_[r];
    const MechanismState begin = robot.state;
    const auto& [end, motors] = plans[r];
    robot.state =
        share == 1.0 ? end
                     : part_of_way(robot.robot->mechanism, begin, end, share, model_.gravity, span);
    if (share > 0.0) {
      robot.track.pieces.push_back({to, begin, robot.state, robot.impact, share * motors});
      robot.impact.setZero();
    }
    robot.now = view_of(robot, robot.state);
  }
}

/// The block of its base in the mass matrix is that of the whole robot, about the reference point.
Eigen::Matrix3d IslandRobots::inertia(std::size_t robot) const {
  const MechanismInstant instant = robots_[robot].robot->mechanism.at(robots_[robot].state);
  const MechanismMechanics whole = mechanics(robot);
  const Eigen::Matrix3d arm = cross_matrix(whole.p_WC - instant.reference);
  return robots_[robot].robot->mechanism.mass_matrix(instant).block<3, 3>(3, 3) +
         whole.mass * arm * arm;
}

void IslandRobots::move_faster(std::size_t r, const Vector3d& v, const Vector3d& w,
                               const Vector3d& point) {
  Robot& robot = robots_[r];
  const Vector3d reference = robot.robot->mechanism.at(robot.state).reference;
  robot.state.velocities.head<3>() += v + w.cross(reference - point);
  robot.state.velocities.segment<3>(3) += w;
  robot.track.pieces.back().end.velocities = robot.state.velocities;
  robot.now = view_of(robot, robot.state);
}

void IslandRobots::take_velocities(const ContactSolution& solution,
                                   const std::vector<OuterImpulse>& outer) {
  ContactProblem solved;  // Problem that was solved, as far as drives are concerned.
  add_drives_at_impact(solved);
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    const Mechanism& mechanism = robots_[r].robot->mechanism;
    MechanismState& state = robots_[r].state;
    robots_[r].impact += impulses_of(r, robots_[r].robot->rigid_motor_count(), solved, solution);
    if (!mechanism.has_free_base() || !outer[r].is_known) {
      state.velocities = solution.mechanisms[r];
      continue;
    }
    const MechanismMechanics before = mechanism.mechanics(state, model_.gravity);
    state.velocities = solution.mechanisms[r];
    state.velocities = mechanism.with_momenta(state, before.linear_momentum + outer[r].linear,
                                              before.angular_momentum + outer[r].angular);
  }
}

std::vector<RobotTrack> IslandRobots::take_tracks() {
  std::vector<RobotTrack> tracks;
  for (Robot& robot : robots_) {
    tracks.push_back(std::move(robot.track));
  }
  return tracks;
}

MechanismState part_of_way(const Mechanism& mechanism, const MechanismState& begin,
                           const MechanismState& end, double share, const Vector3d& gravity,
                           double span) {
  MechanismState state{mechanism.between(begin.positions, end.positions, share),
                       begin.velocities + share * (end.velocities - begin.velocities)};
  if (!mechanism.has_free_base() || share == 0.0) {
    return state;
  }
  const MechanismMechanics from = mechanism.mechanics(begin, gravity);
  const MechanismMechanics to = mechanism.mechanics(end, gravity);
  const auto at = [&](const Vector3d& a, const Vector3d& b) -> Vector3d {
    return a + share * (b - a);
  };
  // The moment of the weight about the origin grows as the centre of mass moves.
  const Vector3d moment = (to.p_WC - from.p_WC).cross(from.mass * gravity) * span;
  state.velocities = mechanism.with_momenta(
      state, at(from.linear_momentum, to.linear_momentum),
      at(from.angular_momentum, to.angular_momentum) + 0.5 * (share * share - share) * moment);
  return state;
}

}  // namespace firstcontact::detail
