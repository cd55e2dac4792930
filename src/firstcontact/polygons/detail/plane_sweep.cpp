#include <firstcontact/polygons/detail/plane_sweep.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <memory_resource>
#include <set>
#include <tuple>
#include <utility>

namespace firstcontact::detail {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;

/// The left border of the untriangulated region between two edges.
///
/// It is a chain of nodes from the lower edge to the upper one. The next point sees the newest of
/// them, `helper`.
struct Front {
  std::uint32_t bottom = kNone;
  std::uint32_t top = kNone;
  std::uint32_t helper = kNone;

  [[nodiscard]] bool is_empty() const { return bottom == kNone; }
};

/// A point on a front, and its neighbours there.
struct Node {
  std::uint32_t point = 0;
  std::uint32_t down = kNone;
  std::uint32_t up = kNone;
};

/// An edge from its left to its right end, and the region above it while the sweep is over it.
struct Edge {
  std::uint32_t left = 0;
  std::uint32_t right = 0;
  std::int64_t weight = 0;     ///< Rings to the right less rings to the left.
  std::int64_t winding = 0;    ///< Winding number above the edge.
  std::uint32_t next = kNone;  ///< Next edge with the same left end.
  Front front;
};

class Sweep {
 public:
  Sweep(std::span<const PlanePoint> points, std::span<const RingEdge> edges, WindingRule rule)
      : points_(points),
        rule_(rule),
        starting_at_(points.size(), kNone),
        status_(Order{this}, &memory_) {
    edges_.reserve(edges.size());
    nodes_.reserve(2 * edges.size());
    triangles_.reserve(edges.size());
    for (const RingEdge& edge : edges) {
      const bool to_the_right = edge.from < edge.to;
      add_edge(std::min(edge.from, edge.to), std::max(edge.from, edge.to), to_the_right ? 1 : -1);
    }
  }

  std::optional<std::vector<std::array<std::uint32_t, 3>>> run() {
    for (std::uint32_t v = 0; v < points_.size() && !failed_; ++v) {
      pass(v);
    }
    if (failed_) {
      return std::nullopt;
    }
    return std::move(triangles_);
  }

 private:
  struct Point {
    std::uint32_t number;
  };

  /// Orders edges from bottom to top. Edges in the status do not cross, so one line decides.
  struct Order {
    using is_transparent = void;
    const Sweep* sweep;
    bool operator()(std::uint32_t e, std::uint32_t f) const { return sweep->is_below(e, f); }
    bool operator()(std::uint32_t e, Point p) const { return sweep->side(e, p.number) > 0; }
    bool operator()(Point p, std::uint32_t e) const { return sweep->side(e, p.number) < 0; }
  };
  using Status = std::pmr::set<std::uint32_t, Order>;

  void add_edge(std::uint32_t left, std::uint32_t right, std::int64_t weight) {
    edges_.push_back({.left = left,
                      .right = right,
                      .weight = weight,
                      .winding = 0,
                      .next = starting_at_[left],
                      .front = {}});
    starting_at_[left] = static_cast<std::uint32_t>(edges_.size() - 1);
  }

  [[nodiscard]] int turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return orientation(points_[a], points_[b], points_[c]);
  }

  /// The side of an edge on which a point lies; 1 above.
  [[nodiscard]] int side(std::uint32_t e, std::uint32_t point) const {
    return turn(edges_[e].left, edges_[e].right, point);
  }

  [[nodiscard]] bool is_below(std::uint32_t e, std::uint32_t f) const {
    if (edges_[e].left == edges_[f].left) {
      return side(e, edges_[f].right) > 0;
    }
    return edges_[e].left < edges_[f].left ? side(e, edges_[f].left) > 0
                                           : side(f, edges_[e].left) < 0;
  }

  [[nodiscard]] bool is_inside(std::int64_t winding) const {
    return rule_ == WindingRule::any_winding ? winding != 0 : winding > 0;
  }

  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::int64_t winding) {
    triangles_.push_back(winding < 0 ? std::array{a, c, b} : std::array{a, b, c});
  }

  /// Adds the flat triangle of an edge and a point on it, which becomes the left end of the rest.
  void split(std::uint32_t left, std::uint32_t right, std::int64_t weight, std::uint32_t v) {
    triangles_.push_back(weight < 0 ? std::array{right, left, v} : std::array{left, right, v});
    add_edge(v, right, weight);
  }

  // ---- Fronts

  std::uint32_t add_node(std::uint32_t point, std::uint32_t down, std::uint32_t up) {
    const auto node = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({point, down, up});
    if (down != kNone) {
      nodes_[down].up = node;
    }
    if (up != kNone) {
      nodes_[up].down = node;
    }
    return node;
  }

  Front single(std::uint32_t v) {
    const std::uint32_t node = add_node(v, kNone, kNone);
    return {node, node, node};
  }

  /// Cuts off the triangles that v, the top of the front, sees below it.
  void cut_below(const Front& front, std::int64_t winding) {
    const std::uint32_t v = nodes_[front.top].point;
    for (;;) {
      const std::uint32_t b = nodes_[front.top].down;
      const std::uint32_t c = b == kNone ? kNone : nodes_[b].down;
      if (c == kNone || turn(v, nodes_[b].point, nodes_[c].point) <= 0) {
        return;
      }
      add_triangle(v, nodes_[b].point, nodes_[c].point, winding);
      nodes_[front.top].down = c;
      nodes_[c].up = front.top;
    }
  }

  /// Cuts off the triangles that v, the bottom of the front, sees above it.
  void cut_above(const Front& front, std::int64_t winding) {
    const std::uint32_t v = nodes_[front.bottom].point;
    for (;;) {
      const std::uint32_t b = nodes_[front.bottom].up;
      const std::uint32_t c = b == kNone ? kNone : nodes_[b].up;
      if (c == kNone || turn(v, nodes_[c].point, nodes_[b].point) <= 0) {
        return;
      }
      add_triangle(v, nodes_[c].point, nodes_[b].point, winding);
      nodes_[front.bottom].up = c;
      nodes_[c].down = front.bottom;
    }
  }

  Front with_top(Front front, std::uint32_t v, std::int64_t winding) {
    front.top = add_node(v, front.top, kNone);
    front.helper = front.top;
    cut_below(front, winding);
    return front;
  }

  Front with_bottom(Front front, std::uint32_t v, std::int64_t winding) {
    front.bottom = add_node(v, kNone, front.bottom);
    front.helper = front.bottom;
    cut_above(front, winding);
    return front;
  }

  /// Splits a front at a diagonal from v to the helper: the fronts below and above it.
  std::pair<Front, Front> split_front(const Front& front, std::uint32_t v, std::int64_t winding) {
    const std::uint32_t helper = front.helper;
    const std::uint32_t above = nodes_[helper].up;
    const std::uint32_t twin = add_node(nodes_[helper].point, kNone, above);
    nodes_[helper].up = kNone;
    const Front lower{front.bottom, helper, helper};
    const Front upper{twin, front.top == helper ? twin : front.top, twin};
    return {with_top(lower, v, winding), with_bottom(upper, v, winding)};
  }

  /// Joins the fronts of two gaps at v, the top of the lower and the bottom of the upper one.
  Front joined(const Front& lower, const Front& upper) {
    const std::uint32_t above = nodes_[upper.bottom].up;
    nodes_[lower.top].up = above;
    if (above != kNone) {
      nodes_[above].down = lower.top;
    }
    return {lower.bottom, upper.top == upper.bottom ? lower.top : upper.top, lower.top};
  }

  /// Closes a gap whose two edges end at v.
  void close(const Front& front, std::uint32_t v, std::int64_t winding) {
    const Front closed = with_bottom(front, v, winding);
    // Seen from the other side, v is above the top, too.
    const Front turned = with_top(closed, v, winding);
    failed_ = failed_ || nodes_[nodes_[turned.top].down].down != turned.bottom;
  }

  // ---- Edges

  /// Whether edge e, next below f, comes to lie above f.
  [[nodiscard]] bool cross(std::uint32_t e, std::uint32_t f) const {
    const std::uint32_t e_right = edges_[e].right;
    const std::uint32_t f_right = edges_[f].right;
    return e_right > f_right ? side(e, f_right) < 0 : e_right < f_right && side(f, e_right) > 0;
  }

  void check_neighbours(Status::const_iterator below, Status::const_iterator above) {
    failed_ =
        failed_ || (below != status_.end() && above != status_.end() && cross(*below, *above));
  }

  /// The edges that start at v, from bottom to top; edges that lie on each other are one edge.
  std::vector<std::uint32_t> starting_edges(std::uint32_t v) {
    starting_.clear();
    for (std::uint32_t e = starting_at_[v]; e != kNone; e = edges_[e].next) {
      starting_.push_back(e);
    }
    std::sort(starting_.begin(), starting_.end(), [&](std::uint32_t e, std::uint32_t f) {
      const int turned = turn(v, edges_[e].right, edges_[f].right);
      return turned != 0 ? turned > 0 : edges_[e].right < edges_[f].right;
    });
    std::vector<std::uint32_t> distinct;
    for (const std::uint32_t e : starting_) {
      if (distinct.empty() || turn(v, edges_[distinct.back()].right, edges_[e].right) != 0) {
        distinct.push_back(e);
        continue;
      }
      Edge& shorter = edges_[distinct.back()];
      const std::int64_t weight = edges_[e].weight;
      shorter.weight += weight;
      if (const std::uint32_t end = shorter.right; end != edges_[e].right) {
        split(v, edges_[e].right, weight, end);
      }
    }
    return distinct;
  }

  /// Ends the edges that end at v or that v lies on. Returns the front above the topmost of them.
  Front end_edges(Status::iterator first, Status::iterator last, std::uint32_t v) {
    Front above;
    for (auto it = first; it != last; ++it) {
      const Edge edge = edges_[*it];
      if (edge.right != v) {
        split(edge.left, edge.right, edge.weight, v);
      }
      above = edge.front;
      if (std::next(it) != last && !edge.front.is_empty()) {
        close(edge.front, v, edge.winding);
      }
    }
    status_.erase(first, last);
    return above;
  }

  /// Puts the edges that start at v between the fronts below and above it.
  void start_edges(const std::vector<std::uint32_t>& starting, Status::iterator next,
                   std::int64_t winding, const Front& above, std::uint32_t v) {
    for (const std::uint32_t e : starting) {
      Edge& edge = edges_[e];
      edge.winding = winding + edge.weight;
      failed_ = failed_ || (rule_ == WindingRule::positive_winding && edge.winding < 0);
      if (!is_inside(winding) && !is_inside(edge.winding)) {
        triangles_.push_back({edge.left, edge.right, edge.right});
      }
      winding = edge.winding;
      edge.front = e == starting.back() ? above : is_inside(winding) ? single(v) : Front{};
      status_.insert(next, e);
    }
  }

  void pass(std::uint32_t v) {
    const auto [first, last] = status_.equal_range(Point{v});
    const bool is_hit = first != last;
    const auto below = first == status_.begin() ? status_.end() : std::prev(first);
    const std::int64_t winding = below == status_.end() ? 0 : edges_[*below].winding;
    const std::int64_t winding_above = is_hit ? edges_[*std::prev(last)].winding : winding;
    Front lower = below == status_.end() ? Front{} : edges_[*below].front;
    Front upper = end_edges(first, last, v);
    if (is_hit) {
      lower = lower.is_empty() ? lower : with_top(lower, v, winding);
      upper = upper.is_empty() ? upper : with_bottom(upper, v, winding_above);
    } else if (!lower.is_empty()) {
      std::tie(lower, upper) = split_front(lower, v, winding);
    }
    const std::vector<std::uint32_t> starting = starting_edges(v);
    if (starting.empty() && !lower.is_empty() && !upper.is_empty()) {
      lower = joined(lower, upper);
    }
    if (below != status_.end()) {
      edges_[*below].front = lower;
    }
    start_edges(starting, last, winding, upper, v);
    check_neighbours(below, below == status_.end() ? status_.begin() : std::next(below));
    check_neighbours(last == status_.begin() ? status_.end() : std::prev(last), last);
  }

  std::span<const PlanePoint> points_;
  WindingRule rule_;
  std::vector<Edge> edges_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> starting_at_;  ///< The first edge with this left end.
  std::vector<std::uint32_t> starting_;
  std::pmr::monotonic_buffer_resource memory_;
  Status status_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  bool failed_ = false;
};

}  // namespace

std::optional<std::vector<std::array<std::uint32_t, 3>>> triangulate_rings(
    std::span<const PlanePoint> points, std::span<const RingEdge> edges, WindingRule rule) {
  return Sweep(points, edges, rule).run();
}

}  // namespace firstcontact::detail
