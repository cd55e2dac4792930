/// @file
/// The visual scene of a COLLADA document: its nodes with their poses, and the geometry that they
/// place.

#pragma once

#include <cstddef>
#include <unordered_map>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/model_files/detail/dae_budget.h>
#include <firstcontact/model_files/detail/dae_document.h>

namespace firstcontact::detail {

/// An <instance_geometry> or <instance_controller>, and its node's map to the world.
struct DaePlacement {
  const XmlElement* instance = nullptr;
  Eigen::Affine3d X_WN = Eigen::Affine3d::Identity();
};

/// A node, once for all of its instances.
struct DaeNode {
  std::vector<const XmlElement*> placed;               ///< Instances of geometries and controllers.
  std::vector<const XmlElement*> children;             ///< Nodes inside, then instanced ones.
  Eigen::Affine3d X_PN = Eigen::Affine3d::Identity();  ///< Map to the parent's frame.
  /// Map to the world's frame, for its first instance.
  Eigen::Affine3d X_WN = Eigen::Affine3d::Identity();
  std::size_t times = 0;  ///< How often the scene contains it.
  bool open = false;      ///< Whether it is on the path to the current node.
};

/// The scene that <scene> instances, in metres, with the axes of the file.
class DaeScene {
 public:
  /// Reads the scene of a document.
  ///
  /// @throws ParseError  no scene, a node inside of itself, an unknown element, and as
  ///         read_dae_transform()
  DaeScene(const DaeDocument& document, DaeBudget& budget);

  [[nodiscard]] const XmlElement& element() const { return *scene_; }

  /// The placements, in the order of a depth-first walk.
  [[nodiscard]] const std::vector<DaePlacement>& placements() const { return placements_; }

  /// Finds the node of an element <node>, or null if the scene does not contain it.
  [[nodiscard]] const DaeNode* node(const XmlElement& element) const;

 private:
  DaeNode& enter(const XmlElement& element, const Eigen::Affine3d& X_WP);
  void read_node(const XmlElement& element, DaeNode& node);
  void walk(const XmlElement& root);

  const DaeDocument& document_;
  DaeBudget& budget_;
  const XmlElement* scene_ = nullptr;
  Eigen::Affine3d X_WS_;  ///< Map by the unit.
  std::vector<DaePlacement> placements_;
  std::unordered_map<const XmlElement*, DaeNode> nodes_;
};

}  // namespace firstcontact::detail
