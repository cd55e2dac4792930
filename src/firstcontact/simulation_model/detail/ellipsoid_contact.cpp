#include <firstcontact/simulation_model/detail/ellipsoid_contact.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/simulation_model/detail/common_normal.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// [-]  Most by which a distance may change as it is computed from the features, by itself.
constexpr double kSameDistance = 1e-3;
/// [-]  Most sine between a contact's normal and that of the face on which it is.
constexpr double kOnFace = 1e-5;
/// [-]  Most difference of the radii of both ends of a cylinder, by themselves.
constexpr double kSameRadius = 1e-9;
/// [-]  Points nearer to an end of an edge than this are at that corner, by its length.
constexpr double kAtCorner = 1e-7;

/// A corner of an edge.
struct End {
  std::uint32_t vertex = 0;
  Vector3d place = Vector3d::Zero();  // [m]  In the world.
};

/// One body of a contact, in the world.
struct Side {
  NormalSide core = {};
  RoundFeature round = {};
  double thickness = 0.0;              // [m]  Thickness around the core.
  std::optional<Vector3d> along = {};  // [-]  The normal, where the feature determines it.
  std::array<End, 2> ends = {};        // Of an edge.

  /// [m]  The point of the surface that is farthest along n; for an edge, beside another point.
  [[nodiscard]] Vector3d farthest(const Vector3d& n, const Vector3d& beside) const {
    const Vector3d on_line =
        core.line ? Vector3d((beside - core.point).dot(*core.line) * *core.line) : Vector3d::Zero();
    return core.point + on_line + core.farthest(n) + thickness * n;
  }
};

/// The normal of a face in world axes, on the side of a direction; zero for a triangle without
/// area.
Vector3d face_normal(const PlacedRound& body, std::uint32_t triangle, const Vector3d& outwards) {
  const auto& v = body.shape->mesh().vertices;
  const auto& [a, b, c] = body.shape->mesh().triangles[triangle];
  const Vector3d n =
      body.pose.rotation.normalized() * (v[b] - v[a]).cross(v[c] - v[a]).stableNormalized();
  return n.dot(outwards) < 0.0 ? Vector3d(-n) : n;
}

/// The edge or the corner of a triangle that is nearest to a point.
///
/// @param p_B  [m]  body axes
Feature rim_feature(const Shape& shape, std::uint32_t triangle, const Vector3d& p_B) {
  const auto& corners = shape.mesh().triangles[triangle];
  const auto& v = shape.mesh().vertices;
  double least = std::numeric_limits<double>::infinity();
  Feature nearest;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t from = corners[k];
    const std::uint32_t to = corners[(k + 1) % 3];
    const Vector3d edge = v[to] - v[from];
    const double part = edge.dot(p_B - v[from]) / edge.squaredNorm();
    const double share = std::clamp(part, 0.0, 1.0);
    const double distance = (p_B - v[from] - share * edge).norm();
    if (!(distance < least)) {
      continue;
    }
    least = distance;
    if (share < kAtCorner || share > 1.0 - kAtCorner) {
      nearest = {FeatureType::vertex, share < 0.5 ? from : to, triangle};
    } else {
      nearest = {FeatureType::edge, shape.edge_index(from, to), triangle};
    }
  }
  return nearest;
}

/// The circle of the cylinder on whose side a point is; null elsewhere.
///
/// @param outwards  [-]  unit, out of the body
const RoundCircle* cylinder_at(const PlacedRound& body, const Vector3d& outwards) {
  if (body.circles == nullptr || body.circles->circles().size() != 2) {
    return nullptr;  // A cone has one circle, an ellipsoid none.
  }
  const std::vector<RoundCircle>& ends = body.circles->circles();
  const Vector3d axis = body.pose.rotation.normalized() * ends[0].axis_B;
  const bool is_cylinder = std::abs(ends[0].outer - ends[1].outer) <= kSameRadius * ends[0].outer;
  return is_cylinder && std::abs(axis.dot(outwards)) <= kOnFace ? ends.data() : nullptr;
}

/// The side of a body that is no ellipsoid.
///
/// @param point     [m]
/// @param outwards  [-]  unit, out of the body
Side side_of(const PlacedRound& body, const Vector3d& point, const Vector3d& outwards,
             Feature& feature) {
  Side side{.thickness = body.shape->radius()};
  side.core.point = point - side.thickness * outwards;
  if (body.is_curved) {
    side.along = outwards;
    side.round.circle = cylinder_at(body, outwards);
    return side;
  }
  if (feature.type == FeatureType::face) {
    const Vector3d n = face_normal(body, feature.index, outwards);
    if (n.cross(outwards).norm() <= kOnFace) {
      side.along = n;
      return side;
    }
    const Eigen::Quaterniond R = body.pose.rotation.normalized();
    feature = rim_feature(*body.shape, feature.index,
                          R.conjugate() * (side.core.point - body.pose.position));
  }
  const auto in_world = [&](std::uint32_t vertex) -> Vector3d {
    return body.pose.position +
           body.pose.rotation.normalized() * body.shape->mesh().vertices[vertex];
  };
  if (feature.type == FeatureType::edge) {
    const auto [a, b] = body.shape->edge(feature.index);
    side.ends = {End{a, in_world(a)}, End{b, in_world(b)}};
    side.core.point = side.ends[0].place;
    side.core.line = (side.ends[1].place - side.ends[0].place).stableNormalized();
  } else {
    side.core.point = in_world(feature.index);
  }
  return side;
}

Side side_of(const PlacedRound& body) {
  const Eigen::Matrix3d R = body.pose.rotation.normalized().toRotationMatrix();
  return {.core = {.point = body.pose.position + R * body.ellipsoid->centre_B,
                   .squares = body.ellipsoid->squares(R)},
          .round = {.ellipsoid = body.ellipsoid}};
}

/// The closest points of two sides along a normal.
struct Closest {
  Vector3d n = Vector3d::UnitZ();       // [-]  From A to B.
  std::array<Vector3d, 2> points = {};  // [m]

  [[nodiscard]] double distance() const { return n.dot(points[1] - points[0]); }
};

Closest closest_of(const std::array<Side, 2>& sides, const Vector3d& before) {
  Closest found;
  if (sides[0].along) {
    found.n = *sides[0].along;
  } else if (sides[1].along) {
    found.n = -*sides[1].along;
  } else {
    found.n = common_normal({sides[0].core, sides[1].core}, before);
  }
  // An ellipsoid, or else a corner, comes first: it has a farthest point without the other.
  const std::size_t first = sides[0].core.line || sides[0].along ? 1 : 0;
  const Vector3d outwards = first == 0 ? found.n : Vector3d(-found.n);
  found.points[first] = sides[first].farthest(outwards, Vector3d::Zero());
  found.points[1 - first] = sides[1 - first].farthest(-outwards, found.points[first]);
  return found;
}

/// Replaces an edge by its end where the closest point of the line is beyond. Returns whether it
/// did.
bool end_edge(const Vector3d& closest, Side& side, Feature& feature) {
  if (!side.core.line) {
    return false;
  }
  for (std::size_t k = 0; k < 2; ++k) {
    const Vector3d outwards = (k == 0 ? -1.0 : 1.0) * *side.core.line;
    if (outwards.dot(closest - side.ends[k].place) > 0.0) {
      side.core.point = side.ends[k].place;
      side.core.line.reset();
      feature = {FeatureType::vertex, side.ends[k].vertex, feature.triangle};
      return true;
    }
  }
  return false;
}

}  // namespace

std::array<RoundFeature, 2> make_ellipsoidal(const std::array<PlacedRound, 2>& bodies,
                                             Contact& contact) {
  const Vector3d before = *contact.n_AB_W;
  const auto side_at = [&](std::size_t s, const Vector3d& point, Feature& feature) {
    return bodies[s].ellipsoid != nullptr
               ? side_of(bodies[s])
               : side_of(bodies[s], point, s == 0 ? before : Vector3d(-before), feature);
  };
  std::array<Side, 2> sides{side_at(0, contact.p_WA, contact.feature_A),
                            side_at(1, contact.p_WB, contact.feature_B)};
  Closest found = closest_of(sides, before);
  if (end_edge(found.points[0], sides[0], contact.feature_A) ||
      end_edge(found.points[1], sides[1], contact.feature_B)) {
    found = closest_of(sides, before);
  }
  const double distance = found.distance();
  if (std::abs(distance - contact.distance) <= kSameDistance * std::abs(contact.distance)) {
    contact.n_AB_W = found.n;
    contact.distance = distance;
    // A plane goes through the point of the face, so its closest point lies along the normal.
    contact.p_WA =
        sides[0].along ? Vector3d(found.points[1] - distance * found.n) : found.points[0];
    contact.p_WB =
        sides[1].along ? Vector3d(found.points[0] + distance * found.n) : found.points[1];
  }
  return {sides[0].round, sides[1].round};
}

}  // namespace firstcontact::detail
