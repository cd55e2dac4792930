#include <firstcontact/scene/detail/load_robots.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

#include <firstcontact/robot/robot_motion.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/detail/add_report.h>
#include <firstcontact/scene/detail/load_body.h>
#include <firstcontact/scene/whole_turn_jumps.h>
#include <firstcontact/text/brief_list.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/quantity.h>
#include <firstcontact/text/sha256.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

/// Requires that a robot that is only checked has geometry that can touch.
///
/// @throws ParseError
void require_geometry(const SceneRobot& robot, const RobotModel& model) {
  const auto is_empty = [](const Link& link) { return link.collision.empty(); };
  const auto links = model.links();
  if (!robot.dynamics && std::all_of(links.begin(), links.end(), is_empty)) {
    throw ParseError(robot.file.urdf.string(),
                     robot.file.surface != RobotSurface::collision
                         ? "expected links with <visual> geometry, none has any"
                         : "expected links with <collision> geometry, none has any; surface "
                           "\"visual\" (--visual) takes what they look like");
  }
}

class RobotLoader {
 public:
  RobotLoader(Scene scene, ShapeCache& cache)
      : scene_(std::move(scene)), cache_(cache), digests_(scene_.text_digest + '\n') {}

  LoadedScene load() {
    robots_.rules() = rules_of(scene_);
    loaded_.warnings = scene_.warnings;
    add_reports(scene_.file_reports, loaded_);
    for (const Body& body : scene_.bodies) {
      add(body);
    }
    for (const SceneRobot& robot : scene_.robots) {
      add(robot);
    }
    for (std::size_t k = 0; k < scene_.robots.size(); ++k) {
      attach(k);
      report_limits(k);
    }
    loaded_.robots = std::make_shared<const RobotScene>(std::move(robots_));
    loaded_.input_digest = sha256(digests_);
    loaded_.scene = std::move(scene_);
    return std::move(loaded_);
  }

 private:
  [[nodiscard]] ReadingOptions reading() const { return {.lenient = scene_.options.lenient}; }

  void add(const Body& body) {
    DeformingBody moved = load_body(body, scene_, cache_, digests_, loaded_);
    robots_.add_body(body.name, std::move(moved.shape), std::move(moved.X_WS));
  }

  void add(const SceneRobot& robot) {
    CachedRobot cached = cache_.load(robot.file, reading());
    require_geometry(robot, cached.model);
    digests_ += cached.digest + '\n' + robot.srdf_digest + '\n';
    for (const FileReport& report : *cached.files) {
      add_report(report, loaded_);
    }
    if (!robot.semantics.report.path.empty()) {
      add_report(robot.semantics.report, loaded_);
    }
    TrajectoryMotion motion =
        joint_motions(robot.model, robot.trajectory, robot.state, scene_.duration);
    warn(robot, motion.at_default);
    const std::size_t first = robots_.size();
    const std::size_t index =
        robots_.add_robot(robot.name,
                          RobotMotion(std::move(cached.model), motion.joints,
                                      normalised_motion(robot.base, scene_.duration)),
                          robot.semantics.disabled);
    for (const auto& [link, padding] : robot.padding) {
      robots_.set_padding(first + link, padding);
    }
    for (const auto& [joint, error] : robot.tracking_error) {
      robots_.set_tracking_error(index, robot.model.joints()[joint].name, error);
    }
  }

  void warn(const SceneRobot& robot, const std::vector<std::string>& at_default) {
    std::vector<std::string>& warnings = loaded_.warnings;
    if (!at_default.empty()) {
      warnings.push_back(robot.name + ": no position is given for " + some_of(at_default) +
                         (at_default.size() == 1 ? ": it rests" : ": they rest") +
                         " at 0, or at the limit next to it");
    }
    warnings.insert(warnings.end(), robot.trajectory.warnings.begin(),
                    robot.trajectory.warnings.end());
    for (const WholeTurnJump& jump : whole_turn_jumps(robot.model, robot.trajectory)) {
      warnings.push_back(robot.name + ": " + describe(jump));
    }
    const double first = robot.trajectory.points.front().time;
    if (!robot.trajectory.joint_names.empty() && first > 0.0) {
      warnings.push_back(robot.name + ": the trajectory begins at " + quantity(first, "s") +
                         "; until then the robot rests where it begins");
    }
  }

  void attach(std::size_t robot) {
    const std::size_t first = first_member(scene_, robot);
    for (const SceneAttachment& attached : scene_.robots[robot].attached) {
      Attachment attachment{.body = attached.body,
                            .link = first + attached.link,
                            .t_from = attached.from_time / scene_.duration,
                            .t_to = attached.to_time ? *attached.to_time / scene_.duration : 1.0,
                            .X_LB = attached.pose};
      for (const std::size_t link : attached.touch_links) {
        attachment.touch_links.push_back(first + link);
      }
      robots_.attach(std::move(attachment));
    }
  }

  void report_limits(std::size_t robot) {
    SceneLimits limits{robot, limit_report(robots_.robot_motion(robot), scene_.duration)};
    for (const LimitViolation& violation : limits.violations) {
      loaded_.warnings.push_back(describe(scene_.robots[robot], violation, scene_.duration));
    }
    if (!limits.violations.empty()) {
      loaded_.limits.push_back(std::move(limits));
    }
  }

  Scene scene_;
  ShapeCache& cache_;
  std::string digests_;
  RobotScene robots_;
  LoadedScene loaded_;
};

}  // namespace

PairRules rules_of(const Scene& scene) {
  PairRules rules(scene.options.margin);
  for (const BodyGroup& group : scene.groups) {
    rules.add_group(group.bodies);
  }
  for (const BodyPair& pair : scene.ignored_pairs) {
    rules.ignore(pair);
  }
  for (const PairMargin& pair : scene.pair_margins) {
    rules.set_margin(pair.bodies, pair.margin);
  }
  for (const GroupPair& pair : scene.ignored_groups) {
    rules.ignore_groups(pair[0], pair[1]);
  }
  for (const GroupMargin& pair : scene.group_margins) {
    rules.set_group_margin(pair.groups[0], pair.groups[1], pair.margin);
  }
  return rules;
}

LoadedScene load_robots(Scene scene, ShapeCache& cache) {
  return RobotLoader(std::move(scene), cache).load();
}

}  // namespace firstcontact::detail
