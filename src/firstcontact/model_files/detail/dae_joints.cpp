#include <firstcontact/model_files/detail/dae_joints.h>

#include <cstddef>
#include <unordered_set>

#include <firstcontact/text/text_cursor.h>

namespace firstcontact::detail {

std::vector<const XmlElement*> DaeJointFinder::skeletons(const XmlElement& instance) const {
  std::vector<const XmlElement*> roots;
  for (const XmlElement* skeleton : document_.xml().children(instance, "skeleton")) {
    const XmlText text = document_.xml().content(*skeleton);
    TextCursor cursor(text.view(), document_.xml().source(), {}, text.line());
    const std::string_view word = cursor.find_line() ? cursor.word() : std::string_view();
    const XmlElement* const root =
        word.starts_with('#') ? document_.find_id(word.substr(1), "node") : nullptr;
    if (root == nullptr) {
      document_.fail(*skeleton, "expected '#' and the id of a node of the skin's skeleton, got " +
                                    detail::quoted(word));
    }
    roots.push_back(root);
  }
  roots.push_back(&scene_.element());
  return roots;
}

const DaeJointFinder::Subtree& DaeJointFinder::subtree(const XmlElement& root) {
  // The memory of a node here, in units of the memory of a corner in a mesh.
  constexpr std::size_t kWork = 64;
  const auto [known, is_new] = subtrees_.try_emplace(&root);
  Subtree& found = known->second;
  if (!is_new) {
    return found;
  }
  std::vector<const XmlElement*> queue = {&root};
  if (&root == &scene_.element()) {
    queue = document_.xml().children(root, "node");
  }
  std::unordered_set<const XmlElement*> seen(queue.begin(), queue.end());
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const XmlElement& element = *queue[i];
    budget_.spend(document_, element, kWork);
    if (const char* sid = element.Attribute("sid")) {
      found.by_sid.try_emplace(sid, &element);
    }
    if (const char* name = element.Attribute("name")) {
      found.by_name.try_emplace(name, &element);
    }
    const DaeNode* const node = scene_.node(element);
    if (node == nullptr) {
      continue;
    }
    for (const XmlElement* child : node->children) {
      if (seen.insert(child).second) {
        queue.push_back(child);
      }
    }
  }
  return found;
}

const XmlElement* DaeJointFinder::find(const std::string& name, bool by_id,
                                       const std::vector<const XmlElement*>& skeletons) {
  for (const XmlElement* root : by_id ? std::vector<const XmlElement*>() : skeletons) {
    const Subtree& nodes = subtree(*root);
    if (const auto known = nodes.by_sid.find(name); known != nodes.by_sid.end()) {
      return known->second;
    }
  }
  if (const XmlElement* const element = document_.find_id(name, "node")) {
    return element;
  }
  for (const XmlElement* root : skeletons) {
    const Subtree& nodes = subtree(*root);
    if (const auto known = nodes.by_name.find(name); known != nodes.by_name.end()) {
      return known->second;
    }
  }
  return nullptr;
}

Eigen::Affine3d DaeJointFinder::pose(const std::string& name, bool by_id,
                                     const std::vector<const XmlElement*>& skeletons,
                                     const XmlElement& instance) {
  const XmlElement* const element = find(name, by_id, skeletons);
  const DaeNode* const node = element == nullptr ? nullptr : scene_.node(*element);
  if (node == nullptr) {
    document_.fail(instance, "expected the joint " + detail::quoted(name) +
                                 " of a skin among the nodes of the scene, got none");
  }
  if (node->times != 1) {
    document_.fail(instance, "expected the joint " + detail::quoted(name) +
                                 " of a skin once in the scene, got it several times");
  }
  return node->X_WN;
}

}  // namespace firstcontact::detail
