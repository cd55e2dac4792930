#include <firstcontact/simulation/detail/moving_contact.h>

#include <optional>

#include <Eigen/Geometry>

#include <firstcontact/motion/detail/turn.h>
#include <firstcontact/simulation/detail/constants.h>
#include <firstcontact/simulation/detail/sim_body.h>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// The surface of one body around a contact.
struct SurfaceThere {
  Vector3d centre;                     // [m]  p_CP_W: of the point that goes with the body.
  double radius = 0.0;                 // [m]  Of the surface about it, and half of the gap beyond.
  std::optional<Vector3d> along = {};  // Of an edge.
  bool is_face = false;
};

SurfaceThere surface_at(const ContactSide& side, const Feature& feature, const Vector3d& arm,
                        const Vector3d& outwards, double distance) {
  const Shape& shape = side.body->shape;
  SurfaceThere found{.centre = arm,
                     .radius = shape.radius() + 0.5 * distance,
                     .is_face = feature.type == FeatureType::face};
  found.centre -= found.radius * outwards;
  if (feature.type == FeatureType::edge) {
    const auto [a, b] = shape.edge(feature.index);
    const Vector3d along = shape.mesh().vertices[b] - shape.mesh().vertices[a];
    found.along = side.R_WB * along.stableNormalized();
  }
  return found;
}

/// Without its part along a line.
Vector3d across(Vector3d v, const std::optional<Vector3d>& along) {
  return along ? Vector3d(v - v.dot(*along) * *along) : v;
}

/// The normal after both surfaces moved.
///
/// @param by        of each body
/// @param apart     [m]  from the centre on A to that on B, there
/// @param is_round  whether either has a radius
Vector3d moved_normal(const Vector3d& n, const std::array<SurfaceThere, 2>& now,
                      const std::array<Quaterniond, 2>& by, const Vector3d& apart, bool is_round) {
  for (std::size_t s = 0; s < 2; ++s) {
    if (now[s].is_face) {
      return by[s] * n;
    }
  }
  std::array<std::optional<Vector3d>, 2> along;
  for (std::size_t s = 0; s < 2; ++s) {
    if (now[s].along) {
      along[s] = by[s] * *now[s].along;
    }
  }
  if (along[0] && along[1]) {
    const Vector3d before = now[0].along->cross(*now[1].along);
    if (before.norm() > kCrossingEdges) {
      const Vector3d after = along[0]->cross(*along[1]);
      return (before.dot(n) < 0.0 ? -after : after).stableNormalized();
    }
  }
  if (!is_round) {
    return n;
  }
  const Vector3d between = across(across(apart, along[0]), along[1]);
  return between.dot(n) > 0.0 ? between.stableNormalized() : n;
}

}  // namespace

Vector3d MovedContact::velocity(const std::array<ContactSide, 2>& sides) const {
  return frame * (sides[1].v + sides[1].w.cross(arms[1]) - sides[0].v - sides[0].w.cross(arms[0]));
}

MovedContact moved_contact(const ManifoldPoint& touch, const ContactPoint& contact, double distance,
                           const std::array<ContactSide, 2>& sides, double time) {
  const Vector3d n = contact.frame.row(0).transpose();
  const std::array<SurfaceThere, 2> now{
      surface_at(sides[0], touch.feature_A, contact.arm_A, n, distance),
      surface_at(sides[1], touch.feature_B, contact.arm_B, -n, distance)};
  std::array<Quaterniond, 2> by;
  std::array<Vector3d, 2> centres;  // From the centres of mass, there.
  for (std::size_t s = 0; s < 2; ++s) {
    by[s] = turn(time * sides[s].w);
    centres[s] = by[s] * now[s].centre;
  }
  const Vector3d apart = sides[1].p_WC + time * sides[1].v + centres[1] -
                         (sides[0].p_WC + time * sides[0].v + centres[0]);
  const bool is_round = sides[0].body->shape.radius() > 0.0 || sides[1].body->shape.radius() > 0.0;
  const Vector3d n_there = moved_normal(n, now, by, apart, is_round);
  const Matrix3d turned = Quaterniond::FromTwoVectors(n, n_there).toRotationMatrix();
  return {{centres[0] + now[0].radius * n_there, centres[1] - now[1].radius * n_there},
          contact.frame * turned.transpose()};
}

}  // namespace firstcontact::detail
