#include <firstcontact/verification/verify_run.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/math/float_environment.h>
#include <firstcontact/math/number_text.h>
#include <firstcontact/parallel/parallel_for.h>
#include <firstcontact/record/load_scene_of.h>
#include <firstcontact/record/run.h>
#include <firstcontact/scene/links_as_bodies.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/separation/detail/box_tree.h>
#include <firstcontact/separation/detail/inside_solid.h>
#include <firstcontact/separation/detail/pair_cover.h>
#include <firstcontact/verification/detail/near_pairs.h>
#include <firstcontact/verification/detail/piece_motion.h>
#include <firstcontact/verification/detail/run_follower.h>
#include <firstcontact/verification/detail/script_deviation.h>

namespace firstcontact {
namespace {

using detail::BrokenRun;
using detail::CoverOutcome;
using detail::CoverResult;
using detail::FollowedBody;
using detail::FollowedStep;
using detail::RunFollower;
using detail::RunMember;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Number of steps that are proven side by side.
///
/// All of them have the same least distance, that of the steps before. So the answer does not
/// depend on the number of threads.
constexpr std::size_t kChunk = 16;

void require_plain(const Scene& scene) {
  for (const Body& body : scene.bodies) {
    if (std::holds_alternative<VertexMotion>(body.motion)) {
      throw std::invalid_argument("expected rigid bodies: the vertices of \"" + body.name +
                                  "\" move");
    }
  }
}

/// Gives a member the script of its body.
void add_script(const Body& body, double duration, RunMember& member) {
  if (member.is_free) {
    return;
  }
  try {
    member.script = detail::script_of(body.motion, duration, member.p_BC);
  } catch (const detail::UncertainMotion& error) {
    member.uncertain = error.what();
  }
}

std::vector<RunMember> make_members(const RunHeader& header, const LoadedScene& loaded) {
  std::vector<RunMember> members;
  for (std::size_t b = 0; b < loaded.scene.bodies.size(); ++b) {
    const Body& body = loaded.scene.bodies[b];
    const Shape& shape = loaded.bodies.shape(b);
    const Motion& motion = loaded.bodies.motion(b);
    const Eigen::Vector3d& p_BC = header.centres_of_mass.at(b);
    const auto* fixed = std::get_if<FixedMotion>(&body.motion);
    members.push_back({.name = body.name,
                       .shape = shape,
                       .p_BC = p_BC,
                       .tree = detail::build_box_tree(shape, p_BC),
                       .round = detail::round_set_of(shape, p_BC),
                       .is_free = body.free.has_value(),
                       .start = fixed != nullptr ? fixed->pose : motion.pose(0.0)});
    add_script(body, loaded.scene.duration, members.back());
  }
  return members;
}

/// What a mass of the header contradicts in the scene; empty where it agrees.
std::string wrong_mass(const Body& body, double mass) {
  const std::optional<double> given = body.free ? body.free->mass : 0.0;
  if (given ? mass == *given : mass > 0.0) {
    return {};
  }
  return "The mass of \"" + body.name + "\" is " + detail::shortest(mass) + " kg, but " +
         (!body.free ? "the body is not free."
          : given    ? "its scene gives " + detail::shortest(*given) + " kg."
                     : "the body is free.");
}

LoadedScene load(const RunHeader& header) {
  require_plain(header.scene);
  ShapeCache cache;
  return links_as_bodies(load_scene_of(header, cache)).loaded;
}

class Verification {
 public:
  Verification(const RunHeader& header, const VerifyRunOptions& options)
      : options_(options),
        loaded_(load(header)),
        members_(make_members(header, loaded_)),
        follower_(members_, header.scene, options.scripted_tolerance) {
    result_.verdict = ProofVerdict::proven;
    result_.least_distance = kInfinity;
    result_.pair_counts = loaded_.pair_counts;
    result_.warnings = loaded_.warnings;
    if (header.kind == RunKind::simulation) {
      require_masses(header);
    }
  }

  RunVerification run(const std::function<std::optional<RunStep>()>& next) {
    require_outside_at_start();
    find_first_witness();
    while (going()) {
      if (!take_chunk(next)) {
        break;
      }
    }
    if (result_.verdict == ProofVerdict::proven && result_.steps == 0) {
      stop(ProofVerdict::not_proven, "The run has no step.");
    }
    const bool all_apart =
        result_.verdict == ProofVerdict::proven || result_.verdict == ProofVerdict::broken;
    result_.least_distance = all_apart ? std::min(result_.least_distance, known()) : 0.0;
    result_.greatest_jump = follower_.greatest_jump();
    result_.scripted_deviation = follower_.scripted_deviation();
    result_.greatest_behind = follower_.greatest_behind();
    return result_;
  }

 private:
  /// One pair of a step, with its proof.
  struct Job {
    std::size_t step = 0;  // Index in the chunk.
    BodyPair bodies = {};
    CoverResult result = {};
  };

  /// Whether to go on: after an open step the rest may still be refuted.
  [[nodiscard]] bool going() const {
    return result_.verdict == ProofVerdict::proven ||
           (result_.verdict == ProofVerdict::not_proven && !ended_);
  }

  void stop(ProofVerdict verdict, std::string problem, std::optional<RunMoment> at = {}) {
    if (result_.verdict == ProofVerdict::not_proven && verdict == ProofVerdict::not_proven) {
      return;  // The first problem counts.
    }
    result_.verdict = verdict;
    result_.problem = std::move(problem);
    result_.problem_at = at;
  }

  /// Whether two bodies may touch. Nothing is promised of two bodies that scripts move, or nothing.
  [[nodiscard]] bool may_touch(const BodyPair& pair) const {
    return (members_[pair[0]].is_free || members_[pair[1]].is_free) &&
           loaded_.bodies.rules().margin(pair).has_value();
  }

  [[nodiscard]] std::string names(const BodyPair& pair) const {
    return "\"" + members_[pair[0]].name + "\" and \"" + members_[pair[1]].name + "\"";
  }

  FollowedBody at_start(std::size_t body) const {
    const RunMember& member = members_[body];
    FollowedBody rest;
    rest.pieces.emplace_back(member.start, 0.0, 0.0, member.p_BC);
    return rest;
  }

  void require_masses(const RunHeader& header) {
    for (std::size_t b = 0; b < loaded_.scene.bodies.size() && going(); ++b) {
      if (std::string wrong = wrong_mass(loaded_.scene.bodies[b], header.masses.at(b));
          !wrong.empty()) {
        stop(ProofVerdict::broken, std::move(wrong));
      }
    }
  }

  /// Requires that no body begins inside of a solid, as it would never have to cross the surface.
  void require_outside_at_start() {
    std::vector<Eigen::AlignedBox3d> boxes;
    for (std::size_t b = 0; b < members_.size(); ++b) {
      boxes.push_back(detail::swept_box(members_[b], at_start(b)));
    }
    for (const BodyPair& pair : detail::near_pairs(boxes, 0.0)) {
      if (may_touch(pair)) {
        require_outside(pair, pair[0], pair[1]);
        require_outside(pair, pair[1], pair[0]);
      }
    }
  }

  void require_outside(const BodyPair& pair, std::size_t solid, std::size_t body) {
    // The inside of a curved body takes part in the proof of each step.
    if (!members_[solid].shape.is_solid() || members_[solid].round || !going()) {
      return;
    }
    for (const Eigen::Vector3d& point : detail::points_of_components(members_[body].shape)) {
      const std::optional<bool> inside = is_inside(solid, body, point);
      if (inside != false) {
        stop(inside ? ProofVerdict::refuted : ProofVerdict::not_proven,
             names(pair) + (inside ? " are inside each other at the start."
                                   : " may be inside each other at the start."),
             RunMoment{.step = 1, .time = 0.0, .bodies = pair, .distance = 0.0});
        return;
      }
    }
  }

  [[nodiscard]] std::optional<bool> is_inside(std::size_t solid, std::size_t body,
                                              const Eigen::Vector3d& vertex) const {
    const Eigen::Vector3d& origin = members_[solid].start.position;
    const auto place = [&](std::size_t b) {
      return detail::PieceMotion(members_[b].start, 0.0, 0.0, Eigen::Vector3d::Zero())
          .enclosure(0.0, origin);
    };
    const IntervalVector3 p = inverse(place(solid)) * (place(body) * enclose(vertex));
    const Mesh& mesh = members_[solid].shape.mesh();
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& corner : mesh.vertices) {
      box.extend(corner);
    }
    for (int k = 0; k < 3; ++k) {
      if (p.c[k].lower() > box.max()[k] || p.c[k].upper() < box.min()[k]) {
        return false;
      }
    }
    return detail::is_inside(mesh, p);
  }

  /// Finds a first upper bound of the distances: the least distance of points of two bodies.
  void find_first_witness() {
    std::vector<Eigen::Vector3d> points;
    for (std::size_t b = 0; b < members_.size(); ++b) {
      const detail::BodyInstant now = at_start(b).pieces.front().instant(0.0, {0.0, 0.0, 0.0});
      const RunMember& member = members_[b];
      points.emplace_back(
          now.pivot + now.R * (member.round ? member.round->centre : member.tree.triangles[0][0]));
    }
    constexpr double kSlack = 1.0 + 0x1p-30;
    for (std::size_t a = 0; a < points.size(); ++a) {
      for (std::size_t b = a + 1; b < points.size(); ++b) {
        const double distance = kSlack * (points[a] - points[b]).norm() +
                                0x1p-30 * (points[a].norm() + points[b].norm());
        if (distance < known() && may_touch({a, b})) {
          result_.closest =
              RunMoment{.step = 1, .time = 0.0, .bodies = {a, b}, .distance = distance};
        }
      }
    }
  }

  [[nodiscard]] double known() const {
    return result_.closest.value_or(RunMoment{.distance = kInfinity}).distance;
  }

  /// Takes the next steps. False at the end of the run.
  bool take_chunk(const std::function<std::optional<RunStep>()>& next) {
    std::vector<FollowedStep> chunk;
    std::optional<std::string> broken;
    std::optional<std::string> unproven;
    bool more = true;
    // The first step is alone: it finds how close bodies come, which saves the others the search.
    const std::size_t size = result_.steps == 0 ? 1 : kChunk;
    while (more && chunk.size() < size && !options_.stop.stop_requested()) {
      const std::optional<RunStep> step = next();
      more = step.has_value();
      if (!more) {
        break;
      }
      try {
        chunk.push_back(follower_.follow(*step));
        time_lost_.push_back(step->time_lost);
      } catch (const BrokenRun& error) {
        broken = "Step " + std::to_string(step->index) + ": " + error.what() + ".";
        break;
      } catch (const detail::UncertainMotion& error) {
        unproven = "Step " + std::to_string(step->index) + ": " + error.what() + ".";
        break;
      }
    }
    prove(chunk);
    if (going() && broken) {
      stop(ProofVerdict::broken, *broken);
    } else if (going() && unproven) {
      stop(ProofVerdict::not_proven, *unproven);
    } else if (going() && options_.stop.stop_requested()) {
      stop(ProofVerdict::not_proven, "Stopped before the end of the run.");
      ended_ = true;
    }
    return more;
  }

  void prove(const std::vector<FollowedStep>& chunk) {
    std::vector<Job> jobs;
    for (std::size_t k = 0; k < chunk.size(); ++k) {
      add_jobs(chunk[k], k, jobs);
    }
    const double known_before = known();
    parallel_for(options_.threads, jobs.size(), [&](std::size_t k) {
      if (!options_.stop.stop_requested()) {
        jobs[k].result = cover(chunk[jobs[k].step], jobs[k].bodies, known_before);
      }
    });
    if (options_.stop.stop_requested()) {
      return;
    }
    std::size_t done = 0;
    for (std::size_t k = 0; k < chunk.size() && going(); ++k) {
      while (done < jobs.size() && jobs[done].step == k) {
        take(jobs[done++], chunk[k]);
      }
      ++result_.steps;
      result_.time = chunk[k].begin + chunk[k].lasted;
      result_.time_lost += time_lost_[k];
    }
    time_lost_.clear();
    if (options_.progress) {
      options_.progress(result_.time);
    }
  }

  void add_jobs(const FollowedStep& step, std::size_t place, std::vector<Job>& jobs) const {
    std::vector<Eigen::AlignedBox3d> boxes;
    for (std::size_t b = 0; b < members_.size(); ++b) {
      boxes.push_back(detail::swept_box(members_[b], step.bodies[b]));
    }
    for (const BodyPair& pair : detail::near_pairs(boxes, std::max(step.clearance, known()))) {
      if ((step.bodies[pair[0]].moves || step.bodies[pair[1]].moves) && may_touch(pair)) {
        jobs.push_back({.step = place, .bodies = pair});
      }
    }
  }

  [[nodiscard]] CoverResult cover(const FollowedStep& step, const BodyPair& pair,
                                  double known_before) const {
    using Pieces = std::vector<const detail::CoveredMotion*>;
    const auto pieces_of = [&](std::size_t b) {
      Pieces pieces;
      for (const detail::PieceMotion& piece : step.bodies[b].pieces) {
        pieces.push_back(&piece);
      }
      return pieces;
    };
    const auto body = [&](std::size_t b, const Pieces& pieces) {
      return detail::CoverBody{.tree = members_[b].tree,
                               .pieces = pieces,
                               .thickness = members_[b].shape.radius(),
                               .jump = step.bodies[b].jump,
                               .round = members_[b].round ? &*members_[b].round : nullptr};
    };
    const Pieces pieces_A = pieces_of(pair[0]);
    const Pieces pieces_B = pieces_of(pair[1]);
    return detail::cover_pair(
        body(pair[0], pieces_A), body(pair[1], pieces_B),
        {.promised = step.clearance, .known = known_before, .work = options_.work});
  }

  void take(const Job& job, const FollowedStep& step) {
    const CoverResult& found = job.result;
    result_.least_distance = std::min(result_.least_distance, found.least);
    const RunMoment seen{.step = step.index,
                         .time = step.begin + found.seen_time,
                         .bodies = job.bodies,
                         .distance = found.seen};
    if (found.seen < known()) {
      result_.closest = seen;
    }
    RunMoment at = seen;
    at.time = step.begin + found.time;
    if (found.outcome == CoverOutcome::closer && result_.verdict != ProofVerdict::refuted) {
      stop(ProofVerdict::refuted, names(job.bodies) + " come closer than promised.", at);
    } else if (found.outcome == CoverOutcome::not_proven) {
      stop(ProofVerdict::not_proven,
           "It could not be proven that " + names(job.bodies) + " stay apart as promised.", at);
    }
  }

  const VerifyRunOptions& options_;
  LoadedScene loaded_;
  std::vector<RunMember> members_;
  RunFollower follower_;
  RunVerification result_;
  std::vector<double> time_lost_;  // For the steps of the chunk.
  bool ended_ = false;
};

}  // namespace

RunVerification verify_run(const RunHeader& header,
                           const std::function<std::optional<RunStep>()>& next,
                           const VerifyRunOptions& options) {
  if (!(options.scripted_tolerance > 0.0)) {
    throw std::invalid_argument("VerifyRunOptions::scripted_tolerance must be > 0, got " +
                                detail::shortest(options.scripted_tolerance));
  }
  const FloatEnvironmentGuard guard;
  return Verification(header, options).run(next);
}

}  // namespace firstcontact
