#include <firstcontact/edges/detail/edge_search.h>

#include <algorithm>
#include <utility>
#include <vector>

#include <firstcontact/query/first_contact.h>
#include <firstcontact/robot_check/detail/geometry_search.h>

namespace firstcontact::detail {

EdgeSearch::EdgeSearch(RobotScene scene, const RobotCheckOptions& options, double early)
    : scene_(std::move(scene)),
      options_(options),
      early_(early),
      timeline_(scene_),
      candidates_(timeline_) {
  options_.contacts = ContactState::none;
  options_.contact_band = 0.0;
}

void EdgeSearch::set_motion(std::size_t robot, RobotMotion motion) {
  robot_ = robot;
  moved_body_ = motion.model().joints().empty() ? std::optional(motion.base()) : std::nullopt;
  scene_.set_motion(robot, std::move(motion));
  is_followed_ = false;
}

void EdgeSearch::follow_motions() {
  if (!is_followed_) {
    timeline_.follow_motions();
    workspace_.places.forget();
    is_followed_ = true;
  }
}

const Motion* EdgeSearch::body_motion(std::size_t geometry) const {
  const std::size_t member = timeline_.geometries()[geometry].member;
  if (const std::optional<RobotLink> link = scene_.robot_link(member)) {
    return link->robot == robot_ && moved_body_ ? &*moved_body_ : nullptr;
  }
  return scene_.rests(member) ? &scene_.body_motion(member) : nullptr;
}

FirstContactResult EdgeSearch::ask(const GeometryCandidate& candidate, const TimeWindow& window) {
  const Motion* A = body_motion(candidate.geometries[0]);
  const Motion* B = body_motion(candidate.geometries[1]);
  if (A != nullptr && B != nullptr && !candidate.hold && window.begin < window.end) {
    const auto shape = [&](std::size_t k) -> const Shape& {
      return *timeline_.geometries()[candidate.geometries[k]].shape;
    };
    FirstContactResult result =
        firstcontact::first_contact({shape(0), *A}, {shape(1), *B}, workspace_.queries,
                                    {.margin = candidate.threshold,
                                     .tolerance = options_.tolerance,
                                     .contacts = ContactState::none,
                                     .budget = options_.budget});
    if (result.t > window.end) {
      result.verdict = Verdict::free;
      result.t = window.end;
    }
    return result;
  }
  GeometrySearch search(timeline_, candidate, options_, workspace_);
  return window.begin < window.end && !candidate.hold ? search.first_contact_early(window, early_)
                                                      : search.first_contact(window);
}

EdgeFound EdgeSearch::found_by(const GeometryCandidate& candidate,
                               const FirstContactResult& result) const {
  return {result.verdict, result.t, timeline_.pairs()[candidate.pair].members, result.reason};
}

bool EdgeSearch::is_contact_at(const GeometryCandidate& instant) {
  GeometrySearch search(timeline_, instant, options_, workspace_);
  if (!instant.hold && search.has_vertex_inside(instant.window.begin)) {
    return true;
  }
  return is_contact(ask(instant, instant.window).verdict);
}

bool EdgeSearch::is_inside_at(const GeometryCandidate& candidate, const TimeWindow& within) {
  return within.begin == within.end &&
         GeometrySearch(timeline_, candidate, options_, workspace_).is_inside(within.begin);
}

EdgeFound EdgeSearch::first_contact() {
  follow_motions();
  EdgeFound first;
  if (const UndecidedReason reason = spent(options_.budget); reason != UndecidedReason::none) {
    return {Verdict::undecided, 0.0, {}, reason};
  }
  // A contact makes all later windows unnecessary.
  const WindowProbe probe = [&](const GeometryCandidate& overlapping) {
    first = earlier_by(overlapping, first);
    return first.t;
  };
  for (std::size_t piece = 0; piece < timeline_.piece_count(); ++piece) {
    if (timeline_.piece(piece).begin > first.t) {
      break;
    }
    std::vector<GeometryCandidate> left = candidates_.find_until_contact(piece, probe);
    std::stable_sort(left.begin(), left.end(),
                     [](const GeometryCandidate& x, const GeometryCandidate& y) {
                       return x.window.begin < y.window.begin;
                     });
    for (const GeometryCandidate& candidate : left) {
      first = earlier_by(candidate, first);
    }
  }
  return first;
}

EdgeFound EdgeSearch::earlier_by(const GeometryCandidate& candidate, const EdgeFound& first) {
  if (candidate.window.begin > first.t) {
    return first;
  }
  const FirstContactResult result =
      ask(candidate, {candidate.window.begin, std::min(candidate.window.end, first.t)});
  if (result.verdict == Verdict::free) {
    return first;
  }
  // At the same time a contact has priority over an undecided pair.
  const bool is_earlier =
      result.t < first.t || first.verdict == Verdict::free ||
      (result.t == first.t && is_contact(result.verdict) && !is_contact(first.verdict));
  return is_earlier ? found_by(candidate, result) : first;
}

EdgeFound EdgeSearch::any_contact(const TimeWindow& within) {
  follow_motions();
  EdgeFound unknown;
  if (const UndecidedReason reason = spent(options_.budget); reason != UndecidedReason::none) {
    return {Verdict::undecided, 0.0, {}, reason};
  }
  const InstantProbe probe = [&](const GeometryCandidate& at) {
    return within.begin <= at.window.begin && at.window.begin <= within.end && is_contact_at(at);
  };
  for (std::size_t piece = 0; piece < timeline_.piece_count(); ++piece) {
    const TimeWindow whole = timeline_.piece(piece);
    if (whole.end < within.begin || whole.begin > within.end) {
      continue;
    }
    ProbedCandidates found = candidates_.find_unless_contact(piece, probe);
    if (found.contact) {
      return contact_of(*found.contact);
    }
    const EdgeFound of_piece = any_contact(std::move(found.candidates), whole, within);
    if (is_contact(of_piece.verdict)) {
      return of_piece;
    }
    unknown = of_piece.verdict == Verdict::undecided ? of_piece : unknown;
  }
  return unknown;
}

EdgeFound EdgeSearch::contact_of(const GeometryCandidate& candidate) const {
  return {Verdict::contact, 0.0, timeline_.pairs()[candidate.pair].members, {}};
}

EdgeFound EdgeSearch::any_contact(std::vector<GeometryCandidate> candidates,
                                  const TimeWindow& piece, const TimeWindow& within) {
  for (GeometryCandidate& candidate : candidates) {
    candidate.window = {std::max(candidate.window.begin, within.begin),
                        std::min(candidate.window.end, within.end)};
  }
  std::erase_if(candidates, [](const GeometryCandidate& candidate) {
    return candidate.window.begin > candidate.window.end;
  });
  // The middles of whole windows have been tested.
  const bool is_clipped = piece.begin < within.begin || piece.end > within.end;
  for (const GeometryCandidate& candidate : candidates) {
    const double middle = 0.5 * (candidate.window.begin + candidate.window.end);
    if (candidate.gap < 0.0 && is_clipped && is_contact(ask(candidate, {middle, middle}).verdict)) {
      return contact_of(candidate);
    }
  }
  EdgeFound unknown;
  for (const GeometryCandidate& candidate : candidates) {
    const FirstContactResult result = ask(candidate, candidate.window);
    if (is_contact(result.verdict) || is_inside_at(candidate, within)) {
      return contact_of(candidate);
    }
    if (result.verdict == Verdict::undecided) {
      unknown = found_by(candidate, result);
      unknown.t = 0.0;
    }
  }
  return unknown;
}

}  // namespace firstcontact::detail
