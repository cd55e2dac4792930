#include <firstcontact/dynamics/detail/island.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <unordered_map>

#include <firstcontact/dynamics/detail/island_robots.h>
#include <firstcontact/dynamics/detail/overlap_tree.h>
#include <firstcontact/dynamics/detail/response.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact::detail {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

/// How often slight contacts of the motion ahead are turned into constraints before the bodies are
/// moved until the first of them.
constexpr int kRounds = 12;

/// A contact ahead is slight if the bodies approach by less than this part of the smaller one's
/// radius over the span of the plan, and would not bounce.
constexpr double kSlightApproach = 0.4;

/// Half of what is missing to the rest distance is made up for in a plan.
constexpr double kPush = 0.5;

/// Impacts slower than what gravity adds in this many steps do not bounce: bodies come to rest.
constexpr double kStepsWithoutBounce = 2.0;

/// Of contact problems: of what gravity adds in a step. Heaps are solved less exactly, and where
/// they slide even less.
constexpr double kTolerance = 3e-7;
constexpr double kHeapTolerance = 1e-3;
constexpr std::size_t kHeap = 300;  // Contacts.
constexpr int kHeapRounds = 2;
constexpr double kLeastTolerance = 1e-9;  // [m/s]

/// A residual of this part of what gravity adds tells that a problem has no solution, or none that
/// was found.
constexpr double kUnsolved = 1e-2;

/// After as many impacts in a row that hardly let time pass, the island is jammed. Nor are bodies
/// pushed apart in less time: who looks at the motion could not divide it.
constexpr std::size_t kMostStalls = 10;
constexpr double kStall = 1e-9;  // [-]  Of the step.

/// A plan that was stopped is followed by one of at least this part of its span.
constexpr double kLeastShare = 0.1;

/// Links that turn fast make plans shorter, down to this part of the step.
constexpr double kLeastShareOfLinks = 0.01;

/// Pairs nearer than this part of their distance of rest are hardly let nearer.
constexpr double kJammed = 1e-3;

/// A touch of the motion ahead, and how it would be reached.
struct TouchAhead {
  Touch touch;
  ContactPoint contact;  // With the arms of its time.
  double least = 0.0;    // [m/s]  Normal velocity that keeps the pair apart until the end.
};

/// What the bodies do over its span: the rest of the step, or less.
struct Plan {
  std::vector<Move> moves = {};     // Of each member.
  std::vector<ContactBody> at_end;  // Velocities of each member.
  std::vector<RobotPlan> robots = {};
  std::vector<Touch> touches = {};  // With their impulses.
  double residual = 0.0;            // [m/s]
};

/// A pair that the plan brings into contact.
struct Hit {
  BodyPair bodies;
  double t = 0.0;  // [-]  Of the span.
  bool is_slight = false;
  std::vector<TouchAhead> ahead = {};
};

AlignedBox3d widened(const AlignedBox3d& box, double by) {
  const Vector3d slack = Vector3d::Constant(by);
  return {box.min() - slack, box.max() + slack};
}

class Island {
 public:
  Island(const StepContext& step, std::vector<std::size_t> members, Workspace& workspace)
      : world_(step.world),
        start_(step.start),
        around_(step.around),
        guesses_(step.guesses),
        workspace_(workspace),
        robots_(step.world, step.start, members),
        span_(step.start.h) {
    track_.members = std::move(members);
    track_.pieces.resize(size());
    track_.clearance = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < size(); ++k) {
      place_[track_.members[k]] = k;
      states_.push_back(start_.states[track_.members[k]]);
    }
  }

  IslandTrack run() {
    std::size_t stalls = 0;
    find_manifolds();
    if (has_bounce()) {
      ++track_.events;
      impact();
    }
    while (track_.reached < start_.h) {
      if (track_.events > world_.events || stalls >= kMostStalls) {
        break;
      }
      const double reached = track_.reached;
      const double planned = span();
      const double t = advance();
      if (t < 1.0) {
        ++track_.events;
        impact();
      }
      choose_span(planned, t);
      stalls = track_.reached - reached > kStall * start_.h ? 0 : stalls + 1;
    }
    track_.robots = robots_.take_tracks();
    return std::move(track_);
  }

 private:
  /// [s]  Of the next plan.
  [[nodiscard]] double span() const {
    const double of_links = std::max(robots_.longest_span(), kLeastShareOfLinks * start_.h);
    return std::min({span_, start_.h - track_.reached, of_links});
  }
  [[nodiscard]] std::size_t size() const { return track_.members.size(); }
  [[nodiscard]] const SimBody& member(std::size_t k) const {
    return world_.bodies[track_.members[k]];
  }
  /// Where a member is now, or a body around the island.
  [[nodiscard]] const Pose& pose_of(std::size_t body) {
    if (world_.bodies[body].kind == BodyKind::free) {
      return states_[place_.at(body)].X_WB;
    }
    const auto [found, is_new] = poses_around_.try_emplace(body);
    if (is_new) {
      found->second = scripted_pose(world_, start_, body, track_.reached / start_.h);
    }
    return found->second;
  }

  /// A constraint is linear, the way of a point that turns is not: on a fast body it leads nearer
  /// than the distance of rest, to half of what is left with each impact, in less and less time.
  /// Then plans are as short as it took, so that what pushes apart gets there within them.
  void choose_span(double planned, double t) {
    if (t < 1.0) {
      span_ = is_too_near() ? std::max(std::max(t, kLeastShare) * planned, kStall * start_.h)
                            : start_.h;
    } else {
      span_ = 2.0 * planned;
    }
  }

  [[nodiscard]] bool is_too_near() const {
    return std::ranges::any_of(
        manifolds_, [&](const auto& entry) { return entry.second.gap < world_.distances.pushed; });
  }

  /// Of a member, or of a body around the island, over the span.
  [[nodiscard]] Move move_of(std::size_t body, const std::vector<Move>& moves) const {
    return world_.bodies[body].kind == BodyKind::free
               ? moves[place_.at(body)]
               : start_.scripted[body].part(span() / start_.h);
  }

  /// Pairs of a member and any other body of the island or around it that the moves may bring as
  /// near as `reach` beyond their margin. Moves are those of the members and, where the island
  /// lets time pass, of what is around it.
  template <class Use>
  void for_each_pair(const std::vector<AlignedBox3d>& boxes, double reach, bool is_still,
                     const Use& use) {
    const double most = reach + world_.laws.greatest_margin();
    const auto use_near = [&](std::size_t a, const AlignedBox3d& box_a, std::size_t b,
                              const AlignedBox3d& box_b) {
      const BodyPair pair{std::min(a, b), std::max(a, b)};
      const std::optional<double> margin = world_.laws.margin(pair);
      if (margin && widened(box_a, reach).exteriorDistance(box_b) <= *margin) {
        use(pair, *margin);
      }
    };
    std::vector<AlignedBox3d> halfway;
    for (std::size_t k = 0; k < size(); ++k) {
      around_.for_each_overlap(widened(boxes[k], most), [&](std::size_t b) {
        const Move move = is_still ? Move() : move_of(b, {});
        use_near(track_.members[k], boxes[k], b, swept_box(world_.bodies[b], pose_of(b), move));
      });
      halfway.push_back(widened(boxes[k], 0.5 * most));
    }
    for (const auto& [i, k] : overlapping_pairs(halfway)) {
      use_near(track_.members[i], boxes[i], track_.members[k], boxes[k]);
    }
  }

  void find_manifolds() {
    manifolds_.clear();
    std::vector<AlignedBox3d> boxes;
    for (std::size_t k = 0; k < size(); ++k) {
      boxes.push_back(swept_box(member(k), states_[k].X_WB, {}));
    }
    for_each_pair(boxes, world_.distances.band, true, [&](const BodyPair& pair, double margin) {
      Manifold manifold =
          find_manifold(world_, pair, {pose_of(pair[0]), pose_of(pair[1])}, margin, workspace_);
      if (manifold.gap <= world_.distances.band) {
        carry_impulses(world_, track_.reached > 0.0 ? acted_ : guesses_, manifold);
        manifolds_.emplace(pair, std::move(manifold));
      }
    });
  }

  /// The members as they move now, and what they touch.
  [[nodiscard]] ProblemBodies problem_bodies() const {
    ProblemBodies bodies;
    for (std::size_t k = 0; k < size(); ++k) {
      const RigidState& state = states_[k];
      bodies.add(track_.members[k],
                 member(k).piece ? robots_.body(k)
                                 : ContactBody{inverse_inertia(member(k).inertia, state.X_WB),
                                               state.v_WC, state.w_WB},
                 centre_of_mass(member(k).inertia, state.X_WB));
    }
    return bodies;
  }

  void add_others(const BodyPair& pair, ProblemBodies& bodies) {
    for (const std::size_t b : pair) {
      if (!bodies.has(b)) {
        const Move& move = start_.scripted[b];
        bodies.add(b, {{}, move.translation / start_.h, move.rotation_vector / start_.h},
                   centre_of_mass(world_.bodies[b].inertia, pose_of(b)));
      }
    }
  }

  // --- Between impacts -------------------------------------------------------------------------

  /// Moves everything to the first contact ahead that is no mere constraint, or to the end of the
  /// plan. Returns how far, in parts of its span.
  double advance() {
    std::vector<Hit> constraints;
    Plan plan;
    push_.reset();
    for (int round = 0; round < kRounds; ++round) {
      plan = make_plan(constraints);
      const std::vector<Hit> hits = find_hits(plan);
      if (hits.empty()) {
        move_to(plan, 1.0);
        return 1.0;
      }
      const bool has_slight =
          std::ranges::any_of(hits, [](const Hit& hit) { return hit.is_slight; });
      if (!has_slight || round + 1 == kRounds) {
        const double t = std::ranges::min(hits, {}, [](const Hit& hit) { return hit.t; }).t;
        move_to(plan, t);
        return t;
      }
      std::ranges::copy_if(hits, std::back_inserter(constraints),
                           [](const Hit& hit) { return hit.is_slight; });
    }
    return 0.0;  // Not reached: the last round moves.
  }

  /// Velocities without contacts, and how far they lead.
  struct FreeFlight {
    std::vector<ContactBody> at_end;
    std::vector<Vector3d> rotation_vectors;
  };

  [[nodiscard]] FreeFlight free_flight(const std::vector<ContactBody>& bodies) const {
    FreeFlight flight;
    flight.at_end = bodies;
    for (std::size_t k = 0; k < size(); ++k) {
      const SimBody& body = member(k);
      if (body.piece) {
        flight.rotation_vectors.emplace_back(Vector3d::Zero());
        continue;  // Flies with its robot.
      }
      Vector3d force = body.inertia.mass * world_.gravity;
      Vector3d torque = Vector3d::Zero();
      const double from = start_.time + track_.reached;
      for (const TimedForce& timed : body.forces) {
        // The mean over the span.
        const double share =
            std::max(0.0, std::min(timed.to, from + span()) - std::max(timed.from, from)) / span();
        force += share * timed.force;
        torque += share * timed.torque;
      }
      flight.at_end[k].v += span() * flight.at_end[k].inverse_inertia.mass.cwiseProduct(force);
      const FreeTurn turn = free_turn(body.inertia, states_[k], torque, span());
      flight.at_end[k].w = turn.w_WB;
      flight.rotation_vectors.push_back(turn.rotation_vector);
    }
    return flight;
  }

  /// Starts from the impulses of the touches, which are those of a whole step, and leaves those
  /// that it finds there.
  [[nodiscard]] Plan make_plan(std::vector<Hit>& constraints) {
    ProblemBodies bodies = problem_bodies();
    ContactProblem problem;
    std::vector<Touch*> touches;
    const double share = span() / start_.h;
    const auto add = [&](Touch& touch, double least) -> ContactPoint& {
      add_others(touch.bodies, bodies);
      problem.contacts.push_back(
          contact_at(touch, bodies, world_.laws.friction(touch.bodies), least));
      touches.push_back(&touch);
      ContactPoint& contact = problem.contacts.back();
      contact.guess *= share;
      contact.least_normal_velocity -= drift_along(touch.bodies, contact) / span();
      return contact;
    };
    for (auto& [pair, manifold] : manifolds_) {
      for (Touch& touch : manifold.touches) {
        const ContactPoint& contact = add(touch, -world_.distances.way_to_rest(touch.gap) / span());
        // What will bounce has to arrive first.
        if (bounces(pair, -normal_velocity(contact, bodies.bodies()))) {
          problem.contacts.pop_back();
          touches.pop_back();
        }
      }
    }
    for (Hit& hit : constraints) {
      for (TouchAhead& ahead : hit.ahead) {
        ContactPoint& contact = add(ahead.touch, ahead.least);
        contact.arm_A = ahead.contact.arm_A;
        contact.arm_B = ahead.contact.arm_B;
      }
    }
    const FreeFlight flight = free_flight(bodies.bodies());
    problem.bodies = flight.at_end;
    const std::vector<RobotPlan> free = robots_.fly(problem, start_.time + track_.reached, span());
    const ContactSolution solution = project(problem);
    Plan plan{.at_end = solution.bodies, .residual = solution.residual};
    for (std::size_t k = 0; k < touches.size(); ++k) {
      Touch acting = *touches[k];
      acting.impulse = problem.contacts[k].frame.transpose() * solution.impulses[k];
      touches[k]->impulse = acting.impulse / share;
      plan.touches.push_back(acting);
    }
    plan.at_end.resize(size());
    const std::vector<bool> by_end = led_by_end(problem, bodies.bodies(), solution);
    set_moves(bodies.bodies(), flight, solution, by_end, plan);
    plan.robots = robots_.plan(problem, solution, free, by_end, span());
    push_apart(plan);
    robots_.set_moves(plan.robots, states_, span(), plan.moves);
    return plan;
  }

  /// [m]  What the drift of links adds to the way along a contact's normal.
  [[nodiscard]] double drift_along(const BodyPair& pair, const ContactPoint& contact) const {
    double way = 0.0;
    for (int side = 0; side < 2; ++side) {
      if (world_.bodies[pair[side]].piece) {
        const std::size_t k = place_.at(pair[side]);
        const Move drift = robots_.drift(k, states_[k].X_WB);
        const Vector3d& arm = side == 0 ? contact.arm_A : contact.arm_B;
        const Vector3d at_contact = drift.translation + drift.rotation_vector.cross(arm);
        way += (side == 0 ? -1.0 : 1.0) * contact.frame.row(0).dot(at_contact);
      }
    }
    return way;
  }

  /// The free velocities as contacts and drives allow them.
  [[nodiscard]] ContactSolution project(const ContactProblem& problem) const {
    if (problem.contacts.empty() && problem.drives.empty()) {
      return unchanged(problem);
    }
    ContactSolution solution = project_on_contacts(problem, projection_options(problem));
    limit_energy(problem, solution);
    return solution;
  }

  /// [m/s]  A part of what gravity adds in a step.
  [[nodiscard]] double of_gravity(double part) const {
    return std::max(kLeastTolerance, part * world_.gravity.norm() * start_.h);
  }

  [[nodiscard]] ProjectionOptions projection_options(const ContactProblem& problem) const {
    return {.tolerance = of_gravity(problem.contacts.size() < kHeap ? kTolerance : kHeapTolerance),
            .rounds = kHeapRounds};
  }

  /// Contacts add no energy: without moving bodies around, what they allow contains rest, and the
  /// projection on it makes no velocity longer in the kinetic metric. A scripted body adds at most
  /// its own speed twice. Of a problem without solution, as of a body that is crushed, the solver's
  /// answer is anything: it is shortened to what there was before, or to what moves with the
  /// script.
  /// Motors add what they want, as long as there is a solution.
  void limit_energy(const ContactProblem& problem, ContactSolution& solution) const {
    const bool is_solved = solution.residual <= of_gravity(kUnsolved);
    if (is_solved && robots_.has_motors()) {
      return;
    }
    const double before = energy_of(problem, problem.bodies, velocities_of(problem.mechanisms));
    const double after = energy_of(problem, solution.bodies, solution.mechanisms);
    double mass = 0.0;
    for (std::size_t k = 0; k < size(); ++k) {
      mass += member(k).inertia.mass;
    }
    double speed = 0.0;
    for (const ContactPoint& contact : problem.contacts) {
      for (int side = 0; side < 2; ++side) {
        const ContactBody& body = problem.bodies[contact.bodies[side]];
        if (contact.bodies[side] >= size()) {
          const Vector3d& arm = side == 0 ? contact.arm_A : contact.arm_B;
          speed = std::max(speed, (body.v + body.w.cross(arm)).norm());
        }
      }
    }
    const double along = speed * std::sqrt(0.5 * mass);
    const double allowed =
        is_solved ? std::sqrt(before) + 2.0 * along : std::max(std::sqrt(before), along);
    if (std::sqrt(after) <= allowed * (1.0 + 1e-9)) {
      return;
    }
    const double share = allowed / std::sqrt(after);
    for (std::size_t k = 0; k < size(); ++k) {
      solution.bodies[k].v *= share;
      solution.bodies[k].w *= share;
    }
    for (Eigen::VectorXd& velocities : solution.mechanisms) {
      velocities *= share;
    }
  }

  /// [J]  Of the members and their robots.
  [[nodiscard]] double energy_of(const ContactProblem& problem,
                                 const std::vector<ContactBody>& bodies,
                                 const std::vector<Eigen::VectorXd>& mechanisms) const {
    double sum = kinetic_energy(problem.mechanisms, mechanisms);
    for (std::size_t k = 0; k < size(); ++k) {
      if (!member(k).piece) {
        sum += kinetic_energy(member(k).inertia, {states_[k].X_WB, bodies[k].v, bodies[k].w});
      }
    }
    return sum;
  }

  /// The mean of the velocities at both ends is exact under constant forces; where it would break a
  /// constraint, as at one that only begins to act, those at the end lead the bodies in contact.
  [[nodiscard]] std::vector<bool> led_by_end(const ContactProblem& problem,
                                             const std::vector<ContactBody>& before,
                                             const ContactSolution& solution) const {
    std::vector<ContactBody> mean = solution.bodies;
    for (std::size_t b = 0; b < mean.size(); ++b) {
      mean[b].v = 0.5 * (before[b].v + solution.bodies[b].v);
      mean[b].w = 0.5 * (before[b].w + solution.bodies[b].w);
    }
    const double slack = 2.0 * projection_options(problem).tolerance;
    const bool mean_is_allowed =
        std::ranges::all_of(problem.contacts, [&](const ContactPoint& contact) {
          return normal_velocity(contact, mean) >= contact.least_normal_velocity - slack;
        });
    std::vector<bool> by_end(before.size(), false);
    if (!mean_is_allowed) {
      for (const ContactPoint& contact : problem.contacts) {
        by_end[contact.bodies[0]] = true;
        by_end[contact.bodies[1]] = true;
      }
    }
    return by_end;
  }

  /// Those of pieces of links are their robots' matter.
  void set_moves(const std::vector<ContactBody>& before, const FreeFlight& flight,
                 const ContactSolution& solution, const std::vector<bool>& by_end,
                 Plan& plan) const {
    for (std::size_t k = 0; k < size(); ++k) {
      const Vector3d& w_free = flight.at_end[k].w;
      const Vector3d& w = solution.bodies[k].w;
      const Vector3d turn =
          by_end[k] ? Vector3d(w - 0.5 * (before[k].w + w_free)) : Vector3d(0.5 * (w - w_free));
      const Vector3d& v = solution.bodies[k].v;
      plan.moves.push_back({span() * (by_end[k] ? v : Vector3d(0.5 * (before[k].v + v))),
                            flight.rotation_vectors[k] + span() * turn});
    }
  }

  /// Adds displacements that lead pairs back to their distance of rest.
  void push_apart(Plan& plan) {
    if (!is_too_near() || span() < kStall * start_.h) {
      return;
    }
    if (!push_) {
      push_ = find_push();
    }
    robots_.displace(push_->mechanisms, plan.robots);
    for (std::size_t k = 0; k < size(); ++k) {
      plan.moves[k].translation += push_->bodies[k].v;
      plan.moves[k].rotation_vector += push_->bodies[k].w;
    }
  }

  /// Displacements, in metres in place of metres per second: least in the kinetic metric, and
  /// without velocity, so that they add no energy of motion.
  [[nodiscard]] ContactSolution find_push() {
    const ContactDistances& distances = world_.distances;
    ProblemBodies bodies = problem_bodies();
    ContactProblem problem;
    for (const auto& [pair, manifold] : manifolds_) {
      for (const Touch& touch : manifold.touches) {
        add_others(pair, bodies);
        const double missing = distances.least - touch.gap;
        Touch unknown = touch;
        unknown.impulse.setZero();
        problem.contacts.push_back(
            contact_at(unknown, bodies, 0.0, missing > 0.0 ? kPush * missing : missing));
      }
    }
    problem.bodies = bodies.bodies();
    for (ContactBody& body : problem.bodies) {
      body.v.setZero();
      body.w.setZero();
    }
    robots_.add_mechanisms(problem);
    for (ContactMechanism& mechanism : problem.mechanisms) {
      mechanism.velocity.setZero();
    }
    return project_on_contacts(problem, {.tolerance = 1e-2 * distances.least, .sweeps = 50});
  }

  /// Asks all pairs that the plan may bring near each other.
  [[nodiscard]] std::vector<Hit> find_hits(const Plan& plan) {
    std::vector<AlignedBox3d> boxes;
    for (std::size_t k = 0; k < size(); ++k) {
      boxes.push_back(swept_box(member(k), states_[k].X_WB, plan.moves[k]));
    }
    std::vector<Hit> hits;
    const double reach = world_.distances.least + world_.distances.tolerance;
    clearance_ = world_.distances.least;
    for_each_pair(boxes, reach, false, [&](const BodyPair& pair, double margin) {
      ask(pair, margin, {move_of(pair[0], plan.moves), move_of(pair[1], plan.moves)}, hits);
    });
    return hits;
  }

  void ask(const BodyPair& pair, double margin, const std::array<Move, 2>& moves,
           std::vector<Hit>& hits) {
    const auto found = manifolds_.find(pair);
    const double gap =
        found == manifolds_.end() ? std::numeric_limits<double>::infinity() : found->second.gap;
    const HeldDistance held = held_distance(world_.distances, margin, gap);
    clearance_ = std::min(clearance_, held.margin);
    if (cannot_reach(pair, std::min(gap, world_.distances.band) + margin - held.margin, moves)) {
      return;
    }
    if (!(held.tolerance > 0.0)) {
      hits.push_back(
          {.bodies = pair});  // Rounding left no gap that could be halved: no time passes.
      return;
    }
    FirstContactOptions options;
    options.margin = held.margin;
    options.tolerance = held.tolerance;
    const Motion A = motion_of(world_.bodies[pair[0]], pose_of(pair[0]), moves[0]);
    const Motion B = motion_of(world_.bodies[pair[1]], pose_of(pair[1]), moves[1]);
    first_contact({world_.bodies[pair[0]].shape, A}, {world_.bodies[pair[1]].shape, B}, workspace_,
                  options, answer_);
    if (answer_.verdict == Verdict::free) {
      return;
    }
    hits.push_back(hit_of(pair, margin, {A.pose(answer_.t), B.pose(answer_.t)}, moves));
  }

  /// Whether no point of two bodies gets far enough to close a distance: what rests is not
  /// searched.
  [[nodiscard]] bool cannot_reach(const BodyPair& pair, double distance,
                                  const std::array<Move, 2>& moves) {
    double way = 0.0;
    double size = 0.0;
    for (int side = 0; side < 2; ++side) {
      const double reach = world_.bodies[pair[side]].reach;
      way += moves[side].translation.norm() + reach * moves[side].rotation_vector.norm();
      size += pose_of(pair[side]).position.norm() + reach;
    }
    constexpr double kRounding = 0x1p-44;  // Of the distance and of the way, with room.
    return way + kRounding * size < distance;
  }

  /// The contact that was just found, as a constraint on the span.
  [[nodiscard]] Hit hit_of(const BodyPair& pair, double margin, const std::array<Pose, 2>& poses,
                           const std::array<Move, 2>& moves) {
    Hit hit{.bodies = pair, .t = answer_.t};
    ProblemBodies bodies;
    for (int side = 0; side < 2; ++side) {
      const Move& move = moves[side];
      bodies.add(pair[side], {{}, move.translation / span(), move.rotation_vector / span()},
                 centre_of_mass(world_.bodies[pair[side]].inertia, poses[side]));
    }
    double closing = 0.0;
    for (Touch& touch : touches_among(world_, pair, poses, margin, answer_.contacts)) {
      TouchAhead ahead{.touch = touch, .contact = contact_at(touch, bodies, 0.0, 0.0)};
      const double u_n = normal_velocity(ahead.contact, bodies.bodies());
      // From the gap of the start, were it straight to there.
      const double gap = touch.gap - hit.t * span() * u_n;
      ahead.least = std::min(0.0, -world_.distances.way_to_rest(gap) / span());
      closing = std::max(closing, -u_n);
      hit.ahead.push_back(std::move(ahead));
    }
    hit.is_slight = !hit.ahead.empty() && !bounces(pair, closing) &&
                    closing * span() <= kSlightApproach * smaller_reach(pair);
    return hit;
  }

  [[nodiscard]] double smaller_reach(const BodyPair& pair) const {
    double smaller = std::numeric_limits<double>::infinity();
    for (const std::size_t b : pair) {
      if (world_.bodies[b].kind == BodyKind::free) {
        smaller = std::min(smaller, world_.bodies[b].reach);
      }
    }
    return smaller;
  }

  [[nodiscard]] bool bounces(const BodyPair& pair, double closing) const {
    return world_.laws.restitution(pair) > 0.0 &&
           closing > kStepsWithoutBounce * world_.gravity.norm() * start_.h;
  }

  /// Makes the plan's motions real until t, and looks around there. Bodies stay where t is too
  /// little to be told from now.
  void move_to(const Plan& plan, double t) {
    const double planned = span();
    const bool is_last = planned >= start_.h - track_.reached;
    const double to = t == 1.0 && is_last ? start_.h : track_.reached + t * planned;
    t = to > track_.reached ? t : 0.0;
    robots_.move_to(plan.robots, t, to);
    for (std::size_t k = 0; k < size(); ++k) {
      const RigidState begin = states_[k];
      RigidState& end = states_[k];
      end.X_WB = motion_of(member(k), begin.X_WB, plan.moves[k]).pose(t);
      end.X_WB.rotation.normalize();
      end.v_WC = begin.v_WC + t * (plan.at_end[k].v - begin.v_WC);
      end.w_WB = begin.w_WB + t * (plan.at_end[k].w - begin.w_WB);
      if (member(k).piece) {
        const ContactBody body = robots_.body(k);
        end.v_WC = body.v;
        end.w_WB = body.w;
      }
      if (t > 0.0) {
        const Move move = t < 1.0 ? plan.moves[k].part(t) : plan.moves[k];
        track_.pieces[k].push_back({to, begin.X_WB, move, begin, end});
      }
    }
    track_.reached = to;
    track_.touches = plan.touches;
    track_.residual = std::max(track_.residual, plan.residual);
    track_.clearance = std::min(track_.clearance, clearance_);
    poses_around_.clear();
    if (to < start_.h) {
      acted_ = plan.touches;
      for (Touch& touch : acted_) {
        touch.impulse *= start_.h / planned;
      }
      std::ranges::stable_sort(acted_, comes_before);
      find_manifolds();
    }
  }

  // --- Impacts ---------------------------------------------------------------------------------

  /// Whether anything touches that approaches fast enough to bounce.
  [[nodiscard]] bool has_bounce() {
    ProblemBodies bodies = problem_bodies();
    for (const auto& [pair, manifold] : manifolds_) {
      add_others(pair, bodies);
      for (const Touch& touch : manifold.touches) {
        const ContactPoint contact = contact_at(touch, bodies, 0.0, 0.0);
        if (touch.gap <= world_.distances.touching &&
            bounces(pair, -normal_velocity(contact, bodies.bodies()))) {
          return true;
        }
      }
    }
    return false;
  }

  /// Changes the velocities of what touches now.
  void impact() {
    ProblemBodies bodies = problem_bodies();
    ContactProblem problem;
    std::vector<const Touch*> touches;
    std::vector<double> restitution;
    for (const auto& [pair, manifold] : manifolds_) {
      for (const Touch& touch : manifold.touches) {
        if (touch.gap > world_.distances.touching) {
          continue;
        }
        add_others(pair, bodies);
        Touch unknown = touch;
        unknown.impulse.setZero();
        problem.contacts.push_back(contact_at(unknown, bodies, world_.laws.friction(pair), 0.0));
        touches.push_back(&touch);
        const double closing = -normal_velocity(problem.contacts.back(), bodies.bodies());
        restitution.push_back(bounces(pair, closing) ? world_.laws.restitution(pair) : 0.0);
      }
    }
    if (problem.contacts.empty()) {
      return;
    }
    problem.bodies = bodies.bodies();
    robots_.add_mechanisms(problem);
    robots_.add_drives_at_impact(problem);
    ContactSolution solution = project_impact(
        problem, restitution, size(),
        [&](const auto& moving, const auto& mechanisms) {
          return energy_of(problem, moving, mechanisms);
        },
        projection_options(problem));
    limit_energy(problem, solution);
    robots_.take_velocities(solution);
    for (std::size_t k = 0; k < touches.size(); ++k) {
      if (!solution.impulses[k].isZero(0.0)) {
        track_.impacts.push_back({track_.reached, touches[k]->bodies, touches[k]->point,
                                  problem.contacts[k].frame.transpose() * solution.impulses[k]});
      }
    }
    for (std::size_t k = 0; k < size(); ++k) {
      states_[k].v_WC = solution.bodies[k].v;
      states_[k].w_WB = solution.bodies[k].w;
    }
    track_.residual = std::max(track_.residual, solution.residual);
  }

  const World& world_;
  const StepStart& start_;
  const Surroundings& around_;
  const std::vector<Touch>& guesses_;
  std::vector<Touch> acted_ = {};  // In the last plan, sorted, with the impulses of a whole step.
  Workspace& workspace_;
  IslandTrack track_;
  IslandRobots robots_;
  std::unordered_map<std::size_t, std::size_t> place_;  // Of each member.
  std::vector<RigidState> states_;                      // Of each member, now.
  std::unordered_map<std::size_t, Pose> poses_around_;  // Of those asked for, now.
  std::map<BodyPair, Manifold> manifolds_;
  FirstContactResult answer_;
  std::optional<ContactSolution> push_ = {};  // Of all plans from now.
  double clearance_ = 0.0;                    // [m]  Of the motion asked last.
  double span_;                               // [s]  Longest of a plan, for now.
};

}  // namespace

HeldDistance held_distance(const ContactDistances& distances, double pair_margin, double gap) {
  if (gap > distances.least + distances.tolerance) {
    return {pair_margin + distances.least, distances.tolerance};
  }
  // What cannot yield, as a body that is crushed, would halve its way to nothing.
  const double share = gap > kJammed * distances.least ? 0.5 : 0.99;
  return {pair_margin + share * gap, 0.5 * (1.0 - share) * gap};
}

IslandTrack advance_island(const StepContext& step, std::vector<std::size_t> members,
                           Workspace& workspace) {
  return Island(step, std::move(members), workspace).run();
}

}  // namespace firstcontact::detail
