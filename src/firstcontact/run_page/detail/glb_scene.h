/// @file
/// The nodes, looks and motions of bodies as binary glTF.

#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <nlohmann/json.hpp>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/run_page/detail/glb_writer.h>

namespace firstcontact::detail {

/// The kind of a body, which determines its colour.
enum class GlbLook { free, scripted, resting };

/// The place of a body's centre of mass at one time, and the body's rotation.
struct GlbKey {
  float time = 0.0F;                                         ///< [s]
  Eigen::Vector3d place = Eigen::Vector3d::Zero();           ///< [m]
  Eigen::Quaterniond R_WB = Eigen::Quaterniond(1, 0, 0, 0);  ///< A unit quaternion.
};

/// A body of the scene and its motion.
struct GlbBody {
  std::string name;
  GlbLook look = GlbLook::free;
  Eigen::Vector3d p_BC = Eigen::Vector3d::Zero();  ///< [m]  Centre of mass.
  std::vector<GlbKey> keys;  ///< At least one; times increase strictly. A body with one key rests.
};

/// Collects bodies: each is a node at its centre of mass, with its mesh below it.
class GlbScene {
 public:
  /// @param shape  lives as long as this; bodies that share one share its numbers
  void add(const GlbBody& body, const Shape& shape);

  /// Writes the scene as binary glTF.
  ///
  /// @param up  up direction of the world; becomes y, as in glTF
  [[nodiscard]] std::string write(const Eigen::Vector3d& up);

 private:
  using ShapeKey = std::pair<const Mesh*, double>;
  struct KnownShape {
    nlohmann::ordered_json primitive;
    Eigen::Vector3d origin;
  };

  const KnownShape& known(const Shape& shape);
  std::size_t mesh_of(const Shape& shape, GlbLook look);
  void add_motion(std::size_t node, const std::vector<GlbKey>& keys);

  GlbWriter writer_;
  std::map<ShapeKey, KnownShape> shapes_;
  std::map<std::pair<ShapeKey, GlbLook>, std::size_t> mesh_numbers_;
  nlohmann::ordered_json meshes_ = nlohmann::ordered_json::array();
  nlohmann::ordered_json nodes_ = nlohmann::ordered_json::array();
  nlohmann::ordered_json bodies_ = nlohmann::ordered_json::array();  // Nodes of the bodies.
  nlohmann::ordered_json channels_ = nlohmann::ordered_json::array();
  nlohmann::ordered_json samplers_ = nlohmann::ordered_json::array();
};

}  // namespace firstcontact::detail
