#include <firstcontact/planning/detail/link_goals.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/edges/detail/reach_search.h>
#include <firstcontact/edges/inverse_kinematics.h>
#include <firstcontact/planning/detail/end_check.h>
#include <firstcontact/planning/detail/plan_goals.h>
#include <firstcontact/planning/detail/plan_work.h>
#include <firstcontact/scene/detail/robot_name.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

using Clock = PlanWork::Clock;

constexpr std::size_t kPlaces = 8;       // Places that are enough, of all poses together.
constexpr std::size_t kRounds = 300;     // Most tries of each pose.
constexpr std::size_t kIdleRounds = 50;  // Most tries of each pose in a row that bring no place.

/// A pose that a link is to have, and the configurations of the joints that were found.
struct WantedPose {
  LinkPoseGoal goal;
  std::string name;  ///< For messages: `the pose of link "hand"`.
  std::optional<ReachSearch> search = {};
  std::size_t count_blocked = 0;
  std::optional<Configuration> blocked = {};  ///< The first place that is not free.
};

/// The search for places of all poses of a question.
class LinkGoalSearch {
 public:
  LinkGoalSearch(ScenePlan& plan, const PlanQuestion& question, const std::stop_token& stop)
      : plan_(plan), question_(question), stop_(stop) {}

  void run() {
    require_free_start();
    make_searches();
    take_turns();
    if (!stop_.stop_requested()) {
      take_places();
    }
    plan_.options.spent = seconds();
  }

 private:
  [[nodiscard]] double tolerance() const { return plan_.loaded.scene.options.tolerance; }

  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(Clock::now() - begin_).count();
  }

  void require_free_start() {
    if (const std::optional<std::string> defect = plan_.plan.space.defect(plan_.start)) {
      throw std::invalid_argument("the start: " + *defect);
    }
    EndCheck check(plan_.plan, plan_.start, PathEnd::start, tolerance(), stop_);
    if (!check.is_free(plan_.start) && !stop_.stop_requested()) {
      throw std::invalid_argument(check.describe(plan_.start, "the start"));
    }
  }

  void make_searches() {
    goal_check_.emplace(plan_.plan, plan_.start, PathEnd::goal, tolerance(), stop_);
    const PlanScene& plan = plan_.plan;
    for (const LinkGoal& wanted : question_.link_goals) {
      const RobotName split =
          split_mover_name(plan_.loaded.scene, {question_.robots, question_.body}, wanted.link);
      poses_.push_back(
          {.goal = {.link = link_of_goal(plan.space.model(split.which), wanted, split.name),
                    .mover = split.which,
                    .X_LT = wanted.X_LT,
                    .X_WT = wanted.X_WT,
                    .position_tolerance = wanted.position_tolerance,
                    .rotation_tolerance = wanted.rotation_tolerance},
           .name = "the pose of link " + in_quotes(wanted.link)});
    }
    for (WantedPose& pose : poses_) {  // None of them moves any more.
      const auto accepts = [this, &pose](const Configuration& q) { return is_free(pose, q); };
      pose.search.emplace(
          plan.space, pose.goal, plan_.start,
          ReachOptions{.accepts = accepts, .seed = question_.seed.value_or(PlanOptions().seed)});
    }
  }

  bool is_free(WantedPose& pose, const Configuration& q) {
    const bool is_free = goal_check_->is_free(q);
    if (!is_free && !stop_.stop_requested()) {
      ++pose.count_blocked;
      pose.blocked = pose.blocked.value_or(q);
    }
    return is_free;
  }

  /// Gives each pose one try after the other until there are places enough, or time is over.
  void take_turns() {
    std::size_t found = 0;
    std::size_t idle = 0;  // Rounds without another place.
    for (std::size_t round = 0; round < kRounds && idle < kIdleRounds; ++round) {
      const std::size_t before = found;
      for (WantedPose& pose : poses_) {
        if (found >= kPlaces || is_over(found > 0 || !plan_.goals.empty())) {
          return;
        }
        found += pose.search->try_once() ? 1 : 0;
      }
      idle = found == before && found > 0 ? idle + 1 : 0;
    }
  }

  /// Whether to search no longer: with a goal, half of the time is left to the planner.
  [[nodiscard]] bool is_over(bool has_goal) const {
    const double time = question_.time.value_or(PlanOptions().time);
    return stop_.stop_requested() || !(seconds() < (has_goal ? 0.5 * time : time));
  }

  /// Adds the places to the goals, and a warning for each pose that has none.
  ///
  /// @throws std::invalid_argument if there is no goal at all
  void take_places() {
    std::vector<std::string>& warnings = plan_.loaded.warnings;
    std::vector<WantedPose*> failed;
    for (WantedPose& pose : poses_) {
      if (pose.search->size() == 0) {
        failed.push_back(&pose);
      } else {
        std::ranges::transform(pose.search->places(), std::back_inserter(plan_.goals),
                               &ReachedPose::q);
      }
    }
    if (plan_.goals.empty()) {
      throw std::invalid_argument(problem_of(*failed.front(), /*is_brief=*/false));
    }
    std::ranges::transform(failed, std::back_inserter(warnings),
                           [&](WantedPose* pose) { return problem_of(*pose, /*is_brief=*/true); });
  }

  /// Explains in a sentence that a pose has no free configuration of the joints.
  std::string problem_of(WantedPose& pose, bool is_brief) {
    if (pose.blocked) {
      const std::string what = pose.name + " (all " + std::to_string(pose.count_blocked) +
                               " configurations of the joints that were found)";
      return is_brief ? goal_check_->describe_briefly(*pose.blocked, what)
                      : goal_check_->describe(*pose.blocked, what);
    }
    const std::vector<ReachedPose> nearest = pose.search->places();
    if (nearest.empty()) {
      return pose.name + ": no time was left to look for configurations of the joints";
    }
    std::string text = pose.name +
                       ": no configuration of the joints was found at which it is there; the "
                       "nearest is " +
                       write_json(nearest.front().position_error) + " m";
    if (pose.goal.rotation_tolerance < std::numbers::pi) {
      text += " and " + write_json(nearest.front().rotation_error) + " rad";
    }
    return text + " off";
  }

  ScenePlan& plan_;
  const PlanQuestion& question_;
  const std::stop_token& stop_;
  Clock::time_point begin_ = Clock::now();
  std::optional<EndCheck> goal_check_;
  std::vector<WantedPose> poses_;
};

}  // namespace

void add_link_goals(ScenePlan& plan, const PlanQuestion& question, const std::stop_token& stop) {
  if (question.link_goals.empty()) {
    return;
  }
  if (std::ranges::any_of(plan.plan.contact_pairs,
                          [](const ContactPair& pair) { return pair.at == PathEnd::goal; })) {
    throw std::invalid_argument(
        "contact_pairs at the goal are measured where joints have numbers; give the goal as "
        "positions of joints in place of the pose of a link");
  }
  LinkGoalSearch(plan, question, stop).run();
}

}  // namespace firstcontact::detail
