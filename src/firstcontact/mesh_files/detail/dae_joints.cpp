#include <firstcontact/mesh_files/detail/dae_joints.h>

#include <cstddef>
#include <unordered_set>
#include <utility>

#include <firstcontact/text/text_cursor.h>

namespace firstcontact::detail {

DaeJointFinder::DaeJointFinder(const DaeDocument& document, const DaeScene& scene,
                               const XmlElement& instance)
    : document_(document), scene_(scene), instance_(instance) {
  std::vector<const XmlElement*> skeletons;
  for (const XmlElement* skeleton : document.xml().children(instance, "skeleton")) {
    const XmlText text = document.xml().content(*skeleton);
    TextCursor cursor(text.view(), document.xml().source(), {}, text.line());
    const std::string word(cursor.find_line() ? cursor.word() : std::string_view());
    const XmlElement* root =
        word.starts_with('#') ? document.find_id(word.substr(1), "node") : nullptr;
    if (root == nullptr) {
      document.fail(*skeleton, "expected '#' and the id of a node of the skin's skeleton, got " +
                                   detail::quoted(word));
    }
    skeletons.push_back(root);
  }
  add(std::move(skeletons));
  add(document.xml().children(scene.element(), "node"));
}

/// Nodes nearer to the roots come first.
void DaeJointFinder::add(std::vector<const XmlElement*> queue) {
  std::unordered_set<const XmlElement*> seen(queue.begin(), queue.end());
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const XmlElement& element = *queue[i];
    if (const char* sid = element.Attribute("sid")) {
      by_sid_.try_emplace(sid, &element);
    }
    if (const char* name = element.Attribute("name")) {
      by_name_.try_emplace(name, &element);
    }
    const DaeNode* node = scene_.node(element);
    if (node == nullptr) {
      continue;
    }
    for (const XmlElement* child : node->children) {
      if (seen.insert(child).second) {
        queue.push_back(child);
      }
    }
  }
}

const XmlElement* DaeJointFinder::find(const std::string& name, bool by_id) const {
  if (const auto known = by_sid_.find(name); !by_id && known != by_sid_.end()) {
    return known->second;
  }
  if (const XmlElement* element = document_.find_id(name, "node")) {
    return element;
  }
  const auto known = by_name_.find(name);
  return known == by_name_.end() ? nullptr : known->second;
}

Eigen::Affine3d DaeJointFinder::pose(const std::string& name, bool by_id) const {
  const XmlElement* element = find(name, by_id);
  const DaeNode* node = element == nullptr ? nullptr : scene_.node(*element);
  if (node == nullptr) {
    document_.fail(instance_, "expected the joint " + detail::quoted(name) +
                                  " of a skin among the nodes of the scene, got none");
  }
  if (node->times != 1) {
    document_.fail(instance_, "expected the joint " + detail::quoted(name) +
                                  " of a skin once in the scene, got it several times");
  }
  return node->X_WN;
}

}  // namespace firstcontact::detail
