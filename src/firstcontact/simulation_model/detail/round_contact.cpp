#include <firstcontact/simulation_model/detail/round_contact.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <Eigen/Geometry>

#include <firstcontact/simulation_model/detail/constants.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// [-]  Beyond this cosine between normal and axis a contact on a side is one of its rim.
constexpr double kAlongSide = 0.1;
/// [-]  A normal with a smaller part across the axis is along it.
constexpr double kAcrossAxis = 2e-6;

Vector3d across_axis(const Vector3d& v, const Vector3d& axis) { return v - v.dot(axis) * axis; }

/// One body of a contact in the world.
struct Side {
  RoundFeature feature = {};
  Vector3d axis = Vector3d::UnitZ();    // [-]  Of the circle.
  Vector3d on_axis = Vector3d::Zero();  // [m]  The point of the axis beside the contact.
  Vector3d core = Vector3d::Zero();     // [m]  The closest point, without the radius around it.
  double thickness = 0.0;               // [m]  That radius.
  std::optional<Vector3d> edge = {};    // [-]  The direction of an edge.

  [[nodiscard]] bool is_round() const { return feature.circle != nullptr; }
};

std::optional<Vector3d> edge_direction(const PlacedRound& body, const Feature& feature) {
  if (feature.type != FeatureType::edge) {
    return std::nullopt;
  }
  const auto [a, b] = body.shape->edge(feature.index);
  const auto& v = body.shape->mesh().vertices;
  return body.pose.rotation.normalized() * (v[b] - v[a]).stableNormalized();
}

/// @param point     [m]
/// @param outwards  [-]  unit, out of the body
Side side_of(const PlacedRound& body, const Feature& feature, const Vector3d& point,
             const Vector3d& outwards) {
  Side side{.thickness = body.shape->radius(), .edge = edge_direction(body, feature)};
  side.core = point - side.thickness * outwards;
  side.feature.circle = body.circles != nullptr ? body.circles->at(*body.shape, feature) : nullptr;
  if (side.is_round()) {
    const Eigen::Quaterniond R = body.pose.rotation.normalized();
    side.axis = R * side.feature.circle->axis_B;
    const Vector3d centre = body.pose.position + R * side.feature.circle->centre_B;
    side.on_axis = centre + (point - centre).dot(side.axis) * side.axis;
    side.feature.is_hole = (point - side.on_axis).dot(outwards) < 0.0;
  }
  return side;
}

/// The normal out of a round side, where both bodies lie along each other or cross.
Vector3d outwards_of(const Side& side, const Side& other, const Vector3d& before) {
  const std::optional<Vector3d> line =
      other.is_round() ? std::optional<Vector3d>(other.axis) : other.edge;
  if (line) {
    const Vector3d crossing = side.axis.cross(*line);
    if (crossing.norm() > kCrossingEdges) {
      if (side.feature.is_hole) {
        return before;
      }
      return (crossing.dot(before) < 0.0 ? -crossing : crossing).normalized();
    }
  }
  const Vector3d from_axis =
      across_axis((other.is_round() ? other.on_axis : other.core) - side.on_axis, side.axis);
  const Vector3d away = side.feature.is_hole ? Vector3d(-from_axis) : from_axis;
  return away.dot(before) > 0.0 ? away.normalized() : before;
}

/// [m]  Where a circle is nearest to the other body, from its axis; nothing where the contact is
/// elsewhere on it.
std::optional<Vector3d> nearest_from_axis(const Side& side, const Vector3d& outwards) {
  const Vector3d across = across_axis(outwards, side.axis);
  const Vector3d radial = side.core - side.on_axis;
  const Vector3d nearest = side.feature.is_hole ? Vector3d(-across) : across;
  if (across.norm() < kAcrossAxis ||
      radial.dot(nearest) < kNearLine * radial.norm() * nearest.norm()) {
    return std::nullopt;
  }
  return side.feature.radius() * across.normalized();
}

}  // namespace

Vector3d nearest_on_circle(const Pose& pose, const RoundFeature& feature, const Vector3d& beside,
                           const Vector3d& outwards) {
  const Eigen::Quaterniond R = pose.rotation.normalized();
  const Vector3d axis = R * feature.circle->axis_B;
  const Vector3d centre = pose.position + R * feature.circle->centre_B;
  return centre + (beside - centre).dot(axis) * axis +
         feature.radius() * across_axis(outwards, axis).normalized();
}

std::array<RoundFeature, 2> make_round(const std::array<PlacedRound, 2>& bodies, Contact& contact) {
  Vector3d n = *contact.n_AB_W;
  std::array<Side, 2> sides{side_of(bodies[0], contact.feature_A, contact.p_WA, n),
                            side_of(bodies[1], contact.feature_B, contact.p_WB, -n)};
  const std::array<Feature, 2> features{contact.feature_A, contact.feature_B};
  for (std::size_t s = 0; s < 2; ++s) {
    const std::size_t other = 1 - s;
    if (!sides[s].is_round() ||
        (features[other].type == FeatureType::face && !sides[other].is_round()) ||
        std::abs(n.dot(sides[s].axis)) > kAlongSide) {
      continue;  // A face beside it has the normal already.
    }
    const double sign = s == 0 ? 1.0 : -1.0;
    n = sign * outwards_of(sides[s], sides[other], sign * n);
  }
  std::array<RoundFeature, 2> round;
  std::array<Vector3d, 2> points;
  for (std::size_t s = 0; s < 2; ++s) {
    const Vector3d outwards = s == 0 ? n : Vector3d(-n);
    points[s] = sides[s].core + sides[s].thickness * outwards;
    if (!sides[s].is_round()) {
      continue;
    }
    if (const std::optional<Vector3d> radial = nearest_from_axis(sides[s], outwards)) {
      round[s] = sides[s].feature;
      points[s] = sides[s].on_axis + *radial;
    }
  }
  if (round[0].circle != nullptr || round[1].circle != nullptr) {
    contact.n_AB_W = n;
    contact.distance = n.dot(points[1] - points[0]);
    contact.p_WA =
        round[0].circle != nullptr ? points[0] : Vector3d(points[1] - contact.distance * n);
    contact.p_WB =
        round[1].circle != nullptr ? points[1] : Vector3d(points[0] + contact.distance * n);
  }
  return round;
}

}  // namespace firstcontact::detail
