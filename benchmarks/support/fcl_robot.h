/// @file
/// FCL's discrete tests of a robot among bodies at rest, the way MoveIt does them.

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

/// A dynamic tree of boxes for the robot and one for the surroundings; boxes, spheres and cylinders
/// as FCL's primitives, all else as meshes.
class FclRobot {
 public:
  FclRobot();
  ~FclRobot();

  /// @param X_LG  of the geometry in its link
  void add_link_geometry(std::size_t link, const Shape& shape, const Eigen::Isometry3d& X_LG);
  /// @param source  what the shape was made of
  void add_obstacle(const BodyShape& source, const Shape& shape, const Eigen::Isometry3d& X_WG);

  /// @param tested   pairs of links, first < second
  void set_tested_links(std::span<const std::array<std::size_t, 2>> tested);

  /// After all has been added.
  void set_up();

  /// Whether anything collides with the links at their places. Ends at the first collision.
  [[nodiscard]] bool collides(const std::vector<Eigen::Isometry3d>& X_WL);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Fills the peer with the first robot of a scene and all bodies, and sets it up.
///
/// @param sources  what the bodies of the scene were made of; meshes where there are none
void fill(FclRobot& peer, const RobotScene& scene, const std::vector<BodyShape>& sources);

/// What the bodies of a scene are made of.
[[nodiscard]] std::vector<BodyShape> sources_of(const Scene& scene);

}  // namespace firstcontact::benchmarks
