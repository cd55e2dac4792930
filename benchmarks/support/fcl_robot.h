/// @file
/// FCL's discrete collision tests of a robot among bodies at rest, as MoveIt uses them.

#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/body_shape.h>
#include <firstcontact/scene/scene.h>

namespace firstcontact::benchmarks {

/// Dynamic trees of boxes for the robot and for the surroundings.
///
/// Boxes, spheres and cylinders are FCL's primitives, all other shapes meshes.
class FclRobot {
 public:
  FclRobot();
  ~FclRobot();

  /// @param X_LG  pose of the geometry in its link
  void add_link_geometry(std::size_t link, const Shape& shape, const Eigen::Isometry3d& X_LG);
  /// @param source  the description that the shape was made from
  void add_obstacle(const BodyShape& source, const Shape& shape, const Eigen::Isometry3d& X_WG);

  /// @param tested   pairs of links, first < second
  void set_tested_links(std::span<const std::array<std::size_t, 2>> tested);

  /// Completes the trees; to be called after all shapes were added.
  void set_up();

  /// Returns whether the links at these poses collide with anything; ends at the first collision.
  [[nodiscard]] bool collides(const std::vector<Eigen::Isometry3d>& X_WL);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Fills the peer with the first robot of a scene and all bodies, and sets it up.
///
/// @param sources  the descriptions that the bodies were made from; meshes where empty
void fill(FclRobot& peer, const RobotScene& scene, const std::vector<BodyShape>& sources);

/// Returns the descriptions that the bodies of a scene were made from.
[[nodiscard]] std::vector<BodyShape> sources_of(const Scene& scene);

}  // namespace firstcontact::benchmarks
