/// @file
/// Trees in narrow passages, which other trees take over when they reach one.

#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/math/random_numbers.h>
#include <firstcontact/planning/detail/plan_tree.h>

namespace firstcontact::detail {

/// Small trees that begin at tight places. Their edges lead both ways.
class PassageTrees {
 public:
  /// A node of one of the trees.
  struct Node {
    std::size_t passage = 0;
    std::size_t node = 0;
  };

  void add(PlanTree tree) { passages_.push_back({std::move(tree), {}, {}}); }

  [[nodiscard]] std::size_t size() const { return passages_.size(); }
  [[nodiscard]] const Configuration& operator[](const Node& at) const {
    return passages_[at.passage].tree[at.node];
  }

  /// The tree, 0 or 1, that has taken a passage over.
  [[nodiscard]] std::optional<std::size_t> owner(std::size_t passage) const {
    return passages_[passage].owner;
  }
  /// The node of the owner at the place of a node.
  [[nodiscard]] std::size_t in_owner(const Node& at) const {
    return passages_[at.passage].in_owner[at.node];
  }

  /// [-]  The distance of a place from the passages, by the length of the space; infinite without
  /// any.
  [[nodiscard]] double distance(const ConfigurationSpace& space, const Configuration& q) const;

  /// A node of a passage that a tree does not have, as a target for it.
  ///
  /// The passage is random, or the nearest to a place.
  [[nodiscard]] std::optional<Node> draw(const ConfigurationSpace& space, std::size_t tree,
                                         const Configuration& near, RandomNumbers& random) const;

  /// Lets a tree take over the passage of a node that it has reached.
  ///
  /// @param at  the node of the tree that is at the same place
  void give(const Node& reached, PlanTree& tree, std::size_t at, std::size_t owner);

 private:
  struct Passage {
    PlanTree tree;
    std::optional<std::size_t> owner;
    std::vector<std::size_t> in_owner;
  };
  std::vector<Passage> passages_;
};

}  // namespace firstcontact::detail
