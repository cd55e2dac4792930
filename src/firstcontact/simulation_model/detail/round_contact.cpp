#include <firstcontact/simulation_model/detail/round_contact.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include <Eigen/Geometry>

#include <firstcontact/simulation_model/detail/constants.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// [-]  Greatest cosine between the normal and the axis of a circle that lies along the other body.
constexpr double kAlongSide = 0.1;
/// [-]  Rounding of places and radii: corners are on their circles within it.
constexpr double kRoundingOfCircles = 2e-5;
/// [-]  Least sine between the normal at a face and the axis of a circle on it. A disc that lies
/// nearly flat has no lowest point: with the least turn it runs all around.
constexpr double kLeastAcross = 0.05;

Vector3d across_axis(const Vector3d& v, const Vector3d& axis) { return v - v.dot(axis) * axis; }

/// One body of a contact, in the world.
struct Side {
  RoundFeature feature = {};            // Circle that may replace its feature.
  bool is_side = false;                 // Whether it is a cylinder's side, not only a rim.
  bool is_face = false;                 // Whether it is a flat face.
  Vector3d axis = Vector3d::UnitZ();    // [-]  Axis of the circle.
  Vector3d on_axis = Vector3d::Zero();  // [m]  The point of the axis beside the contact.
  Vector3d radial = Vector3d::Zero();   // [m]  Vector from there to the polygon.
  Vector3d core = Vector3d::Zero();     // [m]  The closest point, without the radius around it.
  double thickness = 0.0;               // [m]  That radius.
  std::optional<Vector3d> line = {};    // [-]  The direction of an edge, or of the axis.

  [[nodiscard]] bool is_round() const { return feature.circle != nullptr; }

  /// [m]  The point of the line beside the contact.
  [[nodiscard]] Vector3d& on_line() { return is_round() ? on_axis : core; }

  /// Makes the side of a rim the edge or the corner that it is.
  void make_plain(const std::optional<Vector3d>& edge) {
    feature = {};
    line = edge;
  }
};

std::optional<Vector3d> edge_direction(const PlacedRound& body, const Feature& feature) {
  if (feature.type != FeatureType::edge) {
    return std::nullopt;
  }
  const auto [a, b] = body.shape->edge(feature.index);
  const auto& v = body.shape->mesh().vertices;
  return body.pose.rotation.normalized() * (v[b] - v[a]).stableNormalized();
}

/// The side of a contact at a feature.
///
/// @param point     [m]
/// @param outwards  [-]  unit, out of the body
/// @param most_sag  [m]  of a circle
Side side_of(const PlacedRound& body, const Feature& feature, const Vector3d& point,
             const Vector3d& outwards, double most_sag) {
  Side side{.is_face = feature.type == FeatureType::face,
            .thickness = body.shape->radius(),
            .line = edge_direction(body, feature)};
  side.core = point - side.thickness * outwards;
  const OnCircle on = body.circles != nullptr ? body.circles->at(*body.shape, feature) : OnCircle{};
  if (on.circle == nullptr || (on.circle->sag() > most_sag && !body.is_curved)) {
    return side;
  }
  const Eigen::Quaterniond R = body.pose.rotation.normalized();
  side.axis = R * on.circle->axis_B;
  const Vector3d centre = body.pose.position + R * on.circle->centre_B;
  side.on_axis = centre + (point - centre).dot(side.axis) * side.axis;
  side.radial = point - side.on_axis;
  const bool is_hole = side.radial.dot(outwards) < 0.0;
  if (is_hole ? on.circle->is_hole : on.circle->is_rim) {
    side.feature = {.circle = on.circle, .is_hole = is_hole};
    side.is_side = on.is_side;
    side.is_face = false;
    side.line = side.axis;
  }
  return side;
}

/// Whether a contact is at a known circle.
///
/// That is on a cylinder, on a rim that stands on a face, or on a rim along a line parallel to its
/// axis.
bool may_be_round(const Side& side, const Side& other, const Vector3d& n) {
  if (side.is_side) {
    return true;
  }
  if (other.is_face) {
    return across_axis(n, side.axis).norm() >= kLeastAcross;
  }
  return other.line && std::abs(n.dot(side.axis)) <= kAlongSide &&
         side.axis.cross(*other.line).norm() <= kCrossingEdges;
}

/// The normal out of a round side, where no face determines it.
Vector3d outwards_of(const Side& side, const Side& other, const Vector3d& before) {
  if (other.line) {
    const Vector3d crossing = side.axis.cross(*other.line);
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

/// Whether the axis of a cylinder crosses an edge, or another axis, on the outside of both bodies.
bool cross(const std::array<Side, 2>& sides, const Vector3d& n) {
  const auto is_along = [&](const Side& side) {
    return !side.is_round() || (!side.feature.is_hole && std::abs(n.dot(side.axis)) <= kAlongSide);
  };
  return sides[0].line && sides[1].line && is_along(sides[0]) && is_along(sides[1]) &&
         sides[0].line->cross(*sides[1].line).norm() > kCrossingEdges;
}

/// A corner of a feature.
struct Corner {
  std::uint32_t vertex = 0;
  Vector3d place = Vector3d::Zero();  // [m]  In the world.
};

/// The corner of an edge, or of a triangle, that is farthest along a direction.
Corner farthest_corner(const PlacedRound& body, const Feature& feature, const Vector3d& along) {
  auto vertices = body.shape->mesh().triangles[feature.triangle];
  if (feature.type == FeatureType::edge) {
    const auto [a, b] = body.shape->edge(feature.index);
    vertices = {a, b, b};
  }
  Corner farthest;
  double most = -std::numeric_limits<double>::infinity();
  for (const std::uint32_t v : vertices) {
    const Vector3d place =
        body.pose.position + body.pose.rotation.normalized() * body.shape->mesh().vertices[v];
    if (along.dot(place) > most) {
      most = along.dot(place);
      farthest = {v, place};
    }
  }
  return farthest;
}

/// The corner beyond which the point of a side's line is; nothing where it is within its feature.
std::optional<Corner> passed_corner(const PlacedRound& body, const Feature& feature, Side& side) {
  for (const Vector3d& along : {*side.line, Vector3d(-*side.line)}) {
    const Corner corner = farthest_corner(body, feature, along);
    if (along.dot(side.on_line() - corner.place) > 0.0) {
      return corner;
    }
  }
  return std::nullopt;
}

/// Moves the points of two lines that cross to where the lines are nearest. The corner of an edge
/// takes its place where that is beyond it.
///
/// @returns whether the points then are within their features
bool move_to_nearest(const std::array<PlacedRound, 2>& bodies, std::array<Feature, 2>& features,
                     std::array<Side, 2>& sides) {
  const std::array<Vector3d, 2> lines{*sides[0].line, *sides[1].line};
  const Vector3d apart = sides[1].on_line() - sides[0].on_line();
  const double cosine = lines[0].dot(lines[1]);
  const double square = 1.0 - cosine * cosine;  // Of the sine.
  const double along_A = lines[0].dot(apart);
  const double along_B = lines[1].dot(apart);
  sides[0].on_line() += (along_A - cosine * along_B) / square * lines[0];
  sides[1].on_line() += (cosine * along_A - along_B) / square * lines[1];
  for (std::size_t s = 0; s < 2; ++s) {
    const auto corner = passed_corner(bodies[s], features[s], sides[s]);
    if (corner && !sides[s].is_round()) {
      Side& other = sides[1 - s];
      sides[s].core = corner->place;
      sides[s].line.reset();
      features[s] = {FeatureType::vertex, corner->vertex, features[s].triangle};
      other.on_axis += (corner->place - other.on_axis).dot(other.axis) * other.axis;
    }
  }
  const auto is_within = [&](std::size_t s) {
    return !sides[s].is_round() || !passed_corner(bodies[s], features[s], sides[s]);
  };
  return is_within(0) && is_within(1);
}

/// The nearest point of a circle, and its distance from the contact of the polygon.
struct OnRound {
  Vector3d radial = Vector3d::Zero();  // [m]  Vector from the axis.
  double depth = 0.0;                  // [m]  Distance across the chord between both, and the sag.
  double along = 0.0;                  // [m]  Length of the chord.
  double side = 0.0;                   // [m]  Length of an edge of the polygon.
};

/// The nearest point by the axis; nothing where the contact is elsewhere on the circle.
std::optional<OnRound> nearest_from_axis(const Side& side, const Vector3d& outwards) {
  const Vector3d across = across_axis(outwards, side.axis);
  const Vector3d radial = side.feature.radius() * across.stableNormalized();
  const double cosine = side.radial.dot(radial) / (side.radial.norm() * radial.norm());
  if (!(cosine >= kNearLine)) {
    return std::nullopt;
  }
  const RoundCircle& circle = *side.feature.circle;
  const double depth = circle.outer * std::max(0.0, 1.0 - cosine);
  return OnRound{.radial = radial,
                 .depth = circle.sag() + depth,
                 .along = std::sqrt(2.0 * circle.outer * depth),
                 .side = 2.0 * std::sqrt(2.0 * circle.outer * circle.sag())};
}

}  // namespace

std::array<RoundFeature, 2> make_round(const std::array<PlacedRound, 2>& bodies, double most_sag,
                                       Contact& contact) {
  Vector3d n = *contact.n_AB_W;
  std::array<Feature, 2> features{contact.feature_A, contact.feature_B};
  std::array<Side, 2> sides{side_of(bodies[0], contact.feature_A, contact.p_WA, n, most_sag),
                            side_of(bodies[1], contact.feature_B, contact.p_WB, -n, most_sag)};
  std::array<bool, 2> is_round{};
  for (std::size_t s = 0; s < 2; ++s) {
    is_round[s] = sides[s].is_round() && may_be_round(sides[s], sides[1 - s], n);
  }
  for (std::size_t s = 0; s < 2; ++s) {
    if (!is_round[s] && sides[s].is_round()) {
      sides[s].make_plain(edge_direction(bodies[s], features[s]));
    }
  }
  if (!is_round[0] && !is_round[1]) {
    return {};
  }
  const bool do_cross = cross(sides, n);
  if (do_cross && !move_to_nearest(bodies, features, sides)) {
    return {};
  }
  for (std::size_t s = 0; s < 2; ++s) {
    if (is_round[s] && !sides[1 - s].is_face && std::abs(n.dot(sides[s].axis)) <= kAlongSide) {
      n = s == 0 ? outwards_of(sides[0], sides[1], n)
                 : Vector3d(-outwards_of(sides[1], sides[0], -n));
    }
  }
  std::array<Vector3d, 2> points;
  double nearer = 0.0;  // [m]  Most by which the circles are nearer than the polygons.
  double beside = 0.0;  // [m]  Greatest distance of the points of two circles.
  for (std::size_t s = 0; s < 2; ++s) {
    const Vector3d outwards = s == 0 ? n : Vector3d(-n);
    points[s] = sides[s].core + sides[s].thickness * outwards;
    const std::optional<OnRound> nearest =
        is_round[s] ? nearest_from_axis(sides[s], outwards) : std::nullopt;
    is_round[s] = nearest.has_value();
    if (nearest) {
      points[s] = sides[s].on_axis + nearest->radial;
      const double around = sides[1 - s].thickness + std::max(0.0, contact.distance);
      nearer += nearest->depth;
      nearer += sides[1 - s].thickness > 0.0 ? 0.5 * nearest->along * nearest->along / around : 0.0;
      beside += nearest->side;
    }
  }
  const double distance = n.dot(points[1] - points[0]);
  const double rounding = kRoundingOfCircles * (points[0].norm() + points[1].norm() + nearer);
  const bool meet = !is_round[0] || !is_round[1] ||
                    (points[1] - points[0] - distance * n).norm() <= beside + rounding;
  // Where lines cross, both points are on their surfaces, wherever the polygons are nearest.
  const bool is_possible = meet && distance <= contact.distance + rounding &&
                           (do_cross || distance >= contact.distance - nearer - rounding);
  if ((!is_round[0] && !is_round[1]) || !is_possible) {
    return {};
  }
  contact.feature_A = features[0];
  contact.feature_B = features[1];
  contact.n_AB_W = n;
  contact.distance = distance;
  contact.p_WA = is_round[0] ? points[0] : Vector3d(points[1] - distance * n);
  contact.p_WB = is_round[1] ? points[1] : Vector3d(points[0] + distance * n);
  return {is_round[0] ? sides[0].feature : RoundFeature{},
          is_round[1] ? sides[1].feature : RoundFeature{}};
}

}  // namespace firstcontact::detail
