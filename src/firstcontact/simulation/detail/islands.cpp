#include <firstcontact/simulation/detail/islands.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>

#include <firstcontact/geometry/detail/overlap_tree.h>
#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/island/detail/sleeping.h>
#include <firstcontact/math/disjoint_sets.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/simulation/detail/island_threads.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/contact_distances.h>
#include <firstcontact/simulation_model/detail/obstacles.h>
#include <firstcontact/simulation_model/detail/sim_body.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>
#include <firstcontact/simulation_model/detail/step_start.h>
#include <firstcontact/simulation_model/detail/swept_hull.h>

namespace firstcontact::detail {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

class Islands {
 public:
  Islands(const SimulationModel& model, const StepStart& start,
          const std::vector<ManifoldPoint>& guesses, IslandThreads& threads,
          const std::stop_token& stop)
      : model_(model),
        start_(start),
        around_(model, start),
        step_{model, start, around_, guesses, stop},
        threads_(threads),
        sets_(model.bodies.size()) {
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      if (model.bodies[b].kind == BodyKind::free) {
        free_.push_back(b);
      }
    }
  }

  std::optional<std::vector<IslandTrack>> run() {
    join_links();
    join_tied();
    join_near();
    if (!advance_bare_robots()) {
      return std::nullopt;
    }
    for (int round = 0; advance_changed(); ++round) {
      if (!join_meeting(round >= kExactRoundsOfIslands)) {
        return take_tracks();
      }
    }
    return std::nullopt;
  }

 private:
  std::vector<IslandTrack> take_tracks() {
    std::vector<IslandTrack> tracks;
    for (auto& track : tracks_) {
      if (track) {
        tracks.push_back(std::move(*track));
      }
    }
    std::ranges::move(bare_, std::back_inserter(tracks));
    return tracks;
  }

  [[nodiscard]] std::size_t set_of(std::size_t body) {
    return sets_.root(static_cast<std::uint32_t>(body));
  }
  void join(std::size_t a, std::size_t b) {
    sets_.join(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b));
  }

  [[nodiscard]] bool may_touch(std::size_t a, std::size_t b) const {
    return model_.laws.margin({std::min(a, b), std::max(a, b)}).has_value();
  }

  /// A box widened by half of the distance that any pair may have to keep.
  [[nodiscard]] AlignedBox3d widened(const AlignedBox3d& box, double by) const {
    const Vector3d slack = Vector3d::Constant(0.5 * (by + model_.laws.greatest_margin()));
    return {box.min() - slack, box.max() + slack};
  }

  void join_links() {
    std::vector<std::size_t> first(model_.robots.size(), kNone);
    for (const std::size_t b : free_) {
      if (const auto& link_body = model_.bodies[b].link_body) {
        std::size_t& one = first[link_body->robot];
        one = one == kNone ? b : one;
        join(one, b);
      }
    }
  }

  void join_tied() {
    for (const SimTie& tie : model_.ties) {
      const auto is_free = [&](const TieEnd& end) {
        return end.body && model_.bodies[*end.body].kind == BodyKind::free;
      };
      if (is_free(tie.ends[0]) && is_free(tie.ends[1])) {
        join(*tie.ends[0].body, *tie.ends[1].body);
      }
    }
  }

  /// Joins bodies that are near each other, and those that would meet without obstacles.
  ///
  /// Most bodies that will meet are among them, so that few islands are advanced twice.
  void join_near() {
    std::vector<Move> moves;
    std::vector<AlignedBox3d> boxes;
    for (const std::size_t b : free_) {
      moves.push_back(inertial_move(b));
      boxes.push_back(widened(swept_box(model_.bodies[b], start_.states[b].X_WB, moves.back()),
                              model_.distances.near));
    }
    for (const auto& [i, k] : overlapping_pairs(boxes)) {
      const std::size_t a = free_[i];
      const std::size_t b = free_[k];
      if (may_touch(a, b) && set_of(a) != set_of(b) &&
          (are_near(a, b) || !pass_by(a, moves[i], b, moves[k]))) {
        join(a, b);
      }
    }
  }

  /// The move of the body over the step by inertia. Links rest: their joints lead them.
  [[nodiscard]] Move inertial_move(std::size_t b) const {
    const RigidState& state = start_.states[b];
    if (model_.bodies[b].link_body || start_.rests[b]) {
      return {};
    }
    return {start_.h * (state.v_WC + 0.5 * start_.h * model_.gravity), start_.h * state.w_WB};
  }

  /// Whether the bodies' boxes are within the band now.
  [[nodiscard]] bool are_near(std::size_t a, std::size_t b) const {
    const auto box_of = [&](std::size_t body) {
      return widened(swept_box(model_.bodies[body], start_.states[body].X_WB, {}),
                     model_.distances.near);
    };
    return box_of(a).intersects(box_of(b));
  }

  /// Whether a plane proves that the hulls do not meet on their ways.
  [[nodiscard]] bool pass_by(std::size_t a, const Move& move_a, std::size_t b,
                             const Move& move_b) const {
    const SweptHull A(model_.bodies[a], start_.states[a].X_WB, move_a);
    const SweptHull B(model_.bodies[b], start_.states[b].X_WB, move_b);
    return stays_apart(A, B, model_.distances.near, (B.p_WC - A.p_WC).normalized());
  }

  /// Advances the sets that are new. Returns false if it was stopped.
  bool advance_changed() {
    std::vector<std::vector<std::size_t>> members(model_.bodies.size());
    for (const std::size_t b : free_) {
      members[set_of(b)].push_back(b);
    }
    tracks_.resize(model_.bodies.size());
    is_new_.assign(model_.bodies.size(), false);
    std::vector<std::size_t> awake;
    for (std::size_t s = 0; s < members.size(); ++s) {
      if (tracks_[s] && tracks_[s]->members == members[s]) {
        continue;
      }
      tracks_[s].reset();
      if (members[s].empty()) {
        continue;
      }
      is_new_[s] = true;
      if (stays_asleep(step_, members[s])) {
        tracks_[s] = track_asleep(step_, std::move(members[s]));
      } else {
        awake.push_back(s);
      }
    }
    threads_.for_each(awake.size(), [&](std::size_t k, Workspace& workspace) {
      const std::size_t s = awake[k];
      if (step_.stop.stop_requested()) {
        return;
      }
      tracks_[s] = advance_island(step_, std::move(members[s]), workspace);
    });
    return std::ranges::all_of(awake, [&](std::size_t s) { return tracks_[s].has_value(); });
  }

  /// Advances robots without geometry, which touch nothing, each by itself. Returns false if it was
  /// stopped.
  bool advance_bare_robots() {
    std::vector<bool> has_link_bodies(model_.robots.size(), false);
    for (const SimBody& body : model_.bodies) {
      if (body.link_body) {
        has_link_bodies[body.link_body->robot] = true;
      }
    }
    for (std::size_t r = 0; r < model_.robots.size(); ++r) {
      if (!has_link_bodies[r]) {
        std::optional<IslandTrack> track = advance_island(step_, {}, threads_.workspace(), {r});
        if (!track) {
          return false;
        }
        bare_.push_back(std::move(*track));
      }
    }
    return true;
  }

  /// The pieces of a body in its island's track.
  [[nodiscard]] const std::vector<TrackPiece>& pieces_of(std::size_t body) {
    const IslandTrack& track = *tracks_[set_of(body)];
    const auto found = std::ranges::lower_bound(track.members, body);
    return track.pieces[static_cast<std::size_t>(found - track.members.begin())];
  }

  [[nodiscard]] AlignedBox3d box_of(std::size_t body) {
    AlignedBox3d box = swept_box(model_.bodies[body], start_.states[body].X_WB, {});
    for (const TrackPiece& piece : pieces_of(body)) {
      box.extend(swept_box(model_.bodies[body], piece.X_WB, piece.move));
    }
    return box;
  }

  /// The motion of a body over the whole step; it rests after the end of its island's track.
  [[nodiscard]] Motion motion_over_step(std::size_t body) {
    std::vector<ConstantRatePiece> pieces;
    Pose last = start_.states[body].X_WB;
    for (const TrackPiece& piece : pieces_of(body)) {
      const double t_end = piece.to < start_.h ? piece.to / start_.h : 1.0;
      if (t_end > (pieces.empty() ? 0.0 : pieces.back().t_end)) {
        pieces.push_back({t_end, piece.X_WB, piece.move.translation, piece.move.rotation_vector});
        last = piece.end.X_WB;
      }
    }
    if (pieces.empty() || pieces.back().t_end < 1.0) {
      pieces.push_back({1.0, last});
    }
    return Motion::constant_rates(pieces, model_.bodies[body].inertia.p_BC);
  }

  [[nodiscard]] bool meet(std::size_t a, std::size_t b) {
    const BodyPair pair{std::min(a, b), std::max(a, b)};
    FirstContactOptions options;
    const HeldDistance held = held_distance(model_.distances, *model_.laws.margin(pair),
                                            std::numeric_limits<double>::infinity());
    options.margin = held.margin;
    options.tolerance = held.tolerance;
    options.contacts = ContactState::none;
    const Motion A = motion_over_step(pair[0]);
    const Motion B = motion_over_step(pair[1]);
    return first_contact({model_.bodies[pair[0]].shape, A}, {model_.bodies[pair[1]].shape, B},
                         threads_.workspace(), options)
               .verdict != Verdict::free;
  }

  /// Joins islands whose new motions meet; `with_ways` also those whose ways meet if any two meet.
  ///
  /// It returns whether there were any.
  bool join_meeting(bool with_ways) {
    std::vector<AlignedBox3d> boxes;
    for (const std::size_t b : free_) {
      boxes.push_back(widened(box_of(b), model_.distances.least + model_.distances.tolerance));
    }
    std::vector<std::array<std::size_t, 2>> meeting;
    std::vector<std::array<std::size_t, 2>> crossing;
    for (const auto& [i, k] : overlapping_pairs(boxes)) {
      const std::size_t a = free_[i];
      const std::size_t b = free_[k];
      const std::size_t set_a = set_of(a);
      const std::size_t set_b = set_of(b);
      if (set_a == set_b || !may_touch(a, b)) {
        continue;
      }
      if ((is_new_[set_a] || is_new_[set_b]) && meet(a, b)) {
        meeting.push_back({a, b});
      } else if (with_ways) {
        crossing.push_back({a, b});
      }
    }
    if (meeting.empty()) {
      return false;
    }
    for (const auto& [a, b] : meeting) {
      join(a, b);
    }
    for (const auto& [a, b] : crossing) {
      join(a, b);
    }
    return true;
  }

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  const SimulationModel& model_;
  const StepStart& start_;
  Obstacles around_;
  StepContext step_;
  IslandThreads& threads_;
  DisjointSets sets_;  // Sets of bodies; an island is named after its least member.
  std::vector<std::size_t> free_;
  std::vector<std::optional<IslandTrack>> tracks_;  // Track of each set, at its name.
  std::vector<bool> is_new_;                        // For each set.
  std::vector<IslandTrack> bare_ = {};              // Tracks of robots without geometry.
};

}  // namespace

std::optional<std::vector<IslandTrack>> advance_islands(const SimulationModel& model,
                                                        const StepStart& start,
                                                        const std::vector<ManifoldPoint>& guesses,
                                                        IslandThreads& threads,
                                                        const std::stop_token& stop) {
  return Islands(model, start, guesses, threads, stop).run();
}

}  // namespace firstcontact::detail
