/// @file
/// Finds the joints of a COLLADA skin in the scene.

#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/mesh_files/detail/dae_document.h>
#include <firstcontact/mesh_files/detail/dae_scene.h>

namespace firstcontact::detail {

/// Looks joints up by the sid that a skin has for them: below the <skeleton>s of its instance, then
/// in the whole scene; where there is no such sid, by id and by name, as some writers do.
class DaeJointFinder {
 public:
  DaeJointFinder(const DaeDocument& document, const DaeScene& scene, const XmlElement& instance);

  /// The map from the joint's frame to the world's.
  ///
  /// @param by_id  the name is an id
  /// @throws ParseError  not in the scene, or several times
  [[nodiscard]] Eigen::Affine3d pose(const std::string& name, bool by_id) const;

 private:
  /// The nodes below some, by one of their attributes. The first of a name counts.
  using Nodes = std::unordered_map<std::string, const XmlElement*>;

  void add(std::vector<const XmlElement*> roots);
  [[nodiscard]] const XmlElement* find(const std::string& name, bool by_id) const;

  const DaeDocument& document_;
  const DaeScene& scene_;
  const XmlElement& instance_;
  Nodes by_sid_;
  Nodes by_name_;
};

}  // namespace firstcontact::detail
