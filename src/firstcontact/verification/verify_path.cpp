#include <firstcontact/verification/verify_path.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/math/float_environment.h>
#include <firstcontact/scene/contact_pair.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/planned_path.h>
#include <firstcontact/text/write_json.h>
#include <firstcontact/verification/detail/describe_finding.h>
#include <firstcontact/verification/detail/moving_scene.h>
#include <firstcontact/verification/detail/rigid_motion.h>
#include <firstcontact/verification/detail/scene_courses.h>
#include <firstcontact/verification/detail/scene_proof.h>

namespace firstcontact {
namespace {

using detail::BrokenPath;
using detail::FreeClaim;
using detail::MovingScene;
using detail::ProofFinding;

/// [-]  Greatest difference of a held distance from the share of its policy.
constexpr double kHeldError = 0x1p-8;

/// [tolerances]  Distance beyond its margin at which a planner still takes a pair to be in contact.
constexpr double kContactTolerances = 3.0;

class PathProof {
 public:
  PathProof(const PlannedPath& path, const VerifyResultOptions& options)
      : path_(path),
        moving_(path),
        courses_(moving_.loaded(), moving_.turnings(), moving_.body()),
        proof_(courses_, {options.work, options.threads, options.stop, options.progress}) {}

  PathVerification run() {
    result_.warnings = moving_.loaded().warnings;
    count_pairs();
    if (result_.tested == 0) {
      result_.warnings.emplace_back("no pair is tested: the scene has nothing that can be touched");
    }
    require_goal();
    find_contact_pairs();
    require_totals();
    result_.verdict = ProofVerdict::proven;
    prove_contact_pairs();
    const std::size_t edges = std::max<std::size_t>(path_.waypoints.size() - 1, 1);
    for (std::size_t edge = 0; edge < edges; ++edge) {
      prove(edge);
      if (result_.verdict == ProofVerdict::proven) {
        result_.edges = std::min(edge + 1, path_.waypoints.size() - 1);
      } else if (result_.verdict == ProofVerdict::refuted) {
        break;
      }
    }
    return result_;
  }

 private:
  /// A pair of the path that is in contact at an end.
  struct Contact {
    BodyPair members = {};
    const NamedContactPair* claim = nullptr;
  };

  [[nodiscard]] bool is_tested(const BodyPair& pair) const {
    const auto [a, b] = pair;
    return (moving_.moves(a) || moving_.moves(b)) && courses_.pairs().margin(pair) &&
           !courses_.pairs().spans(pair).empty() && !courses_.of_member(a).empty() &&
           !courses_.of_member(b).empty();
  }

  void count_pairs() {
    for (std::size_t a = 0; a < courses_.member_count(); ++a) {
      for (std::size_t b = a + 1; b < courses_.member_count(); ++b) {
        result_.tested += is_tested({a, b}) ? 1 : 0;
      }
    }
  }

  [[nodiscard]] std::size_t member_named(const std::string& name) const {
    for (std::size_t member = 0; member < courses_.member_count(); ++member) {
      if (member_name(moving_.loaded().scene, member) == name) {
        return member;
      }
    }
    throw BrokenPath("The scene has no body or link " + detail::in_quotes(name) + ".");
  }

  void find_contact_pairs() {
    std::size_t opening_ends = 0;
    for (const PathEnd at : {PathEnd::start, PathEnd::goal}) {
      opening_ends += std::ranges::any_of(path_.contact_pairs, [&](const NamedContactPair& one) {
        return one.policy == ContactPolicy::must_open && one.at == at;
      });
    }
    if (opening_ends > 0 && path_.waypoints.size() < opening_ends + 2) {
      throw BrokenPath("The path has too few edges for its pairs to open.");
    }
    for (const NamedContactPair& one : path_.contact_pairs) {
      const std::size_t a = member_named(one.pair[0]);
      const std::size_t b = member_named(one.pair[1]);
      const BodyPair members = {std::min(a, b), std::max(a, b)};
      const std::string names =
          detail::in_quotes(one.pair[0]) + " and " + detail::in_quotes(one.pair[1]);
      if (a == b || !is_tested(members)) {
        throw BrokenPath("The contact pair " + names + " is not tested.");
      }
      if (std::ranges::any_of(contacts_, [&](const Contact& other) {
            const bool opens = one.policy == ContactPolicy::must_open &&
                               other.claim->policy == ContactPolicy::must_open &&
                               one.at != other.claim->at;
            return other.members == members && !opens;
          })) {
        throw BrokenPath("The contact pair " + names + " is named twice.");
      }
      if (!(one.distance > 0.0 && std::isfinite(one.distance))) {
        throw BrokenPath("The distance of the contact pair " + names + " is not above 0.");
      }
      if (!path_.times.empty() || courses_.has_tracking_errors()) {
        throw BrokenPath("The contact pair " + names +
                         " is among surroundings that move, or with tracking errors.");
      }
      if (one.at == PathEnd::goal && !result_.reaches_goal) {
        throw BrokenPath("The contact pair " + names + " is at a goal that is not reached.");
      }
      contacts_.push_back({members, &one});
    }
  }

  /// Proves the contact pairs: the policies allow no less than a share of the distance at that end.
  void prove_contact_pairs() {
    for (const Contact& contact : contacts_) {
      const bool at_start = contact.claim->at == PathEnd::start;
      const std::size_t edges = path_.clearances.size();
      const FreeClaim claim{
          .until = {}, .from = share(0), .last = share(std::max<std::size_t>(edges, 1))};
      // A pair that keeps its margin at that end is no contact pair, and needs no hold.
      const double in_contact = courses_.pairs().margin(contact.members).value() +
                                path_.extra_clearance + kContactTolerances * path_.tolerance;
      const double held =
          contact.claim->distance / kept_share(contact.claim->policy) * (1.0 + kHeldError);
      const double most = std::min(held, in_contact);
      take(proof_.prove_within(contact.members, at_start ? claim.from : claim.last, most),
           at_start || edges == 0 ? 0 : edges - 1, claim,
           "A contact pair is held to less than its policy allows. ");
    }
  }

  /// The pairs that are held along an edge.
  [[nodiscard]] std::map<BodyPair, double> held_along(std::size_t edge) const {
    std::map<BodyPair, double> held;
    for (const Contact& contact : contacts_) {
      const std::size_t opens_on =
          contact.claim->at == PathEnd::start ? 0 : path_.clearances.size() - 1;
      if (contact.claim->policy != ContactPolicy::must_open || edge == opens_on) {
        held.emplace(contact.members, contact.claim->distance);
      }
    }
    return held;
  }

  /// [-]  The time of a waypoint at which pieces of the motion begin and end, bit for bit.
  [[nodiscard]] double share(std::size_t waypoint) const {
    return moving_.time(waypoint) / moving_.loaded().scene.duration;
  }

  /// The distance from the last waypoint, as ConfigurationSpace::distance(), by arithmetic of its
  /// own.
  [[nodiscard]] double distance_to_goals() const {
    double least = std::numeric_limits<double>::infinity();
    for (const std::vector<double>& goal : path_.goals) {
      if (goal.size() != path_.waypoints.back().size()) {
        throw BrokenPath("A goal has not as many numbers as a waypoint.");
      }
      const std::vector<double>& end = path_.waypoints.back();
      const double of_joints = path_.robots.empty() ? 0.0 : way_of_joints(end, goal);
      const double of_body = moving_.body() ? way_of_body(end, goal) : 0.0;
      least = std::min(least, std::hypot(of_joints, of_body));
    }
    return least;
  }

  /// [m and rad alike]  Floating joints have a distance and an angle.
  [[nodiscard]] double way_of_joints(const std::vector<double>& from,
                                     const std::vector<double>& to) const {
    double square = 0.0;
    for (std::size_t k = 0; k < from.size(); ++k) {
      if (const auto rest = moving_.rotation_columns(k)) {
        const double angle = angle_of(rotation_in(from, *rest), rotation_in(to, *rest));
        square += angle * angle;
      }
      if (moving_.is_rotation(k) || moving_.is_of_body(k)) {
        continue;
      }
      const bool is_short = path_.turnings.at(k) == Turning::shortest;
      const double way =
          is_short ? std::remainder(to[k] - from[k], 2.0 * std::numbers::pi) : to[k] - from[k];
      square += way * way;
    }
    return std::sqrt(square);
  }

  static Eigen::Vector4d rotation_in(const std::vector<double>& q,
                                     const std::array<std::size_t, 4>& columns) {
    return Eigen::Vector4d(q.at(columns[0]), q.at(columns[1]), q.at(columns[2]), q.at(columns[3]))
        .normalized();
  }

  /// [rad]  The angle of two unit quaternions, exact near 0 as well as near half a turn.
  static double angle_of(const Eigen::Vector4d& a, const Eigen::Vector4d& b) {
    return 4.0 * std::atan2(std::min((a - b).norm(), (a + b).norm()),
                            std::max((a - b).norm(), (a + b).norm()));
  }

  /// [m]  The displacement of the origin, and that of the farthest point by the shortest rotation.
  [[nodiscard]] double way_of_body(const std::vector<double>& from,
                                   const std::vector<double>& to) const {
    const Shape& shape = shape_of_body(moving_.loaded(), *moving_.body());
    const Hierarchy& hierarchy = shape.hierarchy();
    const double reach = hierarchy.centre.norm() + hierarchy.radius + shape.radius();
    const std::array<double, 7> a = moving_.body_numbers(from);
    const std::array<double, 7> b = moving_.body_numbers(to);
    const double angle = angle_of(Eigen::Vector4d(a[3], a[4], a[5], a[6]).normalized(),
                                  Eigen::Vector4d(b[3], b[4], b[5], b[6]).normalized());
    const Eigen::Vector3d way(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
    return way.norm() + reach * angle;
  }

  void require_goal() {
    result_.reaches_goal = path_.goal && *path_.goal < path_.goals.size() &&
                           path_.goals[*path_.goal] == path_.waypoints.back();
    if (path_.is_proven && !result_.reaches_goal) {
      throw BrokenPath("The path calls itself proven, but does not end at the goal that it names.");
    }
    // Covers the roundings of a distance; both are sums of few terms.
    constexpr double kRounding = 1e-9;
    const double distance = result_.reaches_goal ? 0.0 : distance_to_goals();
    if (!(std::abs(path_.distance_to_goal - distance) <= kRounding * (1.0 + distance))) {
      throw BrokenPath("The distance_to_goal of the path is " +
                       detail::write_json(path_.distance_to_goal) + "; it ends " +
                       detail::write_json(distance) + " from the nearest goal.");
    }
    const std::size_t edges = path_.waypoints.size() - 1;
    if (path_.clearances.size() != edges) {
      throw BrokenPath("The path has " + std::to_string(path_.clearances.size()) +
                       " edges between " + std::to_string(edges + 1) + " waypoints.");
    }
  }

  /// Requires that the numbers about the whole path are those of its scene and its edges.
  void require_totals() {
    if (!(path_.tolerance == moving_.loaded().scene.options.tolerance)) {
      throw BrokenPath("The tolerance of the path is not that of its scene.");
    }
    if (!(path_.margin == moving_.loaded().scene.options.margin)) {
      throw BrokenPath("The margin of the path is not that of its scene.");
    }
    if (courses_.has_tracking_errors()) {
      result_.warnings.emplace_back("with tracking errors clearances are not proven again");
    }
    std::optional<double> least;
    for (const std::optional<double>& clearance : path_.clearances) {
      least = least && clearance ? std::min(*least, *clearance) : (least ? least : clearance);
    }
    if (!path_.clearances.empty() && path_.clearance != least) {
      throw BrokenPath("The clearance of the path is not the least of its edges.");
    }
  }

  void prove(std::size_t edge) {
    FreeClaim claim{.until =
                        [this](const BodyPair& pair) {
                          return moving_.moves(pair[0]) || moving_.moves(pair[1]) ? 1.0 : -1.0;
                        },
                    .extra = path_.extra_clearance};
    claim.held = held_along(edge);
    claim.from = share(edge);
    claim.last = share(edge + 1);
    const std::optional<double>& clearance =
        path_.clearances.empty() ? path_.clearance : path_.clearances[edge];
    const bool is_claimed = clearance && *clearance >= 0.0 && !courses_.has_tracking_errors();
    if (is_claimed && result_.verdict == ProofVerdict::proven) {
      // Mostly both hold, and one proof covers both.
      FreeClaim both = claim;
      both.clearance = clearance;
      both.has_margins = true;
      const ProofFinding found = proof_.prove_free(both);
      if (found.verdict == ProofVerdict::proven) {
        return;
      }
      if (found.reason == detail::ProofReason::stopped) {
        take(found, edge, claim, "");
        return;
      }
    }
    take(proof_.prove_free(claim), edge, claim, "");
    if (!clearance) {
      if (result_.tested > claim.held.size()) {
        throw BrokenPath("Edge " + std::to_string(edge) + " has no clearance.");
      }
      return;
    }
    if (!(*clearance >= 0.0)) {
      throw BrokenPath("The clearance of edge " + std::to_string(edge) + " is not a distance.");
    }
    if (result_.verdict == ProofVerdict::proven && is_claimed) {
      claim.clearance = clearance;
      take(proof_.prove_free(claim), edge, claim, "The clearance of the edge does not hold. ");
    }
  }

  void take(const ProofFinding& found, std::size_t edge, const FreeClaim& claim,
            const std::string& before) {
    const bool decides =
        found.verdict != ProofVerdict::proven &&
        (result_.verdict == ProofVerdict::proven || found.verdict == ProofVerdict::refuted);
    if (!decides) {
      return;
    }
    const Scene& scene = moving_.loaded().scene;
    result_.verdict = found.verdict;
    result_.problem = before + detail::describe(found, scene);
    result_.problem_edge = edge;
    result_.problem_at = detail::moment_of(found, scene);
    if (result_.problem_at) {
      for (double* t : {&result_.problem_at->from, &result_.problem_at->to}) {
        *t = std::clamp((*t - claim.from) / (claim.last - claim.from), 0.0, 1.0);
      }
    }
  }

  const PlannedPath& path_;
  MovingScene moving_;
  detail::SceneCourses courses_;
  detail::SceneProof proof_;
  std::vector<Contact> contacts_;
  PathVerification result_;
};

}  // namespace

PathVerification verify_path(const PlannedPath& path, const VerifyResultOptions& options) {
  const FloatEnvironmentGuard guard;
  PathVerification result;
  try {
    return PathProof(path, options).run();
  } catch (const BrokenPath& error) {
    result.verdict = ProofVerdict::broken;
    result.problem = error.what();
  } catch (const detail::UncertainMotion& error) {
    result.problem = std::string("A motion of the path is not certain: ") + error.what() + ".";
  }
  return result;
}

}  // namespace firstcontact
