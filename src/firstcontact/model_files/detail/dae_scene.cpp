#include <firstcontact/model_files/detail/dae_scene.h>

#include <string_view>

#include <firstcontact/model_files/detail/dae_transform.h>

namespace firstcontact::detail {
namespace {

constexpr const char* kLooks = "looks";

const XmlElement& visual_scene(const DaeDocument& document) {
  const XmlElement* scene = document.xml().child(document.root(), "scene");
  const XmlElement* instance =
      scene == nullptr ? nullptr : document.xml().child(*scene, "instance_visual_scene");
  if (instance == nullptr) {
    document.fail(scene == nullptr ? document.root() : *scene,
                  "expected a <scene> with an <instance_visual_scene>: without it nothing says "
                  "what is placed where");
  }
  document.check_children(
      *scene, {"instance_visual_scene"},
      {{"instance_physics_scene", "shapes of a simulator; the visual scene is read"},
       {"instance_kinematics_scene", "joints; the poses of the visual scene are read"}});
  return document.find(*instance, "url", "visual_scene");
}

}  // namespace

DaeScene::DaeScene(const DaeDocument& document, DaeBudget& budget)
    : document_(document),
      budget_(budget),
      scene_(&visual_scene(document)),
      X_WS_(Eigen::Affine3d(Eigen::Scaling(document.unit()))) {
  document_.check_children(*scene_, {"node"}, {{"evaluate_scene", kLooks}});
  for (const XmlElement* root : document_.xml().children(*scene_, "node")) {
    walk(*root);
  }
}

const DaeNode* DaeScene::node(const XmlElement& element) const {
  const auto known = nodes_.find(&element);
  return known == nodes_.end() ? nullptr : &known->second;
}

void DaeScene::read_node(const XmlElement& element, DaeNode& node) {
  document_.check_children(element,
                           {"lookat", "matrix", "rotate", "scale", "skew", "translate",
                            "instance_controller", "instance_geometry", "instance_node", "node"},
                           {{"instance_camera", kLooks}, {"instance_light", kLooks}});
  node.X_PN = read_dae_transform(document_, element);
  std::vector<const XmlElement*> instanced;
  for (const XmlElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    const std::string_view name = child->Name();
    if (name == "node") {
      node.children.push_back(child);
    } else if (name == "instance_node") {
      document_.check_children(*child, {});
      instanced.push_back(&document_.find(*child, "url", "node"));
    } else if (name == "instance_geometry" || name == "instance_controller") {
      document_.check_children(*child, {"skeleton"}, {{"bind_material", kLooks}});
      node.placed.push_back(child);
    }
  }
  node.children.insert(node.children.end(), instanced.begin(), instanced.end());
}

DaeNode& DaeScene::enter(const XmlElement& element, const Eigen::Affine3d& X_WP) {
  budget_.spend(document_, element, 1);
  DaeNode& node = nodes_[&element];
  if (node.open) {
    document_.fail(element, "a node inside of itself, through an <instance_node>");
  }
  if (node.times == 0) {
    read_node(element, node);
    node.X_WN = X_WP * node.X_PN;
  }
  ++node.times;
  node.open = true;
  const Eigen::Affine3d X_WN = X_WP * node.X_PN;
  for (const XmlElement* instance : node.placed) {
    placements_.push_back({instance, X_WN});
  }
  budget_.spend(document_, element, node.placed.size());
  return node;
}

void DaeScene::walk(const XmlElement& root) {
  struct Step {
    DaeNode* node = nullptr;  // The map does not move its elements.
    Eigen::Affine3d X_WN;
    std::size_t next = 0;  // Index of the next child.
  };
  std::vector<Step> path;
  const auto step_into = [&](const XmlElement& element, const Eigen::Affine3d& X_WP) {
    DaeNode& node = enter(element, X_WP);
    path.push_back({&node, X_WP * node.X_PN});
  };
  step_into(root, X_WS_);
  while (!path.empty()) {
    Step& last = path.back();
    if (last.next == last.node->children.size()) {
      last.node->open = false;
      path.pop_back();
      continue;
    }
    const XmlElement& child = *last.node->children[last.next];
    ++last.next;
    const Eigen::Affine3d X_WP = last.X_WN;
    step_into(child, X_WP);
  }
}

}  // namespace firstcontact::detail
