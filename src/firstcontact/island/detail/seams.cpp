#include <firstcontact/island/detail/seams.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/query/close_features.h>
#include <firstcontact/query/placed_shape.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/round_contact.h>
#include <firstcontact/simulation_model/detail/sim_body.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// The shape of a single point.
const Shape& point_shape() {
  static const Shape point({.vertices = {{0.0, 0.0, 0.0}}, .triangles = {{0, 0, 0}}});
  return point;
}

/// Finds the nearest vector that makes no acute angle with any of some directions (C. Hildreth, "A
/// quadratic programming procedure", Naval Research Logistics Quarterly 4 (1957)).
Vector3d nearest_in_polar_cone(const Vector3d& v, const std::vector<Vector3d>& directions) {
  constexpr int kSweeps = 50;
  Vector3d nearest = v;
  std::vector<double> multipliers(directions.size(), 0.0);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double change = 0.0;
    for (std::size_t k = 0; k < directions.size(); ++k) {
      const double next = std::max(0.0, multipliers[k] + directions[k].dot(nearest));
      nearest -= (next - multipliers[k]) * directions[k];
      change = std::max(change, std::abs(next - multipliers[k]));
      multipliers[k] = next;
    }
    if (change <= 1e-14) {
      break;
    }
  }
  return nearest;
}

/// Finds the point at which a body touches along a new normal.
Vector3d point_towards(const SimBody& body, const RoundFeature& round, const Pose& pose,
                       const Vector3d& before, const Vector3d& outwards_before,
                       const Vector3d& outwards) {
  if (round.is_curved()) {
    return farthest_on(pose, round, before, outwards);
  }
  return before + body.shape.radius() * (outwards - outwards_before);
}

}  // namespace

SeamFinder::SeamFinder(IslandState& state, Workspace& workspace,
                       std::function<Pose(std::size_t)> pose_of)
    : state_(state), workspace_(workspace), pose_of_(std::move(pose_of)) {
  for (const auto& [pair, manifold] : state.manifolds) {
    for (std::size_t s = 0; s < 2; ++s) {
      if (state.model.bodies[pair[1 - s]].kind == BodyKind::free) {
        touching_[pair[s]].push_back(pair[1 - s]);
      }
    }
  }
}

bool SeamFinder::level(ManifoldPoint& touch) {
  const bool first = lean(touch, 0);
  const bool second = lean(touch, 1);
  return first || second;
}

/// Lists the bodies other than the pair around a point: fixed and scripted ones, and members that
/// touch one of the pair.
std::vector<std::size_t> SeamFinder::bodies_near(const Vector3d& point,
                                                 const BodyPair& pair) const {
  const Vector3d reach = Vector3d::Constant(state_.model.distances.band);
  const Eigen::AlignedBox3d box(point - reach, point + reach);
  std::vector<std::size_t> near;
  const auto add = [&](std::size_t body) {
    if (body != pair[0] && body != pair[1] && state_.model.bodies[body].shape.radius() == 0.0) {
      near.push_back(body);
    }
  };
  state_.around.for_each_overlap(box, add);
  for (const std::size_t body : pair) {
    const auto beside = touching_.find(body);
    if (beside != touching_.end()) {
      std::ranges::for_each(beside->second, add);
    }
  }
  std::ranges::sort(near);
  near.erase(std::unique(near.begin(), near.end()), near.end());
  return near;
}

/// Adds the directions from a feature into the surface around it.
void SeamFinder::add_directions(std::size_t body, const Feature& feature,
                                std::vector<Vector3d>& directions) const {
  const Shape& shape = state_.model.bodies[body].surface;
  const Eigen::Quaterniond R = pose_of_(body).rotation.normalized();
  const auto add = [&](const Vector3d& direction_B) {
    if (direction_B.any()) {
      directions.push_back(R * direction_B.stableNormalized());
    }
  };
  if (feature.type != FeatureType::face) {
    state_.model.neighbours[body]->for_each_offset(feature, add);
    return;
  }
  const auto& [a, b, c] = shape.mesh().triangles[feature.index];
  const auto& v = shape.mesh().vertices;
  const Vector3d along = (v[b] - v[a]).stableNormalized();
  const Vector3d side = v[c] - v[a];
  const Vector3d across = side - side.dot(along) * along;
  for (const Vector3d& direction : {along, across}) {
    add(direction);
    add(-direction);
  }
}

/// Adds the directions from a point into the surface of a body, if that is near. They come from its
/// edges and corners there, or else from its faces.
bool SeamFinder::add_surface_near(std::size_t body, const Vector3d& point,
                                  std::vector<Vector3d>& directions) {
  const Pose pose = pose_of_(body);
  const Vector3d point_B = pose.rotation.normalized().conjugate() * (point - pose.position);
  if (state_.model.bodies[body].box_B.exteriorDistance(point_B) > state_.model.distances.band) {
    return false;
  }
  const PlacedShape at(point_shape(), {point, Eigen::Quaterniond::Identity()});
  const PlacedShape other(state_.model.bodies[body].surface, pose);
  close_features(at, other, state_.model.distances.band, workspace_, contacts_);
  const auto is_face = [](const Contact& contact) {
    return contact.feature_B.type == FeatureType::face;
  };
  const bool faces_only = std::ranges::all_of(contacts_, is_face);
  for (const Contact& contact : contacts_) {
    if (faces_only || !is_face(contact)) {
      add_directions(body, contact.feature_B, directions);
    }
  }
  return !contacts_.empty();
}

/// Turns the normal at an edge or a corner of one of the bodies.
bool SeamFinder::lean(ManifoldPoint& touch, std::size_t side) {
  const std::size_t body = touch.bodies[side];
  const Feature& feature = side == 0 ? touch.feature_A : touch.feature_B;
  const Feature& opposite = side == 0 ? touch.feature_B : touch.feature_A;
  const bool is_beside_face =
      opposite.type == FeatureType::face && !touch.round[1 - side].is_curved();
  if (feature.type == FeatureType::face || is_beside_face || touch.round[side].is_curved() ||
      state_.model.bodies[body].shape.radius() > 0.0) {
    return false;
  }
  const double margin = state_.model.laws.margin(touch.bodies).value_or(0.0);
  const double sign = side == 0 ? 1.0 : -1.0;
  const Vector3d point = touch.point - 0.5 * sign * (touch.gap + margin) * touch.normal;
  const Vector3d before = sign * touch.normal;
  Vector3d outwards = before;
  std::vector<Vector3d> directions;
  add_directions(body, feature, directions);
  const auto within_face = std::ranges::count_if(directions, [&](const Vector3d& direction) {
    return std::abs(direction.dot(before)) <= kTiltOfFace;
  });
  if (within_face >= (feature.type == FeatureType::edge ? 1 : 2)) {
    return false;  // Its normal is that of a face, and a flush face has the same.
  }
  for (const std::size_t beside : bodies_near(point, touch.bodies)) {
    std::vector<Vector3d> both = directions;
    if (!add_surface_near(beside, point, both)) {
      continue;
    }
    const Vector3d allowed = nearest_in_polar_cone(outwards, both);
    if (allowed.norm() > kLeastLevel) {
      outwards = allowed.normalized();
      directions = std::move(both);
    }
  }
  return (outwards - before).norm() > kTiltOfSeam && take_normal(outwards, side, touch);
}

/// Gives the touch a normal of one of its bodies. Returns whether the other one permits it, and
/// there is a gap along it.
bool SeamFinder::take_normal(const Vector3d& outwards, std::size_t side, ManifoldPoint& touch) {
  const std::size_t other = 1 - side;
  const std::size_t body = touch.bodies[other];
  const SimBody& its = state_.model.bodies[body];
  const Feature& feature = other == 0 ? touch.feature_A : touch.feature_B;
  const Pose pose = pose_of_(body);
  const RoundFeature& round = touch.round[other];
  if (!round.is_curved() && its.shape.radius() == 0.0 &&
      !state_.model.neighbours[body]->is_outermost(
          feature, pose.rotation.normalized().conjugate() * -outwards)) {
    return false;
  }
  const double margin = state_.model.laws.margin(touch.bodies).value_or(0.0);
  const double sign = side == 0 ? 1.0 : -1.0;
  const Vector3d half = 0.5 * sign * (touch.gap + margin) * touch.normal;
  const Vector3d there =
      point_towards(its, round, pose, touch.point + half, -sign * touch.normal, -outwards);
  const double distance = outwards.dot(there - (touch.point - half));
  if (!(distance - margin > kLeastGapOfSeam * state_.model.distances.least)) {
    return false;
  }
  touch.normal = sign * outwards;
  touch.gap = distance - margin;
  touch.point = there - 0.5 * distance * outwards;
  touch.faces[side] = true;
  return true;
}

}  // namespace firstcontact::detail
