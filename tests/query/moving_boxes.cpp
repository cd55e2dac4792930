#include "query/moving_boxes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;

/// The least code of an extent at or above the value.
std::uint16_t extent_code(double value) {
  HierarchyNode node{};
  std::uint32_t low = 0;
  std::uint32_t high = std::numeric_limits<std::uint16_t>::max();
  while (low < high) {
    const std::uint32_t middle = (low + high) / 2;
    node.extent[0][0] = static_cast<std::uint16_t>(middle);
    if (static_cast<double>(node.half_extent(0, 0)) >= value) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return static_cast<std::uint16_t>(low);
}

/// Boxes of like size near each other, the longest side last: thick, flat, needles and points.
HierarchyNode random_node(Random& random) {
  HierarchyNode node{};
  node.node_base_and_used = 1u << 4 | 15u;
  const double size = random.logarithmic(1e-4, 0.5);
  const Vector3d middle = random.uniform(0.0, 0.9) * random.direction();
  for (int slot = 0; slot < HierarchyNode::kWidth; ++slot) {
    const Vector3d centre = middle + random.uniform(0.0, size) * random.direction();
    const Vector3d v = random.uniform(0.0, 0.76) * random.direction();
    std::array<double, 3> extent;
    for (double& e : extent) {
      e = random.chance(0.1) ? 0.0 : size * random.logarithmic(1e-5, 1.0);
    }
    std::sort(extent.begin(), extent.end());
    for (int k = 0; k < 3; ++k) {
      node.centre[k][slot] = static_cast<float>(centre[k]);
      node.rotation[k][slot] = static_cast<float>(v[k]);
      node.extent[k][slot] = extent_code(extent[k]);
    }
  }
  return node;
}

/// Moves and stretches the boxes until t = 1.
void deform(Random& random, Body& body) {
  Hierarchy& hierarchy = body.hierarchy;
  hierarchy.nodes_to = hierarchy.nodes;
  hierarchy.vertices_to = {Vector3d::Zero()};  // Its boxes are all that counts here.
  HierarchyNode& to = hierarchy.nodes_to[0];
  double speed = 0.0;
  for (int slot = 0; slot < HierarchyNode::kWidth; ++slot) {
    const double size = 2.0 * static_cast<double>(to.half_extent(2, slot)) + 1e-6;
    const Vector3d drift = size * random.logarithmic(1e-3, 1.0) * random.direction();
    Vector3d moved;
    Vector3d grown;
    for (int k = 0; k < 3; ++k) {
      const double before = static_cast<double>(to.half_extent(k, slot));
      to.centre[k][slot] += static_cast<float>(drift[k]);
      to.extent[k][slot] = extent_code(before * random.uniform(0.0, 2.0));
      moved[k] = static_cast<double>(to.centre[k][slot]) -
                 static_cast<double>(body.node().centre[k][slot]);
      grown[k] = static_cast<double>(to.half_extent(k, slot)) - before;
    }
    speed = std::max(speed, moved.norm() + grown.norm());
  }
  hierarchy.deformation_speed = speed * hierarchy.unit * (1.0 + 1e-12);
}

Vector3d random_turn(Random& random) {
  return random.chance(0.2) ? Vector3d(Vector3d::Zero())
                            : Vector3d(random.logarithmic(1e-3, 20.0) * random.direction());
}

Body random_body(Random& random) {
  Body body;
  body.hierarchy.unit = std::exp2(std::round(random.uniform(-20.0, 20.0)));
  body.hierarchy.radius = body.hierarchy.unit;
  body.hierarchy.centre = random.chance(0.5)
                              ? random.uniform(0.0, 6.0) * body.hierarchy.unit * random.direction()
                              : Vector3d(Vector3d::Zero());
  body.hierarchy.nodes = {random_node(random)};
  body.rotation = Eigen::AngleAxisd(random.uniform(0.0, std::numbers::pi), random.direction());
  return body;
}

RealMatrix turn(const RealVector& rotation_vector) {
  const Real angle = rotation_vector.norm();
  return angle > 0.0L ? RealMatrix(Eigen::AngleAxis<Real>(angle, rotation_vector / angle))
                      : RealMatrix(RealMatrix::Identity());
}

/// Moves the body's centre so that its first box is at `lever` [m] from the body origin at t.
void set_lever(const Vector3d& lever, double t, Body& body) {
  const double angle = body.rotation_vector.norm();
  const Eigen::AngleAxisd turned(t * angle, body.rotation_vector / angle);
  const HierarchyNode& node = body.node();
  const Vector3d box(node.centre[0][0], node.centre[1][0], node.centre[2][0]);
  body.hierarchy.centre = (turned * body.rotation).conjugate() * lever - body.hierarchy.unit * box;
}

/// The axes of the first box, one per column, in those of its body.
RealMatrix axes_in_body(const Body& body) {
  Body still = body;
  still.rotation_vector.setZero();
  still.rotation.setIdentity();
  return real_box(still, 0, 0.0L, RealVector::Zero()).axes;
}

/// Lets the first box of one body turn about its own middle, beside the wide and resting face of
/// the other's, at t perhaps parallel to it. Returns the direction of the face.
Vector3d tilt(Random& random, double t, Body& tilting, Body& resting) {
  resting.hierarchy.unit = resting.hierarchy.radius = 4.0 * tilting.hierarchy.unit;
  for (int k = 1; k < 3; ++k) {
    resting.hierarchy.nodes[0].extent[k][0] = extent_code(0.5);
  }
  const RealMatrix face = real_box(resting, 0, t, RealVector::Zero()).axes;
  const Vector3d normal = face.col(0).cast<double>();
  tilting.rotation_vector =
      random.logarithmic(0.1, 20.0) * normal.cross(random.direction()).normalized();
  if (random.chance(0.5)) {
    const RealMatrix turned = turn(t * tilting.rotation_vector.cast<Real>());
    const RealMatrix R = turned.transpose() * face * axes_in_body(tilting).transpose();
    tilting.rotation = Eigen::Quaternion<Real>(R).cast<double>().normalized();
  }
  set_lever(Vector3d::Zero(), t, tilting);
  return normal;
}

/// Sets all but the positions; returns the direction from A's first box to B's.
Vector3d set_motion(Random& random, Approach approach, MovingBoxes& c) {
  const Vector3d normal = real_box(c.A, 0, c.t, RealVector::Zero()).axes.col(0).cast<double>();
  const double length = c.size() * random.logarithmic(0.1, 100.0);
  const double path = random.uniform(0.0, 1.0) * length;
  switch (approach) {
    case Approach::any: {
      const Vector3d heading = random.direction();
      c.A.rotation_vector = random_turn(random);
      c.B.rotation_vector = random_turn(random);
      c.A.translation = path * heading;
      c.B.translation = (path - length) * heading + 0.5 * length * random.direction();
      return heading;
    }
    case Approach::spinning:
      c.B.rotation_vector = random.logarithmic(0.01, 20.0) * normal;
      [[fallthrough]];
    case Approach::straight:
      c.A.translation = path * normal;
      c.B.translation = (path - length) * normal;
      return normal;
    case Approach::swinging: {
      const Vector3d axis = normal.cross(random.direction()).normalized();
      c.B.rotation_vector = random.logarithmic(0.1, 20.0) * axis;
      set_lever(10.0 * c.B.hierarchy.unit * normal, c.t, c.B);
      return normal;
    }
    case Approach::tilting:
      return random.chance(0.5) ? tilt(random, c.t, c.A, c.B) : tilt(random, c.t, c.B, c.A);
    case Approach::circling: {
      const Vector3d aside = normal.cross(random.direction()).normalized();
      const double radius =
          random.logarithmic(10.0, 1e5) * std::max(c.A.hierarchy.unit, c.B.hierarchy.unit);
      c.A.rotation_vector = c.B.rotation_vector = random.logarithmic(1e-3, 1.0) * normal;
      set_lever(radius * aside, c.t, c.A);
      set_lever(radius * aside, c.t, c.B);
      c.B.translation = -length * normal;
      return normal;
    }
  }
  return normal;
}

}  // namespace

RealBox real_box(const Body& body, int slot, Real t, const RealVector& origin) {
  const HierarchyNode& node = body.node();
  const HierarchyNode& node_to = body.node_to();
  RealVector centre;
  RealVector v;
  RealVector extent;
  for (int k = 0; k < 3; ++k) {
    centre[k] = (1.0L - t) * node.centre[k][slot] + t * node_to.centre[k][slot];
    v[k] = node.rotation[k][slot];
    extent[k] = (1.0L - t) * node.half_extent(k, slot) + t * node_to.half_extent(k, slot);
  }
  const Eigen::Quaternion<Real> q(std::sqrt(1.0L - v.squaredNorm()), v.x(), v.y(), v.z());
  const Real unit = body.hierarchy.unit;
  const RealMatrix R = turn(t * body.rotation_vector.cast<Real>()) *
                       body.rotation.cast<Real>().normalized().toRotationMatrix();
  const RealVector p = (body.position.cast<Real>() - origin) + t * body.translation.cast<Real>();
  // The rows of the rotation matrix of q are the axes: box_axes().
  return {p + R * (body.hierarchy.centre.cast<Real>() + unit * centre),
          R * q.toRotationMatrix().transpose(), unit * extent};
}

Real distance_of_points(const RealBox& a, const RealBox& b) {
  RealVector p = a.centre;
  Real distance = std::numeric_limits<Real>::infinity();
  for (int i = 0; i < 200; ++i) {
    const RealVector q = b.nearest(p);
    p = a.nearest(q);
    const Real next = (p - q).norm();
    if (!(next < distance * (1.0L - 1e-9L))) {
      break;
    }
    distance = next;
  }
  return distance;
}

namespace {

Approach random_approach(Random& random) {
  return static_cast<Approach>(static_cast<int>(random.uniform(0.0, 5.0)));
}

/// [m]  Of the smaller one of the first boxes: one that tilts gets no nearer than by that.
double least_size(const MovingBoxes& c) {
  const auto size = [](const Body& body) {
    return static_cast<double>(real_box(body, 0, 0.0L, RealVector::Zero()).extent.norm());
  };
  return std::min(size(c.A), size(c.B));
}

MovingBoxes moving_boxes(Random& random, Approach approach, bool deforming) {
  MovingBoxes c;
  c.A = random_body(random);
  c.B = random_body(random);
  if (deforming) {
    deform(random, c.A);
    if (random.chance(0.5)) {
      deform(random, c.B);
    }
  }
  c.t = random.uniform(0.0, 0.9);
  const Vector3d heading = set_motion(random, approach, c);
  const double gap = approach == Approach::tilting ? least_size(c) * random.logarithmic(1e-5, 0.5)
                                                   : c.size() * random.logarithmic(1e-5, 10.0);
  // Near the gap, a direction that is not quite unit would pass for farther apart.
  c.threshold = random.chance(0.5) ? 0.0 : gap * (1.0 - random.logarithmic(1e-5, 1.0));
  if (random.chance(0.3)) {
    c.A.position = random.logarithmic(1.0, 1e6) * c.size() * random.direction();
  }
  // B's box is put where the gap between the first boxes is about as wanted.
  Real apart = c.size() + gap;
  for (int i = 0; i < 8; ++i) {
    const RealVector origin = c.A.position.cast<Real>();
    const RealVector offset = real_box(c.A, 0, c.t, origin).centre + apart * heading.cast<Real>() -
                              real_box(c.B, 0, c.t, origin).centre;
    c.B.position += offset.cast<double>();
    apart = std::max(0.0L, apart + gap - c.distance(0, 0, c.t));
  }
  return c;
}

}  // namespace

MovingBoxes random_moving_boxes(Random& random, Approach approach) {
  return moving_boxes(random, approach, false);
}

MovingBoxes random_moving_boxes(Random& random) {
  return moving_boxes(random, random_approach(random), false);
}

MovingBoxes random_drifting_boxes(Random& random) {
  MovingBoxes c = moving_boxes(random, Approach::swinging, false);
  c.t = 0.0;
  const Vector3d normal = real_box(c.A, 0, 0.0L, RealVector::Zero()).axes.col(0).cast<double>();
  const Vector3d axis = c.B.rotation_vector.normalized();
  const double distance = static_cast<double>(c.distance(0, 0, 0.0L));
  c.B.rotation_vector = random.logarithmic(0.1, 3.0) * axis;
  set_lever(Vector3d::Zero(), 0.0, c.B);
  // axis x (axis x normal) = -normal.
  const Vector3d drift =
      (distance + c.size()) * random.logarithmic(1.0, 100.0) * axis.cross(normal);
  const Vector3d own = c.B.rotation.conjugate() * drift / c.B.hierarchy.unit;
  Hierarchy& hierarchy = c.B.hierarchy;
  hierarchy.nodes_to = hierarchy.nodes;
  hierarchy.vertices_to = {Vector3d::Zero()};
  for (int k = 0; k < 3; ++k) {
    for (int slot = 0; slot < HierarchyNode::kWidth; ++slot) {
      hierarchy.nodes_to[0].centre[k][slot] += static_cast<float>(own[k]);
    }
  }
  hierarchy.deformation_speed = drift.norm() * (1.0 + 1e-5);
  // The lever is gone: B is put back above A's face.
  const RealVector origin = c.A.position.cast<Real>();
  const RealVector above =
      real_box(c.A, 0, 0.0L, origin).centre + Real{distance + c.size()} * normal.cast<Real>();
  c.B.position += (above - real_box(c.B, 0, 0.0L, origin).centre).cast<double>();
  return c;
}

MovingBoxes random_deforming_boxes(Random& random) {
  return moving_boxes(random, random_approach(random), true);
}

}  // namespace firstcontact::test
