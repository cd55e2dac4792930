#include "motion_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/page/write_page.h>
#include <firstcontact/planning/plan_path.h>
#include <firstcontact/planning/plan_scene.h>
#include <firstcontact/retiming/retiming_path.h>
#include <firstcontact/retiming/retiming_scene.h>
#include <firstcontact/retiming/timed_motion.h>
#include <firstcontact/retiming/waypoint_path.h>
#include <firstcontact/scene/gap_bound.h>
#include <firstcontact/scene/hold_contact_pairs.h>
#include <firstcontact/scene/planned_path.h>
#include <firstcontact/scene/trajectory.h>
#include <firstcontact/scene_files/write_result.h>

#include "atomic_file.h"
#include "drawn_path.h"
#include "scene_answer.h"

namespace firstcontact::app {
namespace {

constexpr double kPlayed = 8.0;  // [s]  Duration of a path without times.

/// The length of an edge; for a body its translation and, for viewing, a tenth of its turn.
double way_of(const PlannedPath& path, const std::vector<double>& a, const std::vector<double>& b) {
  if (!path.robots.empty()) {
    double way = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
      way = std::max(way, std::abs(b[k] - a[k]));
    }
    return way;
  }
  const double half = std::abs(a[3] * b[3] + a[4] * b[4] + a[5] * b[5] + a[6] * b[6]);
  return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]) +
         0.1 * 2.0 * std::acos(std::min(1.0, half));
}

std::vector<double> times_of(const PlannedPath& path,
                             const std::vector<std::vector<double>>& waypoints) {
  if (!path.times.empty()) {
    return path.times;
  }
  std::vector<double> times{0.0};
  for (std::size_t k = 1; k < waypoints.size(); ++k) {
    times.push_back(times.back() + way_of(path, waypoints[k - 1], waypoints[k]));
  }
  const double whole = times.back();
  for (std::size_t k = 0; k < times.size(); ++k) {
    times[k] = whole > 0.0 ? kPlayed * times[k] / whole : kPlayed * static_cast<double>(k);
  }
  return times;
}

template <typename Named>
Named& named(std::vector<Named>& all, const std::string& name) {
  return *std::find_if(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
}

/// Leaves out places that follow another one at the same time.
template <typename Place>
void append(std::vector<double>& times, std::vector<Place>& places, double time, Place place) {
  if (times.empty() || time > times.back()) {
    times.push_back(time);
    places.push_back(std::move(place));
  }
}

/// Gives each robot of a path its columns of the positions.
void give_trajectories(const PlannedPath& path, const std::vector<double>& times,
                       const std::vector<std::vector<double>>& positions, Scene& scene) {
  for (const std::string& name : path.robots) {
    const bool is_alone = path.robots.size() == 1 && path.body.empty();
    const std::string begin = is_alone ? "" : name + "/";
    std::vector<std::size_t> columns;
    Trajectory trajectory{.joint_names = {}, .points = {}};
    for (std::size_t k = 0; k < path.joints.size(); ++k) {
      if (path.joints[k].starts_with(begin)) {
        columns.push_back(k);
        trajectory.joint_names.push_back(path.joints[k].substr(begin.size()));
      }
    }
    for (std::size_t k = 0; k < times.size(); ++k) {
      TrajectoryPoint point{.time = times[k], .positions = {}};
      for (const std::size_t column : columns) {
        point.positions.push_back(positions[k][column]);
      }
      trajectory.points.push_back(std::move(point));
    }
    named(scene.robots, name).trajectory = std::move(trajectory);
  }
}

/// The columns of the pose of the body that moves.
std::array<std::size_t, 7> body_columns(const PlannedPath& path) {
  std::array<std::size_t, 7> columns = {0, 1, 2, 3, 4, 5, 6};
  const Joint floating{.name = path.body, .type = JointType::floating};
  for (std::size_t k = 0; k < columns.size() && !path.robots.empty(); ++k) {
    const auto found = std::ranges::find(path.joints, coordinate_name(floating, k));
    columns.at(k) = static_cast<std::size_t>(found - path.joints.begin());
  }
  return columns;
}

void forget_velocities(std::vector<SceneLimits>& limits) {
  for (SceneLimits& of_robot : limits) {
    std::erase_if(of_robot.violations, [](const LimitViolation& violation) {
      return violation.what == JointLimit::velocity;
    });
  }
  std::erase_if(limits, [](const SceneLimits& of_robot) { return of_robot.violations.empty(); });
}

/// A scene in which a mover runs along its path.
struct PlayedPath {
  Scene scene;
  std::vector<double> times;  // [s]  When it is at each waypoint.
};

PlayedPath played(const PlannedPath& path) {
  Scene scene = path.scene;
  hold_contact_pairs(path.contact_pairs, scene);
  std::vector<double> times;
  std::vector<double> all;
  if (!path.body.empty()) {
    WaypointMotion motion;
    all = times_of(path, path.waypoints);
    const std::array<std::size_t, 7> columns = body_columns(path);
    for (std::size_t k = 0; k < all.size(); ++k) {
      std::array<double, 7> q{};
      for (std::size_t i = 0; i < q.size(); ++i) {
        q.at(i) = path.waypoints[k].at(columns.at(i));
      }
      append(motion.times, motion.poses, all[k], pose_of_positions(q));
    }
    times = motion.times;
    named(scene.bodies, path.body).motion = std::move(motion);
  }
  if (!path.robots.empty()) {
    std::vector<bool> turns_short;
    for (const Turning turning : path.turnings) {
      turns_short.push_back(turning == Turning::shortest);
    }
    const WaypointPath unwound_path = unwound({path.joints, path.waypoints}, turns_short);
    all = times_of(path, unwound_path.waypoints);
    times.clear();
    std::vector<std::vector<double>> positions;
    for (std::size_t k = 0; k < all.size(); ++k) {
      append(times, positions, all[k], unwound_path.waypoints[k]);
    }
    give_trajectories(path, times, positions, scene);
  }
  scene.duration = times.size() > 1 ? times.back() : 1.0;
  return {std::move(scene), std::move(all)};
}

/// Answers a scene and writes its page.
///
/// @param asks_gap  whether the page has the gap over time and the closest approach
/// @param draw  called with the scene that is played; null where the page draws no path
/// @param rates  of a retimed motion
/// @returns whether the page was written; not where it was stopped
bool write_answer_page(const MotionPage& page, Scene scene, bool asks_gap, bool has_times,
                       const std::function<PathLook(const LoadedScene&)>& draw,
                       const std::vector<RateLook>& rates = {}) {
  Question question;
  question.closest = asks_gap;
  question.gap_curve = asks_gap;
  question.stop = page.stop;
  question.doing = page.doing;
  ShapeCache cache;
  ManyBodiesWorkspace workspace;
  SceneAnswer answer = answer_scene(std::move(scene), question, cache, workspace);
  if (page.stop.stop_requested()) {
    return false;
  }
  if (!has_times) {
    forget_velocities(answer.loaded.limits);
  }
  const std::string result = write_result(answer.loaded, answer.result,
                                          {.all_pairs = asks_gap, .line = {}, .sampling = {}});
  const auto bound = gap_lower_bound(answer.loaded, answer.result, answer.curve);
  std::optional<PathLook> look;
  if (draw) {
    look = draw(answer.loaded);
  }
  write_file(page.file, write_page(page.viewer, answer.loaded, result, {answer.curve, bound},
                                   {.path = look ? &*look : nullptr, .rates = rates}));
  return true;
}

}  // namespace

Scene scene_in_motion(const RetimingPath& input, const RetimingScene& where,
                      const TimedMotion& motion) {
  Scene scene = input.scene;
  hold_contact_pairs(input.contact_pairs, scene);
  const std::vector<TimedMotion> parts = split_motion(motion, where);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    scene.robots.at(where.robots[k]).trajectory = trajectory_of(parts[k]);
  }
  scene.duration = motion.duration();
  return scene;
}

void write_motion_page(const MotionPage& page, Scene scene, const std::vector<RateLook>& rates) {
  write_answer_page(page, std::move(scene), true, true, nullptr, rates);
}

std::vector<RateLook> rate_looks(const RetimingPath& input, const std::vector<RateLimits>& limits) {
  std::vector<RateLook> rates;
  for (const std::size_t robot : input.robots) {
    const std::string& name = input.scene.robots.at(robot).name;
    const std::string begin = input.robots.size() == 1 ? "" : name + "/";
    for (std::size_t k = 0; k < limits.size(); ++k) {
      const std::string& coordinate = input.path.joint_names.at(k);
      if (coordinate.starts_with(begin)) {
        rates.push_back({.robot = name,
                         .coordinate = coordinate.substr(begin.size()),
                         .velocity = limits[k].velocity,
                         .acceleration = limits[k].acceleration,
                         .jerk = limits[k].jerk});
      }
    }
  }
  return rates;
}

bool write_path_page(const MotionPage& page, const PlannedPath& path, std::vector<TreeLook> trees) {
  PlayedPath played_path = played(path);
  const auto draw = [&](const LoadedScene& loaded) {
    PathLook look = drawn_path(path, played_path.times, loaded);
    look.trees = std::move(trees);
    return look;
  };
  return write_answer_page(page, std::move(played_path.scene), true, !path.times.empty(), draw);
}

bool write_failure_page(const MotionPage& page, const ScenePlan& plan, const PlanResult& result) {
  const auto draw = [&](const LoadedScene&) {
    PathLook look = drawn_failure(plan, result);
    look.trees = drawn_trees(plan, result.trees);
    return look;
  };
  return write_answer_page(page, plan.loaded.scene, false, true, draw);
}

}  // namespace firstcontact::app
