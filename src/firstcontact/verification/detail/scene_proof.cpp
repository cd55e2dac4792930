#include <firstcontact/verification/detail/scene_proof.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

#include <firstcontact/geometry/convex_set.h>
#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/parallel/parallel_for.h>
#include <firstcontact/separation/detail/inside_solid.h>
#include <firstcontact/verification/detail/near_pairs.h>
#include <firstcontact/verification/detail/scene_courses.h>

namespace firstcontact::detail {
namespace {

/// Least number of windows into which a scene is cut; and that for a scene of many shapes.
constexpr std::size_t kWindows = 8;
constexpr std::size_t kManyWindows = 32;
constexpr std::size_t kManyShapes = 50;
constexpr std::size_t kFewShapes = 8;

/// Least size of the batches of pairs that are proven side by side.
///
/// With it all threads have work, and the first finding does not depend on them.
constexpr std::size_t kBatch = 512;

/// The displacement that is left open where bodies come together, by their size; and the longest
/// moment for it [-].
constexpr double kLastWay = 0x1p-38;
constexpr double kLongestMoment = 0x1p-30;

/// Time behind the one at which a body is taken up or put down [-].
constexpr double kBehind = 0x1p-40;

/// [-]  The bounds of tracking errors by which a contact is refuted. Other bounds may be larger.
constexpr double kRefutingShare = 1.125;

std::vector<const CoveredMotion*> pointers(const CoveredMotions& motions) {
  std::vector<const CoveredMotion*> result;
  result.reserve(motions.size());
  for (const auto& motion : motions) {
    result.push_back(motion.get());
  }
  return result;
}

bool claims_margins(const FreeClaim& claim) {
  return claim.has_margins || (!claim.clearance && claim.clearances.empty());
}

BodyPair in_order(const BodyPair& members) {
  return {std::min(members[0], members[1]), std::max(members[0], members[1])};
}

/// Keeps the worse finding; of equal ones the earlier one.
void take(const ProofFinding& found, ProofFinding& kept) {
  const bool decides = found.verdict == ProofVerdict::refuted;
  if (found.verdict != ProofVerdict::proven && kept.verdict != ProofVerdict::refuted &&
      (decides || kept.verdict == ProofVerdict::proven)) {
    const double left_open = kept.left_open;
    kept = found;
    kept.left_open = left_open;
  }
  kept.left_open = std::max(kept.left_open, found.left_open);
}

}  // namespace

SceneProof::SceneProof(const SceneCourses& courses, SceneProofOptions options)
    : courses_(courses), options_(std::move(options)) {}

/// The time of a claim, cut into parts that are proven side by side.
std::vector<TimeSpan> SceneProof::windows(const FreeClaim& claim) const {
  const std::vector<double>& breaks = courses_.breaks();
  std::vector<TimeSpan> spans;
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    const TimeSpan span{std::max(breaks[k], claim.from), std::min(breaks[k + 1], claim.last)};
    if (span.from < span.to) {
      spans.push_back(span);
    }
  }
  const std::size_t shapes = courses_.geometries().size();
  const std::size_t of_all = breaks.size() - 1;
  const std::size_t least = shapes > kManyShapes ? kManyWindows : kWindows;
  // With few shapes those of a single claim are work for all threads.
  const std::size_t among = shapes <= kFewShapes ? std::max<std::size_t>(spans.size(), 1) : of_all;
  const std::size_t parts = (least + among - 1) / among;
  std::vector<TimeSpan> windows;
  for (const TimeSpan& span : spans) {
    double from = span.from;
    for (std::size_t part = 1; part <= parts; ++part) {
      const double share = static_cast<double>(part) / static_cast<double>(parts);
      const double to = part == parts ? span.to : span.from + share * (span.to - span.from);
      if (from < to) {
        windows.push_back({from, to});
        from = to;
      }
    }
  }
  return windows;
}

/// Pairs of geometries of two members.
std::vector<BodyPair> SceneProof::near(const TimeSpan& window, double reach) const {
  const auto geometries = courses_.geometries();
  std::vector<Eigen::AlignedBox3d> boxes(geometries.size());
  parallel_for(options_.threads, boxes.size(),
               [&](std::size_t k) { boxes[k] = courses_.swept_box(geometries[k], window); });
  std::vector<BodyPair> pairs = near_pairs(boxes, reach);
  std::erase_if(pairs, [&](const BodyPair& pair) {
    return geometries[pair[0]].member == geometries[pair[1]].member;
  });
  return pairs;
}

/// [m]  The greatest distance that is claimed of any pair.
double SceneProof::reach_of(const FreeClaim& claim) const {
  double reach = claim.clearance.value_or(0.0);
  if (claims_margins(claim)) {
    reach = std::max(reach, courses_.pairs().greatest_margin() + claim.extra);
  }
  for (const auto& [members, clearance] : claim.clearances) {
    reach = std::max(reach, clearance);
  }
  for (const auto& [members, distance] : claim.held) {
    reach = std::max(reach, distance);
  }
  return reach;
}

/// [m]  The claimed clearance of a pair; none where none is claimed.
std::optional<double> SceneProof::clearance_of(const FreeClaim& claim, const BodyPair& members) {
  const auto own = claim.clearances.find(in_order(members));
  return own != claim.clearances.end() ? own->second : claim.clearance;
}

void SceneProof::add_jobs(const FreeClaim& claim, const TimeSpan& window,
                          std::vector<Job>& jobs) const {
  const auto geometries = courses_.geometries();
  for (const BodyPair& pair : near(window, reach_of(claim))) {
    const BodyPair members{geometries[pair[0]].member, geometries[pair[1]].member};
    const std::optional<double> margin = courses_.pairs().margin(members);
    const auto held = claim.held.find(in_order(members));
    const std::optional<double> clearance = clearance_of(claim, members);
    if (!margin || !(clearance || claims_margins(claim))) {
      continue;
    }
    const bool is_held = held != claim.held.end();
    Job job{.a = pair[0], .b = pair[1], .margin = is_held ? held->second : *margin + claim.extra};
    if (clearance) {
      const bool is_shown = is_held || *clearance <= *margin;  // The margin proves it, too.
      if (is_shown && !claim.has_margins) {
        continue;
      }
      if (!is_shown) {
        job.promise = Promise::kept;
        job.exceeded = claim.has_margins ? std::optional(job.margin) : std::nullopt;
        job.margin = *clearance;
      }
    }
    const double until = claim.until(members);
    for (const TimeSpan& span : courses_.pairs().spans(members)) {
      job.window = {std::max(window.from, span.from), std::min({window.to, span.to, until})};
      if (job.window.from < job.window.to) {
        job.is_last = job.window.to == until;
        jobs.push_back(job);
      }
    }
  }
}

ProofFinding SceneProof::prove_free(const FreeClaim& claim) const {
  ProofFinding finding;
  if (claims_margins(claim) && claim.from == 0.0) {
    finding = prove_outside(claim);
  }
  const std::vector<TimeSpan> all = windows(claim);
  std::vector<Job> jobs;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (finding.verdict == ProofVerdict::refuted) {
      return finding;
    }
    if (options_.stop.stop_requested()) {
      take({.verdict = ProofVerdict::not_proven, .reason = ProofReason::stopped, .when = all[k]},
           finding);
      return finding;
    }
    add_jobs(claim, all[k], jobs);
    if (jobs.size() >= kBatch || k + 1 == all.size()) {
      take(prove(claim, jobs), finding);
      jobs.clear();
      if (options_.progress) {
        options_.progress(all[k].to);
      }
    }
  }
  return finding;
}

ProofFinding SceneProof::prove(const FreeClaim& claim, std::vector<Job>& jobs) const {
  parallel_for(options_.threads, jobs.size(),
               [&](std::size_t k) { jobs[k].finding = prove(claim, jobs[k]); });
  ProofFinding finding;
  for (const Job& job : jobs) {
    take(job.finding, finding);
  }
  return finding;
}

ProofFinding SceneProof::prove(const FreeClaim& claim, const Job& job) const {
  const auto geometries = courses_.geometries();
  const CourseGeometry& A = geometries[job.a];
  const CourseGeometry& B = geometries[job.b];
  CoverOptions asked{.promise = job.promise,
                     .promised = job.margin,
                     .exceeded = job.exceeded,
                     .finds_least = false,
                     .from = job.window.from,
                     .to = job.window.to,
                     .work = options_.work,
                     .stop = options_.stop};
  CoverResult found = cover(A, B, job.window, asked);
  ProofFinding finding{.members = {A.member, B.member}};
  if (claim.ends_in_contact && job.is_last && found.outcome == CoverOutcome::not_proven) {
    const double moment = last_moment(job);
    asked.to = job.window.to - moment;
    if (asked.from < asked.to && found.time + found.half >= asked.to) {
      found = cover(A, B, job.window, asked);
      finding.left_open = moment;
    }
  }
  if (found.outcome == CoverOutcome::closer) {
    finding.verdict = ProofVerdict::refuted;
    finding.reason = ProofReason::closer;
    finding.when = {found.time, found.time};
    finding.distance = found.seen;
  } else if (found.outcome == CoverOutcome::not_proven) {
    finding.verdict = ProofVerdict::not_proven;
    finding.reason =
        !found.ended ? ProofReason::too_close
                     : (options_.stop.stop_requested() ? ProofReason::stopped : ProofReason::work);
    finding.when = {found.time - found.half, found.time + found.half};
  }
  return finding;
}

/// [-]  The moment before the end of a window in which the two shapes come together by less than
/// kLastWay of their size.
double SceneProof::last_moment(const Job& job) const {
  const auto geometries = courses_.geometries();
  const CourseGeometry& A = geometries[job.a];
  const CourseGeometry& B = geometries[job.b];
  const double end = job.window.to;
  const SceneCourses::PairMotions motions = courses_.motions(A, B, {end, end});
  const auto speed = [&](const CoveredMotion& motion, double reach) {
    const double half = std::min(kLongestMoment, 0.5 * (motion.to() - motion.from()));
    const double middle = std::clamp(end, motion.from() + half, motion.to() - half);
    const BodyInstant now = motion.around(middle, half, motion.position());
    const double spin = now.spin.norm() + now.spin_error;
    const double bend = now.constant_rates ? spin * spin * (now.lever + reach)
                                           : now.acceleration + now.turn_acceleration * reach;
    return now.velocity.norm() + now.velocity_error + spin * reach + 2.0 * half * bend;
  };
  const double reach_A = A.tree->nodes[0].reach + A.shape.radius();
  const double reach_B = B.tree->nodes[0].reach + B.shape.radius();
  const double way = kLastWay * (reach_A + reach_B);
  const double fastest = speed(*motions.A.front(), reach_A) + speed(*motions.B.front(), reach_B);
  return fastest > 0.0 ? std::min(way / fastest, kLongestMoment) : kLongestMoment;
}

CoverResult SceneProof::cover(const CourseGeometry& A, const CourseGeometry& B,
                              const TimeSpan& window, CoverOptions options) const {
  const SceneCourses::PairMotions motions = courses_.motions(A, B, window);
  const std::vector<const CoveredMotion*> of_A = pointers(motions.A);
  const std::vector<const CoveredMotion*> of_B = pointers(motions.B);
  const auto body = [](const CourseGeometry& geometry,
                       const std::vector<const CoveredMotion*>& pieces) {
    return CoverBody{.tree = *geometry.tree,
                     .pieces = pieces,
                     .thickness = geometry.shape.radius(),
                     .round = geometry.round ? &*geometry.round : nullptr};
  };
  return cover_pair(body(A, of_A), body(B, of_B), options);
}

/// Proves that no pair begins inside of a solid, as it would never have to cross the surface.
ProofFinding SceneProof::prove_outside(const FreeClaim& claim) const {
  const auto geometries = courses_.geometries();
  ProofFinding finding;
  const auto test = [&](const CourseGeometry& A, const CourseGeometry& B, double t) {
    const BodyPair members{A.member, B.member};
    if (!(t < claim.until(members)) || !courses_.pairs().margin(members)) {
      return;
    }
    const std::optional<bool> nested = are_nested(A, B, t);
    if (nested != false) {
      take({.verdict = nested ? ProofVerdict::refuted : ProofVerdict::not_proven,
            .reason = nested ? ProofReason::inside : ProofReason::perhaps_inside,
            .members = members,
            .when = {t, t}},
           finding);
    }
  };
  for (const BodyPair& pair : near({0.0, 0.0}, 0.0)) {
    const CourseGeometry& A = geometries[pair[0]];
    const CourseGeometry& B = geometries[pair[1]];
    const std::vector<TimeSpan> spans = courses_.pairs().spans({A.member, B.member});
    if (!spans.empty() && spans.front().from == 0.0) {
      test(A, B, 0.0);
    }
  }
  for (const BodyPair& members : courses_.pairs().held_pairs()) {
    for (const TimeSpan& span : courses_.pairs().spans(members)) {
      for (const CourseGeometry& A : courses_.of_member(members[0])) {
        for (const CourseGeometry& B : courses_.of_member(members[1])) {
          if (span.from > 0.0) {
            test(A, B, span.from);
          }
        }
      }
    }
  }
  return finding;
}

std::optional<bool> SceneProof::are_nested(const CourseGeometry& A, const CourseGeometry& B,
                                           double t) const {
  const std::optional<bool> inside_A = has_inside(A, B, t);
  const std::optional<bool> inside_B = has_inside(B, A, t);
  if (inside_A == true || inside_B == true) {
    return true;
  }
  return inside_A && inside_B ? std::optional(false) : std::nullopt;
}

std::optional<bool> SceneProof::has_inside(const CourseGeometry& solid, const CourseGeometry& other,
                                           double t) const {
  // What is inside a curved body is at the distance 0 from it, which the gap shows.
  if (!solid.shape.is_solid() || solid.round) {
    return false;
  }
  const SceneCourses::PairMotions motions = courses_.motions(solid, other, {t, t});
  const auto place = [&](const CoveredMotions& of) {
    return of.front()->enclosure(t, motions.A.front()->position());
  };
  const IntervalTransform X = inverse(place(motions.A)) * place(motions.B);
  const Mesh& mesh = solid.shape.mesh();
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& corner : mesh.vertices) {
    box.extend(corner);
  }
  std::optional<bool> any = false;
  for (const Eigen::Vector3d& p_GQ : points_of_components(other.shape)) {
    const IntervalVector3 p = X * (enclose(p_GQ) - enclose(other.p_GP)) + enclose(solid.p_GP);
    bool is_beside = false;
    for (int k = 0; k < 3; ++k) {
      is_beside = is_beside || p.c[k].lower() > box.max()[k] || p.c[k].upper() < box.min()[k];
    }
    const std::optional<bool> inside = is_beside ? false : is_inside(mesh, p);
    if (inside == true) {
      return true;
    }
    any = inside ? any : inside;
  }
  return any;
}

ProofFinding SceneProof::prove_contact(const BodyPair& members, double t, double tolerance) const {
  const std::optional<double> margin = courses_.pairs().margin(members);
  return prove_within(members, t, margin.value_or(0.0) + tolerance);
}

ProofFinding SceneProof::prove_within(const BodyPair& members, double t, double distance) const {
  ProofFinding finding{.members = members, .when = {t, t}};
  bool is_tested = false;
  for (const TimeSpan& span : courses_.pairs().spans(members)) {
    is_tested = is_tested || (span.from <= t && t <= span.to);
  }
  if (!courses_.pairs().margin(members) || !is_tested) {
    finding.verdict = ProofVerdict::broken;
    return finding;
  }
  finding.verdict = ProofVerdict::refuted;
  finding.reason = ProofReason::apart;
  for (const CourseGeometry& A : courses_.of_member(members[0])) {
    for (const CourseGeometry& B : courses_.of_member(members[1])) {
      const ProofFinding found = prove_contact(A, B, t, distance);
      if (found.verdict == ProofVerdict::proven) {
        return found;
      }
      if (found.verdict == ProofVerdict::not_proven) {
        finding = found;
      }
    }
  }
  return finding;
}

ProofFinding SceneProof::prove_contact(const CourseGeometry& A, const CourseGeometry& B, double t,
                                       double reach) const {
  ProofFinding finding{.members = {A.member, B.member}, .when = {t, t}};
  const std::optional<bool> nested = are_nested(A, B, t);
  if (nested == true) {
    return finding;
  }
  finding.verdict = nested ? ProofVerdict::refuted : ProofVerdict::not_proven;
  finding.reason = nested ? ProofReason::apart : ProofReason::perhaps_inside;
  // Also for the motions from then on, in case one is taken up or put down.
  for (const TimeSpan& window : {TimeSpan{t, t}, TimeSpan{t, std::min(1.0, t + kBehind)}}) {
    CoverOptions asked{.promise = Promise::exceeded,
                       .promised = reach,
                       .finds_least = false,
                       .from = t,
                       .to = t,
                       .tracked = 1.0,
                       .work = options_.work,
                       .stop = options_.stop};
    const CoverResult found = cover(A, B, window, asked);
    if (found.outcome == CoverOutcome::closer) {
      return {.members = {A.member, B.member}, .when = {t, t}, .distance = found.seen};
    }
    if (found.outcome == CoverOutcome::not_proven) {
      finding.verdict = ProofVerdict::not_proven;
      finding.reason = found.ended ? ProofReason::work : ProofReason::too_close;
    } else if (courses_.has_tracking_errors()) {
      asked.tracked = kRefutingShare;
      if (cover(A, B, window, asked).outcome != CoverOutcome::proven) {
        finding.verdict = ProofVerdict::not_proven;
        finding.reason = ProofReason::perhaps_errors;
      }
    }
  }
  return finding;
}

}  // namespace firstcontact::detail
