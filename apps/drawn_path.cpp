#include "drawn_path.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <numeric>
#include <string>
#include <utility>

#include <firstcontact/planning/plan_path.h>
#include <firstcontact/planning/plan_scene.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/planned_path.h>

#include "traced_point.h"

namespace firstcontact::app {
namespace {

constexpr std::size_t kMostTreeLines = 20'000;
constexpr int kPiecesOfPath = 48;   // Straight lines along an edge of the path.
constexpr int kPiecesOfTree = 8;    // Likewise, of a tree.
constexpr double kStraight = 1e-3;  // [-]  Share of its length by which a straight line may bend.

using Line = std::vector<Eigen::Vector3d>;

/// Samples a way; one that is straight has its two ends only.
///
/// @param place  [m]  for a share of the way from 0 to 1
Line sampled(const std::function<Eigen::Vector3d(double)>& place, int pieces) {
  Line line;
  for (int k = 0; k <= pieces; ++k) {
    line.push_back(place(static_cast<double>(k) / pieces));
  }
  const Eigen::Vector3d whole = line.back() - line.front();
  const auto is_on_chord = [&](const Eigen::Vector3d& point) {
    const double along = (point - line.front()).dot(whole) / whole.squaredNorm();
    const double off = (point - line.front() - along * whole).norm();
    return off <= kStraight * whole.norm() && along >= -kStraight && along <= 1.0 + kStraight;
  };
  if (std::ranges::all_of(line, is_on_chord)) {
    return {line.front(), line.back()};
  }
  return line;
}

Movers movers_of(const PlannedPath& path) { return {path.robots, path.body, path.joints}; }

Movers movers_of(const ScenePlan& plan) {
  Movers movers;
  for (std::size_t mover = 0; mover < plan.plan.space.mover_count(); ++mover) {
    const std::string& name = plan.plan.scene.robot_name(plan.plan.robots[mover]);
    if (plan.plan.space.is_body(mover)) {
      movers.body = name;
    } else {
      movers.robots.push_back(name);
    }
  }
  const ConfigurationSpace& space = plan.plan.space;
  for (std::size_t k = 0; k < space.size() && !space.is_body(); ++k) {
    movers.joints.push_back(space.number_name(k));
  }
  return movers;
}

std::vector<TracedLines> without_lines(const std::vector<TracedPoint>& points) {
  std::vector<TracedLines> movers;
  for (const TracedPoint& point : points) {
    movers.push_back({.name = point.name});
  }
  return movers;
}

/// The number of edges of each tree that are drawn; small trees leave their room to the others.
std::vector<std::size_t> drawn_counts(const std::vector<SearchTree>& trees, std::size_t room) {
  std::vector<std::size_t> order(trees.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return trees[k].edges.size(); });
  std::vector<std::size_t> counts(trees.size());
  std::size_t left = trees.size();
  for (const std::size_t k : order) {
    counts[k] = std::min(trees[k].edges.size(), room / left--);
    room -= counts[k];
  }
  return counts;
}

/// The members that are elsewhere at a goal than at the start.
std::vector<GoalLook> drawn_goal(const PlanScene& plan, const Configuration& start,
                                 const Configuration& goal) {
  RobotScene scene = plan.scene;
  plan.set_motions(scene, start, start);
  std::vector<Pose> before;
  for (std::size_t member = 0; member < scene.size(); ++member) {
    before.push_back(scene.pose(member, 0.0));
  }
  plan.set_motions(scene, goal, goal);
  std::vector<GoalLook> moved;
  for (std::size_t member = 0; member < scene.size(); ++member) {
    const Pose X_WM = scene.pose(member, 0.0);
    if (X_WM.position != before[member].position ||
        X_WM.rotation.coeffs() != before[member].rotation.coeffs()) {
      moved.push_back({member, X_WM});
    }
  }
  return moved;
}

}  // namespace

PathLook drawn_path(const PlannedPath& path, const std::vector<double>& times,
                    const LoadedScene& played) {
  const std::vector<TracedPoint> points = traced_points(played, movers_of(path));
  PathLook look{.verdict = kPlanVerdictWords.at(static_cast<std::size_t>(
                    path.is_proven ? PlanVerdict::proven : PlanVerdict::approximate)),
                .movers = without_lines(points),
                .blocked = path.statistics.blocked};
  const double duration = played.scene.duration;
  for (std::size_t k = 0; k + 1 < times.size(); ++k) {
    const double from = std::min(times[k] / duration, 1.0);
    const double to = std::min(times[k + 1] / duration, 1.0);
    look.edges.push_back({path.clearances.at(k), from, to});
    for (std::size_t mover = 0; mover < points.size(); ++mover) {
      const auto place = [&](double share) {
        return points[mover].at(
            pose_of_member(played, points[mover].member, from + share * (to - from)));
      };
      look.movers[mover].lines.push_back(sampled(place, kPiecesOfPath));
    }
  }
  return look;
}

std::vector<TreeLook> drawn_trees(const ScenePlan& plan, const std::vector<SearchTree>& trees) {
  const std::vector<TracedPoint> points = traced_points(plan.loaded, movers_of(plan));
  const std::vector<std::size_t> counts =
      drawn_counts(trees, kMostTreeLines / std::max<std::size_t>(points.size(), 1));
  RobotScene scene = plan.plan.scene;
  std::vector<TreeLook> looks;
  for (std::size_t k = 0; k < trees.size(); ++k) {
    const SearchTree& tree = trees[k];
    TreeLook look{.kind = kSearchTreeWords.at(static_cast<std::size_t>(tree.kind)),
                  .places = tree.places.size(),
                  .edges = tree.edges.size(),
                  .movers = without_lines(points)};
    for (std::size_t edge = 0; edge < counts[k]; ++edge) {
      const auto [from, to] = tree.edges[edge];
      plan.plan.set_motions(scene, tree.places[from], tree.places[to]);
      for (std::size_t mover = 0; mover < points.size(); ++mover) {
        const auto place = [&](double share) {
          return points[mover].at(scene.pose(points[mover].member, share));
        };
        look.movers[mover].lines.push_back(sampled(place, kPiecesOfTree));
      }
    }
    looks.push_back(std::move(look));
  }
  return looks;
}

PathLook drawn_failure(const ScenePlan& plan, const PlanResult& result) {
  PathLook look{.verdict = kPlanVerdictWords.at(static_cast<std::size_t>(PlanVerdict::none)),
                .movers = without_lines(traced_points(plan.loaded, movers_of(plan))),
                .blocked = blocked_by_name(plan, result.statistics)};
  if (!plan.goals.empty()) {
    look.goal = drawn_goal(plan.plan, plan.start, plan.goals.front());
  }
  return look;
}

}  // namespace firstcontact::app
