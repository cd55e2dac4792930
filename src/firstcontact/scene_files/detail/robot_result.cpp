#include <firstcontact/scene_files/detail/robot_result.h>

#include <string>
#include <utility>

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/motion/time_window.h>
#include <firstcontact/robot/limit_report.h>
#include <firstcontact/robot_check/check_robots.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/scene/trajectory.h>
#include <firstcontact/scene_files/detail/contact_json.h>
#include <firstcontact/scene_files/detail/result_json.h>

namespace firstcontact::detail {
namespace {

const char* word(JointLimit limit) { return kJointLimitWords[static_cast<std::size_t>(limit)]; }

class RobotResultWriter {
 public:
  explicit RobotResultWriter(const LoadedScene& loaded)
      : scene_(loaded.scene), members_(*loaded.robots) {}

  [[nodiscard]] JsonObject head(const RobotCheckResult& result) const {
    ContactArray contacts(scene_.duration);
    ContactCount count{0, true};
    for (const RobotPairAnswer& pair : result.pairs) {
      if (result.first && pair.t == result.t) {
        append_contacts(pair, contacts);
        count += pair.contact_count;
      }
    }
    JsonObject object{{"id", to_json(scene_.id)},
                      {"verdict", to_json(firstcontact::word(result.verdict))},
                      {"reason", to_json(result.reason)},
                      {"t", to_json(result.t)},
                      {"t_upper", to_json(result.t_upper)},
                      {"time", seconds(result.t)},
                      {"pair", result.first ? names(result.pairs[*result.first].members)
                                            : JsonValue{.value = JsonNull{}}},
                      {"contacts", contacts.take()}};
    append_contact_count(count, object);
    object.push_back({"clearance", to_json(result.clearance)});
    return object;
  }

  [[nodiscard]] JsonValue closest(const RobotPairAnswer& pair) const {
    const LeastClearance& found = *pair.least_clearance;
    JsonObject object{{"pair", names(pair.members)},
                      {"distance", to_json(found.distance)},
                      {"lower_bound", to_json(found.lower_bound)},
                      {"t", to_json(found.t)},
                      {"time", seconds(found.t)},
                      {"reason", to_json(found.reason)}};
    if (found.closest) {
      object.push_back({"points", two(to_json(found.closest->p_WA), to_json(found.closest->p_WB))});
    }
    return {.value = std::move(object)};
  }

  [[nodiscard]] JsonValue pair(const RobotPairAnswer& pair) const {
    ContactArray contacts(scene_.duration);
    append_contacts(pair, contacts);
    JsonObject object{{"pair", names(pair.members)},
                      {"margin", to_json(pair.threshold)},
                      {"verdict", to_json(firstcontact::word(pair.verdict))},
                      {"reason", to_json(pair.reason)},
                      {"t", to_json(pair.t)},
                      {"t_upper", to_json(pair.t_upper)},
                      {"time", seconds(pair.t)},
                      {"contacts", contacts.take()}};
    append_contact_count(pair.contact_count, object);
    object.push_back({"clearance", to_json(proven_clearance(pair))});
    append_tolerances(pair.tolerance_used, pair.enclosure_error, object);
    if (pair.least_clearance) {
      object.push_back({"closest", closest(pair)});
    }
    if (!pair.intervals.empty()) {
      object.push_back({"intervals", intervals(pair)});
    }
    return {.value = std::move(object)};
  }

  /// Only where they differ from what was asked, and from 0.
  void append_tolerances(double tolerance_used, double enclosure_error, JsonObject& object) const {
    if (tolerance_used > scene_.options.tolerance) {
      object.push_back({"tolerance_used", to_json(tolerance_used)});
    }
    if (enclosure_error > 0.0) {
      object.push_back({"enclosure_error", to_json(enclosure_error)});
    }
  }

  [[nodiscard]] static JsonValue turn(const SceneRobot& robot, const JointTurn& turn) {
    return {.value = JsonObject{{"robot", to_json(robot.name)},
                                {"joint", to_json(turn.joint)},
                                {"from", to_json(turn.from)},
                                {"to", to_json(turn.to)},
                                {"turned", to_json(turn.turned)},
                                {"turning", to_json(to_string(turn.turning))}}};
  }

  [[nodiscard]] JsonValue limit(const SceneRobot& robot, const LimitViolation& violation) const {
    JsonArray intervals;
    for (const TimeWindow& interval : violation.intervals) {
      intervals.push_back(two(seconds(interval.begin), seconds(interval.end)));
    }
    return {.value = JsonObject{{"robot", to_json(robot.name)},
                                {"joint", to_json(robot.model.joints()[violation.joint].name)},
                                {"limit", to_json(word(violation.what))},
                                {"value", to_json(violation.limit)},
                                {"excess", to_json(violation.excess)},
                                {"time", seconds(violation.t_excess)},
                                {"intervals", {.value = std::move(intervals)}}}};
  }

 private:
  [[nodiscard]] JsonValue seconds(double t) const { return to_json(t * scene_.duration); }

  [[nodiscard]] JsonValue names(const BodyPair& members) const {
    return two(to_json(members_.name(members[0])), to_json(members_.name(members[1])));
  }

  [[nodiscard]] JsonValue intervals(const RobotPairAnswer& pair) const {
    JsonArray array;
    for (const ContactInterval& interval : pair.intervals) {
      array.push_back({.value = JsonObject{{"enter", to_json(interval.enter)},
                                           {"leave", to_json(interval.leave)},
                                           {"enter_time", seconds(interval.enter)},
                                           {"leave_time", seconds(interval.leave)},
                                           {"reason", to_json(interval.reason)}}});
    }
    return {.value = std::move(array)};
  }

  void append_contacts(const RobotPairAnswer& pair, ContactArray& array) const {
    array.set_names(names(pair.members));
    for (const RobotContact& found : pair.contacts) {
      array.add(found.contact, found.geometries);
    }
  }

  const Scene& scene_;
  const RobotScene& members_;
};

}  // namespace

JsonObject robot_result(const LoadedScene& loaded, const RobotCheckResult& result, bool all_pairs) {
  const RobotResultWriter writer(loaded);
  JsonObject object = writer.head(result);
  if (result.closest) {
    object.push_back({"closest", writer.closest(result.pairs[*result.closest])});
  }
  if (all_pairs) {
    JsonArray pairs;
    for (const RobotPairAnswer& pair : result.pairs) {
      pairs.push_back(writer.pair(pair));
    }
    object.push_back({"pairs", {.value = std::move(pairs)}});
  }
  writer.append_tolerances(result.tolerance_used, result.enclosure_error, object);
  JsonArray turns;
  for (const SceneRobot& robot : loaded.scene.robots) {
    for (const JointTurn& turn : joint_turns(robot.model, robot.trajectory)) {
      turns.push_back(RobotResultWriter::turn(robot, turn));
    }
  }
  if (!turns.empty()) {
    object.push_back({"turns", {.value = std::move(turns)}});
  }
  JsonArray limits;
  for (const SceneLimits& of_robot : loaded.limits) {
    for (const LimitViolation& violation : of_robot.violations) {
      limits.push_back(writer.limit(loaded.scene.robots[of_robot.robot], violation));
    }
  }
  object.push_back({"limits", {.value = std::move(limits)}});
  object.push_back({"warnings", to_json(check_warnings(loaded))});
  return object;
}

}  // namespace firstcontact::detail
