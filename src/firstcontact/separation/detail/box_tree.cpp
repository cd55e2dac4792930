#include <firstcontact/separation/detail/box_tree.h>

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>

namespace firstcontact::detail {
namespace {

/// [-]  Factor that covers a few roundings of a length.
constexpr double kUp = 1.0 + 0x1p-48;

class Builder {
 public:
  Builder(const Mesh& mesh, const Eigen::Vector3d& p_BC) {
    tree_.triangles.reserve(mesh.triangles.size());
    for (const auto& corners : mesh.triangles) {
      auto& triangle = tree_.triangles.emplace_back();
      std::transform(corners.begin(), corners.end(), triangle.begin(),
                     [&](std::uint32_t v) -> Eigen::Vector3d { return mesh.vertices[v] - p_BC; });
    }
  }

  BoxTree build() {
    tree_.nodes.reserve(2 * tree_.triangles.size());
    tree_.nodes.emplace_back();
    fill(0, 0, tree_.triangles.size());
    return std::move(tree_);
  }

 private:
  using Triangle = std::array<Eigen::Vector3d, 3>;

  /// Fills the node over the triangles from `begin` to `end`; halves them along their greatest
  /// spread.
  void fill(std::size_t node, std::size_t begin, std::size_t end) {
    Triangle* const first = tree_.triangles.data();
    Eigen::AlignedBox3d box;
    Eigen::AlignedBox3d middles;
    for (std::size_t k = begin; k < end; ++k) {
      for (const Eigen::Vector3d& corner : first[k]) {
        box.extend(corner);
      }
      middles.extend(middle(first[k]));
    }
    const bool is_leaf = end - begin == 1;
    const std::size_t child = is_leaf ? begin : tree_.nodes.size();
    tree_.nodes[node] = node_around(box, is_leaf, static_cast<std::uint32_t>(child));
    if (is_leaf) {
      return;
    }
    Eigen::Index axis = 0;
    (void)middles.sizes().maxCoeff(&axis);
    const std::size_t half = begin + (end - begin) / 2;
    std::nth_element(
        first + begin, first + half, first + end,
        [axis](const Triangle& a, const Triangle& b) { return middle(a)[axis] < middle(b)[axis]; });
    tree_.nodes.resize(child + 2);
    fill(child, begin, half);
    fill(child + 1, half, end);
  }

  static Eigen::Vector3d middle(const Triangle& t) { return (t[0] + t[1] + t[2]) / 3.0; }

  static BoxNode node_around(const Eigen::AlignedBox3d& box, bool is_leaf, std::uint32_t first) {
    BoxNode node;
    node.centre = box.center();
    node.extent = kUp * (box.max() - node.centre).cwiseMax(node.centre - box.min());
    node.reach = kUp * (node.centre.cwiseAbs() + node.extent).norm();
    node.is_leaf = is_leaf;
    node.first = first;
    return node;
  }

  BoxTree tree_;
};

}  // namespace

BoxTree build_box_tree(const Mesh& mesh, const Eigen::Vector3d& p_BC) {
  return Builder(mesh, p_BC).build();
}

BoxTree build_box_tree(const Shape& shape, const Eigen::Vector3d& p_BC) {
  BoxTree tree = build_box_tree(shape.mesh(), p_BC);
  if (shape.is_curved()) {
    tree.nodes.resize(1);
    tree.nodes.front().is_leaf = true;
    tree.triangles.clear();
  }
  return tree;
}

}  // namespace firstcontact::detail
