#include <firstcontact/planning/detail/timed_connect.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include <firstcontact/math/detail/nearest_index.h>
#include <firstcontact/planning/detail/plan_tree.h>
#include <firstcontact/planning/detail/timed_edges.h>

namespace firstcontact::detail {
namespace {

constexpr std::size_t kRestNodes = 16;  // Number of times at which a goal is a node, while it is
                                        // free.
constexpr int kMostSteps = 32;          // Most steps of a tree towards a node of the other one.

/// Places, each with a proven edge from or to its parent; times increase or decrease along a
/// branch.
class TimedTree {
 public:
  TimedTree(const TimedEdges& edges, bool is_forward) : edges_(edges), is_forward_(is_forward) {}

  std::size_t add(TimedPlace place, std::size_t parent) {
    places_.push_back(std::move(place));
    parents_.push_back(parent);
    found_.add(places_.size() - 1, [this](std::size_t a, std::size_t b) {
      return edges_.space().distance(places_[a].q, places_[b].q);
    });
    return places_.size() - 1;
  }

  [[nodiscard]] std::size_t size() const { return places_.size(); }
  [[nodiscard]] const TimedPlace& operator[](std::size_t node) const { return places_[node]; }

  /// [s]  The time from a node to a place in the tree's direction; negative against it.
  [[nodiscard]] double time_from(const TimedPlace& node, const TimedPlace& to) const {
    return is_forward_ ? to.t - node.t : node.t - to.t;
  }

  /// [s]  The time `seconds` after a node in the tree's direction.
  [[nodiscard]] double time_on(const TimedPlace& node, double seconds) const {
    return is_forward_ ? node.t + seconds : node.t - seconds;
  }

  /// The nearest node in the space that is on the right side in time.
  [[nodiscard]] std::optional<std::size_t> nearest(const TimedPlace& to) const {
    return found_.nearest(
        [&](std::size_t node) { return edges_.space().distance(places_[node].q, to.q); },
        [&](std::size_t node) { return time_from(places_[node], to) > 0.0; });
  }

  /// The node with the least time to a place that one edge at the allowed speeds reaches.
  [[nodiscard]] std::optional<std::size_t> latest(const TimedPlace& to) const {
    std::optional<std::size_t> best;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < places_.size(); ++k) {
      const double time = time_from(places_[k], to);
      if (time > 0.0 && time < least && edges_.travel_time(places_[k].q, to.q) <= time) {
        least = time;
        best = k;
      }
    }
    return best;
  }

  [[nodiscard]] std::vector<TimedPlace> to_root(std::size_t node) const {
    std::vector<TimedPlace> places;
    for (; node != kNoParent; node = parents_[node]) {
      places.push_back(places_[node]);
    }
    return places;
  }

  /// Gives the tree away, with an edge for each place that has a parent.
  [[nodiscard]] SearchTree take() {
    SearchTree tree{.kind = is_forward_ ? SearchTreeKind::from_start : SearchTreeKind::from_goals,
                    .edges = edges_of_parents(parents_)};
    for (TimedPlace& place : places_) {
      tree.places.push_back(std::move(place.q));
      tree.times.push_back(place.t);
    }
    return tree;
  }

 private:
  const TimedEdges& edges_;
  bool is_forward_;
  std::vector<TimedPlace> places_;
  std::vector<std::size_t> parents_;
  NearestIndex found_;
};

class TimedConnect {
 public:
  TimedConnect(TimedEdges& edges, double range)
      : edges_(edges), range_(range), trees_{TimedTree(edges, true), TimedTree(edges, false)} {}

  std::vector<TimedPlace> run(const Configuration& start, const std::vector<Configuration>& goals,
                              RandomNumbers& random, const std::function<bool()>& is_over) {
    trees_[0].add({start, 0.0}, kNoParent);
    for (const Configuration& goal : goals) {
      add_rests(goal);
    }
    if (trees_[1].size() == 0) {
      return {};
    }
    std::optional<std::array<std::size_t, 2>> met = meet_at_once();
    for (std::size_t grows = 0; !met && !is_over(); grows = 1 - grows) {
      ++edges_.counts().iterations;
      met = grow(grows, {edges_.space().sample(random), edges_.duration() * random.uniform()});
    }
    edges_.counts().nodes = trees_[0].size() + trees_[1].size();
    return met ? joined(*met) : std::vector<TimedPlace>{};
  }

  /// Gives both trees away.
  [[nodiscard]] std::vector<SearchTree> take_trees() {
    return {trees_[0].take(), trees_[1].take()};
  }

 private:
  /// Adds a goal at the end, and at earlier times from which it is free until then.
  void add_rests(const Configuration& goal) {
    const double duration = edges_.duration();
    const TimedPlace end{goal, duration};
    if (edges_.at(end).verdict != Verdict::free) {
      return;
    }
    std::size_t last = trees_[1].add(end, kNoParent);
    for (std::size_t k = kRestNodes; k-- > 1;) {
      const TimedPlace earlier{goal,
                               duration * static_cast<double>(k) / static_cast<double>(kRestNodes)};
      if (!edges_.is_free(earlier, trees_[1][last])) {
        return;
      }
      last = trees_[1].add(earlier, last);
    }
  }

  /// Whether an edge leads from the start to a goal.
  std::optional<std::array<std::size_t, 2>> meet_at_once() {
    for (std::size_t node = trees_[1].size(); node-- > 0;) {
      if (edges_.is_free(trees_[0][0], trees_[1][node])) {
        return std::array{trees_[0].add(trees_[1][node], 0), node};
      }
    }
    return std::nullopt;
  }

  bool is_edge_free(std::size_t tree, const TimedPlace& node, const TimedPlace& next) {
    return tree == 0 ? edges_.is_free(node, next) : edges_.is_free(next, node);
  }

  /// The place on the way to another one that is within the range and keeps the speeds.
  [[nodiscard]] TimedPlace towards(const TimedTree& tree, const TimedPlace& from,
                                   const TimedPlace& to) const {
    const double time = tree.time_from(from, to);
    const double pace = std::max(edges_.travel_time(from.q, to.q), time);
    const double way = edges_.space().distance(from.q, to.q);
    const double share = std::min(way > range_ ? range_ / way : 1.0, time / pace);
    if (share >= 1.0) {
      return to;
    }
    return {edges_.space().interpolate(from.q, to.q, share), tree.time_on(from, share * pace)};
  }

  /// Extends a tree towards a sample, and the other one towards the added node.
  std::optional<std::array<std::size_t, 2>> grow(std::size_t grows, const TimedPlace& sample) {
    TimedTree& tree = trees_[grows];
    const std::optional<std::size_t> near = tree.nearest(sample);
    if (!near) {
      return std::nullopt;
    }
    const TimedPlace target = towards(tree, tree[*near], sample);
    if (!is_edge_free(grows, tree[*near], target)) {
      return std::nullopt;
    }
    const std::size_t added = tree.add(target, *near);
    if (const auto reached = connect(1 - grows, target)) {
      return grows == 0 ? std::array{added, *reached} : std::array{*reached, added};
    }
    return std::nullopt;
  }

  /// Grows a tree towards a place, edge by edge; returns the node there.
  std::optional<std::size_t> connect(std::size_t grows, const TimedPlace& target) {
    TimedTree& tree = trees_[grows];
    const std::optional<std::size_t> from = tree.latest(target);
    if (!from) {
      return std::nullopt;
    }
    std::size_t node = *from;
    for (int step = 0; step < kMostSteps; ++step) {
      const TimedPlace next = towards(tree, tree[node], target);
      if (!is_edge_free(grows, tree[node], next)) {
        return std::nullopt;
      }
      node = tree.add(next, node);
      if (next == target) {
        return node;
      }
    }
    return std::nullopt;
  }

  [[nodiscard]] std::vector<TimedPlace> joined(const std::array<std::size_t, 2>& met) const {
    std::vector<TimedPlace> path = trees_[0].to_root(met[0]);
    std::reverse(path.begin(), path.end());
    const std::vector<TimedPlace> rest = trees_[1].to_root(met[1]);
    path.insert(path.end(), rest.begin() + 1, rest.end());  // Both have the place where they met.
    return path;
  }

  TimedEdges& edges_;
  double range_;
  std::array<TimedTree, 2> trees_;
};

}  // namespace

TimedFound timed_connect(TimedEdges& edges, const Configuration& start,
                         const std::vector<Configuration>& goals, double range,
                         RandomNumbers& random, const std::function<bool()>& is_over,
                         bool keep_trees) {
  TimedConnect connect(edges, range);
  TimedFound found{connect.run(start, goals, random, is_over), {}};
  if (keep_trees) {
    found.trees = connect.take_trees();
  }
  return found;
}

}  // namespace firstcontact::detail
