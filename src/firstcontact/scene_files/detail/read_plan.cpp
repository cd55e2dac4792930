#include <firstcontact/scene_files/detail/read_plan.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <firstcontact/scene/detail/robot_name.h>
#include <firstcontact/scene/detail/scene_names.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene_files/detail/floating_state.h>
#include <firstcontact/scene_files/detail/read_pose.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

constexpr std::size_t kSeeds = std::size_t{1} << 53;  // Whole numbers that JSON keeps.

class PlanReader {
 public:
  PlanReader(const Scene& scene, const JsonReader& read) : scene_(scene), read_(read) {}

  PlanQuestion plan(const JsonValue& value) const {
    const JsonObject& object = read_.object(
        value, {{"robot", "robots", "body", "joints", "start", "goal", "goals", "bounds", "box",
                 "speeds", "margin", "planner", "contacts", "contact_pairs", "seed", "time"}});
    PlanQuestion plan;
    take_mover(value, object, plan);
    take_options(object, plan);
    take_contact_pairs(object, plan);
    if (plan.robots.empty()) {
      take_body(object, plan);
    } else {
      take_joints(object, plan);
    }
    take_goals(value, object, plan);
    return plan;
  }

 private:
  void take_mover(const JsonValue& value, const JsonObject& object, PlanQuestion& plan) const {
    const JsonValue* robot = find(object, "robot");
    const JsonValue* robots = find(object, "robots");
    const JsonValue* body = find(object, "body");
    if (robot != nullptr && robots != nullptr) {
      read_.fail(value, "expected either \"robot\" or \"robots\", got both");
    }
    if (body != nullptr) {
      plan.body = numbered(*body, "body", scene_.bodies);
    }
    if (robot != nullptr) {
      plan.robots = {numbered(*robot, "robot", scene_.robots)};
    } else if (robots != nullptr) {
      take_robots(*robots, plan);
    } else if (body != nullptr) {
      // It moves alone.
    } else if (scene_.robots.size() == 1) {
      plan.robots = {0};
    } else {
      read_.fail(value, "expected \"robot\", \"robots\" or \"body\", the name of what moves");
    }
  }

  void take_robots(const JsonValue& value, PlanQuestion& plan) const {
    for (const JsonValue& one : read_.array(value, "an array of names of robots")) {
      const std::size_t robot = numbered(one, "robot", scene_.robots);
      if (std::ranges::find(plan.robots, robot) != plan.robots.end()) {
        read_.fail(one, "expected each robot once, got it a second time");
      }
      plan.robots.push_back(robot);
    }
    if (plan.robots.size() < 2) {
      read_.fail_expected("at least two robots; a single one is \"robot\"", value);
    }
  }

  template <class Named>
  std::size_t numbered(const JsonValue& value, const std::string& what,
                       const std::vector<Named>& all) const {
    const std::string& name = read_.string(value, "the name of a " + what);
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
    if (all.empty()) {
      read_.fail(value, "expected a scene with the " + what + " " + in_quotes(name) +
                            ", but the scene has no " + (what == "body" ? "bodies" : "robots"));
    }
    if (found == all.end()) {
      std::vector<std::string_view> names;
      for (const Named& one : all) {
        names.push_back(one.name);
      }
      const std::string_view near = nearest_word(name, names);
      read_.fail(value, "expected the name of a " + what + " of the scene, got " + in_quotes(name) +
                            (near.empty() ? "" : "; did you mean " + in_quotes(near) + "?"));
    }
    return static_cast<std::size_t>(found - all.begin());
  }

  void take_options(const JsonObject& object, PlanQuestion& plan) const {
    if (const JsonValue* margin = find(object, "margin")) {
      plan.margin = read_.not_negative(*margin);
    }
    if (const JsonValue* planner = find(object, "planner")) {
      plan.planner = read_.enumerator<Planner>(*planner, kPlannerWords);
    }
    if (const JsonValue* contacts = find(object, "contacts")) {
      plan.contacts = read_.enumerator<ContactUse>(*contacts, kContactUseWords);
    }
    if (const JsonValue* seed = find(object, "seed")) {
      plan.seed = read_.index(*seed, kSeeds, "a seed, a whole number");
    }
    if (const JsonValue* time = find(object, "time")) {
      plan.time = read_.positive(*time);
    }
  }

  void take_contact_pairs(const JsonObject& object, PlanQuestion& plan) const {
    const JsonValue* pairs = find(object, "contact_pairs");
    if (pairs == nullptr) {
      return;
    }
    const SceneNames names = names_in(scene_);
    for (const JsonValue& element : read_.array(*pairs, "an array of pairs in contact")) {
      const JsonObject& entry = read_.object(element, {{"pair", "policy", "at"}});
      const JsonValue& pair = read_.member(element, "pair");
      const JsonArray& two = read_.array(pair, "a pair of names, such as [\"peg\", \"block\"]");
      if (two.size() != 2) {
        read_.fail_expected("a pair of names, such as [\"peg\", \"block\"]", pair);
      }
      ContactPair contact;
      const std::size_t a = member_named(two[0], names);
      const std::size_t b = member_named(two[1], names);
      contact.members = {std::min(a, b), std::max(a, b)};
      if (a == b) {
        read_.fail(pair, "expected two bodies, got one twice");
      }
      contact.policy =
          read_.enumerator<ContactPolicy>(read_.member(element, "policy"), kContactPolicyWords);
      if (const JsonValue* at = find(entry, "at")) {
        contact.at = read_.enumerator<PathEnd>(*at, kPathEndWords);
      }
      // A pair may open at the start and close at the goal; other holds are of the whole path.
      const auto contradicts = [&](const ContactPair& other) {
        const bool opens = other.policy == ContactPolicy::must_open &&
                           contact.policy == ContactPolicy::must_open && other.at != contact.at;
        return other.members == contact.members && !opens;
      };
      if (std::any_of(plan.contact_pairs.begin(), plan.contact_pairs.end(), contradicts)) {
        read_.fail(pair,
                   "expected each pair once, or must_open at both ends; got it a second time");
      }
      plan.contact_pairs.push_back(contact);
    }
  }

  /// Reads a body or a link: members that may be in contact are named exactly.
  std::size_t member_named(const JsonValue& value, const SceneNames& names) const {
    const std::string what =
        scene_.robots.empty() ? "the name of a body" : "the name of a body, or robot/link";
    const std::string& name = read_.string(value, what);
    const auto found = names.find(name);
    if (found == names.end()) {
      read_.fail(value, "expected " + what + ", got " + in_quotes(name) + hint(names, name));
    }
    if (found->second.kind != Named::Kind::member) {
      read_.fail(value, "expected " + what + ", got the robot or group " + in_quotes(name));
    }
    return found->second.index;
  }

  void take_joints(const JsonObject& object, PlanQuestion& plan) const {
    const JsonValue* box = find(object, "box");
    if (box != nullptr && !plan.body) {
      read_.fail(*box, "\"box\" is of a body; a robot has \"bounds\"");
    }
    take_box(object, plan);
    if (const JsonValue* joints = find(object, "joints")) {
      for (const JsonValue& joint : read_.array(*joints, "an array of names of joints")) {
        const std::string& name = read_.string(joint, "the name of a joint");
        if (is_body(name, plan)) {
          continue;  // It is planned in any case.
        }
        plan.joints.push_back(is_floating(joint, name, plan) ? name
                                                             : known_joint(joint, name, plan));
      }
    }
    if (const JsonValue* start = find(object, "start")) {
      plan.start = state(*start, plan);
    }
    if (const JsonValue* speeds = find(object, "speeds")) {
      for (const auto& [name, speed] : members_of(*speeds, "speeds by joint")) {
        const std::size_t slash = name.rfind('/');
        const std::string of = name.substr(0, slash);
        const bool is_rate = name.ends_with("/linear") || name.ends_with("/angular");
        plan.speeds[is_rate && is_floating(speed, of, plan) ? name
                                                            : known_joint(speed, name, plan)] =
            speed_of(speed);
      }
    }
    if (const JsonValue* bounds = find(object, "bounds")) {
      for (const auto& [name, limits] :
           members_of(*bounds, "limits by joint, such as {\"joint\": [-1, 1]}")) {
        const JsonArray& two = read_.array(limits, "two numbers");
        if (two.size() != 2) {
          read_.fail_expected("two numbers, the lower limit first", limits);
        }
        plan.bounds[known_joint(limits, name, plan)] = {read_.number(two[0]), read_.number(two[1])};
      }
    }
  }

  double speed_of(const JsonValue& value) const {
    constexpr double kMostSpeed = 1e8;
    const double speed = read_.positive(value);
    if (speed > kMostSpeed) {
      read_.fail_expected("a speed of at most 1e8", value);
    }
    return speed;
  }

  const JsonObject& members_of(const JsonValue& value, const std::string& expected) const {
    const auto* all = std::get_if<JsonObject>(&value.value);
    if (all == nullptr) {
      read_.fail_expected(expected, value);
    }
    return *all;
  }

  void take_body(const JsonObject& object, PlanQuestion& plan) const {
    for (const char* key : {"joints", "bounds"}) {
      if (const JsonValue* given = find(object, key)) {
        read_.fail(*given, in_quotes(key) + " is of a robot; a body has \"box\"");
      }
    }
    if (const JsonValue* start = find(object, "start")) {
      plan.start_pose = read_pose(*start, read_);
    }
    if (const JsonValue* speeds = find(object, "speeds")) {
      (void)read_.object(*speeds, {{"linear", "angular"}});
      for (const char* key : {"linear", "angular"}) {
        plan.speeds[key] = speed_of(read_.member(*speeds, key));
      }
    }
    take_box(object, plan);
  }

  void take_box(const JsonObject& object, PlanQuestion& plan) const {
    if (const JsonValue* box = find(object, "box")) {
      const JsonArray& corners = read_.array(*box, "two corners");
      if (corners.size() != 2) {
        read_.fail_expected("two corners, the low one first", *box);
      }
      plan.box = {read_.vector3(corners[0]), read_.vector3(corners[1])};
    }
  }

  void take_goals(const JsonValue& value, const JsonObject& object, PlanQuestion& plan) const {
    const JsonValue* goal = find(object, "goal");
    const JsonValue* goals = find(object, "goals");
    if ((goal == nullptr) == (goals == nullptr)) {
      read_.fail(value, goal == nullptr ? "expected \"goal\" or \"goals\", got neither"
                                        : "expected either \"goal\" or \"goals\", got both");
    }
    std::vector<const JsonValue*> all;
    if (goal != nullptr) {
      all.push_back(goal);
    } else {
      plan.lists_goals = true;
      for (const JsonValue& one : read_.array(*goals, "an array of goals")) {
        all.push_back(&one);
      }
    }
    if (all.empty()) {
      read_.fail_expected("at least one goal", *goals);
    }
    for (const JsonValue* one : all) {
      if (plan.robots.empty()) {
        plan.goal_poses.push_back(read_pose(*one, read_));
      } else if (is_link_goal(*one)) {
        plan.link_goals.push_back(link_goal(*one, plan));
      } else {
        plan.goals.push_back(state(*one, plan));
      }
    }
  }

  /// Whether a goal names a link: positions of joints are numbers, the name of a link is a string.
  static bool is_link_goal(const JsonValue& value) {
    const auto* object = std::get_if<JsonObject>(&value.value);
    const JsonValue* link = object == nullptr ? nullptr : find(*object, "link");
    return link != nullptr && std::holds_alternative<std::string>(link->value);
  }

  LinkGoal link_goal(const JsonValue& value, const PlanQuestion& plan) const {
    const JsonObject& object = read_.object(
        value, {{"link", "frame", "pose", "position_tolerance", "rotation_tolerance"}});
    LinkGoal goal;
    const JsonValue& link = read_.member(value, "link");
    goal.link = read_.string(link, "the name of a link");
    const RobotName split = split_name(link, goal.link, plan);
    if (split.which == plan.robots.size()) {
      read_.fail(link, "expected a link of a robot, got " + in_quotes(goal.link));
    }
    const RobotModel& model = scene_.robots[plan.robots[split.which]].model;
    if (!model.find_link(split.name)) {
      std::vector<std::string_view> names;
      for (const Link& one : model.links()) {
        names.push_back(one.name);
      }
      const std::string_view near = nearest_word(split.name, names);
      read_.fail(link, "expected a link of the robot, got " + in_quotes(goal.link) +
                           (near.empty() ? "" : "; did you mean " + in_quotes(near) + "?"));
    }
    goal.X_WT = read_pose(read_.member(value, "pose"), read_);
    if (const JsonValue* frame = find(object, "frame")) {
      goal.X_LT = read_pose(*frame, read_);
    }
    if (const JsonValue* tolerance = find(object, "position_tolerance")) {
      goal.position_tolerance = read_.positive(*tolerance);
    }
    if (const JsonValue* tolerance = find(object, "rotation_tolerance")) {
      goal.rotation_tolerance = read_.positive(*tolerance);
    }
    return goal;
  }

  RobotName split_name(const JsonValue& where, const std::string& name,
                       const PlanQuestion& plan) const {
    try {
      return split_mover_name(scene_, {plan.robots, plan.body}, name);
    } catch (const std::invalid_argument& error) {
      read_.fail(where, error.what());
    }
  }

  /// A name within one of the movers, in the form of the question.
  std::string full_name(const PlanQuestion& plan, std::size_t which,
                        const std::string& name) const {
    return joined_mover_name(scene_, {plan.robots, plan.body}, which, name);
  }

  /// Whether a name is that of the body which moves beside robots.
  [[nodiscard]] bool is_body(const std::string& name, const PlanQuestion& plan) const {
    return plan.body && scene_.bodies[*plan.body].name == name;
  }

  /// Whether a name is that of a floating joint or of the body, whose pose is planned as a whole.
  bool is_floating(const JsonValue& where, const std::string& name,
                   const PlanQuestion& plan) const {
    if (is_body(name, plan)) {
      return true;
    }
    const RobotName split = split_name(where, name, plan);
    if (split.which == plan.robots.size()) {
      return false;
    }
    const RobotModel& model = scene_.robots[plan.robots[split.which]].model;
    const auto joint = model.find_joint(split.name);
    return joint && model.joints()[*joint].type == JointType::floating;
  }

  std::string known_joint(const JsonValue& where, const std::string& name,
                          const PlanQuestion& plan) const {
    const RobotName split = split_name(where, name, plan);
    if (split.which == plan.robots.size()) {
      if (!pose_index(split.name)) {
        read_.fail(where,
                   "expected a number of the pose of the body, such as trans_x or rot_w, got " +
                       in_quotes(name));
      }
      return name;
    }
    const RobotModel& model = scene_.robots[plan.robots[split.which]].model;
    try {
      return full_name(plan, split.which,
                       coordinate_name(model, find_coordinate(model, split.name)));
    } catch (const std::invalid_argument& error) {
      read_.fail(where, error.what());
    }
  }

  /// Reads a state of the SRDF by its name, coordinates by theirs, or an array of both.
  JointPositions state(const JsonValue& value, const PlanQuestion& plan) const {
    JointPositions positions;
    add_state(value, plan, positions);
    return positions;
  }

  void add_state(const JsonValue& value, const PlanQuestion& plan,
                 JointPositions& positions) const {
    if (const auto* array = std::get_if<JsonArray>(&value.value)) {
      for (const JsonValue& element : *array) {
        add_state(element, plan, positions);
      }
    } else if (const auto* name = std::get_if<std::string>(&value.value)) {
      const RobotName split = split_name(value, *name, plan);
      if (split.which == plan.robots.size()) {
        read_.fail(value, "expected a state of a robot, got " + in_quotes(*name));
      }
      const SceneRobot& robot = scene_.robots[plan.robots[split.which]];
      try {
        for (const auto& [joint, position] :
             group_state(robot.model, robot.semantics, split.name)) {
          positions[full_name(plan, split.which, joint)] = position;
        }
      } catch (const std::invalid_argument& error) {
        read_.fail(value, error.what());
      }
    } else if (const auto* object = std::get_if<JsonObject>(&value.value)) {
      JointPositions own;
      for (const auto& [joint, position] : *object) {
        add_once(read_positions(joint, position, plan), own, position, read_);
      }
      for (const auto& [joint, position] : own) {
        positions[joint] = position;
      }
    } else {
      read_.fail_expected(
          "positions by joint, such as {\"joint\": 0.1}, or the name of a state of the SRDF",
          value);
    }
  }

  /// Reads the position of a coordinate, or the pose of a floating joint or of the body.
  JointPositions read_positions(const std::string& name, const JsonValue& value,
                                const PlanQuestion& plan) const {
    if (is_body(name, plan)) {
      return pose_positions({.name = name, .type = JointType::floating}, value, read_);
    }
    const RobotName split = split_name(value, name, plan);
    if (split.which < plan.robots.size()) {
      const RobotModel& model = scene_.robots[plan.robots[split.which]].model;
      if (const auto pose = floating_positions(model, split.name, value, read_)) {
        JointPositions named;
        for (const auto& [coordinate, number] : *pose) {
          named[full_name(plan, split.which, coordinate)] = number;
        }
        return named;
      }
    }
    return {{known_joint(value, name, plan), read_.number(value)}};
  }

  const Scene& scene_;
  const JsonReader& read_;
};

}  // namespace

PlanQuestion read_plan(const JsonValue& value, const Scene& scene, const JsonReader& read) {
  return PlanReader(scene, read).plan(value);
}

}  // namespace firstcontact::detail
