/// @file
/// Where two bodies touch: the contacts that act on them.

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
  std::array<std::uint32_t, 2> surface = {};        ///< SurfaceNeighbours::surface_index of both.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< [m]  SimulationModel, between the surfaces.
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< [-]  From A to B.
  double gap = 0.0;                                   ///< [m]  Beyond the pair's margin.
  std::array<RoundFeature, 2> round = {};             ///< On which curve of A, of B it is.
  std::array<bool, 2> corner = {false, false};  ///< Whether a corner of A, of B, is on a face; not
                                                ///< one of a circle, which runs round.
  std::array<bool, 2> faces = {false, false};   ///< Whether its normal goes with A, with B, as if
                                                ///< it were that of a face.
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();  ///< [N s]  On B, world; found or guessed.
};

/// All triangles of a flat face are one feature.
[[nodiscard]] bool same_features(const ManifoldPoint& x, const ManifoldPoint& y);

/// Whether both are on one circle, or one ellipsoid, of one of the bodies.
[[nodiscard]] bool share_curve(const ManifoldPoint& x, const ManifoldPoint& y);

/// The contacts of a list at which both surfaces bulge towards each other, each place once; all of
/// it where none does. Of very many, the nearest ones of each neighbourhood. Contacts without
/// normal, of surfaces that meet, are left out.
///
/// @param margin  [m]  of the pair
[[nodiscard]] std::vector<ManifoldPoint> touches_among(const SimulationModel& model,
                                                       const BodyPair& bodies,
                                                       const std::array<Pose, 2>& poses,
                                                       double margin,
                                                       const std::vector<Contact>& contacts);

/// The touches of two bodies at rest at these poses, and the least gap of all their features.
struct Manifold {
  BodyPair bodies = {};
  double gap = 0.0;  ///< [m]  Infinite where nothing is within the band.
  std::vector<ManifoldPoint> touches = {};
};

/// [m]  Of its touches; infinite where there is none.
[[nodiscard]] double least_gap(const Manifold& manifold);

/// Finds the manifolds of many pairs in memory that they share.
class ManifoldFinder {
 public:
  ManifoldFinder(const SimulationModel& model, Workspace& workspace)
      : model_(model), workspace_(workspace) {}

  /// @param A,B     the shapes of the pair
  /// @param margin  [m]  of the pair
  [[nodiscard]] Manifold find(const BodyPair& bodies, const PlacedShape& A, const PlacedShape& B,
                              double margin);

 private:
  const SimulationModel& model_;
  Workspace& workspace_;
  std::vector<Contact> contacts_;
};

/// Whether the bodies, or else the features, of one touch come before those of the other.
[[nodiscard]] bool comes_before(const ManifoldPoint& x, const ManifoldPoint& y);

/// Gives the manifold the impulses of the touches before.
///
/// Each goes to the touch of the same features or, as these change with every rounding where edges
/// lie on edges, to the nearest one close by; or else to the nearest one on a curve.
///
/// @param before  sorted
/// @param size    [m]  of the smaller body
void carry_impulses(const std::vector<ManifoldPoint>& before, double size, Manifold& manifold);

}  // namespace firstcontact::detail
