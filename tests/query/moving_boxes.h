/// @file
/// Pairs of bodies made of boxes that come near each other, and the true positions of their boxes.
/// Extended precision computes these from the numbers that define the motion, without code of the
/// library.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/motion/motion.h>

#include "support/random.h"

namespace firstcontact::test {

using Real = long double;
using RealVector = Eigen::Matrix<Real, 3, 1>;
using RealMatrix = Eigen::Matrix<Real, 3, 3>;

/// A body of one node: four boxes, and the numbers that define its motion.
///
/// Where it deforms, every point of a box is at one place of the box at both ends, and moves from
/// one to the other.
struct Body {
  Hierarchy hierarchy;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // [m]  Position of the body origin at t = 0.
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Vector3d rotation_vector = Eigen::Vector3d::Zero();

  [[nodiscard]] const HierarchyNode& node() const { return hierarchy.nodes[0]; }
  [[nodiscard]] const HierarchyNode& node_to() const {
    return hierarchy.deforms() ? hierarchy.nodes_to[0] : node();
  }
  [[nodiscard]] Motion motion() const {
    return Motion::constant_velocity({position, rotation}, translation, rotation_vector);
  }
};

struct RealBox {
  RealVector centre;
  RealMatrix axes;  // one per column
  RealVector extent;

  [[nodiscard]] RealVector nearest(const RealVector& p) const {
    const RealVector local = axes.transpose() * (p - centre);
    return centre + axes * local.cwiseMax(-extent).cwiseMin(extent);
  }
};

/// Computes the box at time t; positions are relative to `origin`.
[[nodiscard]] RealBox real_box(const Body& body, int slot, Real t, const RealVector& origin);

/// Computes the distance of two points of the boxes that alternating projections bring closest.
///
/// It is never below the distance of the boxes.
[[nodiscard]] Real distance_of_points(const RealBox& a, const RealBox& b);

/// Two bodies whose first boxes come near each other at t.
struct MovingBoxes {
  Body A;
  Body B;
  double t = 0.0;
  double threshold = 0.0;  // [m]

  [[nodiscard]] Real distance(int i, int j, Real at) const {
    const RealVector origin = A.position.cast<Real>();
    return distance_of_points(real_box(A, i, at, origin), real_box(B, j, at, origin));
  }

  /// [m]  Computes the size of the first boxes together.
  [[nodiscard]] double size() const {
    const RealVector a = real_box(A, 0, 0.0L, RealVector::Zero()).extent;
    const RealVector b = real_box(B, 0, 0.0L, RealVector::Zero()).extent;
    return static_cast<double>(a.norm() + b.norm()) + 1e-6 * (A.hierarchy.unit + B.hierarchy.unit);
  }
};

/// Motion of B towards a face of A; except for `any`, the bounds have no margin but their slack.
enum class Approach {
  any,
  straight,
  spinning,  ///< Rotates about the face's normal: points are fast, but not towards the face.
  swinging,  ///< Rotates about an axis in the face, at first along it: only the acceleration
             ///< counts.
  tilting,   ///< One of the two rotates above a face, about its own middle: only its extent counts.
  circling,  ///< Both rotate about a far axis along the normal: fast, but not towards each other.
};

/// Makes bodies of sizes from 1e-6 m to 1e6 m, some pairs far from the origin.
///
/// Their boxes are thick, flat, needles or points.
[[nodiscard]] MovingBoxes random_moving_boxes(Random& random, Approach approach);
[[nodiscard]] MovingBoxes random_moving_boxes(Random& random);

/// Makes the same two bodies where one or both deform as well, by 1e-3 to 1 of their size.
[[nodiscard]] MovingBoxes random_deforming_boxes(Random& random);

/// Makes a B that rotates, and drifts in its own frame so that at first it comes no nearer to A.
///
/// It comes nearer because the drift turns with B (Coriolis).
[[nodiscard]] MovingBoxes random_drifting_boxes(Random& random);

}  // namespace firstcontact::test
