/// @file
/// The manifold of two bodies: the contacts that act on them.

#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/query/contact.h>
#include <firstcontact/query/placed_shape.h>
#include <firstcontact/query/workspace.h>
#include <firstcontact/simulation_model/detail/round_feature.h>

namespace firstcontact::detail {

struct SimulationModel;

/// A point at which two bodies are near each other.
struct ManifoldPoint {
  BodyPair bodies = {};
  Feature feature_A;
  Feature feature_B;
  std::array<std::uint32_t, 2> surface = {};          ///< SurfaceNeighbours::surface_index of both.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    ///< [m]  In the world, between the surfaces.
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< [-]  From A to B.
  double gap = 0.0;                                   ///< [m]  Excess over the pair's margin.
  std::array<RoundFeature, 2> round = {};  ///< Curved feature of A and of B on which the point is.
  std::array<bool, 2> corner = {false, false};  ///< Whether a corner of A, of B, is on a face; not
                                                ///< a corner of a circle, which runs round.
  std::array<bool, 2> faces = {false, false};   ///< Whether the normal goes with A, with B, like
                                                ///< that of a face.
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();  ///< [N s]  Impulse on B in world axes; found
                                                      ///< or guessed.
};

/// Whether two points have the same features; all triangles of a flat face are one feature.
[[nodiscard]] bool same_features(const ManifoldPoint& x, const ManifoldPoint& y);

/// Whether both are on one circle, or one ellipsoid, of one of the bodies.
[[nodiscard]] bool share_curve(const ManifoldPoint& x, const ManifoldPoint& y);

/// Makes manifold points of the contacts of a list at which both surfaces bulge towards each other.
///
/// Each place is taken once; where no surface bulges, all contacts are taken. If there are very
/// many, the nearest ones of each neighbourhood are taken. Contacts without normal, of surfaces
/// that meet, are left out.
///
/// @param margin  [m]  of the pair
[[nodiscard]] std::vector<ManifoldPoint> touches_among(const SimulationModel& model,
                                                       const BodyPair& bodies,
                                                       const std::array<Pose, 2>& poses,
                                                       double margin,
                                                       const std::vector<Contact>& contacts);

/// Whether one of two bodies is a curved shape. Their gap is then that of convex sets.
[[nodiscard]] bool are_curved(const SimulationModel& model, const BodyPair& bodies);

/// The manifold points of two bodies at rest at these poses, and the least gap of all their
/// features.
struct Manifold {
  BodyPair bodies = {};
  double gap = 0.0;  ///< [m]  Infinite where nothing is within the band.
  std::vector<ManifoldPoint> touches = {};
};

/// [m]  The least gap of the manifold points; infinite where there is none.
[[nodiscard]] double least_gap(const Manifold& manifold);

/// Finds the manifolds of many pairs in memory that they share.
class ManifoldFinder {
 public:
  ManifoldFinder(const SimulationModel& model, Workspace& workspace)
      : model_(model), workspace_(workspace) {}

  /// Finds the manifold of a pair.
  ///
  /// @param A,B     the surfaces of the pair (SimBody::surface)
  /// @param margin  [m]  of the pair
  [[nodiscard]] Manifold find(const BodyPair& bodies, const PlacedShape& A, const PlacedShape& B,
                              double margin);

 private:
  void find_among_triangles(const PlacedShape& A, const PlacedShape& B, double margin,
                            Manifold& manifold);
  void add_of_sets(const std::array<Pose, 2>& poses, double margin, Manifold& manifold);

  const SimulationModel& model_;
  Workspace& workspace_;
  std::vector<Contact> contacts_;
};

/// Whether one point comes before the other: by the bodies, then by the features.
[[nodiscard]] bool comes_before(const ManifoldPoint& x, const ManifoldPoint& y);

/// Gives the manifold the impulses of earlier points.
///
/// Each impulse goes to the point of the same features. These change with every rounding where
/// edges lie on edges. Then it goes to the nearest point close by, or else to the nearest one on a
/// curve.
///
/// @param before  sorted
/// @param size    [m]  of the smaller body
void carry_impulses(const std::vector<ManifoldPoint>& before, double size, Manifold& manifold);

}  // namespace firstcontact::detail
