#include <firstcontact/simulation/detail/record_step.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <limits>
#include <tuple>
#include <utility>

#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/island/detail/island.h>
#include <firstcontact/simulation/detail/simulation_state.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/island_robots.h>
#include <firstcontact/simulation_model/detail/manifold.h>
#include <firstcontact/simulation_model/detail/move.h>
#include <firstcontact/simulation_model/detail/sim_body.h>
#include <firstcontact/simulation_model/detail/sim_robot.h>
#include <firstcontact/simulation_model/detail/sim_tie.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>
#include <firstcontact/simulation_model/detail/step_start.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// [-]  Most by which the exact motion that was proven free and the recorded one differ, by the
/// sizes involved. Poses are rounded at the begin of a piece, and a cut piece has rounded rates.
constexpr double kRounding = 0x1p-46;

/// The order of contacts in a step.
bool is_listed_before(const RunContact& x, const RunContact& y) {
  const auto key = [](const RunContact& c) {
    return std::tuple(c.bodies, c.feature_A.type, c.feature_A.index, c.feature_B.type,
                      c.feature_B.index);
  };
  return key(x) < key(y);
}

/// The contacts to record: for a pair with many, only those with an impulse.
///
/// @param contacts  sorted
std::vector<RunContact> without_idle(const std::vector<RunContact>& contacts) {
  std::vector<RunContact> kept;
  for (auto first = contacts.begin(); first != contacts.end();) {
    const auto end = std::find_if(first, contacts.end(),
                                  [&](const RunContact& c) { return c.bodies != first->bodies; });
    const bool are_many = end - first > kManyRecordedOfPair;
    std::copy_if(first, end, std::back_inserter(kept), [&](const RunContact& contact) {
      return !are_many || !contact.impulse.isZero(0.0);
    });
    first = end;
  }
  return kept;
}

/// Moves a simulation to the end of a step, and records its way.
class StepRecorder {
 public:
  /// @param lasted  [s]  duration of the step
  StepRecorder(const SimulationModel& model, const StepStart& start, double lasted,
               SimulationState& state)
      : model_(model), start_(start), lasted_(lasted), state_(state) {}

  RunStep record(const std::vector<IslandTrack>& tracks) {
    RunStep step{.index = state_.count + 1,
                 .time = state_.time + lasted_,
                 .lasted = lasted_,
                 .time_lost = start_.h - lasted_};
    // Islands keep near bodies at this distance, whether there are any or not.
    step.clearance =
        model_.has_pairs ? model_.distances.least : std::numeric_limits<double>::infinity();
    add_tracks(tracks, step);
    for (std::size_t b = 0; b < state_.states.size(); ++b) {
      if (model_.bodies[b].kind == BodyKind::scripted) {
        step.bodies.push_back(recorded_script(b));
      }
    }
    std::ranges::sort(step.bodies, {}, &RunBody::body);
    std::ranges::stable_sort(step.impacts, {}, &RunImpact::at);
    step.clearance = std::max(0.0, step.clearance - kRounding * size_of(step));
    add_mechanics(step);
    add_contacts(tracks, step);
    add_ties(tracks, step);
    state_.contacts = step.contacts;
    state_.contacts_lasted = lasted_;
    state_.ties = step.ties;
    state_.time = step.time;
    state_.count = step.index;
    return step;
  }

 private:
  void add_tracks(const std::vector<IslandTrack>& tracks, RunStep& step) {
    std::vector<VectorXd> efforts;
    for (const MechanismState& robot : state_.robots) {
      efforts.emplace_back(VectorXd::Zero(robot.velocities.size()));
    }
    for (const IslandTrack& track : tracks) {
      if (model_.has_pairs) {
        step.clearance = std::min(step.clearance, track.clearance);
      }
      step.residual = std::max(step.residual, track.residual);
      step.events += track.events;
      std::ranges::copy_if(track.impacts, std::back_inserter(step.impacts),
                           [&](const RunImpact& impact) { return impact.at <= lasted_; });
      add_members(track, step);
      for (const RobotTrack& robot : track.robots) {
        const VectorXd impulses = follow(robot);
        if (lasted_ > 0.0) {
          efforts[robot.robot] = impulses / lasted_;
        }
      }
    }
    for (std::size_t r = 0; r < state_.robots.size(); ++r) {
      const auto& [positions, velocities] = state_.robots[r];
      step.robots.push_back({.robot = model_.robots[r].number,
                             .positions = {positions.begin(), positions.end()},
                             .velocities = {velocities.begin(), velocities.end()},
                             .efforts = {efforts[r].begin(), efforts[r].end()}});
    }
  }

  void add_members(const IslandTrack& track, RunStep& step) {
    const bool rests =
        track.rests == Rest::goes_on || (track.rests == Rest::begins && lasted_ == start_.h);
    for (std::size_t k = 0; k < track.members.size(); ++k) {
      RunBody body = recorded(track.members[k], track.pieces[k]);
      body.rests = rests;
      state_.rests[body.body] = rests;
      step.bodies.push_back(std::move(body));
    }
  }

  /// [m]  The greatest coordinate, displacement and reach of a body, summed.
  [[nodiscard]] double size_of(const RunStep& step) const {
    double size = 0.0;
    for (const RunBody& body : step.bodies) {
      for (const RunPiece& piece : body.pieces) {
        size = std::max(size,
                        piece.X_WB.position.cwiseAbs().maxCoeff() + piece.translation.norm() +
                            model_.bodies[body.body].reach * (1.0 + piece.rotation_vector.norm()));
      }
    }
    return size;
  }

  /// Adds the contacts of the step.
  ///
  /// Contacts of bodies that stay at rest keep their forces of the step before, or of its last
  /// part, for the duration of this one.
  void add_contacts(const std::vector<IslandTrack>& tracks, RunStep& step) const {
    const double before = state_.contacts_lasted;
    const double of_rest = before > 0.0 && lasted_ > 0.0 ? lasted_ / before : 1.0;
    std::vector<bool> stays(state_.states.size(), false);
    std::vector<ManifoldPoint> touches;
    for (const IslandTrack& track : tracks) {
      if (track.rests == Rest::goes_on) {
        for (const std::size_t b : track.members) {
          stays[b] = true;
        }
      }
      touches.insert(touches.end(), track.touches.begin(), track.touches.end());
    }
    for (const RunContact& contact : state_.contacts) {
      if (stays[contact.bodies[0]] || stays[contact.bodies[1]]) {
        step.contacts.push_back(contact);
        step.contacts.back().impulse *= of_rest;
      }
    }
    for (const ManifoldPoint& touch : touches) {
      step.contacts.push_back({touch.bodies, touch.feature_A, touch.feature_B, touch.point,
                               touch.normal, touch.gap + model_.laws.margin(touch.bodies).value(),
                               touch.impulse});
    }
    std::ranges::stable_sort(step.contacts, is_listed_before);
    step.contacts = without_idle(step.contacts);
  }

  /// Adds the mean forces of ties; ties of bodies that stay at rest keep those of the step before.
  void add_ties(const std::vector<IslandTrack>& tracks, RunStep& step) const {
    step.ties.resize(model_.ties.size());
    for (const IslandTrack& track : tracks) {
      for (const TieTrackPiece& piece : track.ties) {
        const double share = piece.to <= lasted_
                                 ? 1.0
                                 : std::max(0.0, lasted_ - piece.from) / (piece.to - piece.from);
        if (share > 0.0) {
          step.ties[piece.tie].force += share / lasted_ * piece.linear;
          step.ties[piece.tie].torque += share / lasted_ * piece.angular;
        }
      }
      for (std::size_t k = 0; k < track.members.size() && track.rests == Rest::goes_on &&
                              state_.ties.size() == step.ties.size() && !step.ties.empty();
           ++k) {
        for (const std::size_t t : model_.ties_of[track.members[k]]) {
          step.ties[t] = state_.ties[t];
        }
      }
    }
  }

  /// The track of a body until the end of the step, as a run has it. Moves the body's state there.
  RunBody recorded(std::size_t b, const std::vector<TrackPiece>& pieces) {
    RunBody body{.body = b};
    RigidState& state = state_.states[b];
    const RigidState begin = state;
    double from = 0.0;
    for (const TrackPiece& piece : pieces) {
      const double share =
          piece.to <= lasted_ ? 1.0 : std::max(0.0, (lasted_ - from) / (piece.to - from));
      if (share < 1.0) {
        const Motion motion = motion_of(model_.bodies[b], piece.X_WB, piece.move);
        state.X_WB = motion.pose(share);
        state.X_WB.rotation.normalize();
        state.v_WC = piece.begin.v_WC + share * (piece.end.v_WC - piece.begin.v_WC);
        state.w_WB = piece.begin.w_WB + share * (piece.end.w_WB - piece.begin.w_WB);
      } else {
        state = piece.end;
      }
      const Move move = share < 1.0 ? piece.move.part(share) : piece.move;
      body.pieces.push_back(
          {std::min(piece.to, lasted_), piece.X_WB, move.translation, move.rotation_vector});
      from = piece.to;
      if (from >= lasted_) {
        break;
      }
    }
    if (body.pieces.empty()) {
      body.pieces.push_back({lasted_, begin.X_WB});
    }
    body.X_WB = state.X_WB;
    body.linear_velocity = state.v_WC;
    body.angular_velocity = state.w_WB;
    return body;
  }

  RunBody recorded_script(std::size_t b) {
    const double share = lasted_ / start_.h;
    const Move move = start_.scripted[b].part(share);
    state_.behind[b] += start_.waits[b] ? lasted_ : 0.0;
    RunBody body{.body = b, .behind = state_.behind[b]};
    body.pieces.push_back({lasted_, start_.states[b].X_WB, move.translation, move.rotation_vector});
    RigidState& state = state_.states[b];
    state.X_WB = scripted_pose(model_, start_, b, share);
    state.X_WB.rotation.normalize();
    state.v_WC = start_.scripted[b].translation / start_.h;
    state.w_WB = start_.scripted[b].rotation_vector / start_.h;
    body.X_WB = state.X_WB;
    body.linear_velocity = state.v_WC;
    body.angular_velocity = state.w_WB;
    return body;
  }

  /// Moves the state of a robot to the end of the step.
  ///
  /// @returns [N m s or N s]  impulses of its motors until then, on each coordinate
  VectorXd follow(const RobotTrack& track) {
    MechanismState& state = state_.robots[track.robot];
    VectorXd impulses = VectorXd::Zero(state.velocities.size());
    double from = 0.0;
    for (const RobotTrackPiece& piece : track.pieces) {
      const double share =
          piece.to <= lasted_ ? 1.0 : std::max(0.0, (lasted_ - from) / (piece.to - from));
      if (share == 1.0) {
        state = piece.end;
      } else {
        const Mechanism& mechanism = model_.robots[track.robot].mechanism;
        state =
            part_of_way(mechanism, piece.begin, piece.end, share, model_.gravity, piece.to - from);
      }
      impulses += piece.impact + share * piece.motors;
      from = piece.to;
      if (from >= lasted_) {
        break;
      }
    }
    return impulses;
  }

  void add_mechanics(RunStep& step) const {
    for (std::size_t r = 0; r < state_.robots.size(); ++r) {
      const MechanismMechanics robot =
          model_.robots[r].mechanism.mechanics(state_.robots[r], model_.gravity);
      step.kinetic_energy += robot.kinetic_energy;
      step.potential_energy += robot.potential_energy;
      step.linear_momentum += robot.linear_momentum;
      step.angular_momentum += robot.angular_momentum;
    }
    for (const SimTie& tie : model_.ties) {
      step.potential_energy +=
          elastic_energy(tie, place_of(tie, [&](std::size_t b) { return state_.states[b].X_WB; }));
    }
    for (std::size_t b = 0; b < state_.states.size(); ++b) {
      const SimBody& body = model_.bodies[b];
      if (body.kind != BodyKind::free || body.link_body) {
        continue;
      }
      const RigidState& state = state_.states[b];
      const Vector3d p_WC = centre_of_mass(body.inertia, state.X_WB);
      const Vector3d momentum = body.inertia.mass * state.v_WC;
      step.kinetic_energy += kinetic_energy(body.inertia, state);
      step.potential_energy -= body.inertia.mass * model_.gravity.dot(p_WC);
      step.linear_momentum += momentum;
      step.angular_momentum +=
          p_WC.cross(momentum) + rotational_inertia(body.inertia, state.X_WB) * state.w_WB;
    }
  }

  const SimulationModel& model_;
  const StepStart& start_;
  double lasted_;  // [s]
  SimulationState& state_;
};

}  // namespace

RunStep record_step(const SimulationModel& model, const StepStart& start,
                    const std::vector<IslandTrack>& tracks, SimulationState& state) {
  double lasted = start.h;
  for (const IslandTrack& track : tracks) {
    lasted = std::min(lasted, track.reached);
  }
  return StepRecorder(model, start, lasted, state).record(tracks);
}

}  // namespace firstcontact::detail
