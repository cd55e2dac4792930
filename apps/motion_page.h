/// @file
/// A page that plays a planned path, or a trajectory along it.

#pragma once

#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include <firstcontact/page/path_look.h>
#include <firstcontact/page/rate_look.h>
#include <firstcontact/planning/search_tree.h>
#include <firstcontact/scene/scene.h>

namespace firstcontact {
struct PlanResult;
struct PlannedPath;
struct RateLimits;
struct RetimingPath;
struct RetimingScene;
struct ScenePlan;
struct TimedMotion;
}  // namespace firstcontact

namespace firstcontact::app {

/// The scene in which the robots of a retiming follow their motion.
[[nodiscard]] Scene scene_in_motion(const RetimingPath& input, const RetimingScene& where,
                                    const TimedMotion& motion);

/// A page that is being made.
struct MotionPage {
  std::string file;
  std::string viewer;      ///< The viewer's page.
  std::stop_token stop{};  ///< Ends the check early, without a page.
  std::function<void(std::string)> doing = [](const std::string&) {};  ///< Gets the present work.
};

/// Checks a scene once more and writes the page of the answer, with the gap over time.
///
/// @param scene  scene_in_motion() of a retiming
/// @param rates  the limits that it keeps
void write_motion_page(const MotionPage& page, Scene scene, const std::vector<RateLook>& rates);

/// The limits of a retiming, by robot and coordinate.
///
/// @param limits  of the coordinates of its path
[[nodiscard]] std::vector<RateLook> rate_looks(const RetimingPath& input,
                                               const std::vector<RateLimits>& limits);

/// Plays a path: checks the scene in which the mover runs along it, and writes the page.
///
/// It runs at the times of the path. Without times it takes eight seconds, which the edges share by
/// their lengths; then no velocity is beyond its limit.
///
/// @param trees  of the search, to be drawn on demand
/// @returns whether the page was written; not where it was stopped
bool write_path_page(const MotionPage& page, const PlannedPath& path,
                     std::vector<TreeLook> trees = {});

/// Writes the page of a search that found no path: the scene at the start, with the goal.
///
/// @returns whether the page was written; not where it was stopped
bool write_failure_page(const MotionPage& page, const ScenePlan& plan, const PlanResult& result);

}  // namespace firstcontact::app
