#include <firstcontact/simulation_model/detail/moving_contact.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Geometry>

#include <firstcontact/motion/detail/turn.h>
#include <firstcontact/simulation_model/detail/common_normal.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/sim_body.h>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// The surface of one body around a contact.
struct SurfaceThere {
  Vector3d centre;                     // [m]  p_CP_W of the point that goes with the body.
  double radius = 0.0;                 // [m]  Radius of the surface about it, with half of the gap.
  std::optional<Vector3d> along = {};  // Direction of an edge.
  double ring = 0.0;                   // [m]  Radius about that line; negative for a hole.
  std::optional<Matrix3d> squares = {};  // [m^2]  For an ellipsoid: NormalSide.
  bool is_face = false;
};

/// The part of a vector across a line.
Vector3d across(Vector3d v, const std::optional<Vector3d>& along) {
  return along ? Vector3d(v - v.dot(*along) * *along) : v;
}

std::optional<Matrix3d> turned(const std::optional<Matrix3d>& squares, const Quaterniond& by) {
  if (!squares) {
    return std::nullopt;
  }
  const Matrix3d R = by.toRotationMatrix();
  return R * *squares * R.transpose();
}

SurfaceThere surface_at(const ContactSide& side, const Feature& feature, const Vector3d& arm,
                        const Vector3d& outwards, double distance) {
  const Shape& shape = side.body->shape;
  if (side.round.ellipsoid != nullptr) {
    const RoundEllipsoid& ellipsoid = *side.round.ellipsoid;
    return {.centre = side.R_WB * (ellipsoid.centre_B - side.body->inertia.p_BC),
            .radius = 0.5 * distance,
            .squares = ellipsoid.squares(side.R_WB)};
  }
  if (side.round.circle != nullptr) {
    const Vector3d axis = side.R_WB * side.round.circle->axis_B;
    SurfaceThere found{
        .centre = arm, .radius = 0.5 * distance, .along = axis, .ring = side.round.radius()};
    found.centre -= found.radius * outwards + found.ring * across(outwards, axis).normalized();
    return found;
  }
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

/// The normal after both surfaces moved.
///
/// @param faces     whether the normal goes with A, with B
/// @param by        rotation of each body
/// @param apart     [m]  from the centre on A to that on B, after the motion
/// @param radius    [m]  of both surfaces, negative where the larger one is a hole; 0: neither has
///                  one
Vector3d moved_normal(const Vector3d& n, const std::array<bool, 2>& faces,
                      const std::array<SurfaceThere, 2>& now, const std::array<Quaterniond, 2>& by,
                      const Vector3d& apart, double radius) {
  for (std::size_t s = 0; s < 2; ++s) {
    if (now[s].is_face || faces[s]) {
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
  if (now[0].squares || now[1].squares) {
    return common_normal({NormalSide{Vector3d::Zero(), turned(now[0].squares, by[0]), along[0]},
                          NormalSide{apart, turned(now[1].squares, by[1]), along[1]}},
                         n);
  }
  if (radius == 0.0) {
    return n;
  }
  // From the centre of a hole, a body inside is in the direction out of the hole.
  Vector3d between = across(across(apart, along[0]), along[1]);
  between = radius < 0.0 ? Vector3d(-between) : between;
  return between.dot(n) > 0.0 ? between.stableNormalized() : n;
}

/// [m]  The radius of the surface at a contact, or the greatest of an ellipsoid; 0: it is flat.
double radius_of(const ContactSide& side) {
  if (side.round.ellipsoid != nullptr) {
    return side.round.ellipsoid->radii.maxCoeff();
  }
  return side.round.circle != nullptr ? side.round.radius() : side.body->shape.radius();
}

/// [-]  The difference of the surface's bend from that of a ball of the same height, by that
/// height.
double unlike_a_ball(const RoundEllipsoid& ellipsoid, const Vector3d& n_B) {
  const double height = ellipsoid.farthest(n_B).dot(n_B);
  const Matrix3d ball = height * (Matrix3d::Identity() - n_B * n_B.transpose());
  return (ellipsoid.bend(n_B) - ball).norm() / height;
}

bool is_round(const ContactSide& side) { return radius_of(side) != 0.0; }

/// The line of an edge or of a cylinder's axis, where a contact can go along it. On a rim, to which
/// the normal leans, it can not.
std::optional<Vector3d> line_at(const SurfaceThere& surface, const Vector3d& n) {
  const bool is_on_rim =
      surface.along && surface.ring != 0.0 && std::abs(surface.along->dot(n)) > kAcrossCylinder;
  return is_on_rim ? std::nullopt : surface.along;
}

/// [m]  Computes how far a contact goes along the surfaces of A and of B, so that its two points
/// meet again.
///
/// Along a face, an edge or a cylinder it goes with the other body's point. Where two lines cross
/// it goes along both.
///
/// @param n       [-]  the normal
/// @param apart   [m]  by how much B's point leaves A's across the normal, without these ways
std::array<Vector3d, 2> ways_to_meet(const ManifoldPoint& touch,
                                     const std::array<ContactSide, 2>& sides,
                                     const std::array<SurfaceThere, 2>& now, const Vector3d& n,
                                     const Vector3d& apart) {
  std::array<Vector3d, 2> ways{Vector3d::Zero(), Vector3d::Zero()};
  if (goes_over(touch, sides, 0)) {
    ways[0] = apart;
    return ways;
  }
  if (goes_over(touch, sides, 1)) {
    ways[1] = -apart;
    return ways;
  }
  const std::array<std::optional<Vector3d>, 2> lines{line_at(now[0], n), line_at(now[1], n)};
  if (lines[0] && lines[1]) {
    const double cosine = lines[0]->dot(*lines[1]);
    const double square = 1.0 - cosine * cosine;  // Of the sine.
    if (square > kCrossingEdges * kCrossingEdges) {
      const double along_A = lines[0]->dot(apart);
      const double along_B = lines[1]->dot(apart);
      ways[0] = (along_A - cosine * along_B) / square * *lines[0];
      ways[1] = (cosine * along_A - along_B) / square * *lines[1];
    }
  } else if (lines[0] && !now[1].is_face) {
    ways[0] = lines[0]->dot(apart) * *lines[0];
  } else if (lines[1] && !now[0].is_face) {
    ways[1] = -lines[1]->dot(apart) * *lines[1];
  }
  return ways;
}

}  // namespace

Vector3d MovedContact::velocity(const std::array<ContactSide, 2>& sides) const {
  return frame * (sides[1].v + sides[1].w.cross(arms[1]) - sides[0].v - sides[0].w.cross(arms[0]));
}

double rate_on_rim(const Vector3d& n, const std::array<ContactSide, 2>& sides) {
  double fastest = 0.0;
  for (std::size_t s = 0; s < 2; ++s) {
    if (sides[s].round.circle != nullptr) {
      const Vector3d axis = sides[s].R_WB * sides[s].round.circle->axis_B;
      const double turning = sides[s].w.cross(axis).norm() + sides[1 - s].w.cross(n).norm();
      fastest = turning > 0.0 ? std::max(fastest, turning / axis.cross(n).norm()) : fastest;
    }
  }
  return fastest;
}

double span_on_ellipsoid(const Vector3d& n, const std::array<ContactSide, 2>& sides, double time,
                         double least) {
  double longest = std::numeric_limits<double>::infinity();
  for (std::size_t s = 0; s < 2; ++s) {
    if (sides[s].round.ellipsoid == nullptr) {
      continue;
    }
    const Vector3d turning = (sides[1 - s].w - sides[s].w).cross(n);  // Turn of n, as seen from the
                                                                      // body.
    for (const double share : {0.0, 0.5, 1.0}) {
      const Vector3d there = (n + share * time * turning).normalized();
      const Vector3d n_B = sides[s].R_WB.transpose() * there;
      const double rate = unlike_a_ball(*sides[s].round.ellipsoid, n_B) * turning.norm();
      const double height = sides[s].round.ellipsoid->farthest(n_B).dot(n_B);
      // The way of the centre bends by an eighth of the acceleration of its height.
      const double bending = height * rate * turning.norm();
      if (rate > 0.0) {
        longest = std::min(
            {longest, kArmOfPlan / rate, std::sqrt(8.0 * kSagittaOfPlan * least / bending)});
      }
    }
  }
  return longest;
}

bool follows_curve(const ContactPoint& contact, const std::array<ContactSide, 2>& sides,
                   double time) {
  return time * rate_on_rim(contact.frame.row(0).transpose(), sides) <= kTurnOfCurve &&
         (is_round(sides[0]) || is_round(sides[1]));
}

bool turns_on_corner(const ManifoldPoint& touch, const std::array<ContactSide, 2>& sides,
                     double time) {
  const auto turns = [&](std::size_t side) {
    return touch.corner[side] && time * sides[side].w.norm() > kTurnOnCorner;
  };
  return turns(0) || turns(1);
}

double most_change(const ContactPoint& contact, const std::array<ContactSide, 2>& sides,
                   double time) {
  const std::array<double, 2> arms{contact.arm_A.norm(), contact.arm_B.norm()};
  double speed = 0.0;  // [m/s]  Speed of both at the contact.
  double turning = 0.0;
  for (std::size_t s = 0; s < 2; ++s) {
    const double w = sides[s].w.norm();
    speed += sides[s].v.norm() + w * arms[s];
    turning += w;
    // Lines between centres turn about the smaller arm.
    if (is_round(sides[s]) && arms[s] > 0.0) {
      turning += (sides[0].v - sides[1].v).norm() / arms[s];
    }
  }
  return 2.0 * time * turning * speed;
}

bool goes_over(const ManifoldPoint& touch, const std::array<ContactSide, 2>& sides,
               std::size_t side) {
  const auto is_flat = [&](std::size_t s) {
    const Feature& feature = s == 0 ? touch.feature_A : touch.feature_B;
    return touch.faces[s] || (feature.type == FeatureType::face && !sides[s].round.is_curved());
  };
  return is_flat(side) && !is_flat(1 - side);
}

MovedContact moved_contact(const ManifoldPoint& touch, const ContactPoint& contact, double distance,
                           const std::array<ContactSide, 2>& sides, double time) {
  const Vector3d n = contact.frame.row(0).transpose();
  const std::array<SurfaceThere, 2> now{
      surface_at(sides[0], touch.feature_A, contact.arm_A, n, distance),
      surface_at(sides[1], touch.feature_B, contact.arm_B, -n, distance)};
  std::array<Quaterniond, 2> by;
  std::array<Vector3d, 2> centres;  // Relative to the centres of mass, there.
  for (std::size_t s = 0; s < 2; ++s) {
    by[s] = turn(time * sides[s].w);
    centres[s] = by[s] * now[s].centre;
  }
  const auto centre_there = [&](std::size_t s) -> Vector3d {
    return sides[s].p_WC + time * sides[s].v + centres[s];
  };
  const Vector3d apart = centre_there(1) - centre_there(0);
  const double radius = radius_of(sides[0]) + radius_of(sides[1]);
  const Vector3d n_there = moved_normal(n, touch.faces, now, by, apart, radius);
  const Matrix3d turn_of_frame = Quaterniond::FromTwoVectors(n, n_there).toRotationMatrix();
  std::array<Vector3d, 2> arms;
  for (std::size_t s = 0; s < 2; ++s) {
    const Vector3d outwards = s == 0 ? n_there : Vector3d(-n_there);
    arms[s] = centres[s] + now[s].radius * outwards;
    arms[s] += NormalSide{.squares = turned(now[s].squares, by[s])}.farthest(outwards);
    if (now[s].ring != 0.0) {
      arms[s] += now[s].ring * across(outwards, by[s] * *now[s].along).normalized();
    }
  }
  const Vector3d between = apart + arms[1] - centres[1] - (arms[0] - centres[0]);
  const auto left_by = [&](std::size_t s) -> Vector3d {
    const Vector3d& arm = s == 0 ? contact.arm_A : contact.arm_B;
    return time * (sides[s].v + sides[s].w.cross(now[s].centre)) + arms[s] - centres[s] -
           (arm - now[s].centre);
  };
  // By velocities, not by places: points that stick to each other stay the same points.
  const std::array<Vector3d, 2> ways =
      ways_to_meet(touch, sides, now, n, across(left_by(1) - left_by(0), n));
  for (std::size_t s = 0; s < 2; ++s) {
    arms[s] += by[s] * ways[s];
  }
  return {arms, contact.frame * turn_of_frame.transpose(), n_there.dot(between)};
}

}  // namespace firstcontact::detail
