#include <firstcontact/planning/detail/lazy_prm.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <queue>
#include <utility>

namespace firstcontact::detail {
namespace {

constexpr std::size_t kFirstBatch = 64;  // Number of places; each further batch is half of all so
                                         // far.
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

class Roadmap {
 public:
  Roadmap(PlanWork& work, const Configuration& start, const std::vector<Configuration>& goals)
      : work_(work), goal_count_(goals.size()) {
    add(start);
    for (const Configuration& goal : goals) {
      add(goal);
    }
  }

  FoundPath run(RandomNumbers& random) {
    std::size_t enough = std::numeric_limits<std::size_t>::max();
    while (!work_.is_over() && places_.size() < enough) {
      ++work_.counts().iterations;
      const bool had_path = best_.has_value();
      search();
      if (best_ && !had_path) {
        enough = 2 * places_.size();
      }
      work_.report(places_.size(), best_ ? std::optional(best_->cost) : std::nullopt);
      grow(random);
    }
    search();
    work_.counts().nodes = places_.size();
    FoundPath found = best_ ? FoundPath{best_->places, true} : nearest();
    if (work_.options().keep_trees) {
      found.trees.push_back(take_roadmap());
    }
    return found;
  }

 private:
  enum class Known { nothing, free, blocked };
  struct Edge {
    std::size_t a = 0;
    std::size_t b = 0;
    double length = 0.0;
    Known known = Known::nothing;
  };
  struct Best {
    double cost = 0.0;
    std::vector<Configuration> places;
  };

  [[nodiscard]] double length(std::size_t a, std::size_t b) const {
    return work_.space().distance(places_[a], places_[b]);
  }

  void add(Configuration q) {
    places_.push_back(std::move(q));
    edges_of_.emplace_back();
    const std::size_t added = places_.size() - 1;
    const double d = static_cast<double>(work_.space().is_body() ? 6 : work_.space().size());
    const double n = static_cast<double>(places_.size());
    const auto most =
        static_cast<std::size_t>(std::ceil(std::numbers::e * (1.0 + 1.0 / d) * std::log(n + 1.0)));
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t k = 0; k < added; ++k) {
      near.emplace_back(length(k, added), k);
    }
    const std::size_t count = std::min(most, near.size());
    std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end());
    near.resize(count);
    for (const auto& [distance, k] : near) {
      edges_of_[k].push_back(edges_.size());
      edges_of_[added].push_back(edges_.size());
      edges_.push_back({k, added, distance});
    }
  }

  void grow(RandomNumbers& random) {
    const std::size_t end = places_.size() + std::max(kFirstBatch, places_.size() / 2);
    while (places_.size() < end && !work_.is_over()) {
      Configuration q = work_.space().sample(random);
      if (work_.is_free(q)) {
        add(std::move(q));
      }
    }
  }

  [[nodiscard]] bool is_goal(std::size_t node) const { return node >= 1 && node <= goal_count_; }

  [[nodiscard]] double to_goal(std::size_t node) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t goal = 1; goal <= goal_count_; ++goal) {
      least = std::min(least, length(node, goal));
    }
    return least;
  }

  /// Checks the edges of the shortest path that is left until one is proven, or none is shorter.
  void search() {
    while (!work_.is_over()) {
      const std::vector<std::size_t> path = shortest_path(false);
      if (path.empty()) {
        return;
      }
      if (prove(path)) {
        Best found;
        std::size_t node = 0;
        found.places.push_back(places_[node]);
        for (const std::size_t edge : path) {
          node = other_end(edge, node);
          found.places.push_back(places_[node]);
          found.cost += edges_[edge].length;
        }
        if (!best_ || found.cost < best_->cost) {
          best_ = std::move(found);
        }
        return;
      }
    }
  }

  bool prove(const std::vector<std::size_t>& path) {
    for (const std::size_t index : path) {
      Edge& edge = edges_[index];
      if (edge.known == Known::nothing) {
        edge.known = work_.is_free(places_[edge.a], places_[edge.b]) ? Known::free : Known::blocked;
      }
      if (edge.known == Known::blocked) {
        return false;
      }
    }
    return true;
  }

  [[nodiscard]] std::size_t other_end(std::size_t edge, std::size_t node) const {
    return edges_[edge].a == node ? edges_[edge].b : edges_[edge].a;
  }

  /// The edges from the start to a goal by A*; empty where there is no path.
  ///
  /// @param proven_only  uses proven edges alone, and ends at the place nearest to a goal
  [[nodiscard]] std::vector<std::size_t> shortest_path(bool proven_only) const {
    std::vector<double> cost(places_.size(), std::numeric_limits<double>::infinity());
    std::vector<std::size_t> by(places_.size(), kNone);
    std::vector<bool> done(places_.size(), false);
    std::priority_queue<std::pair<double, std::size_t>, std::vector<std::pair<double, std::size_t>>,
                        std::greater<>>
        open;
    cost[0] = 0.0;
    open.emplace(to_goal(0), 0);
    std::size_t nearest = 0;
    double least = to_goal(0);
    while (!open.empty()) {
      const std::size_t node = open.top().second;
      open.pop();
      if (done[node]) {
        continue;
      }
      done[node] = true;
      const double left = to_goal(node);
      if (left < least) {
        least = left;
        nearest = node;
      }
      if (is_goal(node)) {
        return edges_to(node, by);
      }
      for (const std::size_t index : edges_of_[node]) {
        const Edge& edge = edges_[index];
        if (edge.known == Known::blocked || (proven_only && edge.known != Known::free)) {
          continue;
        }
        const std::size_t next = other_end(index, node);
        if (cost[node] + edge.length < cost[next]) {
          cost[next] = cost[node] + edge.length;
          by[next] = index;
          open.emplace(cost[next] + to_goal(next), next);
        }
      }
    }
    return proven_only ? edges_to(nearest, by) : std::vector<std::size_t>();
  }

  [[nodiscard]] std::vector<std::size_t> edges_to(std::size_t node,
                                                  const std::vector<std::size_t>& by) const {
    std::vector<std::size_t> edges;
    while (node != 0) {
      edges.push_back(by[node]);
      node = other_end(by[node], node);
    }
    std::reverse(edges.begin(), edges.end());
    return edges;
  }

  [[nodiscard]] FoundPath nearest() const {
    FoundPath found{{places_[0]}, false};
    std::size_t node = 0;
    for (const std::size_t edge : shortest_path(true)) {
      node = other_end(edge, node);
      found.places.push_back(places_[node]);
    }
    return found;
  }

  /// Gives the places away, with the edges that are proven.
  [[nodiscard]] SearchTree take_roadmap() {
    SearchTree roadmap{.kind = SearchTreeKind::roadmap, .places = std::move(places_)};
    for (const Edge& edge : edges_) {
      if (edge.known == Known::free) {
        roadmap.edges.push_back({edge.a, edge.b});
      }
    }
    return roadmap;
  }

  PlanWork& work_;
  std::size_t goal_count_;
  std::vector<Configuration> places_;  // The start, the goals, then samples.
  std::vector<Edge> edges_;
  std::vector<std::vector<std::size_t>> edges_of_;
  std::optional<Best> best_;
};

}  // namespace

FoundPath lazy_prm_star(PlanWork& work, const Configuration& start,
                        const std::vector<Configuration>& goals, RandomNumbers& random) {
  return Roadmap(work, start, goals).run(random);
}

}  // namespace firstcontact::detail
