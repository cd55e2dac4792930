#include <firstcontact/edges/detail/blocked_place.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/edges/detail/straight_ways.h>
#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/math/random_numbers.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/query/workspace.h>
#include <firstcontact/text/quantity.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

constexpr std::size_t kRings = 12;  // Each twice as wide as the one before.
constexpr std::size_t kPlacesOfRing = 128;
constexpr double kFirstRing = 1e-3;  // [-]  Part of the sampled region.
constexpr int kHalvingsToFree = 12;

/// [m]  Length of the way along a direction from which on A no longer touches B.
std::optional<double> way_out(const Shape& A, const Pose& X_WA, const Shape& B, const Pose& X_WB,
                              const Eigen::Vector3d& direction, Workspace& workspace) {
  const double far = 2.0 * (A.hierarchy().radius + B.hierarchy().radius + A.radius() + B.radius()) +
                     (X_WA.position + X_WA.rotation * A.hierarchy().centre - X_WB.position -
                      X_WB.rotation * B.hierarchy().centre)
                         .norm();
  const Pose begin{X_WA.position + far * direction, X_WA.rotation};
  const Motion inwards = Motion::constant_velocity(begin, -far * direction);
  const Motion rests = Motion::fixed(X_WB);
  const FirstContactResult found =
      first_contact({A, inwards}, {B, rests}, workspace, {.contacts = ContactState::none});
  if (found.verdict == Verdict::free) {
    return 0.0;
  }
  return found.verdict == Verdict::contact ? std::optional(far * (1.0 - found.t)) : std::nullopt;
}

std::vector<Eigen::Vector3d> directions_of_cube() {
  std::vector<Eigen::Vector3d> all;
  for (int k = 0; k < 27; ++k) {
    const Eigen::Vector3d v(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
    if (!v.isZero(0.0)) {
      all.push_back(v.normalized());
    }
  }
  return all;
}

/// The scene with its movers at a place.
RobotScene placed_scene(const PlaceTest& test, const Configuration& q) {
  RobotScene scene = test.scene.scene;
  test.scene.set_motions(scene, q, q);
  return scene;
}

/// [m]  The distance to which a pair is held in place of its margin.
std::optional<double> held_distance(const PlaceTest& test, const BodyPair& pair) {
  const std::vector<HeldPair>& held = test.options.held;
  const auto found = std::ranges::find(held, pair, &HeldPair::members);
  return found == held.end() ? std::nullopt : std::optional(found->distance);
}

/// Halves the way to a free place as long as its middle is free, or the middle of the other half.
Configuration nearer_place(const PlaceTest& test, Configuration blocked, Configuration best) {
  for (int k = 0; k < kHalvingsToFree; ++k) {
    Configuration middle = test.scene.space.interpolate(blocked, best, 0.5);
    (test.is_free(middle) ? best : blocked) = std::move(middle);
  }
  return best;
}

/// A free place on a straight way; among all directions the nearest, up to a factor of 2.
std::optional<Configuration> free_place_straight_from(const PlaceTest& test, const Configuration& q,
                                                      RandomNumbers& random) {
  const ConfigurationSpace& space = test.scene.space;
  const std::vector<Eigen::VectorXd> directions = directions_at(space, q, random);
  double way = test.options.tolerance;
  for (int k = 0; k < kWayDoublings; ++k, way *= 2.0) {
    std::optional<Configuration> best;
    for (const Eigen::VectorXd& direction : directions) {
      const Configuration place = behind_way(space, q, direction, way);
      if (space.defect(place) || !space.is_in_box(place) || !test.is_free(place)) {
        continue;
      }
      Configuration nearer = nearer_place(test, behind_way(space, q, direction, 0.5 * way), place);
      if (!best || space.distance(q, nearer) < space.distance(q, *best)) {
        best = std::move(nearer);
      }
    }
    if (best) {
      return best;
    }
  }
  return std::nullopt;
}

bool has_tracking_errors(const RobotScene& scene) {
  const auto is_error = [](const TrackingError& error) {
    return error.angle > 0.0 || error.distance > 0.0;
  };
  for (std::size_t robot = 0; robot < scene.robot_count(); ++robot) {
    if (std::ranges::any_of(scene.tracking_errors(robot), is_error)) {
      return true;
    }
  }
  return false;
}

/// Describes the distance of a pair that does not touch: the sum that the test requires, and the
/// mend.
std::string too_near(const PlaceTest& test, const RobotScene& placed, const BodyPair& pair) {
  const double tolerances = test.options.extra_clearance + test.options.tolerance;
  return " are no farther apart than their margin of " +
         quantity(placed.margin(pair).value_or(0.0), "m") + " and " + quantity(tolerances, "m") +
         " for the tolerances of the search" +
         (has_tracking_errors(placed) ? ", tracking errors added" : "") +
         " (move them apart, or take a smaller margin or tolerance)";
}

std::string numbers_of(const ConfigurationSpace& space, const Configuration& q) {
  std::string text;
  for (std::size_t k = 0; k < q.size(); ++k) {
    text += k == 0 ? "" : space.is_body() ? " " : ", ";
    text += space.is_body() ? "" : space.number_name(k) + "=";
    text += write_json(q[k]);
  }
  return text;
}

/// [m]  An upper bound of how deep the two are in each other; none where it was not found.
///
/// It is the shortest of 26 straight ways on which the first shape leaves the second one for good.
std::optional<double> depth_of(const RobotScene& scene, const BodyPair& members, double t) {
  Workspace workspace;
  double deepest = 0.0;
  for (std::size_t a = 0; a < scene.geometries(members[0]).size(); ++a) {
    for (std::size_t b = 0; b < scene.geometries(members[1]).size(); ++b) {
      const Shape& A = scene.geometries(members[0])[a].shape;
      const Shape& B = scene.geometries(members[1])[b].shape;
      const Pose X_WA = scene.geometry_pose(members[0], a, t);
      const Pose X_WB = scene.geometry_pose(members[1], b, t);
      if (distance({A, Motion::fixed(X_WA)}, {B, Motion::fixed(X_WB)}, 0.0, workspace).distance >
          0.0) {
        continue;  // Near, or enclosed: a pair that does not meet has no depth.
      }
      double least = std::numeric_limits<double>::infinity();
      for (const Eigen::Vector3d& direction : directions_of_cube()) {
        const std::optional<double> way = way_out(A, X_WA, B, X_WB, direction, workspace);
        least = std::min(least, way.value_or(least));
      }
      deepest = std::max(deepest, least);
    }
  }
  return std::isfinite(deepest) ? std::optional(deepest) : std::nullopt;
}

/// A free place near one that is not free.
///
/// It is on a straight way along an axis or in a random direction, else the nearest of some
/// thousand random places.
std::optional<Configuration> free_place_near(const PlaceTest& test, const Configuration& q) {
  const ConfigurationSpace& space = test.scene.space;
  RandomNumbers random(1);
  if (std::optional<Configuration> place = free_place_straight_from(test, q, random)) {
    return place;
  }
  double share = kFirstRing;
  for (std::size_t ring = 0; ring < kRings; ++ring, share = std::min(1.0, 2.0 * share)) {
    std::optional<Configuration> best;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < kPlacesOfRing; ++k) {
      const Configuration towards = space.sample(random);
      const Configuration place = space.interpolate(q, towards, share * random.uniform());
      const double distance = space.distance(q, place);
      if (distance < least && test.is_free(place)) {
        least = distance;
        best = place;
      }
    }
    if (best) {
      return nearer_place(test, q, *best);
    }
  }
  return std::nullopt;
}

}  // namespace

PlaceTest test_of(const EdgeChecker& checker) {
  return {.scene = checker.scene(),
          .options = checker.options(),
          .is_free = [&checker](const Configuration& q) { return checker.is_free(q); }};
}

std::string describe_pair(const PlaceTest& test, const Configuration& q, const BodyPair& pair,
                          const std::string& what) {
  const PlanScene& scene = test.scene;
  const RobotScene placed = placed_scene(test, q);
  std::string text =
      what + ": " + in_quotes(scene.name(pair[0])) + " and " + in_quotes(scene.name(pair[1]));
  const std::optional<double> depth = depth_of(placed, pair, test.t);
  if (depth && *depth > 0.0) {
    text += " touch, up to " + quantity(*depth, "m") + " deep";
  } else if (const std::optional<double> held = held_distance(test, pair)) {
    text += " are no farther apart than " + quantity(*held, "m") + ", which contact_pairs keeps";
  } else {
    text += too_near(test, placed, pair);
  }
  if (const std::optional<Configuration> place = free_place_near(test, q)) {
    text += "; the nearest free configuration that was found is at " +
            numbers_of(test.scene.space, *place);
  } else {
    text += "; no free configuration was found near it";
  }
  return text;
}

std::string describe_blocked(const EdgeChecker& checker, const Configuration& q,
                             const std::string& what) {
  const EdgeAnswer answer = checker.check(q, q);
  if (answer.verdict == EdgeVerdict::undecided || !answer.pair) {
    return name_blocked(checker.scene(), std::nullopt, what);
  }
  return describe_pair(test_of(checker), q, *answer.pair, what + " is not free");
}

std::string name_blocked(const PlanScene& scene, const std::optional<BodyPair>& pair,
                         const std::string& what) {
  return what + " is not free: " +
         (pair ? in_quotes(scene.name((*pair)[0])) + " and " + in_quotes(scene.name((*pair)[1])) +
                     " are in the way"
               : "it was not decided with the effort that is allowed");
}

}  // namespace firstcontact::detail
