#include <firstcontact/edges/edge_checker.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

#include <tbb/enumerable_thread_specific.h>

#include <firstcontact/edges/detail/edge_question.h>
#include <firstcontact/edges/detail/edge_search.h>
#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/math/float_environment.h>
#include <firstcontact/parallel/parallel_for.h>
#include <firstcontact/robot/rest.h>
#include <firstcontact/robot_check/check_robots.h>
#include <firstcontact/robot_check/detail/robot_timeline.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

void require_option(bool condition, const char* what) {
  if (!condition) {
    throw std::invalid_argument(std::string("EdgeCheckOptions::") + what);
  }
}

void require_options(const EdgeCheckOptions& options) {
  require_option(options.tolerance > 0.0 && std::isfinite(options.tolerance),
                 "tolerance must be finite and > 0");
  require_option(options.extra_clearance >= 0.0 && std::isfinite(options.extra_clearance),
                 "extra_clearance must be finite and >= 0");
  require_option(options.fraction_tolerance >= 0.0 && options.fraction_tolerance <= 1.0,
                 "fraction_tolerance must be in [0, 1]");
  require_option(options.effort >= 1, "effort must be at least 1");
  for (const HeldPair& pair : options.held) {
    require_option(pair.distance > 0.0 && std::isfinite(pair.distance),
                   "held: distances must be finite and > 0");
    require_option(pair.tolerance > 0.0 && std::isfinite(pair.tolerance),
                   "held: tolerances must be finite and > 0");
  }
}

bool is_at_rest(const RobotMotion& motion) {
  bool all = motion.base_path(0.5).rest() != nullptr;
  for (std::size_t joint = 0; joint < motion.model().joints().size(); ++joint) {
    const JointPath* path = motion.joint_path(joint, 0.5);
    const std::optional<JointMotion> given = motion.given(joint);
    // A joint that mimics another rests with it.
    all = all && (path == nullptr || path->rest() != nullptr ||
                  (given ? rests(*given) : motion.model().joints()[joint].mimic.has_value()));
  }
  return all;
}

/// Refuses movers that are not robots of the scene, each once.
void require_robots(const PlanScene& plan) {
  const std::set<std::size_t> all(plan.robots.begin(), plan.robots.end());
  if (all.size() != plan.robots.size() || all.size() != plan.space.mover_count() ||
      *all.rbegin() >= plan.scene.robot_count()) {
    throw std::invalid_argument("expected a robot of the scene for each mover of the space");
  }
}

/// Refuses bodies and robots that move by themselves.
void require_at_rest(const PlanScene& plan) {
  const RobotScene& scene = plan.scene;
  for (const Attachment& attachment : scene.attachments()) {
    if (attachment.t_from > 0.0 || attachment.t_to < 1.0) {
      throw std::invalid_argument("body " + detail::in_quotes(scene.name(attachment.body)) +
                                  " is held for a part of the time only; a path is planned for "
                                  "what is held all the time");
    }
    if (!attachment.X_LB) {
      throw std::invalid_argument("body " + detail::in_quotes(scene.name(attachment.body)) +
                                  " is held without its pose in the link (X_LB), which each edge "
                                  "would find anew");
    }
  }
  for (std::size_t member = 0; member < scene.size(); ++member) {
    const bool is_held =
        std::any_of(scene.attachments().begin(), scene.attachments().end(),
                    [&](const Attachment& attachment) { return attachment.body == member; });
    if (!scene.robot_link(member) && !is_held && !scene.rests(member)) {
      throw std::invalid_argument("body " + detail::in_quotes(scene.name(member)) +
                                  " moves; a path is planned among bodies at rest");
    }
  }
  for (std::size_t robot = 0; robot < scene.robot_count(); ++robot) {
    if (!plan.mover(robot) && !is_at_rest(scene.robot_motion(robot))) {
      throw std::invalid_argument("robot " + detail::in_quotes(scene.robot_name(robot)) +
                                  " moves by itself; a path is planned among robots at rest");
    }
  }
}

/// Refuses held pairs about which nothing would be proven.
///
/// @param held_scene  as scene_of_held()
void require_held(const PlanScene& plan, const std::vector<HeldPair>& held,
                  const RobotScene& held_scene) {
  const detail::RobotTimeline timeline(held_scene);
  const std::vector<bool> moved = detail::moved_members(plan);
  for (const HeldPair& pair : held) {
    const std::string names = detail::in_quotes(plan.name(pair.members[0])) + " and " +
                              detail::in_quotes(plan.name(pair.members[1]));
    const auto found =
        std::ranges::find(timeline.pairs(), pair.members, &detail::TestedPair::members);
    if (found == timeline.pairs().end() || !timeline.is_tested(*found, 0)) {
      throw std::invalid_argument("contact pairs: " + names + " are not tested");
    }
    if (!moved[pair.members[0]] && !moved[pair.members[1]]) {
      throw std::invalid_argument("contact pairs: no edge moves " + names);
    }
  }
  if (!held.empty() && timeline.has_tracking_errors()) {
    throw std::invalid_argument(
        "contact pairs: a robot has tracking errors; within them a pair in contact may touch");
  }
}

/// Returns the earlier one; at the same time a contact has priority over an undecided pair.
const detail::EdgeFound& earlier(const detail::EdgeFound& one, const detail::EdgeFound& other) {
  if (one.verdict == Verdict::free || other.verdict == Verdict::free) {
    return one.verdict == Verdict::free ? other : one;
  }
  if (one.t != other.t) {
    return one.t < other.t ? one : other;
  }
  return is_contact(one.verdict) ? one : other;
}

/// [m]  Bounds how far bodies that robots hold reach from the links that hold them.
double carried_reach(const RobotScene& scene) {
  double reach = 0.0;
  for (const Attachment& attachment : scene.attachments()) {
    const Shape& shape = scene.geometries(attachment.body)[0].shape;
    const double place = scene.stretches(attachment.body).empty() || !attachment.X_LB
                             ? 0.0
                             : attachment.X_LB->position.norm();
    reach = std::max(
        reach, place + shape.hierarchy().centre.norm() + shape.hierarchy().radius + shape.radius());
  }
  return reach;
}

std::optional<double> finite_clearance(double clearance) {
  return std::isfinite(clearance) ? std::optional(std::max(0.0, clearance)) : std::nullopt;
}

}  // namespace

std::optional<std::size_t> PlanScene::mover(std::size_t robot) const {
  const auto found = std::ranges::find(robots, robot);
  return found == robots.end() ? std::nullopt
                               : std::optional(static_cast<std::size_t>(found - robots.begin()));
}

struct EdgeChecker::Data {
  /// The searches of one thread.
  struct ThreadWork {
    explicit ThreadWork(const Data& data)
        : search(data.padded, detail::question_of_edges(data.options),
                 data.options.fraction_tolerance) {
      if (data.held) {
        search_of_held = std::make_unique<detail::EdgeSearch>(
            *data.held, detail::question_of_held(data.options), data.options.fraction_tolerance);
      }
    }

    detail::EdgeSearch search;
    std::unique_ptr<detail::EdgeSearch> search_of_held;  // Null where no pair is held.
    std::optional<RobotChecker> closest;                 // Made where it is needed.
  };

  Data(PlanScene given, const EdgeCheckOptions& asked)
      : plan(std::move(given)),
        options(asked),
        carried(carried_reach(plan.scene)),
        rounding(options.extra_clearance),
        padded(detail::scene_of_edges(plan, options.extra_clearance, options.held)),
        works([this] { return std::make_unique<ThreadWork>(*this); }) {
    if (options.held.empty()) {
      return;
    }
    held = detail::scene_of_held(plan, options.extra_clearance, options.held);
    require_held(plan, options.held, *held);
    for (const HeldPair& pair : options.held) {
      rounding = std::min(rounding, pair.tolerance);
    }
  }

  /// Searches along an edge by `ask`, held pairs included.
  template <class Ask>
  [[nodiscard]] EdgeAnswer ask_along(const Configuration& from, const Configuration& to,
                                     const Ask& ask) {
    ThreadWork& work = *works.local();
    plan.set_motions(work.search, from, to);
    const detail::EdgeFound found = with_held(work, from, to, ask(work.search), ask);
    const EdgeAnswer edge = answer(from, to, found, work.search.least_margin());
    return edge.fraction > 0.0 ? edge : with_proven_piece(work, from, to, found, edge, ask);
  }

  /// Finds the fraction to which an edge is proven, where rounding is too large for a piece to
  /// inherit the proof. Rounding moves the axis of a screw, and places far from the origin. So the
  /// piece itself is searched.
  template <class Ask>
  [[nodiscard]] EdgeAnswer with_proven_piece(ThreadWork& work, const Configuration& from,
                                             const Configuration& to,
                                             const detail::EdgeFound& found, EdgeAnswer edge,
                                             const Ask& ask) {
    constexpr std::array<double, 3> kShares = {1.0, 1.0 - 1e-4, 0.9};
    for (const double share : kShares) {
      const double fraction = share * found.t;
      if (edge.verdict == EdgeVerdict::free || !(fraction > 0.0)) {
        break;
      }
      const Configuration piece = plan.space.interpolate(from, to, fraction);
      plan.set_motions(work.search, from, piece);
      if (with_held(work, from, piece, ask(work.search), ask).verdict == Verdict::free) {
        edge.fraction = fraction;
        break;
      }
    }
    return edge;
  }

  /// Returns a finding, or that of `ask` for held pairs where it is earlier.
  template <class Ask>
  [[nodiscard]] detail::EdgeFound with_held(ThreadWork& work, const Configuration& from,
                                            const Configuration& to, const detail::EdgeFound& found,
                                            const Ask& ask) {
    if (!work.search_of_held) {
      return found;
    }
    plan.set_motions(*work.search_of_held, from, to);
    return earlier(found, ask(*work.search_of_held));
  }

  /// Makes the answer of a finding.
  ///
  /// Before t all pairs are free, with the extra. The extra is larger than the departure of a piece
  /// to a rounded place. Held pairs have their tolerance in place of the extra, where that is less.
  [[nodiscard]] EdgeAnswer answer(const Configuration& from, const Configuration& to,
                                  const detail::EdgeFound& found, double least_margin) const {
    EdgeAnswer answer;
    answer.pair = found.pair;
    answer.reason = found.reason;
    answer.clearance = finite_clearance(least_margin);
    if (found.verdict == Verdict::free) {
      answer.verdict = EdgeVerdict::free;
      answer.fraction = 1.0;
      return answer;
    }
    answer.verdict = is_contact(found.verdict) ? EdgeVerdict::blocked : EdgeVerdict::undecided;
    const bool inherits = plan.space.rounding_bound(from, to, carried) <= rounding;
    answer.fraction = inherits ? found.t : 0.0;
    if (found.t == 0.0) {
      answer.clearance = 0.0;
    }
    return answer;
  }

  PlanScene plan;
  EdgeCheckOptions options;
  double carried;                  // [m]
  double rounding;                 // [m]  Permitted departure of pieces of edges.
  RobotScene padded;               // With the extra clearance; each thread has a copy.
  std::optional<RobotScene> held;  // Set where pairs are held; copied in the same way.
  tbb::enumerable_thread_specific<std::unique_ptr<ThreadWork>> works;
};

EdgeChecker::EdgeChecker(PlanScene scene, const EdgeCheckOptions& options) {
  require_options(options);
  require_robots(scene);
  require_at_rest(scene);
  const FloatEnvironmentGuard guard;
  data_ = std::make_unique<Data>(std::move(scene), options);
}

EdgeChecker::~EdgeChecker() = default;
EdgeChecker::EdgeChecker(EdgeChecker&&) noexcept = default;
EdgeChecker& EdgeChecker::operator=(EdgeChecker&&) noexcept = default;

const PlanScene& EdgeChecker::scene() const { return data_->plan; }
const EdgeCheckOptions& EdgeChecker::options() const { return data_->options; }

EdgeAnswer EdgeChecker::check(const Configuration& from, const Configuration& to) const {
  const FloatEnvironmentGuard guard;
  return data_->ask_along(from, to,
                          [](detail::EdgeSearch& search) { return search.first_contact(); });
}

EdgeAnswer EdgeChecker::check_quickly(const Configuration& from, const Configuration& to) const {
  const FloatEnvironmentGuard guard;
  return data_->ask_along(from, to,
                          [](detail::EdgeSearch& search) { return search.any_contact(); });
}

EdgeAnswer EdgeChecker::check_closely(const Configuration& from, const Configuration& to) const {
  const FloatEnvironmentGuard guard;
  Data::ThreadWork& work = *data_->works.local();
  std::optional<RobotChecker>& closest = work.closest;
  if (!closest) {
    closest.emplace(data_->padded);
  }
  scene().set_motions(*closest, from, to);
  RobotCheckOptions question = detail::question_of_edges(data_->options);
  question.closest = true;
  const SceneResult found = closest->check(question);
  detail::EdgeFound first{found.verdict, found.t, {}, found.reason};
  if (found.first) {
    first.pair = found.pairs[*found.first].members;
  } else if (found.closest) {
    first.pair = found.pairs[*found.closest].members;
  }
  first = data_->with_held(work, from, to, first,
                           [](detail::EdgeSearch& search) { return search.first_contact(); });
  EdgeAnswer answer = data_->answer(from, to, first, found.clearance);
  if (answer.fraction == 0.0) {
    answer =
        data_->with_proven_piece(work, from, to, first, answer,
                                 [](detail::EdgeSearch& search) { return search.first_contact(); });
  }
  if (answer.verdict == EdgeVerdict::free && found.closest) {
    answer.reason = found.pairs[*found.closest].closest->reason;
  }
  return answer;
}

std::vector<EdgeAnswer> EdgeChecker::check(std::span<const Configuration> from,
                                           std::span<const Configuration> to, int threads) const {
  if (from.size() != to.size()) {
    throw std::invalid_argument("expected as many ends of edges as starts, got " +
                                std::to_string(to.size()) + " and " + std::to_string(from.size()));
  }
  std::vector<EdgeAnswer> answers(from.size());
  parallel_for(threads, from.size(), [&](std::size_t k) { answers[k] = check(from[k], to[k]); });
  return answers;
}

bool EdgeChecker::is_free(const Configuration& q) const {
  return check_quickly(q, q).verdict == EdgeVerdict::free;
}

StateAnswer EdgeChecker::state(const Configuration& q) const {
  const EdgeAnswer found = check_closely(q, q);
  return {found.verdict, found.verdict == EdgeVerdict::free ? found.clearance : std::optional(0.0),
          found.pair};
}

}  // namespace firstcontact
