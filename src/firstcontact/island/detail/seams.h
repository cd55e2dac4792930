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
/// What slides at the contact distance over two slabs side by side comes near the edge of the
/// second one, with a normal that leans back. No surface is there that could push so: together the
/// slabs have a flat one. A normal must be one that both surfaces allow: it lies in the normal cone
/// of the body that is touched, and in that of each body whose surface is within the band of the
/// contact. The nearest such normal takes the place of the one found. Where there is none, as in a
/// corner, the contact stays as it is. So it does where its gap along the new normal would be too
/// small: then the second slab is a step.
class SeamFinder {
 public:
  /// @param pose_of  where a body is
  SeamFinder(IslandState& state, Workspace& workspace, std::function<Pose(std::size_t)> pose_of);

  /// Returns whether the touch was changed.
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
  std::unordered_map<std::size_t, std::vector<std::size_t>> touching_ = {};  // Members.
  std::vector<Contact> contacts_ = {};
};

}  // namespace firstcontact::detail
