#include <firstcontact/simulation_model/detail/ellipsoid_contact.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <Eigen/Geometry>

#include <firstcontact/simulation_model/detail/common_normal.h>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// [-]  Rounding of places and radii: corners are on their ellipsoid within it.
constexpr double kRoundingOfEllipsoids = 1e-12;

/// An edge, relative to its middle.
struct Edge {
  std::array<std::uint32_t, 2> ends = {};  // Vertices.
  Vector3d middle = Vector3d::Zero();      // [m]
  Vector3d direction = Vector3d::Zero();   // [-]
  double half = 0.0;                       // [m]
};

/// One body of a contact, in the world.
struct Side {
  NormalSide core = {};
  RoundFeature round = {};
  double thickness = 0.0;         // [m]  Thickness around the core.
  std::optional<Edge> edge = {};  // Edge that is the core, for a body that is no ellipsoid.
  bool is_face = false;           // Whether it is a flat face.

  /// [m]  The point of the surface that is farthest along n; for an edge, beside another point.
  [[nodiscard]] Vector3d farthest(const Vector3d& n, const Vector3d& beside) const {
    const Vector3d along =
        core.line ? Vector3d((beside - core.point).dot(*core.line) * *core.line) : Vector3d::Zero();
    return core.point + along + core.farthest(n) + thickness * n;
  }
};

/// The side of a contact at a feature.
///
/// @param outwards  [-]  unit, out of the body
Side side_of(const PlacedRound& body, const Feature& feature, const Vector3d& point,
             const Vector3d& outwards, double most_sag) {
  const Matrix3d R = body.pose.rotation.normalized().toRotationMatrix();
  if (body.ellipsoid != nullptr && body.ellipsoid->sag <= most_sag) {
    return {.core = {.point = body.pose.position + R * body.ellipsoid->centre_B,
                     .squares = body.ellipsoid->squares(R)},
            .round = {.ellipsoid = body.ellipsoid}};
  }
  Side side{.thickness = body.shape->radius(), .is_face = feature.type == FeatureType::face};
  side.core.point = point - side.thickness * outwards;
  if (feature.type == FeatureType::edge) {
    const auto [a, b] = body.shape->edge(feature.index);
    const auto& v = body.shape->mesh().vertices;
    const Vector3d along = R * (v[b] - v[a]);
    side.edge = Edge{.ends = {a, b},
                     .middle = body.pose.position + R * (0.5 * (v[a] + v[b])),
                     .direction = along.stableNormalized(),
                     .half = 0.5 * along.norm()};
    side.core.line = side.edge->direction;
  }
  return side;
}

/// The direction that separates two sides, and their closest points.
struct Separated {
  Vector3d n;                      // [-]  From A to B.
  std::array<Vector3d, 2> points;  // [m]
};

Separated separate(const std::array<Side, 2>& sides, const Vector3d& before) {
  const Vector3d n = sides[0].is_face || sides[1].is_face
                         ? before
                         : common_normal({sides[0].core, sides[1].core}, before);
  Separated found{.n = n, .points = {}};
  const std::size_t first = sides[0].core.line ? 1 : 0;
  const Vector3d sign_n = first == 0 ? n : Vector3d(-n);
  found.points[first] = sides[first].farthest(sign_n, Vector3d::Zero());
  found.points[1 - first] = sides[1 - first].farthest(-sign_n, found.points[first]);
  return found;
}

/// Replaces a side by the end of its edge where the closest point of the line is beyond.
///
/// The feature becomes that corner. It returns whether it did.
bool end_edge(Side& side, const Vector3d& closest, Feature& feature) {
  if (!side.edge) {
    return false;
  }
  const double along = (closest - side.edge->middle).dot(side.edge->direction);
  if (std::abs(along) <= side.edge->half) {
    return false;
  }
  side.core.point =
      side.edge->middle + std::copysign(side.edge->half, along) * side.edge->direction;
  side.core.line.reset();
  feature.type = FeatureType::vertex;
  feature.index = side.edge->ends[along > 0.0 ? 1 : 0];
  return true;
}

}  // namespace

std::array<RoundFeature, 2> make_ellipsoidal(const std::array<PlacedRound, 2>& bodies,
                                             double most_sag, Contact& contact) {
  const Vector3d before = *contact.n_AB_W;
  std::array<Side, 2> sides{side_of(bodies[0], contact.feature_A, contact.p_WA, before, most_sag),
                            side_of(bodies[1], contact.feature_B, contact.p_WB, -before, most_sag)};
  if (!sides[0].round.is_curved() && !sides[1].round.is_curved()) {
    return {};
  }
  Separated found = separate(sides, before);
  std::array<Feature, 2> features{contact.feature_A, contact.feature_B};
  if (end_edge(sides[0], found.points[0], features[0]) ||
      end_edge(sides[1], found.points[1], features[1])) {
    found = separate(sides, before);
  }
  double sag = 0.0;
  for (const Side& side : sides) {
    sag += side.round.is_curved() ? side.round.ellipsoid->sag : 0.0;
  }
  const double distance = found.n.dot(found.points[1] - found.points[0]);
  const double rounding =
      kRoundingOfEllipsoids * (found.points[0].norm() + found.points[1].norm() + sag);
  if (!(distance >= contact.distance - sag - rounding && distance <= contact.distance + rounding)) {
    return {};
  }
  // A plane passes through the closest point of the face, so the point on it lies along the normal.
  for (std::size_t s = 0; s < 2; ++s) {
    if (sides[s].is_face) {
      found.points[s] = found.points[1 - s] + (s == 1 ? distance : -distance) * found.n;
    }
  }
  contact.feature_A = features[0];
  contact.feature_B = features[1];
  contact.n_AB_W = found.n;
  contact.distance = distance;
  contact.p_WA = found.points[0];
  contact.p_WB = found.points[1];
  return {sides[0].round, sides[1].round};
}

}  // namespace firstcontact::detail
