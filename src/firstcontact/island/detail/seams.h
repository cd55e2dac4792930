/// @file
/// Seams between bodies whose surfaces are flush.

#pragma once

#include <cstddef>
#include <functional>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/motion/pose.h>
#include <firstcontact/query/contact.h>
#include <firstcontact/query/workspace.h>
#include <firstcontact/simulation_model/detail/manifold.h>

namespace firstcontact::detail {

struct IslandState;

/// Turns normals at edges that another body continues.
///
/// Take a body that slides at the contact distance over two slabs side by side. Near the edge of
/// the second one the normal leans back. No surface is there that could push so: together the slabs
/// have a flat one. A normal must be one that both surfaces permit. It lies in the normal cone of
/// the touched body, and in that of each body whose surface is within the band of the contact. The
/// nearest such normal replaces the one found. Where there is none, as in a corner, the contact
/// stays as it is. It also stays where its gap along the new normal would be too small: then the
/// second slab is a step.
class SeamFinder {
 public:
  /// Prepares the finder.
  ///
  /// @param pose_of  the pose of a body
  SeamFinder(IslandState& state, Workspace& workspace, std::function<Pose(std::size_t)> pose_of);

  /// Turns the normal of a touch. Returns whether it changed.
  bool level(ManifoldPoint& touch);

 private:
  [[nodiscard]] std::vector<std::size_t> bodies_near(const Eigen::Vector3d& point,
                                                     const BodyPair& pair) const;
  void add_directions(std::size_t body, const Feature& feature,
                      std::vector<Eigen::Vector3d>& directions) const;
  [[nodiscard]] bool add_surface_near(std::size_t body, const Eigen::Vector3d& point,
                                      std::vector<Eigen::Vector3d>& directions);
  bool lean(ManifoldPoint& touch, std::size_t side);
  bool take_normal(const Eigen::Vector3d& outwards, std::size_t side, ManifoldPoint& touch);

  IslandState& state_;
  Workspace& workspace_;
  std::function<Pose(std::size_t)> pose_of_;
  // Members that touch each body.
  std::unordered_map<std::size_t, std::vector<std::size_t>> touching_ = {};
  std::vector<Contact> contacts_ = {};
};

}  // namespace firstcontact::detail
