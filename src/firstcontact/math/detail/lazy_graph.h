/// @file
/// A graph whose shortest path is kept up to date while edges are added and blocked.

#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <tuple>
#include <vector>

namespace firstcontact::detail {

/// Nodes, edges with lengths, and the shortest path from node 0 to a goal.
///
/// A search keeps what it knows of the costs. After a change it visits only nodes whose costs
/// change. Each edge makes a way longer, if only by rounding up. So places may be equal: two nodes
/// without a way from the start never pass for each other's way.
///
/// Source: S. Koenig, M. Likhachev, D. Furcy, "Lifelong Planning A*", Artificial Intelligence 155
/// (2004).
class LazyGraph {
 public:
  struct Edge {
    std::size_t a = 0;
    std::size_t b = 0;
    double length = 0.0;
    bool is_known = false;  ///< Whether it is known to be free.
    bool is_blocked = false;
  };

  /// Adds a node; the first one is the start.
  ///
  /// @param to_goal  lower bound of its distance to a goal; 0 for a goal
  std::size_t add_node(double to_goal, bool is_goal);
  /// Adds an edge between two nodes and returns its number.
  std::size_t add_edge(std::size_t a, std::size_t b, double length, bool is_known);
  void set_known(std::size_t edge) { edges_[edge].is_known = true; }
  void block(std::size_t edge);

  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  [[nodiscard]] std::size_t edge_count() const { return edges_.size(); }
  [[nodiscard]] const Edge& edge(std::size_t number) const { return edges_[number]; }
  [[nodiscard]] std::size_t other_end(std::size_t edge, std::size_t node) const {
    return edges_[edge].a == node ? edges_[edge].b : edges_[edge].a;
  }

  /// The edges of the shortest path that is not blocked, from the start on; empty where there is
  /// none.
  [[nodiscard]] std::vector<std::size_t> shortest_path();

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  struct Node {
    double to_goal = 0.0;
    double cost = kNever;    // From the start, as far as it was passed on to its neighbours.
    double ahead = kNever;   // From the start, by the costs of its neighbours.
    std::size_t by = kNone;  // Edge to the neighbour of `ahead`.
    std::vector<std::size_t> edges = {};
  };
  using Entry = std::tuple<double, double, std::size_t>;

  [[nodiscard]] Entry entry(std::size_t node) const;
  [[nodiscard]] double cost_by(std::size_t edge, std::size_t node) const;
  void offer(std::size_t node, std::size_t edge);
  void look_ahead(std::size_t node);
  void queue(std::size_t node);
  void settle(std::size_t node);
  void run();
  [[nodiscard]] std::size_t nearest_goal() const;

  std::vector<Node> nodes_;
  std::vector<Edge> edges_;
  std::vector<std::size_t> goals_;
  // Nodes whose costs differ. Entries that are out of date are left in it.
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open_;
};

}  // namespace firstcontact::detail
