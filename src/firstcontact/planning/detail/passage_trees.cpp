#include <firstcontact/planning/detail/passage_trees.h>

#include <algorithm>
#include <limits>

namespace firstcontact::detail {

double PassageTrees::distance(const ConfigurationSpace& space, const Configuration& q) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Passage& passage : passages_) {
    least = std::min(least, space.distance(passage.tree[passage.tree.nearest(q)], q));
  }
  return least;
}

std::optional<PassageTrees::Node> PassageTrees::draw(const ConfigurationSpace& space,
                                                     std::size_t tree, const Configuration& near,
                                                     RandomNumbers& random) const {
  std::vector<std::size_t> open;
  for (std::size_t k = 0; k < passages_.size(); ++k) {
    if (passages_[k].owner != tree) {
      open.push_back(k);
    }
  }
  if (open.empty()) {
    return std::nullopt;
  }
  if (random.below(2) == 0) {
    const std::size_t k = open[random.below(open.size())];
    return Node{k, random.below(passages_[k].tree.size())};
  }
  Node best;
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t k : open) {
    const std::size_t node = passages_[k].tree.nearest(near);
    const double distance = space.distance(passages_[k].tree[node], near);
    if (distance < least) {
      least = distance;
      best = {k, node};
    }
  }
  return best;
}

void PassageTrees::give(const Node& reached, PlanTree& tree, std::size_t at, std::size_t owner) {
  Passage& passage = passages_[reached.passage];
  passage.owner = owner;
  passage.in_owner.assign(passage.tree.size(), kNoParent);
  passage.in_owner[reached.node] = at;
  // From the node up to the root, then down: parents have lower numbers than their children.
  std::size_t below = reached.node;
  for (std::size_t node = passage.tree.parent(below); node != kNoParent;
       node = passage.tree.parent(node)) {
    passage.in_owner[node] = tree.add(passage.tree[node], passage.in_owner[below]);
    below = node;
  }
  for (std::size_t node = 0; node < passage.tree.size(); ++node) {
    if (passage.in_owner[node] == kNoParent) {
      passage.in_owner[node] =
          tree.add(passage.tree[node], passage.in_owner[passage.tree.parent(node)]);
    }
  }
  for (const std::size_t node : passage.tree.marked()) {
    tree.mark(passage.in_owner[node]);
  }
}

}  // namespace firstcontact::detail
