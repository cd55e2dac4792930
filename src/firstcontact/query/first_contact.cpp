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

namespace firstcontact {
namespace {

using detail::MovingPair;
using detail::Window;

void require_range(bool holds, const char* option, const char* range, double value) {
  if (!holds) {
    throw std::invalid_argument(std::string("FirstContactOptions::") + option + " must be " +
                                range + ", got " + std::to_string(value));
  }
}

/// Eight times the error of a gap near contact: below it doubles cannot tell distances apart.
double resolvable_distance(const MovingPair& pair, double margin) {
  const double size = pair.A().radius + pair.B().radius;
  RelativeState touching;
  touching.p_AB = Eigen::Vector3d(size + margin, 0.0, 0.0);
  return 8.0 * pair.gap_error(touching);
}

/// Far above the motion between neighbouring times, which ends a search of very fast bodies.
double resolvable_motion(const MovingPair& pair) { return 0x1p-49 * pair.speed_bound(); }

/// Searches a part of a piece in windows of time. Bodies that stay close for long are opened to
/// their triangles and never closed again; a new search from the root costs less than to drag these
/// along. Most pieces are one window.
detail::PieceResult search_windows(const MovingPair& pair, const Window& part,
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
detail::PieceResult search(const MovingPair& pair, const Window& part, detail::SearchLimits limits,
                           detail::WorkspaceData& workspace, FirstContactResult& result) {
  detail::PieceResult found = search_windows(pair, part, limits, workspace, result.work);
  if (found.reason == UndecidedReason::precision && resolvable_motion(pair) > limits.tolerance) {
    limits.tolerance = result.tolerance_used = resolvable_motion(pair);
    found = search_windows(pair, part, limits, workspace, result.work);
  }
  return found;
}

void report_contacts(const MovingShape& A, const MovingShape& B, const MovingPair& pair,
                     const Eigen::Vector3d& p_WC, const detail::PieceResult& found,
                     const FirstContactOptions& options, detail::WorkspaceData& workspace,
                     FirstContactResult& result) {
  const detail::ContactFrame frame{A.shape, B.shape, pair, result.t, p_WC};
  if (options.contacts == ContactState::first) {
    const RelativeState state = pair.motion().state(result.t);
    const TrianglePair triangles = pair.place(state, found.triangle_A, found.triangle_B);
    result.contacts.push_back(detail::make_contact(frame, state, found.triangle_A, found.triangle_B,
                                                   triangle_distance(triangles.A, triangles.B)));
  } else if (options.contacts == ContactState::all) {
    const double band = options.margin + result.tolerance_used + options.contact_band +
                        A.shape.radius() + B.shape.radius();
    if (found.all_remembered && options.contact_band == 0.0) {
      detail::collect_contacts_of(workspace.opened_pairs, frame, band, result.contacts);
    } else {
      detail::collect_contacts(frame, band, workspace, result.contacts);
    }
  }
}

void solve(const MovingShape& A, const MovingShape& B, const Window& window,
           detail::WorkspaceData& workspace, const FirstContactOptions& options,
           FirstContactResult& result) {
  const Hierarchy& hA = A.shape.hierarchy();
  const Hierarchy& hB = B.shape.hierarchy();
  const RelativeMotion start_motion(A.X_WS.path(0, hA.centre), B.X_WS.path(0, hB.centre),
                                    options.tolerance);
  const MovingPair start(hA, hB, start_motion);
  result.tolerance_used = options.tolerance;
  result.t = window.begin;
  for (detail::SharedPiece piece(A.X_WS, B.X_WS); piece.valid(); piece.next()) {
    const Window part{std::max(piece.begin(), window.begin), std::min(piece.end(), window.end)};
    if (part.begin > part.end) {
      continue;
    }
    const RelativeMotion motion(A.X_WS.path(piece.index_A(), hA.centre),
                                B.X_WS.path(piece.index_B(), hB.centre), options.tolerance);
    const MovingPair pair(hA, hB, motion);
    const double radii = A.shape.radius() + B.shape.radius();
    result.tolerance_used =
        std::max(result.tolerance_used, resolvable_distance(pair, options.margin + radii));
    const detail::SearchLimits limits{options.margin + radii, radii, result.tolerance_used,
                                      options.start_contacts, start, options.budget};
    const detail::PieceResult found = search(pair, part, limits, workspace, result);
    result.t = found.t;
    if (found.contact) {
      result.t_upper = found.t;
    }
    if (found.reason != UndecidedReason::none) {
      result.verdict = Verdict::undecided;
      result.reason = found.reason;
      return;
    }
    if (found.contact) {
      result.verdict = found.t > 0.0 ? Verdict::contact : Verdict::contact_at_start;
      const ConstantRatePath& path = motion.A();
      const Eigen::Vector3d p_WC = (path.pivot(found.t) + path.precise_lever(found.t)).value();
      report_contacts(A, B, pair, p_WC, found, options, workspace, result);
      return;
    }
  }
  result.verdict = Verdict::free;
}

/// A contact at t = 0 of a body that lies in another.
void report_contained(const MovingShape& A, const MovingShape& B, const MovingPair& start,
                      const RelativeState& state, const detail::Containment& found,
                      const FirstContactOptions& options, FirstContactResult& result) {
  result.verdict = Verdict::contact_at_start;
  result.t = 0.0;
  result.t_upper = 0.0;
  result.tolerance_used = options.tolerance;
  if (options.contacts != ContactState::none) {
    const ConstantRatePath& path = start.motion().A();
    const Eigen::Vector3d p_WC = (path.pivot(0.0) + path.precise_lever(0.0)).value();
    result.contacts.push_back(
        detail::make_contact({A.shape, B.shape, start, 0.0, p_WC}, state, found));
  }
}

/// Nothing gets into a solid without crossing its surface: it is enough to look at the start.
void solve_solids(const MovingShape& A, const MovingShape& B, const Window& window,
                  detail::WorkspaceData& workspace, const FirstContactOptions& options,
                  FirstContactResult& result) {
  if (!A.shape.is_solid() && !B.shape.is_solid()) {
    solve(A, B, window, workspace, options, result);
    return;
  }
  const Hierarchy& hA = A.shape.hierarchy();
  const Hierarchy& hB = B.shape.hierarchy();
  const RelativeMotion motion(A.X_WS.path(0, hA.centre), B.X_WS.path(0, hB.centre),
                              options.tolerance);
  const MovingPair start(hA, hB, motion);
  const RelativeState state = motion.state(0.0);
  const detail::Containment found = detail::find_containment(A.shape, B.shape, start, state);
  if (found.inside == detail::Inside::yes) {
    report_contained(A, B, start, state, found, options, result);
    return;
  }
  solve(A, B, window, workspace, options, result);
  if (found.inside == detail::Inside::unsure && result.verdict != Verdict::contact_at_start) {
    result.verdict = Verdict::undecided;
    result.reason = UndecidedReason::precision;
    result.t = 0.0;
    result.contacts.clear();
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
}

void detail::first_contact_within(const MovingShape& A, const MovingShape& B, const Window& window,
                                  Workspace& workspace, const FirstContactOptions& options,
                                  FirstContactResult& result) {
  validate(options);
  const FloatEnvironmentGuard guard;
  result.reason = UndecidedReason::none;
  result.t_upper.reset();
  result.clearance = options.start_contacts == StartContacts::report ? options.margin : 0.0;
  result.enclosure_error = A.shape.enclosure_error() + B.shape.enclosure_error();
  result.contacts.clear();
  result.work = {};
  const auto ask = [&](const MovingShape& first, const MovingShape& second) {
    if (window.begin == 0.0) {
      solve_solids(first, second, window, workspace.data(), options, result);
    } else {
      solve(first, second, window, workspace.data(), options, result);
    }
  };
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
