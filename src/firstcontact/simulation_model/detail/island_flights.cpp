#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/island_robots.h>
#include <firstcontact/simulation_model/detail/joint_law.h>
#include <firstcontact/simulation_model/detail/sim_body.h>
#include <firstcontact/simulation_model/detail/sim_robot.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>

namespace firstcontact::detail {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// The rule of a robot's positions at the end of a span.
///
/// Without drives they are those of the mean of these velocities, or flights lead them to `end`.
PositionRule rule_of(const std::vector<JointLaw>& laws, const MechanismState& state,
                     const MechanismState& end, const VectorXd& weights, double span) {
  PositionRule rule{weights, VectorXd::Zero(weights.size())};
  for (const JointLaw& law : laws) {
    const Eigen::Index k = law.velocity;
    rule.origin[k] = end.positions[law.position] - 0.5 * span * end.velocities[k] -
                     span * (weights[k] - 0.5) * state.velocities[k];
  }
  return rule;
}

/// The action of drives over a flight.
///
/// Drives that reach their targets have them at the end, whatever forces that takes. The others act
/// with constant forces, but for the dampers that the flight follows.
MechanismDrive driven_by(const std::vector<JointDrive>& drives, const std::vector<double>& impulses,
                         const VectorXd& followed, const VectorXd& velocities, double span) {
  MechanismDrive drive{.forces = VectorXd::Zero(velocities.size()), .damping = followed};
  std::vector<double> accelerations;
  for (std::size_t k = 0; k < drives.size(); ++k) {
    const auto c = static_cast<Eigen::Index>(drives[k].coordinate);
    if (reaches_target(drives[k], impulses[k]) &&
        std::ranges::find(drive.driven, c) == drive.driven.end()) {
      drive.driven.push_back(c);
      accelerations.push_back((drives[k].target - velocities[c]) / span);
    } else {
      drive.forces[c] += impulses[k] / span;
    }
  }
  drive.accelerations = Eigen::Map<const VectorXd>(accelerations.data(),
                                                   static_cast<Eigen::Index>(accelerations.size()));
  return drive;
}

/// Whether a drive is a damper that flights follow: no spring is beside such a damper.
bool is_followed(const JointDrive& drive, const VectorXd& followed) {
  return drive.compliance > 0.0 && followed.size() > 0 &&
         followed[static_cast<Eigen::Index>(drive.coordinate)] > 0.0;
}

}  // namespace

bool IslandRobots::has_rigid_motors(std::size_t r) const {
  return robots_[r].robot->rigid_motor_count() > 0;
}

void IslandRobots::take_links(std::vector<LinkPlace>& links, RobotFlight& flight) {
  for (LinkPlace& link : links) {
    flight.J.push_back(std::move(link.J));
    flight.X_WB.push_back(link.X_WB);
  }
}

VectorXd IslandRobots::forces_of(std::size_t r, const std::vector<LinkLoad>& loads,
                                 const RobotFlight& flight, double span) const {
  const Robot& robot = robots_[r];
  const Mechanism& mechanism = robot.robot->mechanism;
  const VectorXd positions =
      flight.is_known ? mechanism.between(robot.state.positions, flight.end.positions, 0.5)
                      : mechanism.moved(robot.state.positions, 0.5 * span * robot.state.velocities);
  const MechanismInstant halfway = mechanism.at({positions, robot.state.velocities});
  VectorXd forces = VectorXd::Zero(mechanism.size());
  for (const LinkLoad& load : loads) {
    const auto& [of, link] = place_[load.member];
    if (of == r) {
      const Jacobian& J = halfway.J[robot.links[link].body->link_body->link];
      const Vector3d torque = load.torque - halfway.reference.cross(load.force);
      forces += J.topRows<3>().transpose() * load.force + J.bottomRows<3>().transpose() * torque;
    }
  }
  return forces;
}

std::vector<LinkLoad> IslandRobots::loads_of(std::size_t r,
                                             const std::vector<LinkImpulse>& impulses,
                                             const RobotFlight& flight, double span) const {
  std::vector<LinkLoad> loads;
  for (const LinkImpulse& impulse : impulses) {
    const auto& [of, link] = place_[impulse.member];
    if (of == r) {
      const Inertia& inertia = robots_[r].links[link].body->inertia;
      const Vector3d centre = 0.5 * (centre_of_mass(inertia, robots_[r].now.links[link].X_WB) +
                                     centre_of_mass(inertia, flight.X_WB[link]));
      loads.push_back({impulse.member, impulse.linear / span,
                       (impulse.angular + centre.cross(impulse.linear)) / span, impulse.is_inner});
    }
  }
  return loads;
}

double IslandRobots::turn_of(std::size_t r, const RobotFlight& flight) const {
  double farthest = 0.0;
  for (std::size_t link = 0; link < robots_[r].links.size(); ++link) {
    const Pose& begin = robots_[r].now.links[link].X_WB;
    farthest = std::max(farthest, begin.rotation.angularDistance(flight.X_WB[link].rotation));
  }
  return farthest;
}

Vector3d IslandRobots::centre_at_end(std::size_t member, const RobotFlight& flight) const {
  const auto& [r, link] = place_[member];
  return centre_of_mass(robots_[r].links[link].body->inertia, flight.X_WB[link]);
}

VectorXd IslandRobots::change_by(std::size_t r, const std::vector<LinkImpulse>& impulses,
                                 const RobotFlight& flight) const {
  VectorXd along = VectorXd::Zero(flight.velocities.size());
  for (const LinkImpulse& impulse : impulses) {
    const auto& [of, link] = place_[impulse.member];
    if (of == r) {
      const Jacobian& J = flight.J[link];
      along += J.topRows<3>().transpose() * impulse.linear +
               J.bottomRows<3>().transpose() * impulse.angular;
    }
  }
  return flight.inverse_mass * along;
}

/// The displacement from mean_positions() to the positions where drives place coordinates.
///
/// It is the least such displacement in the kinetic metric, as impulses would make it. It leads no
/// other joint beyond its limits.
VectorXd IslandRobots::placement(std::size_t r, const RobotFlight& flight,
                                 const std::vector<double>& drives, const VectorXd& v,
                                 const VectorXd& positions, const PlanSpan& span) const {
  const std::vector<PlacedCoordinate> placed = placed_coordinates(
      robots_[r].robot->laws, flight.drives, drives, robots_[r].state, flight.rule, span, v);
  std::vector<Eigen::Index> at;
  std::vector<double> missing;
  for (const PlacedCoordinate& coordinate : placed) {
    at.push_back(coordinate.velocity);
    missing.push_back(coordinate.at - positions[coordinate.position]);
  }
  VectorXd displacement = VectorXd::Zero(v.size());
  for (std::size_t known = 0; known < at.size();) {
    known = at.size();
    const Eigen::Map<const VectorXd> way(missing.data(), static_cast<Eigen::Index>(known));
    const MatrixXd columns = flight.inverse_mass(Eigen::all, at);
    displacement = columns * MatrixXd(columns(at, Eigen::all)).llt().solve(way);
    displacement(at) = way;
    for (const JointLaw& law : robots_[r].robot->laws) {
      const double by = displacement[law.velocity];
      const double most = room_within_limits(law, robots_[r].state.positions[law.position],
                                             positions[law.position], by);
      if (most != by && std::ranges::find(at, law.velocity) == at.end()) {
        at.push_back(law.velocity);
        missing.push_back(most);
      }
    }
  }
  return displacement;
}

/// Whether rows of positions lead a coordinate elsewhere than the mean of its velocities does.
bool IslandRobots::jumps(std::size_t r, const RobotFlight& flight,
                         const std::vector<double>& drives, const VectorXd& v,
                         const VectorXd& positions, const PlanSpan& span) const {
  const std::vector<PlacedCoordinate> placed = placed_coordinates(
      robots_[r].robot->laws, flight.drives, drives, robots_[r].state, flight.rule, span, v);
  return std::ranges::any_of(placed, [&](const PlacedCoordinate& coordinate) {
    return coordinate.is_along_rows && std::abs(coordinate.at - positions[coordinate.position]) >
                                           kUnseenJump * model_.distances.least;
  });
}

/// The flight of inertia alone, with drives by the end of the span.
///
/// Inertia carries driven links as they move by themselves, or a fast turn would gain energy. They
/// do not fall in it: the forces of gravity are those at the end.
RobotFlight IslandRobots::flight_by_end(std::size_t r, const PlanSpan& span,
                                        const VectorXd& load) const {
  const Robot& robot = robots_[r];
  const Mechanism& mechanism = robot.robot->mechanism;
  RobotFlight flight{.is_known = true, .by_end = true};
  flight.end = mechanism.after_free_motion(robot.state, Vector3d::Zero(), span.length);
  View there = view_of(robot, flight.end);
  flight.velocities =
      flight.end.velocities - span.length * there.inverse_mass * there.gravity_forces;
  if (load.size() > 0) {
    flight.velocities += span.length * there.inverse_mass * load;
  }
  const VectorXd origin =
      mechanism.moved(flight.end.positions, -span.length * flight.end.velocities);
  flight.drives = drives_by_end(robot.robot->laws, robot.state, origin, span);
  flight.predicted.assign(flight.drives.size(), 0.0);
  flight.inverse_mass = std::move(there.inverse_mass);
  take_links(there.links, flight);
  return flight;
}

/// The flight with all forces; those of drives are predicted from the state at its begin.
///
/// Drives of the contact problem change them.
RobotFlight IslandRobots::flight_of(std::size_t r, const PlanSpan& span,
                                    const VectorXd& load) const {
  const Robot& robot = robots_[r];
  const Mechanism& mechanism = robot.robot->mechanism;
  const std::vector<JointLaw>& laws = robot.robot->laws;
  const double h = span.length;
  RobotFlight flight{.is_known = true};
  MechanismDrive drive;
  std::vector<JointDrive> first;
  const bool is_driven = robot.robot->is_driven();
  if (is_driven) {
    const VectorXd& v = robot.state.velocities;
    VectorXd u = v - h * robot.now.inverse_mass * robot.now.bias;
    if (load.size() > 0) {
      u += h * robot.now.inverse_mass * load;
    }
    const VectorXd followed = followed_damping(laws, robot.now.inverse_mass, h);
    flight.rule.weights = position_weights(laws, robot.now.inverse_mass, followed, h);
    const MechanismState ahead{mechanism.moved(robot.state.positions, 0.5 * h * (v + u)), u};
    first = drives_by_rule(laws, robot.state,
                           rule_of(laws, robot.state, ahead, flight.rule.weights, h), span);
    flight.predicted = predicted_impulses(robot.now.inverse_mass, u, first);
    for (std::size_t k = 0; k < first.size(); ++k) {
      if (is_followed(first[k], followed)) {
        flight.predicted[k] = 0.0;
      }
    }
    drive = driven_by(first, flight.predicted, followed, v, h);
  }
  const VectorXd of_drives = drive.forces;
  if (load.size() > 0) {
    drive.forces = is_driven ? VectorXd(drive.forces + load) : load;
  }
  MechanismMotion motion = mechanism.after_driven_motion(robot.state, model_.gravity, drive, h);
  flight.end = std::move(motion.end);
  View there = view_of(robot, flight.end);
  flight.velocities = flight.end.velocities;
  flight.inverse_mass = std::move(there.inverse_mass);
  take_links(there.links, flight);
  if (!is_driven) {
    return flight;
  }
  flight.rule = rule_of(laws, robot.state, flight.end, flight.rule.weights, h);
  flight.drives = drives_by_rule(laws, robot.state, flight.rule, span);
  // All drives of a coordinate together led it.
  for (std::size_t i = 0; i < drive.driven.size(); ++i) {
    double rest = motion.impulses[static_cast<Eigen::Index>(i)];
    std::optional<std::size_t> leads;
    for (std::size_t k = 0; k < first.size(); ++k) {
      if (static_cast<Eigen::Index>(first[k].coordinate) != drive.driven[i]) {
        continue;
      }
      if (!leads && reaches_target(first[k], flight.predicted[k])) {
        leads = k;
      }
    }
    rest += of_drives[drive.driven[i]] * h;
    for (std::size_t k = 0; k < first.size(); ++k) {
      if (static_cast<Eigen::Index>(first[k].coordinate) == drive.driven[i] && k != *leads) {
        rest -= flight.predicted[k];
      }
    }
    flight.predicted[*leads] = rest;
  }
  for (std::size_t k = 0; k < flight.drives.size(); ++k) {
    JointDrive& change = flight.drives[k];
    if (is_followed(change, drive.damping)) {
      change.target = flight.velocities[static_cast<Eigen::Index>(change.coordinate)];
      continue;
    }
    const double impulse = flight.predicted[k];
    change.target -= change.compliance * impulse;
    change.least -= impulse;
    change.greatest -= impulse;
  }
  return flight;
}

void IslandRobots::fly(const PlanSpan& span, const std::vector<bool>& by_end,
                       const std::vector<VectorXd>& loads,
                       std::vector<RobotFlight>& flights) const {
  flights.resize(robots_.size());
  const VectorXd none;
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    const bool wanted = by_end[r] && robots_[r].robot->is_driven();
    if (!flights[r].is_known || flights[r].by_end != wanted) {
      const VectorXd& load = loads.empty() ? none : loads[r];
      flights[r] = wanted ? flight_by_end(r, span, load) : flight_of(r, span, load);
    }
  }
}

void IslandRobots::set(const std::vector<RobotFlight>& flights, ContactProblem& problem) const {
  problem.mechanisms.clear();
  problem.drives.clear();
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    const Robot& robot = robots_[r];
    const RobotFlight& flight = flights[r];
    const VectorXd velocities = flight.of_contacts.size() > 0
                                    ? VectorXd(flight.velocities - flight.of_contacts)
                                    : flight.velocities;
    for (std::size_t k = 0; k < robot.links.size(); ++k) {
      ContactBody& body = problem.bodies[robot.links[k].member];
      const Eigen::Matrix<double, 6, 1> V = flight.J[k] * velocities;
      body.v = V.head<3>();
      body.w = V.tail<3>();
      body.link = MechanismLink{r, flight.J[k]};
    }
    problem.mechanisms.push_back({flight.inverse_mass, velocities});
    for (JointDrive drive : flight.drives) {
      drive.mechanism = r;
      problem.drives.push_back(drive);
    }
  }
}

}  // namespace firstcontact::detail
