#include <firstcontact/query/first_contact.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

#include <firstcontact/geometry/feature_table.h>
#include <firstcontact/math/float_environment.h>
#include <firstcontact/math/number_text.h>
#include <firstcontact/moving_pairs/detail/convex_leaf.h>
#include <firstcontact/query/detail/contact_search.h>
#include <firstcontact/query/detail/contact_state.h>
#include <firstcontact/query/detail/containment.h>
#include <firstcontact/query/detail/convex_search.h>
#include <firstcontact/query/detail/corner_lines.h>
#include <firstcontact/query/detail/front_query.h>
#include <firstcontact/query/detail/nearest_triangles.h>
#include <firstcontact/query/detail/order.h>
#include <firstcontact/query/detail/pair_query.h>
#include <firstcontact/query/shape_pair.h>

namespace firstcontact {
namespace {

using detail::Hold;
using detail::MovingPair;

void require_range(bool holds, const char* option, const char* range, double value) {
  if (!holds) {
    throw std::invalid_argument(std::string("FirstContactOptions::") + option + " must be " +
                                range + ", got " + detail::shortest(value));
  }
}

/// Eight times the error of a gap near contact; doubles cannot distinguish smaller distances.
double resolvable_distance(const MovingPair& pair, RelativeState state, double margin) {
  state.p_AB = Eigen::Vector3d(pair.A().radius + pair.B().radius + margin, 0.0, 0.0);
  return 8.0 * pair.gap_error(state);
}

/// [m]  More than the motion between neighbouring times, which ends a search of very fast bodies.
double resolvable_motion(const MovingPair& pair) { return 0x1p-49 * pair.speed_bound(); }

/// Searches a part of a piece in windows of time; most pieces are one window.
///
/// Bodies that stay close for long are opened to their triangles and never closed again. A new
/// search from the root costs less than keeping these triangles.
detail::PieceResult search_windows(const MovingPair& pair, const TimeWindow& part,
                                   detail::SearchLimits limits, detail::WorkspaceData& workspace,
                                   WorkCount& work) {
  if (pair.convex_A() != nullptr && pair.convex_B() != nullptr) {
    return detail::search_convex_pair({*pair.convex_A(), *pair.convex_B(), pair.motion()},
                                      part.begin, part.end, limits, work);
  }
  constexpr std::uint64_t kPatience = 1u << 17;
  // More than the distance of neighbouring times; shorter windows do not separate ties.
  constexpr double kLeastWidth = 0x1p-32;
  double begin = part.begin;
  double width = part.end - begin;
  while (true) {
    const double end = std::min(begin + width, part.end);
    const std::uint64_t before = work.node_groups + work.steps;
    limits.patience = width > kLeastWidth ? kPatience : std::numeric_limits<std::uint64_t>::max();
    const detail::PieceResult found =
        detail::search_piece(pair, begin, end, limits, workspace, work);
    if (found.impatient) {
      width = std::clamp(found.t - begin, width / 16.0, width / 2.0);
      begin = found.t;
    } else if (found.finished && end < part.end) {
      const bool quick = work.node_groups + work.steps - before < kPatience / 2;
      width = quick ? 2.0 * width : width;
      begin = end;
    } else {
      return found;
    }
  }
}

/// [-]  Part of the distance by which the nearest points that are found may be farther.
constexpr double kSlack = 0x1p-10;

/// The gap of two shapes at a state.
///
/// @param start  state of the motion that was entered
detail::StartGap gap_at(const ShapePair& shapes, const RelativeState& start,
                        detail::WorkspaceData& workspace, const FirstContactOptions& options,
                        WorkCount& work) {
  const auto& [A, B, motion] = shapes;
  const MovingPair pair(A, B, motion);
  const double radii = A.radius() + B.radius();
  const double margin = options.margin + radii;
  const double tolerance = std::max(options.tolerance, resolvable_distance(pair, start, margin));
  const double error = pair.gap_error(start);
  const detail::NearestTriangles nearest = detail::nearest_triangles(
      pair, start, workspace, work,
      {.within = margin + tolerance + 2.0 * error, .slack = kSlack, .budget = options.budget});
  return {.apart = nearest.distance - radii, .error = error, .stopped = nearest.stopped};
}

/// Searches a part of a piece, with a larger tolerance where doubles come no further.
///
/// That is where time is too coarse for the tolerance, or triangles are too thin. `limits` then has
/// the larger tolerance.
///
/// @param margin  [m]  radii included
detail::PieceResult search(const MovingPair& pair, const TimeWindow& part, double margin,
                           detail::SearchLimits& limits, detail::WorkspaceData& workspace,
                           WorkCount& work) {
  constexpr double kLarger = 8.0;
  constexpr double kLargest = 0x1p-34;  // [-]  Relative to the size; a larger tolerance would be no
                                        // answer.
  const double coarse = resolvable_motion(pair);
  const double largest = std::max(coarse, kLargest * (pair.A().radius + pair.B().radius));
  detail::PieceResult found = search_windows(pair, part, limits, workspace, work);
  while (found.reason == UndecidedReason::precision && limits.tolerance < largest) {
    limits.tolerance = std::min(std::max(coarse, kLarger * limits.tolerance), largest);
    const double above = std::max(0.0, limits.threshold - margin);  // Positive only for a pair that
                                                                    // is held.
    limits.band = std::max(limits.band, margin + (above + limits.tolerance));
    found = search_windows(pair, part, limits, workspace, work);
  }
  return found;
}

/// One query, with the data at hand for it.
struct Query {
  const ShapePair& shapes;
  const TimeWindow& window;
  const FirstContactOptions& options;
  const detail::CornerLines* lines;  ///< null: not known
  detail::WorkspaceData& workspace;
  Hold hold;
  const detail::BoxFront* front = nullptr;  ///< null: begins at the roots
  double early = 0.0;                       ///< [-]  as SearchLimits::early
};

/// Reports only the pair that decided.
void report_first(const detail::ContactFrame& frame, const detail::PieceResult& found,
                  FirstContactResult& result) {
  const MovingPair& pair = frame.pair;
  const RelativeState state = pair.motion().state(frame.t);
  ClosestFeatures closest;
  if (pair.is_convex()) {
    closest = detail::closest_features(pair, state, found.triangle_A, found.triangle_B);
  } else {
    const TrianglePair triangles = pair.place(state, found.triangle_A, found.triangle_B);
    closest = triangle_distance(triangles.A, triangles.B);
  }
  result.contacts.push_back(
      detail::make_contact(frame, state, found.triangle_A, found.triangle_B, closest));
  result.contact_count = {1, false};
}

/// Reports the contacts at the time of a contact.
///
/// @param tolerance  [m]  resolution of the search
void report_contacts(const Query& query, const MovingPair& pair, const detail::PieceResult& found,
                     double tolerance, FirstContactResult& result) {
  const auto& [A, B, motion] = query.shapes;
  const FirstContactOptions& options = query.options;
  const detail::ContactFrame frame{A, B, pair, result.t, motion.origin(result.t)};
  if (options.contacts == ContactState::none) {
    return;
  }
  if (options.contacts == ContactState::first) {
    report_first(frame, found, result);
    return;
  }
  const double band = options.margin + tolerance + options.contact_band + A.radius() + B.radius();
  const auto collect = found.all_remembered && options.contact_band == 0.0
                           ? detail::collect_contacts_of
                           : detail::collect_contacts;
  result.contact_count =
      collect(frame, band, options.contacts.most, query.workspace, result.contacts);
  if (pair.is_convex() && result.contacts.empty()) {
    report_first(frame, found, result);  // The pair is just outside, by rounding.
  }
}

/// [m]  The tolerance that an answer holds to.
///
/// @param limits   limits as they were in the end
/// @param above    [m]  excess of the threshold over the margin
double tolerance_of(const detail::PieceResult& found, const detail::SearchLimits& limits,
                    double above, double coarse, double asked) {
  const bool is_precise = limits.lines != nullptr && found.reason == UndecidedReason::none &&
                          (!found.contact || found.precise_tolerance > 0.0);
  if (is_precise) {
    return found.contact ? std::max(asked, above + found.precise_tolerance) : asked;
  }
  return coarse;
}

/// Searches the piece that was entered; returns whether that ends the query.
bool solve_piece(const Query& query, const TimeWindow& part, FirstContactResult& result) {
  const auto& [A, B, motion] = query.shapes;
  const FirstContactOptions& options = query.options;
  const MovingPair pair(A, B, motion);
  const double radii = A.radius() + B.radius();
  const double margin = options.margin + radii;
  const RelativeState state = motion.state(part.begin);
  double coarse = std::max(result.tolerance_used, resolvable_distance(pair, state, margin));
  const bool by_triangles = query.lines != nullptr && !pair.is_convex();
  detail::SearchLimits limits{
      .threshold = query.hold.distance + radii,
      .tolerance = std::min(coarse, query.hold.tolerance),
      .band = margin + coarse,
      .asked = std::min(options.tolerance, query.hold.tolerance),
      .early = query.early,
      .lines = by_triangles && query.lines->exist(state) ? query.lines : nullptr,
      .budget = options.budget,
      .A = pair.is_convex() ? nullptr : &A,
      .B = pair.is_convex() ? nullptr : &B,
      .front = query.front};
  const double above = std::max(0.0, limits.threshold - margin);  // Positive only for a pair that
                                                                  // is held.
  const double first = limits.tolerance;
  const detail::PieceResult found =
      search(pair, part, margin, limits, query.workspace, result.work);
  if (limits.tolerance > first) {
    coarse = std::max(coarse, above + limits.tolerance);
  }
  result.tolerance_used = tolerance_of(found, limits, above, coarse, options.tolerance);
  result.t = found.t;
  if (found.contact) {
    result.t_upper = std::max(found.t, found.t_upper);
  }
  if (found.reason != UndecidedReason::none) {
    result.verdict = Verdict::undecided;
    result.reason = found.reason;
    return true;
  }
  if (found.contact) {
    result.verdict = found.t > 0.0 ? Verdict::contact : Verdict::contact_at_start;
    result.clearance = found.t > 0.0 ? result.clearance : 0.0;
    report_contacts(query, pair, found, coarse, result);
  }
  return found.contact;
}

void solve(const Query& query, FirstContactResult& result) {
  if (query.hold.stopped != UndecidedReason::none) {
    result.verdict = Verdict::undecided;
    result.reason = query.hold.stopped;
    return;
  }
  result.clearance = query.hold.distance;
  double begin = query.window.begin;
  while (true) {
    const double end = std::min(query.shapes.motion.enter(begin), query.window.end);
    if (solve_piece(query, {begin, end}, result)) {
      return;
    }
    if (end >= query.window.end) {
      break;
    }
    begin = end;
  }
  result.verdict = Verdict::free;
}

/// Reports a contact at t = 0 of a body that lies in another.
void report_contained(const ShapePair& shapes, const RelativeState& state,
                      const detail::Containment& found, const FirstContactOptions& options,
                      FirstContactResult& result) {
  result.verdict = Verdict::contact_at_start;
  result.clearance = 0.0;
  result.t = 0.0;
  result.t_upper = 0.0;
  if (options.contacts != ContactState::none) {
    const auto& [A, B, motion] = shapes;
    const MovingPair pair(A, B, motion);
    result.contacts.push_back(
        detail::make_contact({A, B, pair, 0.0, motion.origin(0.0)}, state, found));
    result.contact_count = {1, true};
  }
}

/// Tests solids at the start: nothing gets into a solid without crossing its surface.
void solve_solids(const Query& query, const RelativeState& start, FirstContactResult& result) {
  const auto& [A, B, motion] = query.shapes;
  const detail::Containment found = detail::find_containment(A, B, MovingPair(A, B, motion), start);
  if (found.inside == detail::Inside::yes) {
    report_contained(query.shapes, start, found, query.options, result);
    return;
  }
  solve(query, result);
  if (found.inside == detail::Inside::unsure && result.verdict != Verdict::contact_at_start) {
    result.verdict = Verdict::undecided;
    result.reason = UndecidedReason::precision;
    result.t = 0.0;
    result.contacts.clear();
    result.contact_count = {};
  }
}

/// Answers a query.
///
/// @param lines  null where they are not known
/// @param held   distance to which the two are held; null: that of the options
/// @param early  [-]  as SearchLimits::early
void answer(const ShapePair& pair, const TimeWindow& window, const detail::CornerLines* lines,
            const Hold* held, Workspace& workspace, const FirstContactOptions& options,
            FirstContactResult& result, const detail::BoxFront* front = nullptr,
            double early = 0.0) {
  detail::validate(options);
  const FloatEnvironmentGuard guard;
  result.reason = UndecidedReason::none;
  result.t = window.begin;
  result.t_upper.reset();
  result.clearance = 0.0;
  result.tolerance_used = options.tolerance;
  result.enclosure_error = detail::enclosure_error(pair.A, pair.B);
  result.contacts.clear();
  result.contact_count = {};
  result.work = {};
  const bool has_inside = window.begin == 0.0 && (pair.A.is_solid() || pair.B.is_solid());
  const bool keeps = held == nullptr && options.start_contacts == StartContacts::keep_half;
  RelativeState start;
  if (has_inside || keeps) {
    pair.motion.enter(0.0);
    start = pair.motion.state(0.0);
  }
  Hold hold{.distance = options.margin};
  if (held != nullptr) {
    hold = *held;
  } else if (keeps) {
    hold = detail::keep_half(gap_at(pair, start, workspace.data(), options, result.work),
                             options.margin);
  }
  const Query query{pair, window, options, lines, workspace.data(), hold, front, early};
  if (has_inside) {
    solve_solids(query, start, result);
  } else {
    solve(query, result);
  }
}

}  // namespace

void detail::validate(const FirstContactOptions& options) {
  require_range(options.margin >= 0.0 && std::isfinite(options.margin), "margin", "finite and >= 0",
                options.margin);
  require_range(options.tolerance > 0.0 && std::isfinite(options.tolerance), "tolerance",
                "finite and > 0", options.tolerance);
  require_range(options.contact_band >= 0.0 && std::isfinite(options.contact_band), "contact_band",
                "finite and >= 0", options.contact_band);
  require_range(options.contacts.kind != ContactState::Kind::nearest || options.contacts.most >= 1,
                "contacts", "nearest(1) or more", static_cast<double>(options.contacts.most));
}

void first_contact(const ShapePair& pair, const TimeWindow& window, Workspace& workspace,
                   const FirstContactOptions& options, FirstContactResult& result) {
  answer(pair, window, nullptr, nullptr, workspace, options, result);
}

detail::StartGap detail::start_gap(const ShapePair& pair, double t, Workspace& workspace,
                                   const FirstContactOptions& options, WorkCount& work) {
  const FloatEnvironmentGuard guard;
  pair.motion.enter(t);
  return gap_at(pair, pair.motion.state(t), workspace.data(), options, work);
}

detail::StartGap detail::nearer(const StartGap& one, const StartGap& other) {
  return {.apart = std::min(one.apart, other.apart),
          .error = std::max(one.error, other.error),
          .stopped = one.stopped != UndecidedReason::none ? one.stopped : other.stopped};
}

detail::Hold detail::keep_half(const StartGap& start, double margin) {
  Hold hold{.distance = margin, .stopped = start.stopped};
  if (start.apart > 16.0 * start.error && std::isfinite(start.apart)) {
    hold.distance = 0.5 * start.apart;
    hold.tolerance = 0.25 * start.apart;
  }
  return hold;
}

void detail::first_contact_held(const ShapePair& pair, const TimeWindow& window, const Hold& hold,
                                Workspace& workspace, const FirstContactOptions& options,
                                FirstContactResult& result) {
  answer(pair, window, nullptr, &hold, workspace, options, result);
}

void detail::first_contact_early(const ShapePair& pair, const TimeWindow& window, double early,
                                 Workspace& workspace, const FirstContactOptions& options,
                                 FirstContactResult& result) {
  FirstContactOptions asked = options;
  asked.contacts = ContactState::none;
  answer(pair, window, nullptr, nullptr, workspace, asked, result, nullptr, early);
}

void detail::first_contact_within(const MovingShape& A, const MovingShape& B,
                                  const TimeWindow& window, Workspace& workspace,
                                  const FirstContactOptions& options, FirstContactResult& result) {
  const auto ask = [&](const MovingShape& first, const MovingShape& second) {
    ConstantRatePair motion = detail::motion_of(first, second, options.tolerance);
    const CornerLines lines(first, second);
    answer({first.shape, second.shape, motion}, window, &lines, nullptr, workspace, options,
           result);
  };
  const FloatEnvironmentGuard guard;
  if (in_order(A, B)) {
    ask(A, B);
    return;
  }
  ask(B, A);
  for (Contact& contact : result.contacts) {
    swap_bodies(contact);
  }
}

bool detail::may_have_front(const Shape& A, const Shape& B) {
  const bool are_triangles = !is_asked_as_convex(A, B) && !is_asked_as_convex(B, A);
  const bool are_rigid = !A.hierarchy().deforms() && !B.hierarchy().deforms();
  return are_triangles && are_rigid &&
         std::max(A.hierarchy().triangles.size(), B.hierarchy().triangles.size()) >
             FeatureTable::kMostTriangles;
}

void detail::first_contact_by_front(const BoxFront& front, const MovingShape& A,
                                    const MovingShape& B, const TimeWindow& window,
                                    Workspace& workspace, const FirstContactOptions& options,
                                    FirstContactResult& result) {
  const FloatEnvironmentGuard guard;
  ConstantRatePair motion = motion_of(A, B, options.tolerance);
  const CornerLines lines(A, B);
  answer({A.shape, B.shape, motion}, window, &lines, nullptr, workspace, options, result, &front);
}

void first_contact(const MovingShape& A, const MovingShape& B, Workspace& workspace,
                   const FirstContactOptions& options, FirstContactResult& result) {
  detail::first_contact_within(A, B, {}, workspace, options, result);
}

FirstContactResult first_contact(const MovingShape& A, const MovingShape& B, Workspace& workspace,
                                 const FirstContactOptions& options) {
  FirstContactResult result;
  first_contact(A, B, workspace, options, result);
  return result;
}

}  // namespace firstcontact
