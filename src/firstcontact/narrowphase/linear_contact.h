/// @file
/// First contact of features whose corners each move on a line of their own: deforming meshes.

#pragma once

#include <array>

#include <Eigen/Core>

#include <firstcontact/math/export.h>

namespace firstcontact {

/// A point at (1 - t) from + t to.
struct LinearPoint {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d to = Eigen::Vector3d::Zero();    ///< [m]
};

using LinearFace = std::array<LinearPoint, 3>;  ///< Corners; may coincide or be collinear.
using LinearEdge = std::array<LinearPoint, 2>;  ///< Ends; may coincide.

struct LinearContactOptions {
  double margin = 0.0;         ///< [m]  Closer than this counts as contact; >= 0.
  double tolerance = 1e-6;     ///< [m]  A contact is no farther than margin + tolerance; > 0.
  int maximum_steps = 10'000;  ///< Beyond this many steps the test is `undecided`.
};

enum class LinearVerdict {
  free,       ///< Proven: farther apart than the margin for all t in [0, 1].
  contact,    ///< Proven: so before t; at t no farther than margin + tolerance.
  undecided,  ///< Proven so before t; nothing known after it: the steps were spent.
};

struct LinearContact {
  LinearVerdict verdict = LinearVerdict::undecided;
  double t = 0.0;  ///< [-]  Proven: no contact before; 1 when free.
  /// [m]  The tolerance that holds in place of the one asked for.
  ///
  /// It is larger where features move farther than that between two neighbouring doubles of t. It
  /// is larger, too, where coordinates are so large that no arithmetic here resolves the one asked
  /// for.
  double tolerance_used = 0.0;
  int steps = 0;
};

/// Finds the first time at which a vertex and a face come within the margin.
///
/// Along a fixed direction n each corner of one feature has a distance from each corner of the
/// other that is linear in t. The features are apart up to the earliest zero of these distances. n
/// is the direction between the closest points. Where these nearly coincide, it is the direction
/// that the features define. n may also turn with the features, as in advance_deforming(), so that
/// sliding does not stall.
///
/// Steps of that kind never pass a contact, whatever the configuration. Nothing is divided by a
/// determinant, and no root of the coplanarity cubic is sought. Its degenerate cases: B. Wang, Z.
/// Ferguson, T. Schneider, X. Jiang, M. Attene, D. Panozzo, "A large-scale benchmark and an
/// inclusion-based algorithm for continuous collision detection", ACM Trans. Graph. 40, 2021.
/// Derivation: ours. The steps are those of conservative advancement (B. Mirtich, 1996) with the
/// exact bound that linear motion allows.
///
/// The claims hold in the arithmetic as executed, also far from the origin: only differences of
/// coordinates are rounded. Where doubles cannot decide, the test is repeated in double-double
/// (precise_linear_contact.h). It distinguishes a gap of 1e-18 of the size from none.
///
/// @throws std::invalid_argument if an option is outside its documented range
[[nodiscard]] FIRSTCONTACT_API LinearContact linear_vertex_face_contact(
    const LinearPoint& vertex, const LinearFace& face, const LinearContactOptions& options = {});

/// Finds the first time at which two edges come within the margin, as linear_vertex_face_contact()
/// does.
[[nodiscard]] FIRSTCONTACT_API LinearContact linear_edge_edge_contact(
    const LinearEdge& A, const LinearEdge& B, const LinearContactOptions& options = {});

}  // namespace firstcontact
