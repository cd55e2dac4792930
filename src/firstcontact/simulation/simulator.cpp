#include <firstcontact/simulation/simulator.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include <firstcontact/scene/links_as_bodies.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/simulation_duration.h>
#include <firstcontact/scene/version.h>
#include <firstcontact/simulation/detail/advance_step.h>
#include <firstcontact/simulation/detail/island_threads.h>
#include <firstcontact/simulation/detail/simulation_state.h>
#include <firstcontact/simulation_model/detail/island_robots.h>
#include <firstcontact/simulation_model/detail/meeting.h>
#include <firstcontact/simulation_model/detail/script.h>
#include <firstcontact/simulation_model/detail/sim_body.h>
#include <firstcontact/simulation_model/detail/sim_robot.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>
#include <firstcontact/simulation_model/detail/step_start.h>
#include <firstcontact/simulation_model/detail/wrong_commands.h>

namespace firstcontact {

using detail::beyond_limits;
using detail::BodyKind;
using detail::is_rotation;
using detail::SimBody;
using detail::SimulationModel;
using detail::StepStart;
using detail::wrong_motor;
using detail::wrong_state;
using detail::wrong_surface;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

void require_simulation(const LoadedScene& loaded) {
  const Scene& scene = loaded.scene;
  if (!scene.simulation) {
    throw std::invalid_argument("the scene has no \"simulation\"");
  }
  (void)simulation_step_count(*scene.simulation);
  for (const Body& body : scene.bodies) {
    if (std::holds_alternative<VertexMotion>(body.motion)) {
      throw std::invalid_argument("body \"" + body.name +
                                  "\": a deforming body is not simulated; leave it out");
    }
  }
}

/// Whether numbers are finite, and so small that products of lengths do not overflow: as in scenes.
bool is_in_range(const Vector3d& v) { return v.cwiseAbs().maxCoeff() <= 1e60 && !v.hasNaN(); }

/// Refuses a command with a defect.
///
/// @throws std::invalid_argument unless nothing is wrong
void require_right(const char* call, const std::string& wrong) {
  if (!wrong.empty()) {
    throw std::invalid_argument(std::string(call) + ": " + wrong);
  }
}

}  // namespace

class Simulator::Implementation {
 public:
  explicit Implementation(const LoadedScene& loaded)
      : linked_((require_simulation(loaded), links_as_bodies(loaded))),
        loaded_(linked_.loaded),
        model_(loaded, linked_),
        script_(linked_, model_) {
    const Scene& scene = loaded_.scene;
    header_ = {.scene = loaded.scene, .version = version(), .input_digest = loaded.input_digest};
    header_.scene.simulation->contact_distance = model_.distances.least;
    std::ranges::copy(
        detail::check_contact_distance(model_.distances.least, loaded_, model_.bodies),
        std::back_inserter(linked_.loaded.warnings));
    for (const detail::SimRobot& robot : model_.robots) {
      state_.robots.push_back(robot.start);
    }
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
      const SimBody& body = model_.bodies[b];
      const bool is_free = body.kind == BodyKind::free;
      header_.masses.push_back(!is_free         ? 0.0
                               : body.link_body ? scene.bodies[b].free->mass.value()
                                                : body.inertia.mass);
      header_.centres_of_mass.push_back(body.inertia.p_BC);
      RigidState state{.X_WB = loaded_.bodies.motion(b).pose(0.0)};
      if (is_free && !body.link_body) {
        state.v_WC = scene.bodies[b].free->linear_velocity;
        state.w_WB = scene.bodies[b].free->angular_velocity;
        lock(body.inertia, state);
      }
      state_.states.push_back(state);
    }
    state_.rests.assign(state_.states.size(), false);
    state_.behind.assign(state_.states.size(), 0.0);
    follow_robots(state_.states);
    require_apart({}, state_.states, [](std::size_t) { return true; });
  }

  const RunHeader& header() const { return header_; }
  const LoadedScene& loaded() const { return loaded_; }
  double time() const { return state_.time; }
  std::size_t step_count() const { return state_.count; }
  const std::vector<RigidState>& states() const { return state_.states; }

  void set_state(std::size_t body, const RigidState& state) {
    if (body >= state_.states.size() || model_.bodies[body].kind != BodyKind::free) {
      throw std::invalid_argument("set_state: body " + std::to_string(body) + " is not free");
    }
    if (model_.bodies[body].link_body) {
      throw std::invalid_argument("set_state: body " + std::to_string(body) +
                                  " is a link; move its robot");
    }
    if (!is_in_range(state.X_WB.position) || !state.X_WB.rotation.coeffs().allFinite() ||
        !is_rotation(state.X_WB.rotation.coeffs()) || !is_in_range(state.v_WC) ||
        !is_in_range(state.w_WB)) {
      throw std::invalid_argument(
          "set_state: numbers must be finite and at most 1e60 in size, and the length of the "
          "quaternion not zero nor beyond doubles");
    }
    std::vector<RigidState> states = state_.states;
    states[body] = state;
    states[body].X_WB.rotation.normalize();
    lock(model_.bodies[body].inertia, states[body]);
    require_apart("set_state", states, [body](std::size_t b) { return b == body; });
    require_tied("set_state", states);
    state_.states = std::move(states);
    state_.rests.assign(state_.states.size(), false);  // A body that it held may fall.
  }

  const std::vector<MechanismState>& robot_states() const { return state_.robots; }

  void set_robot_state(std::size_t robot, const MechanismState& state) {
    if (robot >= state_.robots.size()) {
      throw std::invalid_argument("set_robot_state: there is no robot " + std::to_string(robot) +
                                  " with dynamics");
    }
    const Mechanism& mechanism = model_.robots[robot].mechanism;
    std::string wrong = wrong_state(mechanism, state);
    if (wrong.empty()) {
      wrong = beyond_limits(model_.robots[robot], state.positions);
    }
    if (!wrong.empty()) {
      throw std::invalid_argument("set_robot_state: " + wrong);
    }
    try {
      mechanism.require_mass(mechanism.moved(state.positions, VectorXd::Zero(mechanism.size())));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(std::string("set_robot_state: ") + error.what());
    }
    std::vector<MechanismState> robots = state_.robots;
    // A displacement of zero makes quaternions unit ones.
    robots[robot] = {mechanism.moved(state.positions, VectorXd::Zero(mechanism.size())),
                     state.velocities};
    std::swap(robots, state_.robots);
    std::vector<RigidState> states = state_.states;
    try {
      follow_robots(states);
      require_apart("set_robot_state", states, [&](std::size_t b) {
        return model_.bodies[b].link_body && model_.bodies[b].link_body->robot == robot;
      });
      require_tied("set_robot_state", states);
    } catch (...) {
      state_.robots = std::move(robots);
      throw;
    }
    state_.states = std::move(states);
    state_.rests.assign(state_.states.size(), false);
  }

  void apply_force(std::size_t body, const Vector3d& force, const Vector3d& torque,
                   const std::optional<Vector3d>& p_WP) {
    require_free("apply_force", body);
    const Vector3d p_WC = centre_of_mass(model_.bodies[body].inertia, state_.states[body].X_WB);
    const Vector3d about_C = torque + (p_WP.value_or(p_WC) - p_WC).cross(force);
    if (!is_in_range(force) || !is_in_range(about_C)) {
      throw std::invalid_argument("apply_force: numbers must be finite and at most 1e60 in size");
    }
    applied_.push_back(body);
    model_.bodies[body].forces.push_back({.from = -std::numeric_limits<double>::infinity(),
                                          .to = std::numeric_limits<double>::infinity(),
                                          .force = force,
                                          .torque = about_C});
    state_.rests[body] = false;  // Wakes all bodies that it touches.
  }

  void set_motor(std::size_t robot, std::string_view joint, const JointMotor& motor) {
    detail::JointLaw& law = law_of("set_motor", robot, joint);
    require_right("set_motor", wrong_motor(motor));
    // A new law: nothing of the former motor's target stays.
    law = detail::JointLaw{.position = law.position,
                           .velocity = law.velocity,
                           .limits = law.limits,
                           .damping = law.damping,
                           .friction = law.friction,
                           .motor = motor};
    wake();
  }

  std::optional<JointMotor> motor(std::size_t robot, std::string_view joint) {
    return law_of("motor", robot, joint).motor;
  }

  void set_gravity(const Vector3d& gravity) {
    if (!is_in_range(gravity)) {
      throw std::invalid_argument("set_gravity: numbers must be finite and at most 1e60 in size");
    }
    if (gravity != model_.gravity) {
      model_.gravity = gravity;
      wake();
    }
  }

  void set_surface(std::size_t body, const Surface& surface) {
    require_body("set_surface", body);
    require_right("set_surface", wrong_surface(surface));
    model_.laws.set_surface(body, surface);
    wake();
  }

  void set_pair_surface(const BodyPair& bodies, const Surface& surface) {
    require_body("set_pair_surface", bodies[0]);
    require_body("set_pair_surface", bodies[1]);
    if (bodies[0] == bodies[1]) {
      throw std::invalid_argument("set_pair_surface: expected two bodies, got one twice");
    }
    require_right("set_pair_surface",
                  surface.velocity ? "a pair has no velocity" : wrong_surface(surface));
    model_.laws.set_pair_surface(bodies, surface);
    wake();
  }

  void set_threads(int threads) {
    if (threads < 0) {
      throw std::invalid_argument("set_threads: a number of threads must not be negative");
    }
    threads_ = std::make_unique<detail::IslandThreads>(threads);
  }

  void resume(const RunStep& step) {
    std::vector<MechanismState> robots = robots_of(step);
    std::vector<RigidState> states = state_.states;
    std::size_t moving = 0;
    for (const RunBody& body : step.bodies) {
      if (body.body >= states.size() || model_.bodies[body.body].kind == BodyKind::fixed) {
        throw std::invalid_argument("the step is of another scene: it moves body " +
                                    std::to_string(body.body));
      }
      states[body.body] = {body.X_WB, body.linear_velocity, body.angular_velocity};
      ++moving;
    }
    if (moving != moving_bodies()) {
      throw std::invalid_argument("the step is of another scene: it moves " +
                                  std::to_string(moving) + " bodies, not " +
                                  std::to_string(moving_bodies()));
    }
    forget_forces();
    state_.states = std::move(states);
    state_.robots = std::move(robots);
    state_.time = step.time;
    state_.count = step.index;
    state_.is_stuck = detail::is_lost(step);
    for (const RunBody& body : step.bodies) {
      state_.rests[body.body] = body.rests;
      state_.behind[body.body] = body.behind;
    }
    state_.contacts = step.contacts;
    state_.contacts_lasted = step.lasted;
    state_.ties = step.ties;
  }

  std::optional<RunStep> step(const std::stop_token& stop) {
    detail::SimulationState before = state_;
    std::optional<RunStep> done;
    try {
      done =
          detail::advance_step(model_, script_, *loaded_.scene.simulation, *threads_, stop, state_);
    } catch (...) {
      state_ = std::move(before);
      throw;
    }
    if (done) {
      end_forces(*done);
    } else {
      state_ = std::move(before);
    }
    return done;
  }

 private:
  void require_body(const char* call, std::size_t body) const {
    if (body >= model_.bodies.size()) {
      throw std::invalid_argument(std::string(call) + ": there is no body " + std::to_string(body));
    }
  }

  void require_free(const char* call, std::size_t body) const {
    require_body(call, body);
    if (model_.bodies[body].kind != BodyKind::free) {
      throw std::invalid_argument(std::string(call) + ": body " + std::to_string(body) +
                                  " is not free");
    }
  }

  void require_tied(const char* call, const std::vector<RigidState>& states) const {
    require_right(call, detail::wrong_ties(
                            model_.ties, [&](std::size_t b) { return states[b].X_WB; },
                            model_.distances.least,
                            [&](std::size_t b) { return loaded_.scene.bodies[b].name; }));
  }

  detail::JointLaw& law_of(const char* call, std::size_t robot, std::string_view joint) {
    if (robot >= model_.robots.size()) {
      throw std::invalid_argument(std::string(call) + ": there is no robot " +
                                  std::to_string(robot) + " with dynamics");
    }
    detail::SimRobot& found = model_.robots[robot];
    const auto joints = linked_.models[found.number].joints();
    for (const MechanismJoint& block : found.mechanism.joints()) {
      if (block.joint < joints.size() && joints[block.joint].name == joint &&
          block.positions == 1) {
        return *std::ranges::find(found.laws, block.velocity, &detail::JointLaw::velocity);
      }
    }
    throw std::invalid_argument(std::string(call) + ": robot \"" + found.name +
                                "\" has no joint of one coordinate that is named \"" +
                                std::string(joint) + '"');
  }

  /// Wakes all bodies: a body that was held may move.
  void wake() { state_.rests.assign(state_.states.size(), false); }

  /// Wakes bodies that came to rest under a force that ends, also for a run that is resumed here.
  void end_forces(RunStep& done) {
    for (const std::size_t b : applied_) {
      state_.rests[b] = false;
      std::ranges::find(done.bodies, b, &RunBody::body)->rests = false;
    }
    forget_forces();
  }

  /// Removes the forces that are for the next step alone.
  void forget_forces() {
    for (const std::size_t b : applied_) {
      model_.bodies[b].forces.pop_back();
    }
    applied_.clear();
  }

  static void lock(const Inertia& inertia, RigidState& state) {
    for (int k = 0; k < 3; ++k) {
      state.v_WC[k] = inertia.locked_translation[k] ? 0.0 : state.v_WC[k];
      state.w_WB[k] = inertia.locked_rotation[k] ? 0.0 : state.w_WB[k];
    }
  }

  /// The states of the robots in a step of a run of this scene.
  [[nodiscard]] std::vector<MechanismState> robots_of(const RunStep& step) const {
    std::vector<MechanismState> robots;
    for (std::size_t k = 0; k < model_.robots.size() && k < step.robots.size(); ++k) {
      const RunRobot& recorded = step.robots[k];
      robots.push_back(
          {Eigen::Map<const Eigen::VectorXd>(recorded.positions.data(),
                                             static_cast<Eigen::Index>(recorded.positions.size())),
           Eigen::Map<const Eigen::VectorXd>(
               recorded.velocities.data(), static_cast<Eigen::Index>(recorded.velocities.size()))});
      const Mechanism& mechanism = model_.robots[k].mechanism;
      if (recorded.robot != model_.robots[k].number ||
          !wrong_state(mechanism, robots.back()).empty()) {
        throw std::invalid_argument("the step is of another scene: its robots have other joints");
      }
    }
    if (step.robots.size() != model_.robots.size()) {
      throw std::invalid_argument("the step is of another scene: it moves " +
                                  std::to_string(step.robots.size()) + " robots, not " +
                                  std::to_string(model_.robots.size()));
    }
    return robots;
  }

  /// Moves the link bodies to the places of their joints.
  void follow_robots(std::vector<RigidState>& states) const {
    std::vector<std::size_t> pieces;
    for (std::size_t b = 0; b < states.size(); ++b) {
      if (model_.bodies[b].link_body) {
        pieces.push_back(b);
      }
    }
    const StepStart start{.robots = state_.robots};
    const detail::IslandRobots robots(model_, start, pieces);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      states[pieces[k]] = robots.state(k);
    }
  }

  [[nodiscard]] std::size_t moving_bodies() const {
    return static_cast<std::size_t>(std::ranges::count_if(
        model_.bodies, [](const SimBody& body) { return body.kind != BodyKind::fixed; }));
  }

  /// Throws std::invalid_argument where a pair meets of which `concerns` is true for a body.
  ///
  /// @param call  the call that moves bodies there; empty: they start there
  void require_apart(const std::string& call, const std::vector<RigidState>& states,
                     const std::function<bool(std::size_t)>& concerns) {
    if (const auto pair = detail::find_meeting(model_, states, concerns, threads_->workspace())) {
      const auto& bodies = loaded_.scene.bodies;
      throw std::invalid_argument((call.empty() ? "" : call + ": ") + "bodies \"" +
                                  bodies[(*pair)[0]].name + "\" and \"" + bodies[(*pair)[1]].name +
                                  "\" meet " + (call.empty() ? "at the start" : "there") +
                                  "; move them apart, or ignore the pair in \"pairs\"");
    }
  }

  LinksAsBodies linked_;
  const LoadedScene& loaded_;  // With links as bodies.
  SimulationModel model_;
  detail::Script script_;
  RunHeader header_;
  detail::SimulationState state_;
  std::vector<std::size_t> applied_;  // Bodies whose last forces are for the next step alone.
  std::unique_ptr<detail::IslandThreads> threads_ = std::make_unique<detail::IslandThreads>(0);
};

Simulator::Simulator(const LoadedScene& loaded)
    : implementation_(std::make_unique<Implementation>(loaded)) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

const RunHeader& Simulator::header() const { return implementation_->header(); }
const LoadedScene& Simulator::loaded() const { return implementation_->loaded(); }
double Simulator::time() const { return implementation_->time(); }
std::size_t Simulator::step_count() const { return implementation_->step_count(); }
const std::vector<RigidState>& Simulator::states() const { return implementation_->states(); }
const std::vector<MechanismState>& Simulator::robot_states() const {
  return implementation_->robot_states();
}
void Simulator::set_robot_state(std::size_t robot, const MechanismState& state) {
  implementation_->set_robot_state(robot, state);
}
void Simulator::set_state(std::size_t body, const RigidState& state) {
  implementation_->set_state(body, state);
}
void Simulator::apply_force(std::size_t body, const Vector3d& force, const Vector3d& torque,
                            const std::optional<Vector3d>& p_WP) {
  implementation_->apply_force(body, force, torque, p_WP);
}
void Simulator::set_motor(std::size_t robot, std::string_view joint, const JointMotor& motor) {
  implementation_->set_motor(robot, joint, motor);
}
std::optional<JointMotor> Simulator::motor(std::size_t robot, std::string_view joint) const {
  return implementation_->motor(robot, joint);
}
void Simulator::set_gravity(const Vector3d& gravity) { implementation_->set_gravity(gravity); }
void Simulator::set_surface(std::size_t body, const Surface& surface) {
  implementation_->set_surface(body, surface);
}
void Simulator::set_pair_surface(const BodyPair& bodies, const Surface& surface) {
  implementation_->set_pair_surface(bodies, surface);
}
void Simulator::set_threads(int threads) { implementation_->set_threads(threads); }
void Simulator::resume(const RunStep& step) { implementation_->resume(step); }
std::optional<RunStep> Simulator::step(const std::stop_token& stop) {
  return implementation_->step(stop);
}

}  // namespace firstcontact
