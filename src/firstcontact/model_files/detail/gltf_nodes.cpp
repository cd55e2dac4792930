#include <firstcontact/model_files/detail/gltf_nodes.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include <firstcontact/model_files/detail/gltf_transform.h>
#include <firstcontact/text/parse_error.h>

namespace firstcontact::detail {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/// The children and the parent of each node.
struct Family {
  std::vector<std::vector<std::size_t>> children;
  std::vector<std::size_t> parent;  ///< kNone for a root.
};

Family find_family(const GltfDocument& document) {
  const JsonArray& nodes = document.all(GltfArray::nodes);
  Family family{std::vector<std::vector<std::size_t>>(nodes.size()),
                std::vector<std::size_t>(nodes.size(), kNone)};
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    const JsonObject& object = document.checked(nodes[node], GltfObject::node, place_of_node(node));
    const JsonValue* const children = find(object, "children");
    if (children == nullptr) {
      continue;
    }
    for (const JsonValue& value : document.array(*children)) {
      const std::size_t child = document.index(value, GltfArray::nodes);
      if (family.parent[child] != kNone) {
        document.fail(value, "expected one parent of each node, got node " + std::to_string(child) +
                                 " below node " + std::to_string(family.parent[child]) +
                                 " and node " + std::to_string(node));
      }
      family.parent[child] = node;
      family.children[node].push_back(child);
    }
  }
  return family;
}

/// Lists the nodes below some roots, with the roots. No root is above another.
std::vector<std::size_t> walk(const Family& family, const std::vector<std::size_t>& roots) {
  std::vector<std::size_t> order;
  std::vector<std::size_t> open(roots.rbegin(), roots.rend());
  while (!open.empty()) {
    const std::size_t node = open.back();
    open.pop_back();
    order.push_back(node);
    open.insert(open.end(), family.children[node].rbegin(), family.children[node].rend());
  }
  return order;
}

std::vector<std::size_t> roots_of(const Family& family) {
  std::vector<std::size_t> roots;
  for (std::size_t node = 0; node < family.parent.size(); ++node) {
    if (family.parent[node] == kNone) {
      roots.push_back(node);
    }
  }
  return roots;
}

std::vector<Eigen::Affine3d> place(const GltfDocument& document, const Family& family) {
  const JsonArray& nodes = document.all(GltfArray::nodes);
  std::vector<Eigen::Affine3d> X_WN(nodes.size(), Eigen::Affine3d::Identity());
  std::vector<bool> reached(nodes.size(), false);
  for (const std::size_t node : walk(family, roots_of(family))) {
    const Eigen::Affine3d X_PN = node_transform(document, nodes[node]);
    const std::size_t parent = family.parent[node];
    X_WN[node] = parent == kNone ? X_PN : X_WN[parent] * X_PN;
    reached[node] = true;
  }
  const auto ring = std::find(reached.begin(), reached.end(), false);
  if (ring != reached.end()) {
    document.fail(nodes[static_cast<std::size_t>(ring - reached.begin())],
                  "expected a tree of nodes, got a node that is inside of itself");
  }
  return X_WN;
}

/// Finds the scene that is read; none where the document has no scenes.
std::optional<std::size_t> chosen_scene(const GltfDocument& document) {
  const JsonArray& scenes = document.all(GltfArray::scenes);
  if (const JsonValue* const scene = find(document.root(), "scene")) {
    return document.index(*scene, GltfArray::scenes);
  }
  if (scenes.empty()) {
    return std::nullopt;
  }
  if (scenes.size() > 1) {
    document.log().warn(ParseError(document.log().path(), scenes.front().line,
                                   "the file does not say which of its " +
                                       std::to_string(scenes.size()) +
                                       " scenes is shown (`scene`): the first is read"));
  }
  return 0;
}

std::vector<std::size_t> roots_of_scene(const GltfDocument& document, const Family& family,
                                        std::size_t scene) {
  const JsonValue& where = document.all(GltfArray::scenes)[scene];
  const JsonObject& object =
      document.checked(where, GltfObject::scene, "scenes[" + std::to_string(scene) + "]");
  std::vector<std::size_t> roots;
  std::vector<bool> seen(family.parent.size(), false);
  const JsonValue* const nodes = find(object, "nodes");
  if (nodes == nullptr) {
    return roots;
  }
  for (const JsonValue& value : document.array(*nodes)) {
    const std::size_t node = document.index(value, GltfArray::nodes);
    if (family.parent[node] != kNone) {
      document.fail(value, "expected a root, got node " + std::to_string(node) +
                               ", which is below node " + std::to_string(family.parent[node]));
    }
    if (seen[node]) {
      document.fail(value, "expected each root once, got node " + std::to_string(node) + " again");
    }
    seen[node] = true;
    roots.push_back(node);
  }
  return roots;
}

void warn_of_nodes_outside(const GltfDocument& document, const std::vector<std::size_t>& inside,
                           const std::string& scene) {
  const JsonArray& nodes = document.all(GltfArray::nodes);
  std::vector<bool> is_inside(nodes.size(), false);
  for (const std::size_t node : inside) {
    is_inside[node] = true;
  }
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    if (is_inside[node] || find(document.object(nodes[node]), "mesh") == nullptr) {
      continue;
    }
    document.log().leave_out("node with a mesh", "outside of the scene that is shown");
    document.log().warn(
        ParseError(document.log().path(), nodes[node].line,
                   place_of_node(node) + ": its mesh is left out, as it is not in " + scene +
                       ", the scene that is read"),
        "outside of the scene");
  }
}

}  // namespace

std::string place_of_node(std::size_t node) {
  std::string text = "nodes[";
  text += std::to_string(node);
  text += ']';
  return text;
}

GltfNodes place_nodes(const GltfDocument& document) {
  const Family family = find_family(document);
  GltfNodes nodes;
  nodes.X_WN = place(document, family);
  const std::optional<std::size_t> scene = chosen_scene(document);
  if (!scene) {
    nodes.scene = walk(family, roots_of(family));
    return nodes;
  }
  nodes.scene = walk(family, roots_of_scene(document, family, *scene));
  warn_of_nodes_outside(document, nodes.scene, "scenes[" + std::to_string(*scene) + "]");
  return nodes;
}

}  // namespace firstcontact::detail
