#include <firstcontact/planning/detail/rrt_connect.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <firstcontact/planning/detail/contact_growth.h>
#include <firstcontact/planning/detail/plan_range.h>
#include <firstcontact/planning/detail/plan_tree.h>

namespace firstcontact::detail {
namespace {

constexpr std::size_t kTriesToLeave = 8;   // Number of edges before pushes, and before a tree is
                                           // stuck.
constexpr std::size_t kReportEvery = 256;  // Number of iterations.

/// [-]  The domain of a place with a blocked edge, in ranges.
///
/// Places beside obstacles are the nearest to many samples behind these, which lead nowhere. Once
/// edges are followed along contacts, a blocked edge is useful, and domains do not count.
///
/// Source: A. Yershova, L. Jaillet, T. Simeon, S. M. LaValle, "Dynamic-domain RRTs: efficient
/// exploration by controlling the sampling domain", ICRA 2005.
///
/// A range below the default does not shorten it. Few samples would then count, and each costs a
/// search for the nearest place.
constexpr double kDomain = 3.0;

class Connect {
 public:
  Connect(PlanWork& work, double range)
      : work_(work),
        range_(range),
        domain_(kDomain * std::max(range, default_range(work.space()))),
        trees_{PlanTree(work.space()), PlanTree(work.space())},
        contact_(work, work.options().contacts, range) {}

  FoundPath run(const Configuration& start, const std::vector<Configuration>& goals,
                RandomNumbers& random) {
    trees_[0].mark(trees_[0].add(start, kNoParent));
    for (const Configuration& goal : goals) {
      trees_[1].mark(trees_[1].add(goal, kNoParent));
    }
    for (std::size_t goal = 0; goal < goals.size() && !work_.is_over(); ++goal) {
      if (work_.is_free(start, goals[goal])) {
        return joined({0, goal});
      }
    }
    roots_ = {trees_[0].size(), trees_[1].size()};
    std::size_t grows = 0;
    while (!work_.is_over()) {
      const std::size_t iteration = work_.counts().iterations++;
      if (iteration % kReportEvery == kReportEvery - 1) {
        work_.report(size(), std::nullopt);
      }
      if (tries_ >= kTriesToLeave && !has_left_) {
        has_left_ = true;
        for (std::size_t tree = 0; tree < 2; ++tree) {
          if (const auto met = leave(tree)) {
            return joined(*met);
          }
        }
      }
      const bool is_stuck =
          tries_ >= kTriesToLeave && trees_[grows].size() == roots_[grows] + pushed_[grows];
      contact_.next(is_stuck);
      if (const auto met = grow(grows, work_.space().sample(random))) {
        return joined(*met);
      }
      if (const auto met = push(grows)) {
        return joined(*met);
      }
      if (const auto met = reach_passage(grows)) {
        return joined(*met);
      }
      // The smaller tree grows next: J. Kuffner's balance.
      grows = trees_[0].size() <= trees_[1].size() ? 0 : 1;
    }
    return nearest_to(goals);
  }

  [[nodiscard]] std::size_t size() const { return trees_[0].size() + trees_[1].size(); }

  /// Gives both trees away.
  [[nodiscard]] std::vector<SearchTree> take_trees() {
    return {trees_[0].take(SearchTreeKind::from_start), trees_[1].take(SearchTreeKind::from_goals)};
  }

 private:
  /// The nodes of both trees at which they met.
  using Meeting = std::array<std::size_t, 2>;

  /// Extends a tree towards a sample, then the other one towards the added node.
  std::optional<Meeting> grow(std::size_t grows, const Configuration& sample) {
    PlanTree& tree = trees_[grows];
    const std::size_t near = tree.nearest(sample);
    const double length = work_.space().distance(tree[near], sample);
    if (!(length > 0.0) || (length > tree.domain(near) && !contact_.has_begun())) {
      return std::nullopt;
    }
    const Configuration target =
        length > range_ ? work_.space().interpolate(tree[near], sample, range_ / length) : sample;
    ++tries_;
    if (work_.is_free(tree[near], target)) {
      return meet(grows, tree.add(target, near));
    }
    tree.set_domain(near, domain_);
    if (const auto followed = contact_.follow(tree, near, target)) {
      return meet(grows, followed->node);
    }
    return std::nullopt;
  }

  /// Pushes out of the contacts at the roots of a tree, as an assembly is taken apart, until one is
  /// out of contact.
  ///
  /// It extends the other tree towards each end.
  std::optional<Meeting> leave(std::size_t grows) {
    PlanTree& tree = trees_[grows];
    for (std::size_t root = 0; root < roots_[grows] && !work_.is_over(); ++root) {
      bool is_out = false;
      for (const auto& senses : contact_.ways_out(tree[root])) {
        for (const Eigen::VectorXd& direction : senses) {
          if (work_.is_over()) {
            return std::nullopt;
          }
          const std::size_t before = tree.size();
          const auto left = contact_.leave(tree, root, direction);
          pushed_[grows] += tree.size() - before;
          work_.report(size(), std::nullopt);
          is_out = is_out || (left && left->is_out);
          if (const auto met = left ? meet(grows, left->node) : std::nullopt) {
            return met;
          }
        }
        if (is_out) {
          break;
        }
      }
    }
    return std::nullopt;
  }

  /// Moves in contact in a random direction, then extends the other tree towards the end.
  std::optional<Meeting> push(std::size_t grows) {
    const std::optional<std::size_t> end = contact_.push(trees_[grows]);
    return end ? meet(grows, *end) : std::nullopt;
  }

  /// Extends a tree to a passage and takes it over, or meets the other tree if that has it already.
  std::optional<Meeting> reach_passage(std::size_t grows) {
    PlanTree& tree = trees_[grows];
    const auto passage = contact_.passage(grows, tree[tree.size() - 1]);
    if (!passage) {
      return std::nullopt;
    }
    const Configuration target = contact_.passages()[*passage];
    const std::size_t from = tree.nearest(target);
    std::optional<std::size_t> reached;
    if (work_.is_free(tree[from], target)) {
      reached = tree.add(target, from);
    } else if (const auto followed = contact_.follow_to_passage(tree, from, target);
               followed && followed->reaches_target) {
      reached = followed->node;
    }
    if (!reached) {
      return std::nullopt;
    }
    const std::optional<std::size_t> owner = contact_.passages().owner(passage->passage);
    if (!owner) {
      contact_.passages().give(*passage, tree, *reached, grows);
      return meet(grows, tree.size() - 1);
    }
    const std::size_t other = contact_.passages().in_owner(*passage);
    return grows == 0 ? Meeting{*reached, other} : Meeting{other, *reached};
  }

  /// Extends the other tree towards a node of this one.
  std::optional<Meeting> meet(std::size_t grows, std::size_t node) {
    PlanTree& other = trees_[1 - grows];
    const Configuration target = trees_[grows][node];
    const std::optional<std::size_t> met = connect(1 - grows, other.nearest(target), target);
    if (!met) {
      return std::nullopt;
    }
    return grows == 0 ? Meeting{node, *met} : Meeting{*met, node};
  }

  /// Grows a tree from a node towards a target as far as the way is free; returns the node at the
  /// target.
  std::optional<std::size_t> connect(std::size_t grows, std::size_t node,
                                     const Configuration& target) {
    PlanTree& tree = trees_[grows];
    const Configuration from = tree[node];
    const double length = work_.space().distance(from, target);
    // Most edges are blocked in their first step, whose check takes less work.
    const Configuration first =
        length > range_ ? work_.space().interpolate(from, target, range_ / length) : target;
    std::size_t last = node;
    if (work_.is_free(from, first)) {
      if (length <= range_) {
        return tree.add(target, node);
      }
      // One check proves all steps before the contact.
      const EdgeAnswer answer = work_.check(from, target);
      if (answer.verdict == EdgeVerdict::free) {
        return tree.add(target, node);
      }
      const double free_steps = std::floor(answer.fraction * length / range_);
      for (double step = 1.0; step <= free_steps; ++step) {
        last = tree.add(work_.space().interpolate(from, target, step * range_ / length), last);
      }
    }
    const auto followed = contact_.follow(tree, last, target);
    return followed && followed->reaches_target ? std::optional(followed->node) : std::nullopt;
  }

  [[nodiscard]] FoundPath joined(const Meeting& meeting) const {
    FoundPath found{trees_[0].to_root(meeting[0]), true};
    std::reverse(found.places.begin(), found.places.end());
    const std::vector<Configuration> rest = trees_[1].to_root(meeting[1]);
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
  double domain_;
  std::array<PlanTree, 2> trees_;
  std::array<std::size_t, 2> roots_ = {};
  std::size_t tries_ = 0;  // Number of edges to samples.
  bool has_left_ = false;
  std::array<std::size_t, 2> pushed_ = {};  // Number of pushes from the roots of each tree.
  ContactGrowth contact_;
};

}  // namespace

FoundPath rrt_connect(PlanWork& work, const Configuration& start,
                      const std::vector<Configuration>& goals, double range,
                      RandomNumbers& random) {
  Connect connect(work, range);
  FoundPath found = connect.run(start, goals, random);
  work.counts().nodes = connect.size();
  if (work.options().keep_trees) {
    found.trees = connect.take_trees();
  }
  return found;
}

}  // namespace firstcontact::detail
