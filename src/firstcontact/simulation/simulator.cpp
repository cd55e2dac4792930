#include <firstcontact/simulation/simulator.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include <firstcontact/geometry/detail/overlap_tree.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/scene/simulation_duration.h>
#include <firstcontact/scene/version.h>
#include <firstcontact/simulation/detail/islands.h>

namespace firstcontact {

using detail::BodyKind;
using detail::IslandTrack;
using detail::Move;
using detail::Rest;
using detail::SimBody;
using detail::StepStart;
using detail::Touch;
using detail::TrackPiece;
using detail::World;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// Poses are rounded where a piece begins, and a cut piece has rounded rates: the exact motion that
/// was proven free and the recorded one differ by less than this part of the sizes involved.
constexpr double kRounding = 0x1p-46;

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

/// The order of contacts in a step.
bool comes_before(const RunContact& x, const RunContact& y) {
  const auto key = [](const RunContact& c) {
    return std::tuple(c.bodies, c.feature_A.type, c.feature_A.index, c.feature_B.type,
                      c.feature_B.index);
  };
  return key(x) < key(y);
}

/// Of a pair that touches at more places, as a nut on its thread does at thousands, only those that
/// press are recorded.
constexpr std::ptrdiff_t kManyOfPair = 100;

/// @param contacts  sorted
std::vector<RunContact> without_idle(const std::vector<RunContact>& contacts) {
  std::vector<RunContact> kept;
  for (auto first = contacts.begin(); first != contacts.end();) {
    const auto end = std::find_if(first, contacts.end(),
                                  [&](const RunContact& c) { return c.bodies != first->bodies; });
    const bool are_many = end - first > kManyOfPair;
    std::copy_if(first, end, std::back_inserter(kept), [&](const RunContact& contact) {
      return !are_many || !contact.impulse.isZero(0.0);
    });
    first = end;
  }
  return kept;
}

/// Whether a quaternion can be made a unit one.
bool is_rotation(const Eigen::Vector4d& q) { return q.norm() > 0.0 && std::isfinite(q.norm()); }

/// What keeps a mechanism from being in a state; empty if nothing does.
std::string wrong_state(const Mechanism& mechanism, const MechanismState& state) {
  if (state.positions.size() != mechanism.position_count() ||
      state.velocities.size() != mechanism.size() || !state.positions.allFinite() ||
      !state.velocities.allFinite()) {
    return "expected " + std::to_string(mechanism.position_count()) + " positions and " +
           std::to_string(mechanism.size()) + " velocities, all finite";
  }
  for (const MechanismJoint& joint : mechanism.joints()) {
    const std::optional<Eigen::Index> at = joint.quaternion();
    if (at && !is_rotation(state.positions.segment<4>(*at))) {
      return "positions " + std::to_string(*at) + " to " + std::to_string(*at + 3) +
             " are a quaternion, which must not be zero";
    }
  }
  return {};
}

/// The rotation vector over a part of a motion: of one piece with all its turns, over several by
/// the shortest way.
Vector3d rotation_between(const Motion& motion, double from, double to) {
  const auto breaks = motion.breaks();
  const auto piece = static_cast<std::size_t>(
      std::upper_bound(breaks.begin() + 1, breaks.end() - 1, from) - breaks.begin() - 1);
  if (to <= breaks[piece + 1]) {
    const ConstantRatePath path = motion.path(piece, Vector3d::Zero());
    return path.axis() * (path.rate() * (to - from));
  }
  const Eigen::AngleAxisd turn(motion.pose(to).rotation * motion.pose(from).rotation.conjugate());
  return turn.angle() * turn.axis();
}

}  // namespace

class Simulator::Implementation {
 public:
  explicit Implementation(const LoadedScene& loaded)
      : linked_((require_simulation(loaded), links_as_bodies(loaded))),
        loaded_(linked_.loaded),
        world_(loaded, linked_) {
    const Scene& scene = loaded_.scene;
    header_ = {.scene = loaded.scene, .version = version(), .input_digest = loaded.input_digest};
    header_.scene.simulation->contact_distance = world_.distances.least;
    for (const detail::SimRobot& robot : world_.robots) {
      robots_.push_back(robot.start);
    }
    for (std::size_t b = 0; b < world_.bodies.size(); ++b) {
      const SimBody& body = world_.bodies[b];
      const bool is_free = body.kind == BodyKind::free;
      header_.masses.push_back(!is_free     ? 0.0
                               : body.piece ? scene.bodies[b].free->mass.value()
                                            : body.inertia.mass);
      header_.centres_of_mass.push_back(body.inertia.p_BC);
      RigidState state{.X_WB = loaded_.bodies.motion(b).pose(0.0)};
      if (is_free && !body.piece) {
        state.v_WC = scene.bodies[b].free->linear_velocity;
        state.w_WB = scene.bodies[b].free->angular_velocity;
        lock(body.inertia, state);
      }
      states_.push_back(state);
    }
    rests_.assign(states_.size(), false);
    follow_robots(states_);
    require_apart(states_, [](std::size_t) { return true; });
  }

  const RunHeader& header() const { return header_; }
  const LoadedScene& loaded() const { return loaded_; }
  double time() const { return time_; }
  std::size_t step_count() const { return count_; }
  const std::vector<RigidState>& states() const { return states_; }

  void set_state(std::size_t body, const RigidState& state) {
    if (body >= states_.size() || world_.bodies[body].kind != BodyKind::free) {
      throw std::invalid_argument("set_state: body " + std::to_string(body) + " is not free");
    }
    if (world_.bodies[body].piece) {
      throw std::invalid_argument("set_state: body " + std::to_string(body) +
                                  " is a link; move its robot");
    }
    if (!state.X_WB.position.allFinite() || !state.X_WB.rotation.coeffs().allFinite() ||
        !is_rotation(state.X_WB.rotation.coeffs()) || !state.v_WC.allFinite() ||
        !state.w_WB.allFinite()) {
      throw std::invalid_argument("set_state: numbers must be finite, and the quaternion not zero");
    }
    std::vector<RigidState> states = states_;
    states[body] = state;
    states[body].X_WB.rotation.normalize();
    lock(world_.bodies[body].inertia, states[body]);
    require_apart(states, [body](std::size_t b) { return b == body; });
    states_ = std::move(states);
    rests_.assign(states_.size(), false);  // What it held may fall.
  }

  const std::vector<MechanismState>& robot_states() const { return robots_; }

  void set_robot_state(std::size_t robot, const MechanismState& state) {
    if (robot >= robots_.size()) {
      throw std::invalid_argument("set_robot_state: there is no robot " + std::to_string(robot) +
                                  " with dynamics");
    }
    const Mechanism& mechanism = world_.robots[robot].mechanism;
    const std::string wrong = wrong_state(mechanism, state);
    if (!wrong.empty()) {
      throw std::invalid_argument("set_robot_state: " + wrong);
    }
    std::vector<MechanismState> robots = robots_;
    // A displacement of zero makes quaternions unit ones.
    robots[robot] = {mechanism.moved(state.positions, VectorXd::Zero(mechanism.size())),
                     state.velocities};
    std::swap(robots, robots_);
    std::vector<RigidState> states = states_;
    try {
      follow_robots(states);
      require_apart(states, [&](std::size_t b) {
        return world_.bodies[b].piece && world_.bodies[b].piece->robot == robot;
      });
    } catch (...) {
      robots_ = std::move(robots);
      throw;
    }
    states_ = std::move(states);
    rests_.assign(states_.size(), false);
  }

  void resume(const RunStep& step) {
    std::vector<MechanismState> robots = robots_of(step);
    std::vector<RigidState> states = states_;
    std::size_t moving = 0;
    for (const RunBody& body : step.bodies) {
      if (body.body >= states.size() || world_.bodies[body.body].kind == BodyKind::fixed) {
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
    states_ = std::move(states);
    robots_ = std::move(robots);
    time_ = step.time;
    count_ = step.index;
    for (const RunBody& body : step.bodies) {
      rests_[body.body] = body.rests;
    }
    contacts_ = step.contacts;
  }

  std::optional<RunStep> step(const std::stop_token& stop) {
    const StepStart start = step_start();
    std::optional<std::vector<IslandTrack>> tracks =
        detail::advance_islands(world_, start, guesses(), workspace_, stop);
    if (!tracks) {
      return std::nullopt;
    }
    double lasted = start.h;
    for (const IslandTrack& track : *tracks) {
      lasted = std::min(lasted, track.reached);
    }
    RunStep step = record(start, *tracks, lasted);
    add_contacts(*tracks, step);
    contacts_ = step.contacts;
    time_ = step.time;
    count_ = step.index;
    return step;
  }

 private:
  /// Touches of the step before, as a record of it has them: runs that are resumed go on alike.
  [[nodiscard]] std::vector<Touch> guesses() const {
    std::vector<Touch> touches;
    touches.reserve(contacts_.size());
    for (const RunContact& contact : contacts_) {
      touches.push_back({.bodies = contact.bodies,
                         .feature_A = contact.feature_A,
                         .feature_B = contact.feature_B,
                         .point = contact.point,
                         .normal = contact.normal,
                         .impulse = contact.impulse});
    }
    return touches;
  }

  /// Those of bodies that stay at rest are those of the step before.
  void add_contacts(const std::vector<IslandTrack>& tracks, RunStep& step) const {
    std::vector<bool> stays(states_.size(), false);
    std::vector<Touch> touches;
    for (const IslandTrack& track : tracks) {
      if (track.rests == Rest::goes_on) {
        for (const std::size_t b : track.members) {
          stays[b] = true;
        }
      }
      touches.insert(touches.end(), track.touches.begin(), track.touches.end());
    }
    for (const RunContact& contact : contacts_) {
      if (stays[contact.bodies[0]] || stays[contact.bodies[1]]) {
        step.contacts.push_back(contact);
      }
    }
    for (const Touch& touch : touches) {
      step.contacts.push_back({touch.bodies, touch.feature_A, touch.feature_B, touch.point,
                               touch.normal, touch.gap + world_.laws.margin(touch.bodies).value(),
                               touch.impulse});
    }
    std::ranges::stable_sort(step.contacts, comes_before);
    step.contacts = without_idle(step.contacts);
  }

  static void lock(const Inertia& inertia, RigidState& state) {
    for (int k = 0; k < 3; ++k) {
      state.v_WC[k] = inertia.locked_translation[k] ? 0.0 : state.v_WC[k];
      state.w_WB[k] = inertia.locked_rotation[k] ? 0.0 : state.w_WB[k];
    }
  }

  /// Of a step of a run of this scene.
  [[nodiscard]] std::vector<MechanismState> robots_of(const RunStep& step) const {
    std::vector<MechanismState> robots;
    for (std::size_t k = 0; k < world_.robots.size() && k < step.robots.size(); ++k) {
      const RunRobot& recorded = step.robots[k];
      robots.push_back(
          {Eigen::Map<const Eigen::VectorXd>(recorded.positions.data(),
                                             static_cast<Eigen::Index>(recorded.positions.size())),
           Eigen::Map<const Eigen::VectorXd>(
               recorded.velocities.data(), static_cast<Eigen::Index>(recorded.velocities.size()))});
      const Mechanism& mechanism = world_.robots[k].mechanism;
      if (recorded.robot != world_.robots[k].number ||
          !wrong_state(mechanism, robots.back()).empty()) {
        throw std::invalid_argument("the step is of another scene: its robots have other joints");
      }
    }
    if (step.robots.size() != world_.robots.size()) {
      throw std::invalid_argument("the step is of another scene: it moves " +
                                  std::to_string(step.robots.size()) + " robots, not " +
                                  std::to_string(world_.robots.size()));
    }
    return robots;
  }

  /// Puts the pieces of links where their joints have them.
  void follow_robots(std::vector<RigidState>& states) const {
    std::vector<std::size_t> pieces;
    for (std::size_t b = 0; b < states.size(); ++b) {
      if (world_.bodies[b].piece) {
        pieces.push_back(b);
      }
    }
    const StepStart start{.robots = robots_};
    const detail::IslandRobots robots(world_, start, pieces);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      states[pieces[k]] = robots.state(k);
    }
  }

  [[nodiscard]] std::size_t moving_bodies() const {
    return static_cast<std::size_t>(std::ranges::count_if(
        world_.bodies, [](const SimBody& body) { return body.kind != BodyKind::fixed; }));
  }

  /// All pairs with a body that `concerns` says yes to.
  template <class Concerns>
  void require_apart(const std::vector<RigidState>& states, const Concerns& concerns) {
    std::vector<Eigen::AlignedBox3d> boxes;
    const Vector3d slack = Vector3d::Constant(0.5 * world_.laws.greatest_margin());
    for (std::size_t b = 0; b < states.size(); ++b) {
      const Eigen::AlignedBox3d box = detail::swept_box(world_.bodies[b], states[b].X_WB, {});
      boxes.emplace_back(box.min() - slack, box.max() + slack);
    }
    for (const auto& [a, b] : detail::overlapping_pairs(boxes)) {
      const bool is_held =
          world_.bodies[a].kind != BodyKind::free && world_.bodies[b].kind != BodyKind::free;
      const std::optional<double> margin = world_.laws.margin({a, b});
      if (is_held || !margin || !(concerns(a) || concerns(b))) {
        continue;
      }
      const Motion A = Motion::fixed(states[a].X_WB);
      const Motion B = Motion::fixed(states[b].X_WB);
      const DistanceResult found =
          distance({world_.bodies[a].shape, A}, {world_.bodies[b].shape, B}, 0.0, workspace_);
      if (!(found.lower_bound > *margin)) {
        const auto& bodies = loaded_.scene.bodies;
        throw std::invalid_argument("bodies \"" + bodies[a].name + "\" and \"" + bodies[b].name +
                                    "\" meet at the start; move them apart, or ignore the pair in "
                                    "\"pairs\"");
      }
    }
  }

  [[nodiscard]] StepStart step_start() {
    const Simulation& simulation = *loaded_.scene.simulation;
    StepStart start{
        .time = time_, .h = simulation.step, .states = states_, .robots = robots_, .rests = rests_};
    start.scripted.resize(states_.size());
    for (std::size_t b = 0; b < states_.size(); ++b) {
      if (world_.bodies[b].kind != BodyKind::scripted) {
        continue;
      }
      const Motion& motion = loaded_.bodies.motion(b);
      const double from = std::min(1.0, time_ / loaded_.scene.duration);
      const double to = std::min(1.0, (time_ + start.h) / loaded_.scene.duration);
      start.scripted[b] = {motion.pose(to).position - states_[b].X_WB.position,
                           rotation_between(motion, from, to)};
    }
    return start;
  }

  /// The track of a body until `lasted`, as a run has it. Moves the body's state there.
  RunBody recorded(std::size_t b, const std::vector<TrackPiece>& pieces, double lasted) {
    RunBody body{.body = b};
    RigidState& state = states_[b];
    const RigidState begin = state;
    double from = 0.0;
    for (const TrackPiece& piece : pieces) {
      const double share =
          piece.to <= lasted ? 1.0 : std::max(0.0, (lasted - from) / (piece.to - from));
      if (share < 1.0) {
        const Motion motion = detail::motion_of(world_.bodies[b], piece.X_WB, piece.move);
        state.X_WB = motion.pose(share);
        state.X_WB.rotation.normalize();
        state.v_WC = piece.begin.v_WC + share * (piece.end.v_WC - piece.begin.v_WC);
        state.w_WB = piece.begin.w_WB + share * (piece.end.w_WB - piece.begin.w_WB);
      } else {
        state = piece.end;
      }
      const Move move = share < 1.0 ? piece.move.part(share) : piece.move;
      body.pieces.push_back(
          {std::min(piece.to, lasted), piece.X_WB, move.translation, move.rotation_vector});
      from = piece.to;
      if (from >= lasted) {
        break;
      }
    }
    if (body.pieces.empty()) {
      body.pieces.push_back({lasted, begin.X_WB});
    }
    body.X_WB = state.X_WB;
    body.linear_velocity = state.v_WC;
    body.angular_velocity = state.w_WB;
    return body;
  }

  RunBody recorded_script(std::size_t b, const StepStart& start, double lasted) {
    const double share = lasted / start.h;
    const Move move = start.scripted[b].part(share);
    RunBody body{.body = b};
    body.pieces.push_back({lasted, start.states[b].X_WB, move.translation, move.rotation_vector});
    RigidState& state = states_[b];
    state.X_WB = detail::scripted_pose(world_, start, b, share);
    state.X_WB.rotation.normalize();
    state.v_WC = start.scripted[b].translation / start.h;
    state.w_WB = start.scripted[b].rotation_vector / start.h;
    body.X_WB = state.X_WB;
    body.linear_velocity = state.v_WC;
    body.angular_velocity = state.w_WB;
    return body;
  }

  /// Moves the state of a robot to where it is at `lasted`.
  ///
  /// @returns  [N m s or N s]  of its motors until then, on each coordinate
  VectorXd follow(const detail::RobotTrack& track, double lasted) {
    MechanismState& state = robots_[track.robot];
    VectorXd impulses = VectorXd::Zero(state.velocities.size());
    double from = 0.0;
    for (const detail::RobotTrackPiece& piece : track.pieces) {
      const double share =
          piece.to <= lasted ? 1.0 : std::max(0.0, (lasted - from) / (piece.to - from));
      if (share == 1.0) {
        state = piece.end;
      } else {
        const Mechanism& mechanism = world_.robots[track.robot].mechanism;
        state = {mechanism.between(piece.begin.positions, piece.end.positions, share),
                 piece.begin.velocities + share * (piece.end.velocities - piece.begin.velocities)};
      }
      impulses += piece.impact + share * piece.motors;
      from = piece.to;
      if (from >= lasted) {
        break;
      }
    }
    return impulses;
  }

  RunStep record(const StepStart& start, const std::vector<IslandTrack>& tracks, double lasted) {
    RunStep step{.index = count_ + 1,
                 .time = time_ + lasted,
                 .lasted = lasted,
                 .time_lost = start.h - lasted};
    step.clearance = world_.distances.least;
    double size = 0.0;
    std::vector<VectorXd> efforts;
    for (const MechanismState& robot : robots_) {
      efforts.emplace_back(VectorXd::Zero(robot.velocities.size()));
    }
    for (const IslandTrack& track : tracks) {
      step.clearance = std::min(step.clearance, track.clearance);
      step.residual = std::max(step.residual, track.residual);
      step.events += track.events;
      std::ranges::copy_if(track.impacts, std::back_inserter(step.impacts),
                           [&](const RunImpact& impact) { return impact.at <= lasted; });
      for (std::size_t k = 0; k < track.members.size(); ++k) {
        RunBody body = recorded(track.members[k], track.pieces[k], lasted);
        body.rests =
            track.rests == Rest::goes_on || (track.rests == Rest::begins && lasted == start.h);
        rests_[body.body] = body.rests;
        step.bodies.push_back(std::move(body));
      }
      for (const detail::RobotTrack& robot : track.robots) {
        const VectorXd impulses = follow(robot, lasted);
        if (lasted > 0.0) {
          efforts[robot.robot] = impulses / lasted;
        }
      }
    }
    for (std::size_t r = 0; r < robots_.size(); ++r) {
      const auto& [positions, velocities] = robots_[r];
      step.robots.push_back({.robot = world_.robots[r].number,
                             .positions = {positions.begin(), positions.end()},
                             .velocities = {velocities.begin(), velocities.end()},
                             .efforts = {efforts[r].begin(), efforts[r].end()}});
    }
    for (std::size_t b = 0; b < states_.size(); ++b) {
      if (world_.bodies[b].kind == BodyKind::scripted) {
        step.bodies.push_back(recorded_script(b, start, lasted));
      }
    }
    std::ranges::sort(step.bodies, {}, &RunBody::body);
    std::ranges::stable_sort(step.impacts, {}, &RunImpact::at);
    for (const RunBody& body : step.bodies) {
      for (const RunPiece& piece : body.pieces) {
        size = std::max(size,
                        piece.X_WB.position.cwiseAbs().maxCoeff() + piece.translation.norm() +
                            world_.bodies[body.body].reach * (1.0 + piece.rotation_vector.norm()));
      }
    }
    step.clearance = std::max(0.0, step.clearance - kRounding * size);
    add_mechanics(step);
    return step;
  }

  void add_mechanics(RunStep& step) const {
    for (std::size_t r = 0; r < robots_.size(); ++r) {
      const MechanismMechanics robot =
          world_.robots[r].mechanism.mechanics(robots_[r], world_.gravity);
      step.kinetic_energy += robot.kinetic_energy;
      step.potential_energy += robot.potential_energy;
      step.linear_momentum += robot.linear_momentum;
      step.angular_momentum += robot.angular_momentum;
    }
    for (std::size_t b = 0; b < states_.size(); ++b) {
      const SimBody& body = world_.bodies[b];
      if (body.kind != BodyKind::free || body.piece) {
        continue;
      }
      const RigidState& state = states_[b];
      const Vector3d p_WC = centre_of_mass(body.inertia, state.X_WB);
      const Vector3d momentum = body.inertia.mass * state.v_WC;
      step.kinetic_energy += kinetic_energy(body.inertia, state);
      step.potential_energy -= body.inertia.mass * world_.gravity.dot(p_WC);
      step.linear_momentum += momentum;
      step.angular_momentum +=
          p_WC.cross(momentum) + rotational_inertia(body.inertia, state.X_WB) * state.w_WB;
    }
  }

  LinksAsBodies linked_;
  const LoadedScene& loaded_;  // With links as bodies.
  World world_;
  RunHeader header_;
  std::vector<RigidState> states_;
  std::vector<MechanismState> robots_;
  std::vector<bool> rests_;           // Of each body, since the last step.
  std::vector<RunContact> contacts_;  // Of the last step, sorted.
  double time_ = 0.0;                 // [s]
  std::size_t count_ = 0;
  Workspace workspace_;
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
void Simulator::resume(const RunStep& step) { implementation_->resume(step); }
std::optional<RunStep> Simulator::step(const std::stop_token& stop) {
  return implementation_->step(stop);
}

}  // namespace firstcontact
