#include <firstcontact/simulation/detail/island_robots.h>

#include <algorithm>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <firstcontact/motion/detail/turn.h>
#include <firstcontact/simulation/detail/constants.h>
#include <firstcontact/simulation/detail/sim_body.h>
#include <firstcontact/simulation/detail/simulation_model.h>
#include <firstcontact/simulation/detail/step_start.h>

namespace firstcontact::detail {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

Pose piece_pose(const SimBody& body, const MechanismInstant& instant) {
  const Pose& X_WL = instant.X_WL[body.piece->link];
  const Pose& X_LB = body.piece->X_LB;
  return {X_WL.position + X_WL.rotation * X_LB.position,
          (X_WL.rotation * X_LB.rotation.normalized()).normalized()};
}

/// The move from one pose to another, of all turns the one nearest to `expected`.
Move move_between(const SimBody& body, const Pose& from, const Pose& to, const Vector3d& expected) {
  return {centre_of_mass(body.inertia, to) - centre_of_mass(body.inertia, from),
          nearest_turn(to.rotation * from.rotation.normalized().conjugate(), expected)};
}

}  // namespace

IslandRobots::IslandRobots(const SimulationModel& model, const StepStart& start,
                           const std::vector<std::size_t>& members)
    : model_(model), place_(members.size(), {kNone, kNone}) {
  std::vector<std::size_t> numbers;  // Of the world, of each robot here.
  for (std::size_t k = 0; k < members.size(); ++k) {
    const SimBody& body = model.bodies[members[k]];
    if (!body.piece) {
      continue;
    }
    const std::size_t number = body.piece->robot;
    const auto found = std::ranges::find(numbers, number);
    const auto r = static_cast<std::size_t>(found - numbers.begin());
    if (found == numbers.end()) {
      numbers.push_back(number);
      robots_.push_back({.robot = &model.robots[number], .state = start.robots[number]});
      robots_.back().track.robot = number;
      robots_.back().impact = VectorXd::Zero(model.robots[number].mechanism.size());
    }
    place_[k] = {r, robots_[r].pieces.size()};
    robots_[r].pieces.push_back({.member = k, .body = &body});
  }
  for (Robot& robot : robots_) {
    robot.now = view_of(robot, robot.state);
  }
}

IslandRobots::View IslandRobots::view_of(const Robot& robot, const MechanismState& state) const {
  const Mechanism& mechanism = robot.robot->mechanism;
  const MechanismInstant instant = mechanism.at(state);
  const auto n = mechanism.size();
  View view;
  view.inverse_mass = mechanism.mass_matrix(instant).llt().solve(MatrixXd::Identity(n, n));
  view.gravity_forces = mechanism.bias_forces(instant, model_.gravity) -
                        mechanism.bias_forces(instant, Vector3d::Zero());
  for (const Piece& piece : robot.pieces) {
    PiecePlace place{piece_pose(*piece.body, instant), instant.J[piece.body->piece->link]};
    const Vector3d arm = centre_of_mass(piece.body->inertia, place.X_WB) - instant.reference;
    for (Eigen::Index k = 0; k < place.J.cols(); ++k) {
      place.J.col(k).head<3>() += Vector3d(place.J.col(k).tail<3>()).cross(arm);
    }
    view.pieces.push_back(std::move(place));
  }
  return view;
}

bool IslandRobots::has_motors() const {
  return std::ranges::any_of(robots_,
                             [](const Robot& robot) { return robot.robot->motor_count() > 0; });
}

double IslandRobots::longest_span() const {
  double fastest = 0.0;  // [rad/s]
  for (const Robot& robot : robots_) {
    for (const PiecePlace& piece : robot.now.pieces) {
      const Vector3d w = piece.J.bottomRows<3>() * robot.state.velocities;
      fastest = std::max(fastest, w.norm());
    }
  }
  return fastest > 0.0 ? kMostTurnOfLinks / fastest : std::numeric_limits<double>::infinity();
}

const IslandRobots::PiecePlace& IslandRobots::piece_of(std::size_t member) const {
  const auto& [robot, piece] = place_[member];
  return robots_[robot].now.pieces[piece];
}

ContactBody IslandRobots::body(std::size_t member) const {
  const std::size_t r = place_[member][0];
  const PiecePlace& piece = piece_of(member);
  const Eigen::Matrix<double, 6, 1> V = piece.J * robots_[r].state.velocities;
  return {.v = V.head<3>(), .w = V.tail<3>(), .link = MechanismLink{r, piece.J}};
}

RigidState IslandRobots::state(std::size_t member) const {
  const ContactBody moving = body(member);
  return {piece_of(member).X_WB, moving.v, moving.w};
}

Move IslandRobots::drift(std::size_t member, const Pose& X_WB) const {
  const auto& [robot, piece] = place_[member];
  return move_between(*robots_[robot].pieces[piece].body, X_WB, piece_of(member).X_WB,
                      Vector3d::Zero());
}

void IslandRobots::add_mechanisms(ContactProblem& problem) const {
  for (const Robot& robot : robots_) {
    problem.mechanisms.push_back({robot.now.inverse_mass, robot.state.velocities});
  }
}

std::vector<RobotPlan> IslandRobots::fly(ContactProblem& problem, double from, double span) const {
  std::vector<RobotPlan> free;
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    const Robot& robot = robots_[r];
    const Mechanism& mechanism = robot.robot->mechanism;
    const bool is_driven = robot.robot->is_driven();
    // Inertia carries what is driven as it moves by itself, or a fast turn would gain energy. It
    // does not fall: the forces of gravity are those where it gets.
    const MechanismState end = mechanism.after_free_motion(
        robot.state, is_driven ? Vector3d::Zero() : model_.gravity, span);
    View there = view_of(robot, end);
    VectorXd velocities = end.velocities;
    std::vector<JointDrive> drives;
    if (is_driven) {
      velocities -= span * there.inverse_mass * there.gravity_forces;
      const VectorXd origin = mechanism.moved(end.positions, -span * end.velocities);
      drives = robot.robot->drives(robot.state, origin, r, from, span);
    }
    for (std::size_t k = 0; k < robot.pieces.size(); ++k) {
      ContactBody& body = problem.bodies[robot.pieces[k].member];
      const Eigen::Matrix<double, 6, 1> V = there.pieces[k].J * velocities;
      body.v = V.head<3>();
      body.w = V.tail<3>();
      body.link = MechanismLink{r, std::move(there.pieces[k].J)};
    }
    free.push_back({end});
    problem.mechanisms.push_back({std::move(there.inverse_mass), std::move(velocities)});
    std::ranges::copy(drives, std::back_inserter(problem.drives));
  }
  return free;
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

/// [N m s or N s]  What the motors of a robot, the first ones of its drives, did to each
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

std::vector<RobotPlan> IslandRobots::plan(const ContactProblem& problem,
                                          const ContactSolution& solution,
                                          const std::vector<RobotPlan>& free,
                                          const std::vector<bool>& by_end, double span) const {
  std::vector<RobotPlan> plans;
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    const Robot& robot = robots_[r];
    const Mechanism& mechanism = robot.robot->mechanism;
    const VectorXd& v = solution.mechanisms[r];
    const bool end_leads =
        std::ranges::any_of(robot.pieces, [&](const Piece& piece) { return by_end[piece.member]; });
    const VectorXd changed = v - free[r].end.velocities;
    const VectorXd positions =
        robot.robot->is_driven() ? mechanism.moved(free[r].end.positions, span * changed)
        : end_leads              ? mechanism.moved(robot.state.positions, span * v)
                                 : mechanism.moved(free[r].end.positions, 0.5 * span * changed);
    const VectorXd velocities =
        changed.isZero(0.0) ? v : mechanism.carried({free[r].end.positions, v}, positions);
    plans.push_back(
        {{positions, velocities}, impulses_of(r, robot.robot->motor_count(), problem, solution)});
  }
  return plans;
}

void IslandRobots::displace(const std::vector<VectorXd>& by, std::vector<RobotPlan>& plans) const {
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    VectorXd& positions = plans[r].end.positions;
    positions = robots_[r].robot->mechanism.moved(positions, by[r]);
  }
}

void IslandRobots::set_moves(const std::vector<RobotPlan>& plans,
                             const std::vector<RigidState>& states, double span,
                             std::vector<Move>& moves) const {
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    const Robot& robot = robots_[r];
    const MechanismInstant there = robot.robot->mechanism.at(plans[r].end);
    const VectorXd mean = 0.5 * (robot.state.velocities + plans[r].end.velocities);
    for (std::size_t k = 0; k < robot.pieces.size(); ++k) {
      const auto& [member, body] = robot.pieces[k];
      const Vector3d w = (robot.now.pieces[k].J * mean).tail<3>();
      moves[member] = move_between(*body, states[member].X_WB, piece_pose(*body, there), span * w);
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

void IslandRobots::move_to(const std::vector<RobotPlan>& plans, double share, double to) {
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    Robot& robot = robots_[r];
    const MechanismState begin = robot.state;
    const auto& [end, motors] = plans[r];
    robot.state =
        share == 1.0
            ? end
            : MechanismState{robot.robot->mechanism.between(begin.positions, end.positions, share),
                             begin.velocities + share * (end.velocities - begin.velocities)};
    if (share > 0.0) {
      robot.track.pieces.push_back({to, begin, robot.state, robot.impact, share * motors});
      robot.impact.setZero();
    }
    robot.now = view_of(robot, robot.state);
  }
}

void IslandRobots::take_velocities(const ContactSolution& solution) {
  ContactProblem solved;  // As far as drives are concerned.
  add_drives_at_impact(solved);
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    robots_[r].impact += impulses_of(r, robots_[r].robot->rigid_motor_count(), solved, solution);
    robots_[r].state.velocities = solution.mechanisms[r];
  }
}

std::vector<RobotTrack> IslandRobots::take_tracks() {
  std::vector<RobotTrack> tracks;
  for (Robot& robot : robots_) {
    tracks.push_back(std::move(robot.track));
  }
  return tracks;
}

}  // namespace firstcontact::detail
