#include <firstcontact/simulation_model/detail/round_side.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <Eigen/Geometry>

#include <firstcontact/simulation_model/detail/constants.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// [-]  Corners are on a circle if they are as near to it, by its radius: files have few digits.
constexpr double kOnCircle = 2e-6;

/// [-]  Beyond this cosine between normal and axis a contact on a side is one of its rim.
constexpr double kAlongSide = 0.1;

Vector3d across_axis(const Vector3d& v, const Vector3d& axis) { return v - v.dot(axis) * axis; }

/// [rad]  The greatest angle between two neighbours of directions around an axis.
double greatest_step(std::vector<double> angles) {
  std::ranges::sort(angles);
  double greatest = angles.front() + 2.0 * std::numbers::pi - angles.back();
  for (std::size_t k = 1; k < angles.size(); ++k) {
    greatest = std::max(greatest, angles[k] - angles[k - 1]);
  }
  return greatest;
}

/// The round side about one axis of the body frame.
std::optional<RoundSide> round_about(const Mesh& mesh, int axis, double sag) {
  Eigen::AlignedBox3d box;
  Vector3d mean = Vector3d::Zero();  // The corners of a regular polygon are about their mean.
  for (const Vector3d& vertex : mesh.vertices) {
    box.extend(vertex);
    mean += vertex / static_cast<double>(mesh.vertices.size());
  }
  RoundSide side{.centre_B = mean, .axis_B = Vector3d::Unit(axis)};
  side.centre_B[axis] = box.center()[axis];
  const int x = (axis + 1) % 3;
  const int y = (axis + 2) % 3;
  for (const Vector3d& vertex : mesh.vertices) {
    side.radius = std::max(side.radius, across_axis(vertex - side.centre_B, side.axis_B).norm());
  }
  std::array<std::vector<double>, 2> angles;
  for (const Vector3d& vertex : mesh.vertices) {
    const Vector3d from = vertex - side.centre_B;
    const double away = across_axis(from, side.axis_B).norm();
    const bool is_on_ring = std::abs(away - side.radius) <= kOnCircle * side.radius;
    if (!is_on_ring && away > kOnCircle * side.radius) {
      return std::nullopt;
    }
    const double to_end = std::abs(std::abs(from[axis]) - 0.5 * box.sizes()[axis]);
    if (to_end > kOnCircle * box.sizes()[axis]) {
      return std::nullopt;
    }
    if (is_on_ring) {
      angles[from[axis] > 0.0 ? 1 : 0].push_back(std::atan2(from[y], from[x]));
    }
    side.is_on_ring.push_back(is_on_ring);
  }
  for (const std::vector<double>& of_end : angles) {
    if (of_end.size() < 3 || side.radius * (1.0 - std::cos(0.5 * greatest_step(of_end))) > sag) {
      return std::nullopt;
    }
  }
  return side;
}

/// Whether a feature is part of the side or of a rim.
bool is_of_side(const Shape& shape, const RoundSide& side, const Feature& feature) {
  switch (feature.type) {
    case FeatureType::vertex:
      return side.is_on_ring[feature.index];
    case FeatureType::edge: {
      const auto [a, b] = shape.edge(feature.index);
      return side.is_on_ring[a] && side.is_on_ring[b];
    }
    case FeatureType::face:
      break;
  }
  const auto& [a, b, c] = shape.mesh().triangles[feature.index];
  const auto& v = shape.mesh().vertices;
  const Vector3d normal = (v[b] - v[a]).cross(v[c] - v[a]);
  return std::abs(normal.dot(side.axis_B)) <= 0.5 * normal.norm();
}

/// One body of a contact in the world.
struct Around {
  Vector3d axis;     // [-]  Of the round side.
  Vector3d on_axis;  // [m]  The point of the axis beside the contact.
  Vector3d point;    // [m]  The closest point of the body.
};

std::optional<Vector3d> edge_direction(const PlacedRoundSide& body, const Feature& feature) {
  if (feature.type != FeatureType::edge) {
    return std::nullopt;
  }
  const auto [a, b] = body.shape->edge(feature.index);
  const auto& v = body.shape->mesh().vertices;
  return body.pose.rotation.normalized() * (v[b] - v[a]).stableNormalized();
}

/// The normal from a round side to another body, where both lie along each other or cross.
Vector3d outwards_of(const Around& side, const Vector3d& other, const std::optional<Vector3d>& line,
                     const Vector3d& before) {
  if (line) {
    const Vector3d crossing = side.axis.cross(*line);
    if (crossing.norm() > kCrossingEdges) {
      return (crossing.dot(before) < 0.0 ? -crossing : crossing).normalized();
    }
  }
  const Vector3d away = across_axis(other - side.on_axis, side.axis);
  return away.dot(before) > 0.0 ? away.normalized() : before;
}

}  // namespace

std::optional<RoundSide> find_round_side(const Shape& shape, double sag) {
  if (shape.radius() > 0.0 || !shape.vertices_to().empty()) {
    return std::nullopt;
  }
  for (const int axis : {2, 1, 0}) {
    if (std::optional<RoundSide> side = round_about(shape.mesh(), axis, sag)) {
      return side;
    }
  }
  return std::nullopt;
}

Vector3d nearest_on_side(const PlacedRoundSide& body, const Vector3d& beside,
                         const Vector3d& outwards) {
  const Eigen::Quaterniond R = body.pose.rotation.normalized();
  const Vector3d axis = R * body.side->axis_B;
  const Vector3d centre = body.pose.position + R * body.side->centre_B;
  return centre + (beside - centre).dot(axis) * axis +
         body.side->radius * across_axis(outwards, axis).normalized();
}

std::array<bool, 2> make_round(const std::array<PlacedRoundSide, 2>& bodies, Contact& contact) {
  const std::array<Feature, 2> features{contact.feature_A, contact.feature_B};
  std::array<Vector3d, 2> points{contact.p_WA, contact.p_WB};
  Vector3d n = *contact.n_AB_W;
  std::array<std::optional<Around>, 2> around;
  for (std::size_t s = 0; s < 2; ++s) {
    const auto& [shape, side, pose] = bodies[s];
    if (side == nullptr || !is_of_side(*shape, *side, features[s])) {
      continue;
    }
    const Eigen::Quaterniond R = pose.rotation.normalized();
    const Vector3d axis = R * side->axis_B;
    const Vector3d centre = pose.position + R * side->centre_B;
    around[s] = {axis, centre + (points[s] - centre).dot(axis) * axis, points[s]};
  }
  for (std::size_t s = 0; s < 2; ++s) {
    const std::size_t other = 1 - s;
    if (!around[s] || (features[other].type == FeatureType::face && !around[other]) ||
        std::abs(n.dot(around[s]->axis)) > kAlongSide) {
      continue;  // A face beside it has the normal already.
    }
    const double sign = s == 0 ? 1.0 : -1.0;
    const std::optional<Vector3d> line =
        around[other] ? around[other]->axis : edge_direction(bodies[other], features[other]);
    const Vector3d& beside = around[other] ? around[other]->on_axis : points[other];
    n = sign * outwards_of(*around[s], beside, line, sign * n);
  }
  std::array<bool, 2> rolls{false, false};
  for (std::size_t s = 0; s < 2; ++s) {
    if (!around[s]) {
      continue;
    }
    const Vector3d nearest = across_axis(s == 0 ? n : Vector3d(-n), around[s]->axis);
    const Vector3d radial = around[s]->point - around[s]->on_axis;
    if (nearest.norm() < kOnCircle ||
        radial.dot(nearest) < kNearLine * radial.norm() * nearest.norm()) {
      continue;
    }
    rolls[s] = true;
    points[s] = around[s]->on_axis + bodies[s].side->radius * nearest.normalized();
  }
  if (rolls[0] || rolls[1]) {
    contact.n_AB_W = n;
    contact.distance = n.dot(points[1] - points[0]);
    contact.p_WA = rolls[0] ? points[0] : Vector3d(points[1] - contact.distance * n);
    contact.p_WB = rolls[1] ? points[1] : Vector3d(points[0] + contact.distance * n);
  }
  return rolls;
}

}  // namespace firstcontact::detail
