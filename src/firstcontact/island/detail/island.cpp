#include <firstcontact/island/detail/island.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <firstcontact/island/detail/impact_search.h>
#include <firstcontact/island/detail/island_plan.h>
#include <firstcontact/island/detail/island_response.h>
#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/island/detail/island_ties.h>
#include <firstcontact/island/detail/loose_momenta.h>
#include <firstcontact/island/detail/met_scripts.h>
#include <firstcontact/island/detail/sleeping.h>
#include <firstcontact/record/detail/earlier_impulses.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>

namespace firstcontact::detail {
namespace {

/// [-]  Impulses of a plan are reported at a later contact of the step that is nearer than this, by
/// the smaller reach of both bodies. Larger: their moments are wrong where a contact jumps.
constexpr double kCarriedWithin = 0.1;

class Island {
 public:
  Island(const StepContext& step, std::vector<std::size_t> members, Workspace& workspace,
         const std::vector<std::size_t>& bare_robots)
      : state_(step, std::move(members), bare_robots),
        guesses_(step.guesses),
        stop_(step.stop),
        workspace_(workspace),
        span_(step.start.h) {
    track_.members = state_.members;
    track_.pieces.resize(state_.size());
    track_.clearance = std::numeric_limits<double>::infinity();
  }

  std::optional<IslandTrack> run() {
    std::size_t stalls = 0;
    state_.find_manifolds(guesses_, workspace_);
    for (const auto& [pair, manifold] : state_.manifolds) {
      for (const ManifoldPoint& touch : manifold.touches) {
        scripts_.meet(state_, touch);
      }
    }
    scripts_.meet_ties(state_);
    if (has_bounce() || any_tie_is_hit(state_)) {
      ++track_.events;
      impact();
    }
    while (state_.reached < state_.start.h) {
      if (is_stuck_) {
        track_.crushed = state_.reached;
        track_.crushing = scripts_.crushing();
        break;
      }
      const std::size_t events = scripts_.try_again()
                                     ? std::min(kMostEventsAgain, state_.model.events)
                                     : state_.model.events;
      if (track_.events > events || stalls >= kMostStalls || is_jammed()) {
        track_.crushing = scripts_.crushing();
        break;
      }
      const double reached = state_.reached;
      planned_ = span();
      const std::optional<double> t = advance();
      if (!t) {
        return std::nullopt;
      }
      if (is_stuck_) {
        continue;
      }
      if (*t < 1.0 && !(scripts_.try_again() && is_jammed())) {
        ++track_.events;
        impact();
      }
      choose_span(*t);
      squeezed_ += *t < 1.0 && state_.is_nearer(kSqueezedOfDistance * state_.model.distances.least);
      stalls = state_.reached - reached > stall(state_.start.h) ? 0 : stalls + 1;
    }
    track_.reached = state_.reached;
    track_.robots = state_.robots.take_tracks();
    return std::move(track_);
  }

 private:
  /// [s]  Finds the span of the next plan. Plans that turns make short have equal lengths: the
  /// impulses of a short rest would be no guesses for the next step. The shortest span is so long
  /// that its rounding is no speed of motors.
  [[nodiscard]] double span() {
    const double shortest = kLeastShareOfFast * state_.start.h;
    const double of_fast =
        std::max(std::min(state_.robots.longest_span(), tumbling_span()), shortest);
    const double rest = state_.start.h - state_.reached;
    const double plans = std::max(1.0, std::ceil(rest / turning_span()));
    const double of_motion = std::min({rest / plans, of_fast, tied_span()});
    return std::min(span_, rest - of_motion < shortest ? rest : of_motion);
  }

  /// [s]  Finds the span in which no tied body turns too far: impulses act at the places of ties
  /// halfway.
  [[nodiscard]] double tied_span() const {
    double fastest = 0.0;  // [rad/s]
    for (std::size_t k = 0; k < state_.size() && !state_.ties.empty(); ++k) {
      if (!state_.model.ties_of[state_.members[k]].empty()) {
        fastest = std::max(fastest, state_.states[k].w_WB.norm());
      }
    }
    return fastest > 0.0 ? std::max(kMostTurnOfTied / fastest, kLeastShareOfFast * state_.start.h)
                         : std::numeric_limits<double>::infinity();
  }

  /// [s]  Finds the span in which touching bodies turn no farther than contacts can follow. In
  /// heaps contacts do not follow.
  [[nodiscard]] double turning_span() {
    double longest = std::numeric_limits<double>::infinity();
    if (is_heap(state_, state_.touches())) {
      return longest;
    }
    for (const auto& [pair, manifold] : state_.manifolds) {
      if (least_gap(manifold) > state_.model.distances.band) {
        continue;
      }
      for (const std::size_t body : pair) {
        longest = std::min(longest, spinning_span(body));
      }
      for (const ManifoldPoint& touch : manifold.touches) {
        longest = std::min(longest, rolling_span(touch));
      }
    }
    return longest;
  }

  /// [s]  Finds the span in which a touching body turns no farther than gyroscopic moments permit.
  [[nodiscard]] double spinning_span(std::size_t body) const {
    const SimBody& described = state_.model.bodies[body];
    if (described.kind != BodyKind::free || described.link_body || is_locked(described.inertia) ||
        is_isotropic(described.inertia)) {
      return std::numeric_limits<double>::infinity();
    }
    const double turning = state_.states[state_.place.at(body)].w_WB.norm();
    return std::max(kMostTurnInContact / turning, kLeastShareOfPlan * state_.start.h);
  }

  /// [s]  Finds the span in which a contact on a rim stays near its place there. A contact on an
  /// ellipsoid almost keeps its arm in it. On a rim a contact that runs too fast for any plan does
  /// not count. Over the flat side of an ellipsoid it runs fast for a short time. Islands of few
  /// bodies have plans of a hundredth of a step there; with many bodies they would take too long.
  [[nodiscard]] double rolling_span(const ManifoldPoint& touch) {
    double longest = std::numeric_limits<double>::infinity();
    if (!touch.round[0].is_curved() && !touch.round[1].is_curved()) {
      return longest;
    }
    const std::array<ContactSide, 2> sides = state_.turning_sides(touch);
    const double shortest = kLeastShareOfPlan * state_.start.h;
    const double on_rim = rate_on_rim(touch.normal, sides);
    if (on_rim > 0.0 && kTurnOfCurve / on_rim >= shortest) {
      longest = std::max(kRollOfPlan * kTurnOfCurve / on_rim, shortest);
    }
    const double on_ellipsoid =
        span_on_ellipsoid(touch.normal, sides, span_, state_.model.distances.least);
    const bool is_small = state_.size() < kSeveralBodies;
    const double least = is_small ? kLeastShareOfFast * state_.start.h : shortest;
    return std::min(longest, std::max(on_ellipsoid, least));
  }

  /// Whether the island is jammed. Either impacts go on to squeeze a pair: each leaves less of its
  /// distance, until doubles could not prove it. Or plans go on to break their contacts.
  [[nodiscard]] bool is_jammed() const {
    const std::size_t most = scripts_.try_again() ? kMostCrushedAgain : kMostCrushed;
    return squeezed_ >= kMostSqueezed || crushed_ >= most;
  }

  /// [s]  Finds the span in which bodies that tumble stay near their chords: a t^2 / 8 away at
  /// most, with the angular acceleration a of gyroscopic moments.
  [[nodiscard]] double tumbling_span() const {
    double greatest = 0.0;  // [rad/s^2]
    for (std::size_t k = 0; k < state_.size(); ++k) {
      if (!state_.member(k).link_body) {
        greatest =
            std::max(greatest, tumbling_acceleration(state_.member(k).inertia, state_.states[k]));
      }
    }
    return greatest > 0.0 ? std::sqrt(8.0 * kMostAstray / greatest)
                          : std::numeric_limits<double>::infinity();
  }

  /// Chooses the longest span. A constraint is linear, but the path of a turning point is not. On a
  /// fast body it goes nearer than the rest gap, and halves the gap with each impact, in less and
  /// less time. Then plans are as short as it took, so that pushes act within them.
  void choose_span(double t) {
    if (t < 1.0) {
      span_ = state_.is_too_near()
                  ? std::max(std::max(t, kLeastShareOfPlan) * planned_, stall(state_.start.h))
                  : state_.start.h;
    } else {
      span_ = 2.0 * planned_;
    }
  }

  /// Moves all bodies to the first contact that is no mere constraint, or to the end of the plan.
  /// Returns the fraction of the span; nothing if it was stopped.
  std::optional<double> advance(bool symmetric = false) {
    IslandPlanner planner(state_, planned_, symmetric);
    ImpactSearch search(state_, planned_, workspace_);
    for (int round = 1; !stop_.stop_requested(); ++round) {
      const Plan plan = planner.plan();
      if ((plan.is_refused || !plan.finds_ties || !plan.keeps_energy) &&
          planned_ > kLeastShareOfTied * state_.start.h) {
        planned_ *= 0.5;
        return advance();
      }
      if (!plan.keeps_energy && !symmetric) {
        return advance(true);
      }
      if (plan.is_refused) {
        is_stuck_ = true;
        return 0.0;
      }
      const std::vector<Impact> hits = search.find(plan);
      scripts_.begin_plan();
      for (const Impact& hit : hits) {
        for (const PredictedContact& ahead : hit.ahead) {
          scripts_.meet_in_plan(state_, ahead.touch);
        }
      }
      if (hits.empty() || round == kRoundsOfSlight ||
          std::ranges::none_of(hits, &Impact::is_slight) || is_in_vain(planner, plan, hits)) {
        const bool is_crushed = !hits.empty() && !plan.keeps_contacts();
        double t = state_.robots.share_within_limits(plan.robots);
        for (const Impact& hit : hits) {
          t = std::min(t, hit.t);
        }
        if (!state_.ties.empty() && state_.taut <= kMostTautEvents) {
          const double within = share_within_cables(state_, plan, planned_);
          state_.taut += within < t ? 1 : 0;
          t = std::min(t, within);
        }
        if (is_crushed && ++crushed_ == 1) {
          track_.crushed = state_.reached + t * planned_;
        }
        move_to(plan, planner.touches(), t, search.clearance());
        return t;
      }
      for (const Impact& hit : hits) {
        if (hit.is_slight) {
          for (const PredictedContact& ahead : hit.ahead) {
            planner.add(ahead);
          }
        }
      }
    }
    return std::nullopt;
  }

  /// Whether another plan would be stopped by the same impacts: it has them as constraints, and its
  /// velocities violate these. For a script that tries again, an unsolved plan alone shows it.
  [[nodiscard]] bool is_in_vain(const IslandPlanner& planner, const Plan& plan,
                                const std::vector<Impact>& hits) const {
    const auto is_known = [&](const Impact& hit) {
      return std::ranges::all_of(hit.ahead, [&](const auto& ahead) { return planner.has(ahead); });
    };
    return (scripts_.try_again() && !plan.is_solved) ||
           (!plan.keeps_contacts() && std::ranges::all_of(hits, is_known));
  }

  /// Executes the plan until t, and finds the manifolds there. Bodies stay where t is too small to
  /// change the time.
  void move_to(const Plan& plan, std::vector<ManifoldPoint> touches, double t, double clearance) {
    const bool is_last = planned_ >= state_.start.h - state_.reached;
    const double to = t == 1.0 && is_last ? state_.start.h : state_.reached + t * planned_;
    t = to > state_.reached ? t : 0.0;
    move_bodies(plan, touches, t, to);
    if (t == 1.0 && planned_ == state_.start.h && track_.events == 0 &&
        falls_asleep(state_, plan, touches)) {
      come_to_rest();
    }
    for (const TieTrackPiece& tie : plan.ties) {
      if (t > 0.0) {
        track_.ties.push_back({tie.tie, state_.reached, to, t * tie.linear, t * tie.angular});
      }
    }
    const double before = std::exchange(state_.reached, to);
    track_.residual = std::max(track_.residual, plan.residual);
    track_.clearance = std::min(track_.clearance, clearance);
    state_.poses_around.clear();
    if (to < state_.start.h) {
      acted_ = touches;
      for (ManifoldPoint& touch : acted_) {
        touch.impulse *= state_.start.h / planned_;
      }
      std::ranges::stable_sort(acted_, comes_before);
      state_.find_manifolds(acted_, workspace_);
    }
    for (ManifoldPoint& touch : touches) {
      touch.impulse *= t;
    }
    take(std::move(touches), before);
  }

  /// Moves the bodies to t of the plan.
  ///
  /// @param to  [s]  since the step began
  void move_bodies(const Plan& plan, const std::vector<ManifoldPoint>& touches, double t,
                   double to) {
    const std::vector<RigidState> begin = state_.states;
    const std::optional<Momenta> momenta = momenta_ahead(state_, touches, planned_, t);
    state_.robots.move_to(plan.robots, t, planned_, to);
    for (std::size_t k = 0; k < state_.size(); ++k) {
      state_.states[k] = state_ahead(state_, plan, k, t);
      if (state_.member(k).link_body) {  // Its pose is on a chord, its velocity is its robot's.
        const ContactBody body = state_.robots.body(k);
        state_.states[k].v_WC = body.v;
        state_.states[k].w_WB = body.w;
      }
    }
    if (momenta && t > 0.0) {
      take_momenta(*momenta, state_);
    }
    for (std::size_t k = 0; k < state_.size() && t > 0.0; ++k) {
      const Move move = t < 1.0 ? plan.moves[k].part(t) : plan.moves[k];
      track_.pieces[k].push_back({to, begin[k].X_WB, move, begin[k], state_.states[k]});
    }
  }

  /// Makes the touches of a plan those of the step, with the earlier impulses. Impulses on pairs
  /// that parted become impacts. So do those far from all touches of their pair: at another place
  /// they would have another moment.
  ///
  /// @param before  [s]  begin of the plan
  void take(std::vector<ManifoldPoint> touches, double before) {
    add_earlier_impulses(track_.touches, touches, [&](const ManifoldPoint& earlier) {
      return kCarriedWithin * smaller_reach(state_.model, earlier.bodies);
    });
    for (const ManifoldPoint& parted : track_.touches) {
      track_.impacts.push_back({before, parted.bodies, parted.point, parted.impulse});
    }
    track_.touches = std::move(touches);
  }

  /// Sets the small velocities that are left at the end of the step to 0.
  void come_to_rest() {
    track_.rests = Rest::begins;
    for (std::size_t k = 0; k < state_.size(); ++k) {
      for (RigidState* end : {&state_.states[k], &track_.pieces[k].back().end}) {
        end->v_WC.setZero();
        end->w_WB.setZero();
      }
    }
  }

  /// Whether any touch closes fast enough to bounce.
  [[nodiscard]] bool has_bounce() {
    ProblemBodies bodies = state_.problem_bodies();
    for (const auto& [pair, manifold] : state_.manifolds) {
      state_.add_others(pair, bodies);
      for (const ManifoldPoint& touch : manifold.touches) {
        const ContactPoint contact = contact_at(touch, bodies, 0.0, 0.0);
        if (touch.gap <= state_.model.distances.touching &&
            state_.bounces(pair, -normal_velocity(contact, bodies.bodies()))) {
          return true;
        }
      }
    }
    return false;
  }

  /// Projects the impact of the present touches.
  void impact() {
    ProblemBodies bodies = state_.problem_bodies();
    ContactProblem problem;
    std::vector<const ManifoldPoint*> touches;
    std::vector<BodyPair> pairs;
    for (const auto& [pair, manifold] : state_.manifolds) {
      for (const ManifoldPoint& touch : manifold.touches) {
        if (touch.gap > state_.model.distances.touching) {
          continue;
        }
        state_.add_others(pair, bodies);
        ManifoldPoint unknown = touch;
        unknown.impulse.setZero();
        problem.contacts.push_back(state_.contact(unknown, bodies, 0.0));
        touches.push_back(&touch);
        pairs.push_back(pair);
      }
    }
    add_tied_bodies(state_, bodies);
    problem.ties = rigid_rows(state_, bodies);
    if (problem.contacts.empty() && problem.ties.empty()) {
      return;
    }
    problem.bodies = bodies.bodies();
    state_.robots.add_mechanisms(problem);
    state_.robots.add_drives_at_impact(problem);
    const ContactSolution solution = project_impact_of(state_, problem, pairs);
    if (!is_finite(solution)) {
      is_stuck_ = true;
      return;
    }
    const PlanSolution impact{solution, !is_solved(state_, solution)};
    std::vector<OuterImpulse> outer =
        outer_impulses(problem, impact, bodies, state_.robots.size(), 0.0);
    add_outer_of_ties(problem, solution, bodies, outer);
    state_.robots.take_velocities(solution, outer);
    for (std::size_t k = 0; k < touches.size(); ++k) {
      if (!solution.impulses[k].isZero(0.0)) {
        track_.impacts.push_back({state_.reached, touches[k]->bodies, touches[k]->point,
                                  problem.contacts[k].frame.transpose() * solution.impulses[k]});
      }
    }
    for (std::size_t k = 0; k < state_.size(); ++k) {
      const bool is_link_body = state_.member(k).link_body.has_value();
      const ContactBody& body = is_link_body ? state_.robots.body(k) : solution.bodies[k];
      state_.states[k].v_WC = body.v;
      state_.states[k].w_WB = body.w;
    }
    track_.residual = std::max(track_.residual, solution.residual);
  }

  IslandState state_;
  const std::vector<ManifoldPoint>& guesses_;
  const std::stop_token& stop_;
  // Touches of the last plan, sorted, with the impulses of a whole step.
  std::vector<ManifoldPoint> acted_ = {};
  Workspace& workspace_;
  IslandTrack track_;
  double span_;               // [s]  Longest span of a plan, for now.
  double planned_ = 0.0;      // [s]  Span of the plan.
  std::size_t squeezed_ = 0;  // Number of impacts that left a pair squeezed.
  std::size_t crushed_ = 0;   // Number of plans with impacts whose contacts have no solution.
  bool is_stuck_ = false;     // Whether no plan may be followed, however short.
  MetScripts scripts_ = {};
};

}  // namespace

std::optional<IslandTrack> advance_island(const StepContext& step, std::vector<std::size_t> members,
                                          Workspace& workspace,
                                          const std::vector<std::size_t>& bare_robots) {
  return Island(step, std::move(members), workspace, bare_robots).run();
}

}  // namespace firstcontact::detail
