/// @file
/// Skins of a COLLADA document in the pose of its nodes.

#pragma once

#include <vector>

#include <Eigen/Core>

#include <firstcontact/model_files/detail/dae_budget.h>
#include <firstcontact/model_files/detail/dae_document.h>
#include <firstcontact/model_files/detail/dae_joints.h>

namespace firstcontact::detail {

/// A skin that the scene places.
struct DaeSkinInstance {
  /// <instance_controller>; its <skeleton>s are the roots of the joints.
  const XmlElement& element;
  const XmlElement& skin;  ///< <skin>
};

/// Moves the positions of a skin's geometry into the world, in metres.
///
/// A vertex v goes to the mean by its weights of X_WJ B_J S v over its joints J. S is the bind
/// shape matrix, B_J the joint's inverse bind matrix and X_WJ the map of the joint's node, as the
/// document places it. The node of the instance has no effect. The sum of the weights, which
/// writers round, is divided out. The joint -1 is the bind shape itself.
///
/// Source: "COLLADA – Digital Asset Schema Release 1.4.1", chapter 4, "Skin Deformation".
///
/// @param points    the positions v of the skinned geometry
/// @throws ParseError  joints that are not in the scene, or several times; numbers of weights that
///         do not fit; vertices without weights
[[nodiscard]] std::vector<Eigen::Vector3d> read_dae_skin(
    const DaeDocument& document, DaeJointFinder& finder, DaeBudget& budget,
    const DaeSkinInstance& instance, const std::vector<Eigen::Vector3d>& points);

}  // namespace firstcontact::detail
