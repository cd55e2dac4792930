#include <firstcontact/planning/detail/lazy_prm.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <firstcontact/math/detail/lazy_graph.h>
#include <firstcontact/math/detail/nearest_index.h>
#include <firstcontact/planning/detail/rrt_connect.h>
#include <firstcontact/planning/detail/shorten_path.h>

namespace firstcontact::detail {
namespace {

constexpr std::size_t kFirstBatch = 64;      // Number of places; each further batch is half of all
                                             // so far.
constexpr std::size_t kFewestPlaces = 1000;  // Below this number the graph is not dense enough.
constexpr double kWorthwhile = 0.01;         // [-]  Part of the cost that is worth more work.
constexpr std::size_t kTriesOfSample = 20'000;
constexpr std::size_t kPathsWithoutGain = 4;  // Paths of RRT-Connect in a row without a gain.

class Roadmap {
 public:
  Roadmap(PlanWork& work, const Configuration& start, const std::vector<Configuration>& goals)
      : work_(work), goals_(goals) {
    add(start, false);
    for (const Configuration& goal : goals) {
      add(goal, true);
    }
  }

  /// Takes a proven path to a goal into the graph.
  void take(const std::vector<Configuration>& path) {
    std::size_t last = 0;
    for (std::size_t k = 1; k < path.size(); ++k) {
      const auto goal = std::ranges::find(goals_, path[k]);
      const bool is_end = k + 1 == path.size() && goal != goals_.end();
      const std::size_t node =
          is_end ? 1 + static_cast<std::size_t>(goal - goals_.begin()) : add(path[k], false);
      graph_.add_edge(last, node, length(last, node), true);
      last = node;
    }
  }

  /// Grows the graph until its shortest path stays, and returns the path.
  std::vector<Configuration> run(RandomNumbers& random) {
    double known = std::numeric_limits<double>::infinity();
    std::size_t at = 0;  // Number of places at the last worthwhile gain.
    while (!work_.is_over()) {
      ++work_.counts().iterations;
      search();
      if (cost_ < (1.0 - kWorthwhile) * known) {
        known = cost_;
        at = places_.size();
      }
      work_.report(places_.size(), cost_);
      if (places_.size() >= std::max(kFewestPlaces, 2 * at) || !grow(random)) {
        break;
      }
    }
    work_.counts().nodes += places_.size();
    return best_;
  }

  /// Gives the places away, with the edges that are proven.
  [[nodiscard]] SearchTree take_places() {
    SearchTree roadmap{.kind = SearchTreeKind::roadmap, .places = std::move(places_)};
    for (std::size_t number = 0; number < graph_.edge_count(); ++number) {
      const LazyGraph::Edge& edge = graph_.edge(number);
      if (edge.is_known && !edge.is_blocked) {
        roadmap.edges.push_back({edge.a, edge.b});
      }
    }
    return roadmap;
  }

 private:
  [[nodiscard]] double length(std::size_t a, std::size_t b) const {
    return work_.space().distance(places_[a], places_[b]);
  }

  [[nodiscard]] double to_goal(const Configuration& q) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Configuration& goal : goals_) {
      least = std::min(least, work_.space().distance(q, goal));
    }
    return least;
  }

  /// Adds a place with edges to its nearest ones.
  std::size_t add(const Configuration& q, bool is_goal) {
    const std::size_t added = graph_.add_node(is_goal ? 0.0 : to_goal(q), is_goal);
    places_.push_back(q);
    const double d = static_cast<double>(work_.space().dimension());
    const double n = static_cast<double>(places_.size());
    const auto most =
        static_cast<std::size_t>(std::ceil(std::numbers::e * (1.0 + 1.0 / d) * std::log(n + 1.0)));
    const auto near = index_.nearest_few(
        most, [&](std::size_t node) { return length(node, added); },
        [](std::size_t) { return true; });
    for (const std::size_t node : near) {
      graph_.add_edge(node, added, length(node, added), false);
    }
    index_.add(added, [&](std::size_t a, std::size_t b) { return length(a, b); });
    return added;
  }

  /// Adds a batch of places that could be on a shorter path; false where samples have none.
  bool grow(RandomNumbers& random) {
    const std::size_t end = places_.size() + std::max(kFirstBatch, places_.size() / 2);
    std::size_t tries = 0;
    while (places_.size() < end && tries < kTriesOfSample && !work_.is_over()) {
      ++tries;
      const Configuration q = work_.space().sample(random);
      if (work_.space().distance(places_[0], q) + to_goal(q) < cost_ && work_.is_free(q)) {
        add(q, false);
        tries = 0;
      }
    }
    return tries < kTriesOfSample;
  }

  /// Checks the edges of the shortest path that is left until one is proven.
  void search() {
    while (!work_.is_over()) {
      const std::vector<std::size_t> path = graph_.shortest_path();
      if (path.empty()) {
        return;
      }
      if (!prove(path)) {
        continue;
      }
      std::vector<Configuration> places{places_[0]};
      double cost = 0.0;
      std::size_t node = 0;
      for (const std::size_t edge : path) {
        node = graph_.other_end(edge, node);
        places.push_back(places_[node]);
        cost += graph_.edge(edge).length;
      }
      if (cost < cost_) {
        cost_ = cost;
        best_ = std::move(places);
      }
      return;
    }
  }

  bool prove(const std::vector<std::size_t>& path) {
    for (const std::size_t number : path) {
      const LazyGraph::Edge& edge = graph_.edge(number);
      if (edge.is_known) {
        continue;
      }
      if (work_.is_over()) {
        return false;
      }
      if (!work_.is_free(places_[edge.a], places_[edge.b])) {
        graph_.block(number);
        return false;
      }
      graph_.set_known(number);
    }
    return true;
  }

  PlanWork& work_;
  const std::vector<Configuration>& goals_;
  std::vector<Configuration> places_;  // The start, the goals, then others.
  NearestIndex index_;
  LazyGraph graph_;
  std::vector<Configuration> best_;
  double cost_ = std::numeric_limits<double>::infinity();
};

}  // namespace

FoundPath lazy_prm_star(PlanWork& work, const Configuration& start,
                        const std::vector<Configuration>& goals, double range,
                        RandomNumbers& random) {
  FoundPath best{{start}, false};
  Roadmap roadmap(work, start, goals);
  std::size_t waited = 0;  // Paths in a row that are not shorter.
  while (waited < kPathsWithoutGain && !work.is_over()) {
    FoundPath next = rrt_connect(work, start, goals, range, random);
    if (!next.reaches_goal) {
      if (!best.reaches_goal) {
        best = std::move(next);
      }
      break;
    }
    shorten_path(work, next.places, work.options().shortcuts, random);
    roadmap.take(next.places);
    const double cost = cost_of(work.space(), next.places);
    const double known = best.reaches_goal ? cost_of(work.space(), best.places)
                                           : std::numeric_limits<double>::infinity();
    waited = cost < (1.0 - kWorthwhile) * known ? 0 : waited + 1;
    if (cost < known) {
      best = std::move(next);
    }
    work.report(work.counts().nodes, std::min(cost, known));
  }
  if (!best.reaches_goal) {
    return best;
  }
  std::vector<Configuration> shorter = roadmap.run(random);
  if (!shorter.empty() && cost_of(work.space(), shorter) < cost_of(work.space(), best.places)) {
    best.places = std::move(shorter);
  }
  best.trees.clear();  // The roadmap stands in their place.
  if (work.options().keep_trees) {
    best.trees.push_back(roadmap.take_places());
  }
  return best;
}

}  // namespace firstcontact::detail
