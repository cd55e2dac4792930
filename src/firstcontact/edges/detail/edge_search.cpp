#include <firstcontact/edges/detail/edge_search.h>

#include <algorithm>
#include <utility>
#include <vector>

#include <firstcontact/query/first_contact.h>
#include <firstcontact/robot_check/detail/geometry_search.h>

namespace firstcontact::detail {

EdgeSearch::EdgeSearch(RobotScene scene, const RobotCheckOptions& options)
    : scene_(std::move(scene)), options_(options), timeline_(scene_), candidates_(timeline_) {
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
  return search.first_contact(window);
}

EdgeFound EdgeSearch::found_by(const GeometryCandidate& candidate,
                               const FirstContactResult& result) const {
  return {result.verdict, result.t, timeline_.pairs()[candidate.pair].members, result.reason};
}

EdgeFound EdgeSearch::first_contact() {
  follow_motions();
  EdgeFound first;
  if (const UndecidedReason reason = spent(options_.budget); reason != UndecidedReason::none) {
    return {Verdict::undecided, 0.0, {}, reason};
  }
  for (std::size_t piece = 0; piece < timeline_.piece_count(); ++piece) {
    if (timeline_.piece(piece).begin > first.t) {
      break;
    }
    for (const GeometryCandidate& candidate : candidates_.find(piece, {})) {
      if (candidate.window.begin > first.t) {
        continue;
      }
      const FirstContactResult result =
          ask(candidate, {candidate.window.begin, std::min(candidate.window.end, first.t)});
      if (result.verdict == Verdict::free) {
        continue;
      }
      // A contact at the same time decides rather than what is not known.
      const bool is_earlier =
          result.t < first.t || first.verdict == Verdict::free ||
          (result.t == first.t && is_contact(result.verdict) && !is_contact(first.verdict));
      if (is_earlier) {
        first = found_by(candidate, result);
      }
    }
  }
  return first;
}

EdgeFound EdgeSearch::any_contact(const TimeWindow& within) {
  follow_motions();
  EdgeFound unknown;
  if (const UndecidedReason reason = spent(options_.budget); reason != UndecidedReason::none) {
    return {Verdict::undecided, 0.0, {}, reason};
  }
  for (std::size_t piece = 0; piece < timeline_.piece_count(); ++piece) {
    const TimeWindow whole = timeline_.piece(piece);
    if (whole.end < within.begin || whole.begin > within.end) {
      continue;
    }
    std::vector<GeometryCandidate> candidates = candidates_.find(piece, {});
    for (GeometryCandidate& candidate : candidates) {
      candidate.window = {std::max(candidate.window.begin, within.begin),
                          std::min(candidate.window.end, within.end)};
    }
    std::erase_if(candidates, [](const GeometryCandidate& candidate) {
      return candidate.window.begin > candidate.window.end;
    });
    for (const GeometryCandidate& candidate : candidates) {
      if (candidate.gap < 0.0) {
        const double middle = 0.5 * (candidate.window.begin + candidate.window.end);
        const FirstContactResult result = ask(candidate, {middle, middle});
        if (is_contact(result.verdict)) {
          return {Verdict::contact, 0.0, timeline_.pairs()[candidate.pair].members, {}};
        }
      }
    }
    for (const GeometryCandidate& candidate : candidates) {
      const FirstContactResult result = ask(candidate, candidate.window);
      if (is_contact(result.verdict)) {
        return {Verdict::contact, 0.0, timeline_.pairs()[candidate.pair].members, {}};
      }
      if (result.verdict == Verdict::undecided) {
        unknown = found_by(candidate, result);
        unknown.t = 0.0;
      }
    }
  }
  return unknown;
}

}  // namespace firstcontact::detail
