#include <firstcontact/planning/detail/rrt_connect.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace firstcontact::detail {
namespace {

constexpr std::size_t kNoParent = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kReportEvery = 256;  // Iterations.

/// Places, each with an edge from its parent that is proven.
class PlanTree {
 public:
  explicit PlanTree(const ConfigurationSpace& space) : space_(space) {}

  std::size_t add(Configuration q, std::size_t parent) {
    places_.push_back(std::move(q));
    parents_.push_back(parent);
    return places_.size() - 1;
  }

  [[nodiscard]] std::size_t size() const { return places_.size(); }
  [[nodiscard]] const Configuration& operator[](std::size_t node) const { return places_[node]; }

  [[nodiscard]] std::size_t nearest(const Configuration& q) const {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < places_.size(); ++k) {
      const double distance = space_.distance(places_[k], q);
      if (distance < least) {
        least = distance;
        best = k;
      }
    }
    return best;
  }

  /// From a node to its root.
  [[nodiscard]] std::vector<Configuration> to_root(std::size_t node) const {
    std::vector<Configuration> places;
    for (; node != kNoParent; node = parents_[node]) {
      places.push_back(places_[node]);
    }
    return places;
  }

 private:
  const ConfigurationSpace& space_;
  std::vector<Configuration> places_;
  std::vector<std::size_t> parents_;
};

class Connect {
 public:
  Connect(PlanWork& work, double range)
      : work_(work), range_(range), trees_{PlanTree(work.space()), PlanTree(work.space())} {}

  FoundPath run(const Configuration& start, const std::vector<Configuration>& goals,
                PlanRandom& random) {
    trees_[0].add(start, kNoParent);
    for (const Configuration& goal : goals) {
      trees_[1].add(goal, kNoParent);
    }
    for (std::size_t goal = 0; goal < goals.size() && !work_.is_over(); ++goal) {
      if (work_.is_free(start, goals[goal])) {
        return joined(0, goal);
      }
    }
    std::size_t grows = 0;
    while (!work_.is_over()) {
      const std::size_t iteration = work_.counts().iterations++;
      if (iteration % kReportEvery == kReportEvery - 1) {
        work_.report(size(), std::nullopt);
      }
      if (const auto met = grow(grows, work_.space().sample(random))) {
        return joined((*met)[0], (*met)[1]);
      }
      // The lesser tree grows next: M. Kuffner's balance.
      grows = trees_[0].size() <= trees_[1].size() ? 0 : 1;
    }
    return nearest_to(goals);
  }

  [[nodiscard]] std::size_t size() const { return trees_[0].size() + trees_[1].size(); }

 private:
  /// Extends a tree towards a sample, then the other one towards what was added. The nodes of both
  /// trees at which they met.
  std::optional<std::array<std::size_t, 2>> grow(std::size_t grows, const Configuration& sample) {
    PlanTree& tree = trees_[grows];
    PlanTree& other = trees_[1 - grows];
    const std::size_t near = tree.nearest(sample);
    const double length = work_.space().distance(tree[near], sample);
    if (!(length > 0.0)) {
      return std::nullopt;
    }
    const Configuration target =
        length > range_ ? work_.space().interpolate(tree[near], sample, range_ / length) : sample;
    if (!work_.is_free(tree[near], target)) {
      return std::nullopt;
    }
    const std::size_t added = tree.add(target, near);
    const std::size_t reached = other.nearest(target);
    if (const auto met = connect(1 - grows, reached, target)) {
      return grows == 0 ? std::array{added, *met} : std::array{*met, added};
    }
    return std::nullopt;
  }

  /// Grows a tree from a node towards a target as far as it is free. The node at the target.
  std::optional<std::size_t> connect(std::size_t grows, std::size_t node,
                                     const Configuration& target) {
    PlanTree& tree = trees_[grows];
    const Configuration from = tree[node];
    const EdgeAnswer answer = work_.check(from, target);
    if (answer.verdict == EdgeVerdict::free) {
      return tree.add(target, node);
    }
    // One check proves all steps before the contact.
    const double length = work_.space().distance(from, target);
    const double free_steps = std::floor(answer.fraction * length / range_);
    std::size_t last = node;
    for (double step = 1.0; step <= free_steps; ++step) {
      last = tree.add(work_.space().interpolate(from, target, step * range_ / length), last);
    }
    return std::nullopt;
  }

  [[nodiscard]] FoundPath joined(std::size_t in_first, std::size_t in_second) const {
    FoundPath found{trees_[0].to_root(in_first), true};
    std::reverse(found.places.begin(), found.places.end());
    const std::vector<Configuration> rest = trees_[1].to_root(in_second);
    // Both trees have the place at which they met, unless the start leads straight to a goal.
    const std::size_t skip = rest.front() == found.places.back() ? 1 : 0;
    found.places.insert(found.places.end(), rest.begin() + static_cast<std::ptrdiff_t>(skip),
                        rest.end());
    return found;
  }

  [[nodiscard]] FoundPath nearest_to(const std::vector<Configuration>& goals) const {
    double least = std::numeric_limits<double>::infinity();
    std::size_t best = 0;
    for (const Configuration& goal : goals) {
      const std::size_t node = trees_[0].nearest(goal);
      const double distance = work_.space().distance(trees_[0][node], goal);
      if (distance < least) {
        least = distance;
        best = node;
      }
    }
    FoundPath found{trees_[0].to_root(best), false};
    std::reverse(found.places.begin(), found.places.end());
    return found;
  }

  PlanWork& work_;
  double range_;
  std::array<PlanTree, 2> trees_;
};

}  // namespace

FoundPath rrt_connect(PlanWork& work, const Configuration& start,
                      const std::vector<Configuration>& goals, double range, PlanRandom& random) {
  Connect connect(work, range);
  FoundPath found = connect.run(start, goals, random);
  work.counts().nodes = connect.size();
  return found;
}

}  // namespace firstcontact::detail
