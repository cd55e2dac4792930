/// @file
/// Finds the joints of COLLADA skins in the scene.

#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/model_files/detail/dae_budget.h>
#include <firstcontact/model_files/detail/dae_document.h>
#include <firstcontact/model_files/detail/dae_scene.h>

namespace firstcontact::detail {

/// Finds joints by the sid that a skin has for them.
///
/// The search is below the <skeleton>s of its instance, then in the whole scene. Where there is no
/// such sid, the search is by id and by name, as some writers do. Nodes nearer to the roots are
/// found first.
class DaeJointFinder {
 public:
  DaeJointFinder(const DaeDocument& document, const DaeScene& scene, DaeBudget& budget)
      : document_(document), scene_(scene), budget_(budget) {}

  /// Lists the roots below which the joints of an <instance_controller> are searched, in order.
  ///
  /// @throws ParseError  a <skeleton> that names no node
  [[nodiscard]] std::vector<const XmlElement*> skeletons(const XmlElement& instance) const;

  /// Finds the map from a joint's frame to the world's.
  ///
  /// @param by_id     whether the name is an id
  /// @param instance  for errors
  /// @throws ParseError  the joint is not in the scene, or several times
  [[nodiscard]] Eigen::Affine3d pose(const std::string& name, bool by_id,
                                     const std::vector<const XmlElement*>& skeletons,
                                     const XmlElement& instance);

 private:
  /// The nodes below a root, by their attributes.
  struct Subtree {
    std::unordered_map<std::string_view, const XmlElement*> by_sid;
    std::unordered_map<std::string_view, const XmlElement*> by_name;
  };

  /// Lists the nodes below a root.
  ///
  /// @param root  a <node>, or the <visual_scene>
  const Subtree& subtree(const XmlElement& root);
  [[nodiscard]] const XmlElement* find(const std::string& name, bool by_id,
                                       const std::vector<const XmlElement*>& skeletons);

  const DaeDocument& document_;
  const DaeScene& scene_;
  DaeBudget& budget_;
  std::unordered_map<const XmlElement*, Subtree> subtrees_;
};

}  // namespace firstcontact::detail
