#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <firstcontact/foreign_scenes/planning_scene.h>
#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/robot_question.h>
#include <firstcontact/scene_files/write_scene.h>
#include <firstcontact/trajectory_files/read_trajectory.h>

#include "arguments.h"
#include "arrays.h"
#include "bindings.h"
#include "errors.h"
#include "reports.h"
#include "robots.h"
#include "words.h"

namespace firstcontact::python {

namespace py = pybind11;
using std::filesystem::path;

namespace {

/// Waypoints stay in step time.
BodyMotion body_motion_of(const RecordedMotion& motion) {
  const std::string kind = motion.factory;
  const py::tuple& given = motion.arguments;
  if (kind == "waypoints") {
    return WaypointMotion{given[0].cast<std::vector<double>>(), given[1].cast<std::vector<Pose>>(),
                          given[2].cast<Between>()};
  }
  const Pose start = given[0].cast<Pose>();
  if (kind == "fixed") {
    return FixedMotion{start};
  }
  if (given.size() == 2) {
    return TwoPoseMotion{start, given[1].cast<Pose>(),
                         kind == "screw" ? Between::screw : Between::constant_velocity};
  }
  if (kind == "screw") {
    return ScrewMotion{start, vector_from(given[1], "axis_point"),
                       vector_from(given[2], "axis_direction"), given[3].cast<double>(),
                       given[4].cast<double>()};
  }
  return ConstantVelocityMotion{start, vector_from(given[1], "translation"),
                                vector_from(given[2], "rotation_vector")};
}

std::string sha256(const py::bytes& bytes) {
  return py::module_::import("hashlib")
      .attr("sha256")(bytes)
      .attr("hexdigest")()
      .cast<std::string>();
}

std::string digest_after(const std::string& before, const py::object& said) {
  return sha256(py::bytes(before + std::string(py::repr(said))));
}

/// Compares scenes by their contents, with little work.
py::object contents_of(const Shape& shape) {
  const auto bytes = [](const auto& rows) {
    return py::bytes(reinterpret_cast<const char*>(rows.data()), rows.size() * sizeof(rows[0]));
  };
  return py::make_tuple(sha256(bytes(shape.mesh().vertices)), sha256(bytes(shape.mesh().triangles)),
                        shape.radius(), shape.is_solid(), shape.enclosure_error(),
                        shape.is_curved());
}

py::object contents_of(const Trajectory& trajectory) {
  std::vector<double> numbers;
  for (const TrajectoryPoint& point : trajectory.points) {
    numbers.push_back(point.time);
    for (const auto* list : {&point.positions, &point.velocities, &point.accelerations}) {
      numbers.push_back(static_cast<double>(list->size()));
      numbers.insert(numbers.end(), list->begin(), list->end());
    }
  }
  const std::string digest = sha256(
      py::bytes(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double)));
  if (trajectory.turning == Turning::as_given) {
    return py::make_tuple(trajectory.joint_names, digest);
  }
  return py::make_tuple(trajectory.joint_names, digest, to_string(trajectory.turning));
}

std::vector<path> environment_from(const py::object& value) {
  const char* const name = "environment";
  const char* const what = "a path or a sequence of paths (a scene as a dict: firstcontact.check)";
  if (value.is_none()) {
    return {};
  }
  if (PyUnicode_Check(value.ptr()) || py::hasattr(value, "__fspath__")) {
    return {argument<path>(value, name, what)};
  }
  return argument<std::vector<path>>(value, name, what);
}

void require_not_negative(double number, const std::string& name) {
  if (!(number >= 0.0)) {
    throw py::value_error(name + " must be >= 0, got " + std::string(py::repr(py::float_(number))));
  }
}

std::map<std::string, double> by_name(const py::handle value, const char* name) {
  return argument<std::map<std::string, double>>(value, name, "a dict of numbers by name");
}

/// Reads one number for all links, or numbers by their names.
void set_padding(HeldRobotScene& scene, const py::object& value) {
  std::map<std::size_t, double>& padding = scene.robot().padding;
  if (py::isinstance<py::dict>(value)) {
    for (const auto& [name, number] : by_name(value, "padding")) {
      require_not_negative(number, "padding");
      padding[scene.link(name)] = number;
    }
    return;
  }
  const auto all = argument<double>(value, "padding", "a number, or numbers by link");
  require_not_negative(all, "padding");
  for (std::size_t k = 0; all > 0.0 && k < scene.robot().model.links().size(); ++k) {
    padding[k] = all;
  }
}

std::size_t moving_joint(const RobotModel& model, const std::string& name) {
  const auto found = model.find_joint(name);
  if (!found) {
    (void)find_coordinate(model, name);  // Knows what is near.
  }
  if (!found || model.joints()[*found].type == JointType::fixed || model.joints()[*found].mimic) {
    throw py::value_error(
        "tracking_error: expected the name of a joint that moves by itself, got " +
        std::string(py::repr(py::str(name))));
  }
  return *found;
}

/// Reads one number for all joints, or numbers by their names.
void set_tracking_error(HeldRobotScene& scene, const py::object& value) {
  SceneRobot& robot = scene.robot();
  if (py::isinstance<py::dict>(value)) {
    for (const auto& [name, number] : by_name(value, "tracking_error")) {
      require_not_negative(number, "tracking_error");
      const std::size_t joint = moving_joint(robot.model, name);
      robot.tracking_error[joint] = joint_error(robot.model.joints()[joint], number);
    }
    return;
  }
  const auto all = argument<double>(value, "tracking_error", "a number, or numbers by joint");
  require_not_negative(all, "tracking_error");
  if (all > 0.0) {
    robot.tracking_error = joint_errors(robot.model, all);
  }
}

RobotFile file_from(const py::object& robot) {
  return py::isinstance<HeldRobotModel>(robot)
             ? robot.cast<const HeldRobotModel&>().file
             : RobotFile{.urdf = path_of(robot, "robot",
                                         "a RobotModel, or the path "
                                         "of a URDF")};
}

HeldRobotScene make_scene(const py::object& robot, const py::object& srdf,
                          const py::object& environment, const Pose& base, const py::object& state,
                          const py::object& padding, const py::object& tracking_error,
                          std::optional<double> margin, const std::shared_ptr<ShapeCache>& shapes,
                          double scale, bool lenient) {
  if (!(scale > 0.0 && std::isfinite(scale))) {
    throw py::value_error("scale must be > 0, got " + std::string(py::repr(py::float_(scale))));
  }
  RobotQuestion question{.robot = file_from(robot),
                         .base = base,
                         .environment_scale = scale,
                         .reading = {.lenient = lenient}};
  require_file(question.robot.urdf);
  if (!srdf.is_none()) {
    question.srdf = path_of(srdf, "srdf", "a RobotSemantics, or the path of an SRDF");
    require_file(question.srdf);
  }
  question.environment = environment_from(environment);
  for (const path& file : question.environment) {
    require_file(file);
  }
  Scene read = [&] {
    const py::gil_scoped_release release;
    return read_robot_question(question);
  }();
  if (margin) {
    require_not_negative(*margin, "margin");
    read.options.margin = *margin;
  }
  HeldRobotScene scene(std::move(read), shapes ? shapes : std::make_shared<ShapeCache>());
  JointPositions rest = positions_from(state, scene.robot());
  rest.insert(scene.robot().state.begin(), scene.robot().state.end());  // Of planning scenes.
  scene.robot().state = std::move(rest);
  set_padding(scene, padding);
  set_tracking_error(scene, tracking_error);
  return scene;
}

Trajectory straight(const HeldRobotScene& scene, const py::object& start, const py::object& goal,
                    Turning turning, double velocity_scaling) {
  require_scaling(velocity_scaling, "velocity_scaling");
  const SceneRobot& robot = scene.robot();
  JointPositions from = positions_from(start, robot);
  JointPositions to = from;
  for (const auto& [name, position] : positions_from(goal, robot)) {
    to[name] = position;
  }
  from.insert(robot.state.begin(), robot.state.end());
  return straight_motion(robot.model, from, to, turning, velocity_scaling);
}

}  // namespace

HeldRobotScene::HeldRobotScene(Scene scene, std::shared_ptr<ShapeCache> shapes)
    : scene_(std::move(scene)), shapes_(std::move(shapes)) {
  const auto spans = [](const Body& body) { return spans_duration(body.motion); };
  if (std::any_of(scene_.bodies.begin(), scene_.bodies.end(), spans)) {
    fixed_duration_ = scene_.duration;
  }
}

std::vector<std::size_t> HeldRobotScene::members(const std::string& name) const {
  const auto has_name = [&](const Body& body) { return body.name == name; };
  const auto link = robot().model.find_link(name);
  if (link && std::none_of(scene_.bodies.begin(), scene_.bodies.end(), has_name)) {
    return {first_member(scene_, 0) + *link};
  }
  return members_named(scene_, name);
}

std::size_t HeldRobotScene::link(const std::string& name) const {
  const auto found = robot().model.find_link(name);
  return found ? *found
               : members_named(scene_, robot().name + "/" + name).front() - first_member(scene_, 0);
}

void HeldRobotScene::add(const std::string& name, const Shape& shape, const RecordedMotion& X_WB) {
  const auto has_name = [&](const Body& body) { return body.name == name; };
  if (name.empty() || name == robot().name ||
      std::any_of(scene_.bodies.begin(), scene_.bodies.end(), has_name)) {
    throw py::value_error("name: expected one that no body and no robot has, got " +
                          std::string(py::repr(py::str(name))));
  }
  const BodyMotion motion = body_motion_of(X_WB);
  if (std::holds_alternative<WaypointMotion>(motion)) {
    in_step_time_.insert(scene_.bodies.size());
  }
  note(py::make_tuple("body", name, contents_of(shape), X_WB.factory, X_WB.arguments));
  add_body(scene_, {.name = name, .shape = {.source = shape}, .motion = motion});
}

void HeldRobotScene::attach(SceneAttachment attachment) {
  note(py::make_tuple("attach", attachment.body, attachment.link, attachment.from_time,
                      attachment.to_time, attachment.touch_links, attachment.pose));
  robot().attached.push_back(std::move(attachment));
}

void HeldRobotScene::ignore(const std::string& name, const std::string& other) {
  for (const std::size_t a : members(name)) {
    for (const std::size_t b : members(other)) {
      if (a != b) {
        scene_.ignored_pairs.push_back({std::min(a, b), std::max(a, b)});
      }
    }
  }
  note(py::make_tuple("ignore", name, other));
}

void HeldRobotScene::set_margin(const std::string& name, const std::string& other, double margin) {
  require_not_negative(margin, "margin");
  for (const std::size_t a : members(name)) {
    for (const std::size_t b : members(other)) {
      if (a != b) {
        const BodyPair pair{std::min(a, b), std::max(a, b)};
        std::erase_if(scene_.pair_margins,
                      [&](const PairMargin& known) { return known.bodies == pair; });
        scene_.pair_margins.push_back({pair, margin});
      }
    }
  }
  note(py::make_tuple("margin", name, other, margin));
}

std::shared_ptr<HeldScene> HeldRobotScene::along(const Trajectory* trajectory,
                                                 const std::string& id) const {
  Scene scene = scene_;
  SceneRobot& robot = scene.robots.front();
  scene.id = id;
  if (trajectory != nullptr) {
    robot.trajectory = *trajectory;
    scene.text_digest = digest_after(scene.text_digest, contents_of(*trajectory));
  }
  for (const std::size_t body : in_step_time_) {
    std::get<WaypointMotion>(scene.bodies[body].motion).times = {0.0};  // Do not count.
  }
  const double last = last_time(scene);
  scene.duration = last > 0.0 ? last : fixed_duration_.value_or(1.0);
  constexpr double kSameDuration = 1e-9;  // [-]  Beyond the rounding of the fastest motion.
  if (fixed_duration_ &&
      std::abs(*fixed_duration_ - scene.duration) > kSameDuration * scene.duration) {
    throw py::value_error("trajectory: expected one of " +
                          std::string(py::repr(py::float_(*fixed_duration_))) +
                          " s, as surroundings move over all of it, got one of " +
                          std::string(py::repr(py::float_(scene.duration))) + " s");
  }
  for (const std::size_t body : in_step_time_) {
    auto& waypoints = std::get<WaypointMotion>(scene.bodies[body].motion);
    waypoints = std::get<WaypointMotion>(scene_.bodies[body].motion);
    for (double& time : waypoints.times) {
      time *= scene.duration;
    }
  }
  (void)joint_motions(robot.model, robot.trajectory, robot.state, scene.duration);
  return std::make_shared<HeldScene>(std::move(scene), shapes_);
}

py::tuple HeldRobotScene::state() const {
  Scene scene = scene_;
  scene.robots.front().attached.clear();  // Their times wait for a trajectory.
  const double last = last_time(scene);
  scene.duration = last > 0.0 ? last : scene.duration;
  py::list attached;
  for (const SceneAttachment& a : robot().attached) {
    attached.append(py::make_tuple(a.body, a.link, a.from_time, a.to_time, a.touch_links, a.pose));
  }
  return py::make_tuple(write_scene(scene), scene.text_digest, scene.warnings, attached,
                        in_step_time_, fixed_duration_, reports_state(scene.file_reports),
                        scene.allowed_pairs);
}

HeldRobotScene HeldRobotScene::from_state(const py::tuple& state) {
  HeldRobotScene result(parse_scene(state[0].cast<std::string>(), "pickled scene"),
                        std::make_shared<ShapeCache>());
  result.scene_.text_digest = state[1].cast<std::string>();
  result.scene_.warnings = state[2].cast<std::vector<std::string>>();
  for (const py::handle element : state[3]) {
    const auto attached = element.cast<py::tuple>();
    result.robot().attached.push_back({.body = attached[0].cast<std::size_t>(),
                                       .link = attached[1].cast<std::size_t>(),
                                       .from_time = attached[2].cast<double>(),
                                       .to_time = attached[3].cast<std::optional<double>>(),
                                       .touch_links = attached[4].cast<std::vector<std::size_t>>(),
                                       .pose = attached[5].cast<std::optional<Pose>>()});
  }
  result.in_step_time_ = state[4].cast<std::set<std::size_t>>();
  result.fixed_duration_ = state[5].cast<std::optional<double>>();
  result.scene_.file_reports = reports_from(state[6]);
  result.scene_.allowed_pairs = state[7].cast<std::vector<BodyPair>>();
  return result;
}

void HeldRobotScene::note(const py::object& said) {
  scene_.text_digest = digest_after(scene_.text_digest, said);
}

/// Makes a trajectory of a dict or of columns by joint.
Trajectory trajectory_from(const py::object& value, const RobotModel& robot) {
  const py::object made =
      py::module_::import("firstcontact._trajectory").attr("trajectory_from")(value);
  if (py::isinstance<Trajectory>(made)) {
    return made.cast<Trajectory>();
  }
  return parse_trajectory(made.cast<std::string>(), "trajectory.json", robot);
}

std::shared_ptr<HeldScene> scene_along(const HeldRobotScene& scene, const py::object& trajectory) {
  if (trajectory.is_none()) {
    return scene.along(nullptr, scene.robot().name);
  }
  if (py::isinstance<Trajectory>(trajectory)) {
    return scene.along(&trajectory.cast<const Trajectory&>(), scene.robot().name);
  }
  if (!PyUnicode_Check(trajectory.ptr()) && !py::hasattr(trajectory, "__fspath__")) {
    const Trajectory made = trajectory_from(trajectory, scene.robot().model);
    return scene.along(&made, scene.robot().name);
  }
  const auto file = argument<path>(trajectory, "trajectory", "a path");
  require_file(file);
  const Trajectory read = read_trajectory(file, scene.robot().model);
  return scene.along(&read, file.filename().string());
}

void attach_body(HeldRobotScene& s, const std::string& body, const std::string& link,
                 double from_time, std::optional<double> to_time,
                 const std::vector<std::string>& touch_links, const std::optional<Pose>& pose) {
  const std::vector<std::size_t> found = members_named(s.scene(), body);
  if (found.size() != 1 || found.front() >= s.scene().bodies.size()) {
    throw py::value_error("body: expected the name of a body, got " +
                          std::string(py::repr(py::str(body))));
  }
  SceneAttachment attachment{.body = found.front(),
                             .link = s.link(link),
                             .from_time = from_time,
                             .to_time = to_time,
                             .pose = pose};
  for (const std::string& touched : touch_links) {
    attachment.touch_links.push_back(s.link(touched));
  }
  s.attach(std::move(attachment));
}

void bind_robot_scene(py::module_& m) {
  RobotSceneClass type(m, "RobotScene",
                       R"(A robot and its environment, to be checked along trajectories.

It is the tool's `firstcontact check --robot`, from Python. Meshes are read, and hierarchies built,
once for all trajectories. Bodies and rules may be added between questions, not from several threads
at once. Results of along() do not change with them. For several robots, or a base that moves, write
a scene (check, load_scene).)");
  type.def(py::init(&make_scene), py::arg("robot"), py::arg("srdf") = py::none(),
           py::arg("environment") = py::tuple(), py::kw_only(), py::arg("base") = Pose{},
           py::arg("state") = py::tuple(), py::arg("padding") = 0.0,
           py::arg("tracking_error") = 0.0, py::arg("margin") = py::none(),
           py::arg("shapes") = py::none(), py::arg("scale") = 1.0, py::arg("lenient") = false,
           R"(robot: a RobotModel, or the path of a URDF. srdf: a RobotSemantics, or its path.
environment: paths of meshes, MoveIt planning scenes (.yaml) and scenes (.json) without robots.
base: pose of the robot's root link. state: positions of joints that a trajectory does not name: a
dict by joint, the name of a state of the SRDF, or a sequence of these. padding: [m] of every link,
or a dict by link. tracking_error: [rad or m] of every joint, or a dict by joint; the answer then
holds for every motion within it. margin: [m] of every pair; that of the environment or 0 by
default. shapes: a ShapeCache to share meshes with other scenes. scale: [-] of the meshes of the
environment; 0.001 reads millimetres. lenient: as for load_scene.)")
      .def_property_readonly(
          "robot",
          [](const HeldRobotScene& s) {
            return HeldRobotModel{s.robot().file, s.robot().model};
          },
          "The RobotModel.")
      .def_property_readonly(
          "bodies",
          [](const HeldRobotScene& s) {
            py::list names;
            for (const Body& body : s.scene().bodies) {
              names.append(body.name);
            }
            return py::tuple(names);
          },
          "The names of the bodies around the robot, in order.")
      .def(
          "add_body",
          [](HeldRobotScene& s, const std::string& name, const Shape& shape,
             const RecordedMotion& X_WB) { s.add(name, shape, X_WB); },
          py::arg("name"), py::arg("shape"),
          py::arg("X_WB") = RecordedMotion{Motion::fixed(), "fixed", py::make_tuple(Pose{})},
          "Adds a body. Its motion takes the duration of the trajectory: t runs from 0 to 1 over "
          "it.")
      .def("attach", &attach_body, py::arg("body"), py::arg("link"), py::arg("from_time") = 0.0,
           py::arg("to_time") = py::none(), py::arg("touch_links") = py::tuple(),
           py::arg("pose") = py::none(),
           R"(Lets a link carry a body from one time to another [s], to the end by default.

Meanwhile the body is not tested against the link and the touch_links. Before, it moves by itself;
after, it rests. pose: of the body in the link's frame, from the start on; by default its pose there
at from_time.)")
      .def("ignore", &HeldRobotScene::ignore, py::arg("name"), py::arg("other"),
           "Excludes two bodies or links from the tests; the robot's name means all of its links.")
      .def("set_margin", &HeldRobotScene::set_margin, py::arg("name"), py::arg("other"),
           py::arg("margin"),
           "Sets the margin [m] of two bodies or links, named as for ignore; >= 0.")
      .def("straight_motion", &straight, py::arg("start"), py::arg("goal"),
           py::arg("turning") = Turning::shortest, py::arg("velocity_scaling") = 1.0,
           R"(Makes a trajectory straight in joint space, as fast as the velocity limits allow.

start, goal: as `state` of the constructor; joints that the goal does not name keep their start.
turning: the way of continuous joints and of the angles of planar ones, "short" as MoveIt goes, or
"long" by the numbers. velocity_scaling: factor of the velocity limits, in (0, 1].)")
      .def("along", &scene_along, py::arg("trajectory"),
           R"(Makes the Scene of this robot on a trajectory, as for check_many.

trajectory: a Trajectory, the path of one, or None where the robot rests.)")
      .def("__repr__",
           [](const HeldRobotScene& s) {
             return "<RobotScene of " + s.robot().name + " and " +
                    std::to_string(s.scene().bodies.size()) + " bodies>";
           })
      .def(py::pickle([](const HeldRobotScene& s) { return s.state(); },
                      &HeldRobotScene::from_state));
  bind_check_along(type);
}

}  // namespace firstcontact::python
