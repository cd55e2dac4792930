#include <firstcontact/scene_files/robot_question.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

#include <firstcontact/foreign_scenes/detail/given_positions.h>
#include <firstcontact/foreign_scenes/planning_scene.h>
#include <firstcontact/robot_files/read_srdf.h>
#include <firstcontact/scene/whole_turn_jumps.h>
#include <firstcontact/scene_files/detail/text_reports.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/text/file_extension.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/read_file.h>
#include <firstcontact/text/sha256.h>
#include <firstcontact/text/text_tree.h>
#include <firstcontact/text/write_json.h>
#include <firstcontact/trajectory_files/detail/ros_message.h>
#include <firstcontact/trajectory_files/read_trajectory.h>

namespace firstcontact {
namespace {

using detail::in_quotes;

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

void put(const JointPositions& later, JointPositions& positions) {
  for (const auto& [name, position] : later) {
    positions[name] = position;
  }
}

/// Makes one scene of the files of a question.
class SceneBuilder {
 public:
  explicit SceneBuilder(const RobotQuestion& question) : question_(question) {}

  Scene build() {
    SceneRobot robot = read_robot();
    robot_name_ = robot.name;
    take_motion(robot);
    for (const std::filesystem::path& file : question_.environment) {
      add_environment(file, robot);
    }
    if (goal_) {  // The goal begins where the environment has the joints that nothing else moves.
      robot.trajectory =
          straight_motion(robot.model, robot.state, *goal_, turning(), velocity_scaling_);
    }
    if (question_.padding > 0.0) {
      for (std::size_t link = 0; link < robot.model.links().size(); ++link) {
        robot.padding[link] = std::max(robot.padding[link], question_.padding);
      }
    }
    if (question_.tracking_error > 0.0) {
      robot.tracking_error = joint_errors(robot.model, question_.tracking_error);
    }
    scene_.robots.push_back(std::move(robot));
    allow_pairs();
    set_duration();
    scene_.text_digest = detail::sha256(texts_);
    return std::move(scene_);
  }

 private:
  SceneRobot read_robot() {
    scene_.options.lenient = question_.reading.lenient;
    RobotModel model = read_robot_model(question_.robot, question_.reading);
    std::string name = model.name().empty() ? "robot" : model.name();
    SceneRobot robot{.name = std::move(name),
                     .file = question_.robot,
                     .model = std::move(model),
                     .base = FixedMotion{question_.base}};
    if (!question_.srdf.empty()) {
      robot.srdf = question_.srdf;
      const std::string text = text_of(robot.srdf, "an SRDF file");
      robot.semantics = parse_srdf(text, robot.srdf.string(), robot.model);
      robot.srdf_digest = detail::sha256(text);  // As in a scene that names the SRDF.
    }
    return robot;
  }

  /// Reads a text, which goes into the digest, too.
  std::string text_of(const std::filesystem::path& path, const std::string& what) {
    std::string text = detail::read_file(path, what);
    texts_ += detail::sha256(text) + '\n';
    scene_.files_read.push_back(path);
    return text;
  }

  void take_motion(SceneRobot& robot) {
    const int ways = (question_.trajectory.empty() ? 0 : 1) + (question_.request.empty() ? 0 : 1) +
                     (question_.goal.empty() ? 0 : 1);
    if (ways > 1) {
      refuse("expected one of a trajectory, a request and a goal, got " + std::to_string(ways));
    }
    if (ways == 1 && question_.goal.empty() && !question_.start.empty()) {
      refuse(
          "expected a start beside a goal alone; where joints rest that the motion does not name "
          "is the state");
    }
    if (question_.unwrap && question_.trajectory.empty()) {
      refuse("expected a trajectory, whose whole turns unwrap takes out, got none");
    }
    robot.state = moving(question_.state, "state", robot);
    put(moving(question_.start, "start", robot), robot.state);
    scene_.id = robot.name;
    robot.trajectory.points = {TrajectoryPoint{}};
    if (!question_.trajectory.empty()) {
      robot.trajectory = parse_trajectory(text_of(question_.trajectory, "a trajectory file"),
                                          question_.trajectory, robot.model);
      scene_.file_reports.push_back(
          detail::trajectory_report(question_.trajectory, robot.trajectory));
      robot.trajectory.turning = question_.turning.value_or(Turning::as_given);
      if (question_.unwrap) {
        robot.trajectory = unwrapped(robot.model, std::move(robot.trajectory));
      }
      scene_.id = question_.trajectory.filename().string();
    } else if (!question_.request.empty()) {
      take_request(robot);
    } else if (!question_.goal.empty()) {
      if (question_.start.empty()) {
        refuse("expected a start beside the goal, got none");
      }
      JointPositions goal = moving(question_.goal, "goal", robot);
      if (question_.plans) {
        scene_.plan = PlanQuestion{.robots = {0}, .goals = {std::move(goal)}};
      } else {
        goal_ = std::move(goal);
      }
    }
  }

  void take_request(SceneRobot& robot) {
    const PlanningRequest request =
        parse_planning_request(text_of(question_.request, "a request"), question_.request,
                               robot.model, robot.semantics.groups);
    put(request.start, robot.state);
    robot.base = FixedMotion{request.base};
    velocity_scaling_ = request.velocity_scaling;
    if (question_.plans) {
      scene_.plan = question_of(request);
    } else {
      goal_ = only_goal_of(request);
    }
    scene_.id = question_.request.filename().string();
    add_warnings(request.warnings);
  }

  /// The goal of a straight motion, which has one, of joints.
  [[nodiscard]] JointPositions only_goal_of(const PlanningRequest& request) const {
    if (request.goals.size() != 1) {
      throw ParseError(question_.request.string(),
                       "goal_constraints: expected one goal, got " +
                           std::to_string(request.goals.size()) +
                           "; `firstcontact plan` finds a path to any of them");
    }
    if (request.goals.front().link) {
      throw ParseError(question_.request.string(),
                       "expected a goal of joint positions, got the pose of a link; "
                       "`firstcontact plan` finds a path to it");
    }
    return request.goals.front().positions;
  }

  /// The question for a path to any goal of a request.
  static PlanQuestion question_of(const PlanningRequest& request) {
    PlanQuestion plan{.robots = {0},
                      .joints = request.joints,
                      .bounds = request.bounds,
                      .time = request.planning_time};
    for (const RequestGoal& goal : request.goals) {
      if (goal.link) {
        plan.link_goals.push_back(*goal.link);
      } else {
        plan.goals.push_back(goal.positions);
      }
    }
    return plan;
  }

  /// The way of motions between states.
  [[nodiscard]] Turning turning() const { return question_.turning.value_or(Turning::shortest); }

  /// The positions that the texts give for joints that move; a warning names the others.
  JointPositions moving(const std::vector<std::string>& texts, const std::string& what,
                        const SceneRobot& robot) {
    detail::GivenPositions given = detail::positions_of(texts, what, robot);
    add_warnings(given.warnings);
    return std::move(given.positions);
  }

  void add_warnings(const std::vector<std::string>& warnings) {
    scene_.warnings.insert(scene_.warnings.end(), warnings.begin(), warnings.end());
  }

  void add_environment(const std::filesystem::path& file, SceneRobot& robot) {
    const std::string extension = detail::file_extension(file);
    if (!detail::is_tree_extension(extension)) {
      add_mesh(file);
      return;
    }
    const std::string text = text_of(file, "an environment");
    const detail::JsonValue tree =
        extension == "json" ? detail::parse_json(text, file.string()) : detail::JsonValue();
    if (has_key(tree, "firstcontact")) {
      add_scene(parse_scene(text, file, 1, question_.reading), file);
      const detail::JsonValue* options =
          detail::find(std::get<detail::JsonObject>(tree.value), "options");
      states_duration_ = options != nullptr && has_key(*options, "duration");
    } else {
      require_base_at_origin(robot, file);
      const std::string& root = robot.model.links()[robot.model.root()].name;
      try {
        PlanningScene around = parse_planning_scene(text, file, root);
        const detail::GivenPositions rest =
            detail::positions_at_rest(around.state, file.string(), robot);
        robot.state.insert(rest.positions.begin(), rest.positions.end());
        add_warnings(rest.warnings);
        add_warnings(around.warnings);
        add_planning_scene(std::move(around), file, robot);
      } catch (const std::invalid_argument& error) {
        throw ParseError(file.string(), error.what());
      }
    }
  }

  /// Requires a base at the origin, as objects may be placed by the frame of the root link.
  void require_base_at_origin(const SceneRobot& robot, const std::filesystem::path& file) const {
    const Pose& base = std::get<FixedMotion>(robot.base).pose;
    if (detail::is_identity(base)) {
      return;
    }
    if (!question_.request.empty()) {
      throw ParseError(question_.request.string(),
                       "start_state.multi_dof_joint_state: expected a base at the planning frame "
                       "beside planning scene " +
                           file.string() + ", but it is moved; move the objects in its place");
    }
    throw ParseError(file.string(),
                     "expected a robot whose base is the planning frame, but it is moved");
  }

  static bool has_key(const detail::JsonValue& value, const char* key) {
    const auto* object = std::get_if<detail::JsonObject>(&value.value);
    return object != nullptr && detail::find(*object, key) != nullptr;
  }

  void add_mesh(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) {
      throw ParseError(file.string(),
                       "expected an environment (a mesh, a planning scene in .yaml, or "
                       "a scene in .json), found no such file");
    }
    add({.name = file.stem().string(),
         .shape = {.source = MeshFile{file, question_.environment_scale}},
         .motion = {}});
  }

  void add(Body body) {
    const auto is_taken = [&](const std::string& name) {
      const auto has_name = [&](const auto& other) { return other.name == name; };
      return name == robot_name_ ||
             std::any_of(scene_.bodies.begin(), scene_.bodies.end(), has_name) ||
             std::any_of(scene_.groups.begin(), scene_.groups.end(), has_name);
    };
    const std::string name = body.name;
    for (int k = 2; is_taken(body.name); ++k) {
      body.name = name + " (" + std::to_string(k) + ")";
    }
    scene_.bodies.push_back(std::move(body));
  }

  /// Adds the bodies of a scene, with their rules and options.
  void add_scene(Scene around, const std::filesystem::path& file) {
    if (!around.robots.empty()) {
      throw ParseError(file.string(), "expected an environment without robots, got " +
                                          std::to_string(around.robots.size()) +
                                          "; check this scene itself");
    }
    if (!scene_.bodies.empty()) {
      throw ParseError(file.string(),
                       "expected a scene as the first environment: its rules go by bodies");
    }
    const auto has_name = [&](const auto& other) { return other.name == robot_name_; };
    if (std::any_of(around.bodies.begin(), around.bodies.end(), has_name) ||
        std::any_of(around.groups.begin(), around.groups.end(), has_name)) {
      throw ParseError(file.string(), "expected no body or group " + in_quotes(robot_name_) +
                                          ", as the robot has this name; rename it");
    }
    scene_.file_reports.push_back(detail::surroundings_report(file, "scene", around.bodies.size()));
    around_ = file;
    around_duration_ = around.duration;
    scene_.bodies = std::move(around.bodies);
    scene_.groups = std::move(around.groups);
    scene_.ignored_pairs = std::move(around.ignored_pairs);
    scene_.pair_margins = std::move(around.pair_margins);
    scene_.ignored_groups = std::move(around.ignored_groups);
    scene_.group_margins = std::move(around.group_margins);
    scene_.options = around.options;
    scene_.options.lenient = around.options.lenient || question_.reading.lenient;
  }

  void add_planning_scene(PlanningScene around, const std::filesystem::path& file,
                          SceneRobot& robot) {
    if (around.moves_world && scene_.plan && !scene_.plan->link_goals.empty()) {
      throw ParseError(
          file.string(),
          "fixed_frame_transforms: expected \"world\" to be the planning frame beside a "
          "goal that is the pose of a link; call the frame otherwise");
    }
    scene_.file_reports.push_back(detail::surroundings_report(
        file, "planning scene", around.bodies.size() + around.attached.size()));
    for (std::size_t k = 0; k < around.bodies.size(); ++k) {
      add(std::move(around.bodies[k]));
      ids_[scene_.bodies.size() - 1] = around.object_ids[k];
    }
    for (AttachedObject& object : around.attached) {
      add_attached(std::move(object), robot);
    }
    for (const auto& [link, padding] : around.padding) {
      robot.padding[link_of(robot, link, "link_padding")] = padding;
    }
    for (const DisabledPair& pair : robot.semantics.disabled) {
      const std::string& link = robot.model.links()[pair.link].name;
      const std::string& other = robot.model.links()[pair.other].name;
      const auto entry =
          around.allowed.entries.find({std::min(link, other), std::max(link, other)});
      if (entry != around.allowed.entries.end() && !entry->second) {
        std::string warning = robot.name;
        warning.append(": the planning scene wants ").append(link).append(" and ").append(other);
        warning.append(" tested; the SRDF disables them, and that holds");
        scene_.warnings.push_back(std::move(warning));
      }
    }
    allowed_.push_back(std::move(around.allowed));
  }

  static std::size_t link_of(const SceneRobot& robot, const std::string& name,
                             const std::string& place) {
    const auto found = robot.model.find_link(name);
    if (!found) {
      refuse(place + ": expected a link of the robot, got " + in_quotes(name));
    }
    return *found;
  }

  /// Adds an attached object. Objects of one link are not tested against each other, as they may
  /// touch.
  void add_attached(AttachedObject object, SceneRobot& robot) {
    const std::string place = "attached object " + in_quotes(object.id);
    const std::size_t link = link_of(robot, object.link, place);
    std::vector<std::size_t> touch_links;
    for (const std::string& name : object.touch_links) {
      touch_links.push_back(link_of(robot, name, place));
    }
    for (Body& part : object.parts) {
      SceneAttachment attachment{.body = scene_.bodies.size(),
                                 .link = link,
                                 .touch_links = touch_links,
                                 .pose = std::get<FixedMotion>(part.motion).pose};
      for (const SceneAttachment& other : robot.attached) {
        if (other.link == link) {
          scene_.ignored_pairs.push_back({other.body, attachment.body});
        }
      }
      robot.attached.push_back(std::move(attachment));
      part.motion = FixedMotion{};
      add(std::move(part));
      ids_[scene_.bodies.size() - 1] = object.id;
    }
  }

  /// Allows the pairs that planning scenes allow: of links, and of held objects with all members.
  void allow_pairs() {
    if (allowed_.empty()) {
      return;
    }
    const std::size_t first = first_member(scene_, 0);
    const std::span<const Link> links = scene_.robots.front().model.links();
    const auto name = [&](std::size_t member) -> const std::string& {
      return member < first ? ids_.at(member) : links[member - first].name;
    };
    const auto moves = [&](std::size_t member) { return member >= first || is_held(member); };
    for (std::size_t link = 0; link < first + links.size(); ++link) {
      for (std::size_t other = 0; other < link; ++other) {
        const bool has_names =
            (link >= first || ids_.contains(link)) && (other >= first || ids_.contains(other));
        if (!has_names || !(moves(link) || moves(other))) {
          continue;
        }
        const auto allows = [&](const AllowedCollisions& allowed) {
          return allowed.allows(name(other), name(link));
        };
        if (std::any_of(allowed_.begin(), allowed_.end(), allows)) {
          scene_.ignored_pairs.push_back({other, link});
          scene_.allowed_pairs.push_back({other, link});
        }
      }
    }
  }

  [[nodiscard]] bool is_held(std::size_t body) const {
    const std::vector<SceneAttachment>& attached = scene_.robots.front().attached;
    return std::any_of(attached.begin(), attached.end(),
                       [&](const SceneAttachment& held) { return held.body == body; });
  }

  void set_duration() {
    constexpr double kSameDuration = 1e-9;  // [-]  Beyond the rounding of the fastest motion.
    const double last = last_time(scene_);
    scene_.duration = last > 0.0 ? last : around_duration_.value_or(1.0);
    const auto spans = [](const Body& body) { return spans_duration(body.motion); };
    const bool differs =
        states_duration_ && std::abs(around_duration_.value_or(scene_.duration) - scene_.duration) >
                                kSameDuration * scene_.duration;
    if (differs && std::any_of(scene_.bodies.begin(), scene_.bodies.end(), spans)) {
      throw ParseError(around_.string(),
                       "expected options.duration " + detail::write_json(scene_.duration) +
                           ", as the trajectory takes, since bodies move over all of it; got " +
                           detail::write_json(*around_duration_));
    }
  }

  const RobotQuestion& question_;
  Scene scene_;
  std::string robot_name_;
  std::string texts_;
  std::vector<AllowedCollisions> allowed_;
  std::map<std::size_t, std::string> ids_;  // Ids of bodies that come from planning scenes.
  std::filesystem::path around_;
  std::optional<JointPositions> goal_;  // Goal of a straight motion.
  double velocity_scaling_ = 1.0;       // [-]  Of that motion.
  std::optional<double> around_duration_;
  bool states_duration_ = false;  // Whether a duration is stated; else the motions span any
                                  // duration.
};

}  // namespace

Scene read_robot_question(const RobotQuestion& question) { return SceneBuilder(question).build(); }

}  // namespace firstcontact
