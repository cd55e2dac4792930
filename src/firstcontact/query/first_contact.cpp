#include <firstcontact/query/first_contact.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/query/detail/contact_search.h>
#include <firstcontact/query/detail/contact_state.h>
#include <firstcontact/query/detail/containment.h>
#include <firstcontact/query/detail/order.h>
#include <firstcontact/query/detail/pair_query.h>
#include <firstcontact/query/shape_pair.h>

namespace firstcontact {
namespace {

using detail::MovingPair;

void require_range(bool holds, const char* option, const char* range, double value) {
  if (!holds) {
    throw std::invalid_argument(std::string("FirstContactOptions::") + option + " must be " +
                                range + ", got " + std::to_string(value));
  }
}

/// Eight times the error of a gap near contact: below it doubles cannot tell distances apart.
double resolvable_distance(const MovingPair& pair, RelativeState state, double margin) {
  state.p_AB = Eigen::Vector3d(pair.A().radius + pair.B().radius + margin, 0.0, 0.0);
  return 8.0 * pair.gap_error(state);
}

/// Far above the motion between neighbouring times, which ends a search of very fast bodies.
double resolvable_motion(const MovingPair& pair) { return 0x1p-49 * pair.speed_bound(); }

/// Searches a part of a piece in windows of time. Bodies that stay close for long are opened to
/// their triangles and never closed again; a new search from the root costs less than to drag these
/// along. Most pieces are one window.
detail::PieceResult search_windows(const MovingPair& pair, const TimeWindow& part,
                                   detail::SearchLimits limits, detail::WorkspaceData& workspace,
                                   WorkCount& work) {
  constexpr std::uint64_t kPatience = 1u << 17;
  // Far above the distance of neighbouring times; ties are not told apart by shorter windows.
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

/// Searches a part of a piece with the tolerance in use; where time is too coarse for it, with a
/// larger one.
detail::PieceResult search(const MovingPair& pair, const TimeWindow& part,
                           detail::SearchLimits limits, detail::WorkspaceData& workspace,
                           FirstContactResult& result) {
  detail::PieceResult found = search_windows(pair, part, limits, workspace, result.work);
  if (found.reason == UndecidedReason::precision && resolvable_motion(pair) > limits.tolerance) {
    limits.tolerance = result.tolerance_used = resolvable_motion(pair);
    found = search_windows(pair, part, limits, workspace, result.work);
  }
  return found;
}

void report_contacts(const ShapePair& shapes, const MovingPair& pair,
                     const detail::PieceResult& found, const FirstContactOptions& options,
                     detail::WorkspaceData& workspace, FirstContactResult& result) {
  const auto& [A, B, motion] = shapes;
  const detail::ContactFrame frame{A, B, pair, result.t, motion.origin(result.t)};
  if (options.contacts == ContactState::none) {
    return;
  }
  if (options.contacts == ContactState::first) {
    const RelativeState state = motion.state(result.t);
    const TrianglePair triangles = pair.place(state, found.triangle_A, found.triangle_B);
    result.contacts.push_back(detail::make_contact(frame, state, found.triangle_A, found.triangle_B,
                                                   triangle_distance(triangles.A, triangles.B)));
    result.contact_count = {1, false};
    return;
  }
  const double band =
      options.margin + result.tolerance_used + options.contact_band + A.radius() + B.radius();
  const auto collect = found.all_remembered && options.contact_band == 0.0
                           ? detail::collect_contacts_of
                           : detail::collect_contacts;
  result.contact_count = collect(frame, band, options.contacts.most, workspace, result.contacts);
}

/// Searches the piece that was entered; whether that ends the query.
bool solve_piece(const ShapePair& shapes, const TimeWindow& part, const RelativeState& start,
                 detail::WorkspaceData& workspace, const FirstContactOptions& options,
                 FirstContactResult& result) {
  const auto& [A, B, motion] = shapes;
  const MovingPair pair(A.hierarchy(), B.hierarchy(), motion);
  const double radii = A.radius() + B.radius();
  result.tolerance_used =
      std::max(result.tolerance_used,
               resolvable_distance(pair, motion.state(part.begin), options.margin + radii));
  const detail::SearchLimits limits{.margin = options.margin + radii,
                                    .radii = radii,
                                    .tolerance = result.tolerance_used,
                                    .start_contacts = options.start_contacts,
                                    .start = start,
                                    .budget = options.budget,
                                    .A = &A,
                                    .B = &B};
  const detail::PieceResult found = search(pair, part, limits, workspace, result);
  result.t = found.t;
  if (found.contact) {
    result.t_upper = found.t;
  }
  if (found.reason != UndecidedReason::none) {
    result.verdict = Verdict::undecided;
    result.reason = found.reason;
    return true;
  }
  if (found.contact) {
    result.verdict = found.t > 0.0 ? Verdict::contact : Verdict::contact_at_start;
    result.clearance = found.t > 0.0 ? result.clearance : 0.0;
    report_contacts(shapes, pair, found, options, workspace, result);
  }
  return found.contact;
}

/// @param start  where start distances are taken, if they are
void solve(const ShapePair& shapes, const TimeWindow& window, const RelativeState& start,
           detail::WorkspaceData& workspace, const FirstContactOptions& options,
           FirstContactResult& result) {
  result.tolerance_used = options.tolerance;
  double begin = window.begin;
  while (true) {
    const double end = std::min(shapes.motion.enter(begin), window.end);
    if (solve_piece(shapes, {begin, end}, start, workspace, options, result)) {
      return;
    }
    if (end >= window.end) {
      break;
    }
    begin = end;
  }
  result.verdict = Verdict::free;
}

/// A contact at t = 0 of a body that lies in another.
void report_contained(const ShapePair& shapes, const RelativeState& state,
                      const detail::Containment& found, const FirstContactOptions& options,
                      FirstContactResult& result) {
  result.verdict = Verdict::contact_at_start;
  result.clearance = 0.0;
  result.t = 0.0;
  result.t_upper = 0.0;
  result.tolerance_used = options.tolerance;
  if (options.contacts != ContactState::none) {
    const auto& [A, B, motion] = shapes;
    const MovingPair pair(A.hierarchy(), B.hierarchy(), motion);
    result.contacts.push_back(
        detail::make_contact({A, B, pair, 0.0, motion.origin(0.0)}, state, found));
    result.contact_count = {1, true};
  }
}

/// Nothing gets into a solid without crossing its surface: it is enough to look at the start.
void solve_solids(const ShapePair& shapes, const TimeWindow& window, const RelativeState& start,
                  detail::WorkspaceData& workspace, const FirstContactOptions& options,
                  FirstContactResult& result) {
  const auto& [A, B, motion] = shapes;
  const detail::Containment found =
      detail::find_containment(A, B, MovingPair(A.hierarchy(), B.hierarchy(), motion), start);
  if (found.inside == detail::Inside::yes) {
    report_contained(shapes, start, found, options, result);
    return;
  }
  solve(shapes, window, start, workspace, options, result);
  if (found.inside == detail::Inside::unsure && result.verdict != Verdict::contact_at_start) {
    result.verdict = Verdict::undecided;
    result.reason = UndecidedReason::precision;
    result.t = 0.0;
    result.contacts.clear();
    result.contact_count = {};
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
  detail::validate(options);
  const FloatEnvironmentGuard guard;
  result.reason = UndecidedReason::none;
  result.t = window.begin;
  result.t_upper.reset();
  result.clearance = options.start_contacts == StartContacts::report ? options.margin : 0.0;
  result.enclosure_error = pair.A.enclosure_error() + pair.B.enclosure_error();
  result.contacts.clear();
  result.contact_count = {};
  result.work = {};
  const bool has_inside = window.begin == 0.0 && (pair.A.is_solid() || pair.B.is_solid());
  RelativeState start;
  if (has_inside || options.start_contacts == StartContacts::keep_half) {
    pair.motion.enter(0.0);
    start = pair.motion.state(0.0);
  }
  if (has_inside) {
    solve_solids(pair, window, start, workspace.data(), options, result);
  } else {
    solve(pair, window, start, workspace.data(), options, result);
  }
}

void detail::first_contact_within(const MovingShape& A, const MovingShape& B,
                                  const TimeWindow& window, Workspace& workspace,
                                  const FirstContactOptions& options, FirstContactResult& result) {
  const auto ask = [&](const MovingShape& first, const MovingShape& second) {
    ConstantRatePair motion = detail::motion_of(first, second, options.tolerance);
    first_contact({first.shape, second.shape, motion}, window, workspace, options, result);
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
