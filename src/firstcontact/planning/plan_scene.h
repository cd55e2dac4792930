/// @file
/// The plan of a scene, and its answer as a path file.

#pragma once

#include <stop_token>
#include <vector>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/math/export.h>
#include <firstcontact/planning/plan_path.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/plan_question.h>
#include <firstcontact/scene/planned_path.h>

namespace firstcontact {

class ShapeCache;

/// A question about a scene, ready for plan_path().
struct ScenePlan {
  /// The whole scene at rest, with the mover at its start; its margin is that of the question.
  ///
  /// Members are numbered as those of `plan`.
  LoadedScene loaded;
  PlanScene plan;
  Configuration start;
  std::vector<Configuration> goals;
  PlanOptions options;  ///< The options of the question; else the defaults.
};

/// Loads a scene and prepares its question.
///
/// A robot begins where its trajectory does. Other robots rest at their trajectories of one point.
/// A body that a robot holds keeps its place in the link that it has at the start.
///
/// Goals that are poses of links become configurations of the joints, by inverse kinematics. They
/// share the time of the question with the search: `options.spent` is what they took.
///
/// @param stop  ends inverse kinematics; `goals` may be empty then
/// @throws std::invalid_argument  names what cannot be planned: a joint or a goal that is none, a
///         body or robot that moves by itself, a deforming body, a body that is held for a while.
///         With poses of links also a start that is not free, and goals of which none is
/// @throws as load_scene
[[nodiscard]] FIRSTCONTACT_API ScenePlan make_scene_plan(Scene scene, const PlanQuestion& question,
                                                         ShapeCache& cache,
                                                         const std::stop_token& stop = {});

/// Refuses a start that is a goal, as there is nothing to plan. Where something else moves, a mover
/// may have to leave its place and come back.
///
/// @throws std::invalid_argument  names the goal
FIRSTCONTACT_API void require_goals_apart(const ScenePlan& scene, const PlanQuestion& question);

/// Refuses a start or a goal beyond a limit, by its key in the scene.
///
/// @throws std::invalid_argument  names the key and the coordinate
FIRSTCONTACT_API void require_places(const ScenePlan& scene, const PlanQuestion& question);

/// The question from the first to the last point of the trajectory of a scene's only robot.
///
/// @throws std::invalid_argument if there is no such robot, or its trajectory has no two points
[[nodiscard]] FIRSTCONTACT_API PlanQuestion question_of_trajectory(const Scene& scene);

/// The pairs that blocked a plan, with the names of their members; the most frequent first.
[[nodiscard]] FIRSTCONTACT_API std::vector<NamedBlockingPair> blocked_by_name(
    const ScenePlan& scene, const PlanStatistics& statistics);

/// The contents of a path file.
///
/// @param options  the options of the planner that found the path
/// @param result   an answer with a path
/// @throws std::invalid_argument  without a path, or if its edges are screws. Also for a seed of
///         2^53 or more, which a path file cannot hold.
[[nodiscard]] FIRSTCONTACT_API PlannedPath planned_path(const ScenePlan& scene,
                                                        const PlanOptions& options,
                                                        const PlanResult& result);

}  // namespace firstcontact
