#include <firstcontact/math/detail/lazy_graph.h>

#include <algorithm>
#include <cmath>

namespace firstcontact::detail {

std::size_t LazyGraph::add_node(double to_goal, bool is_goal) {
  const std::size_t added = nodes_.size();
  nodes_.push_back({.to_goal = to_goal});
  if (is_goal) {
    goals_.push_back(added);
  }
  if (added == 0) {
    nodes_[0].ahead = 0.0;
    queue(0);
  }
  return added;
}

std::size_t LazyGraph::add_edge(std::size_t a, std::size_t b, double length, bool is_known) {
  const std::size_t added = edges_.size();
  edges_.push_back({a, b, length, is_known});
  nodes_[a].edges.push_back(added);
  nodes_[b].edges.push_back(added);
  offer(a, added);
  offer(b, added);
  return added;
}

void LazyGraph::block(std::size_t edge) {
  edges_[edge].is_blocked = true;
  for (const std::size_t node : {edges_[edge].a, edges_[edge].b}) {
    if (nodes_[node].by == edge) {
      look_ahead(node);
    }
  }
}

LazyGraph::Entry LazyGraph::entry(std::size_t node) const {
  const double cost = std::min(nodes_[node].cost, nodes_[node].ahead);
  return {cost + nodes_[node].to_goal, cost, node};
}

/// The cost of a node by one of its edges: more than that of the other end, also where the edge is
/// too short to change the sum.
double LazyGraph::cost_by(std::size_t edge, std::size_t node) const {
  const double cost = nodes_[other_end(edge, node)].cost;
  return std::max(cost + edges_[edge].length, std::nextafter(cost, kNever));
}

/// Takes an edge to a node if it makes its way shorter.
void LazyGraph::offer(std::size_t node, std::size_t edge) {
  const double cost = cost_by(edge, node);
  if (node != 0 && !edges_[edge].is_blocked && cost < nodes_[node].ahead) {
    nodes_[node].ahead = cost;
    nodes_[node].by = edge;
    queue(node);
  }
}

/// Finds the shortest way to a node by the costs of all its neighbours.
void LazyGraph::look_ahead(std::size_t node) {
  if (node == 0) {
    return;
  }
  nodes_[node].ahead = kNever;
  nodes_[node].by = kNone;
  for (const std::size_t edge : nodes_[node].edges) {
    const double cost = cost_by(edge, node);
    if (!edges_[edge].is_blocked && cost < nodes_[node].ahead) {
      nodes_[node].ahead = cost;
      nodes_[node].by = edge;
    }
  }
  queue(node);
}

void LazyGraph::queue(std::size_t node) {
  if (nodes_[node].cost != nodes_[node].ahead) {
    open_.push(entry(node));
  }
}

/// Passes the cost of a node on to its neighbours.
void LazyGraph::settle(std::size_t node) {
  Node& settled = nodes_[node];
  if (settled.ahead < settled.cost) {
    settled.cost = settled.ahead;
    for (const std::size_t edge : settled.edges) {
      offer(other_end(edge, node), edge);
    }
    return;
  }
  settled.cost = kNever;
  queue(node);
  for (const std::size_t edge : settled.edges) {
    const std::size_t next = other_end(edge, node);
    if (nodes_[next].by == edge) {
      look_ahead(next);
    }
  }
}

std::size_t LazyGraph::nearest_goal() const {
  return *std::ranges::min_element(goals_, {}, [&](std::size_t goal) {
    return std::min(nodes_[goal].cost, nodes_[goal].ahead);
  });
}

void LazyGraph::run() {
  while (!open_.empty()) {
    const Entry top = open_.top();
    const std::size_t node = std::get<2>(top);
    const bool is_current = nodes_[node].cost != nodes_[node].ahead && top == entry(node);
    if (is_current) {
      const Node& goal = nodes_[nearest_goal()];
      if (goal.cost == goal.ahead && std::get<0>(top) > goal.cost) {
        return;
      }
    }
    open_.pop();
    if (is_current) {
      settle(node);
    }
  }
}

std::vector<std::size_t> LazyGraph::shortest_path() {
  run();
  std::size_t node = nearest_goal();
  std::vector<std::size_t> path;
  if (!(nodes_[node].cost < kNever)) {
    return path;
  }
  while (node != 0) {
    path.push_back(nodes_[node].by);
    node = other_end(nodes_[node].by, node);
  }
  std::ranges::reverse(path);
  return path;
}

}  // namespace firstcontact::detail
