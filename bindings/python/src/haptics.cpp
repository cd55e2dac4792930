#include <firstcontact/haptic_sessions/haptic_session.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

#include <firstcontact/haptics_files/haptic_log.h>
#include <firstcontact/haptics_files/haptic_run.h>
#include <firstcontact/haptics_files/haptic_setup.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/record/write_run.h>

#include "arrays.h"
#include "bindings.h"
#include "busy.h"
#include "run.h"
#include "scene.h"

namespace firstcontact::python {

namespace py = pybind11;

namespace {

/// Poses as n×7 numbers: position, then quaternion w, x, y, z.
py::array rows_of_poses(const std::vector<Pose>& poses) {
  py::array_t<double> array({static_cast<py::ssize_t>(poses.size()), py::ssize_t{7}});
  auto row = array.mutable_unchecked<2>();
  for (py::ssize_t k = 0; k < row.shape(0); ++k) {
    const auto& [p, q] = poses[static_cast<std::size_t>(k)];
    const std::array numbers{p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()};
    for (py::ssize_t i = 0; i < 7; ++i) {
      row(k, i) = numbers[static_cast<std::size_t>(i)];
    }
  }
  return array;
}

/// The pose of a row of seven numbers; none where all are NaN.
std::optional<Pose> pose_of_row(const double* row, py::ssize_t number) {
  if (std::all_of(row, row + 7, [](double x) { return std::isnan(x); })) {
    return std::nullopt;
  }
  const Pose pose{{row[0], row[1], row[2]}, Eigen::Quaterniond(row[3], row[4], row[5], row[6])};
  try {
    (void)Motion::fixed(pose);  // Refuses what a Pose refuses.
  } catch (const std::invalid_argument& error) {
    throw py::value_error("poses: row " + std::to_string(number) + ": " + error.what());
  }
  return pose;
}

/// The poses of handles: a sequence of Pose and None, or n×7 numbers.
std::vector<std::optional<Pose>> poses_from(const py::object& value) {
  using Poses = std::vector<std::optional<Pose>>;
  if (!py::isinstance<py::array>(value)) {
    try {
      return value.cast<Poses>();
    } catch (const py::cast_error&) {
      // Rows of numbers, or the complaint below.
    }
  }
  const py::array_t<double> array = matrix_from(value, "poses");
  if (array.shape(1) != 7) {
    throw py::value_error(
        "poses: expected an array of shape (n, 7), position and quaternion w, x, y, z per row; "
        "got " +
        std::to_string(array.shape(1)) + " columns");
  }
  Poses poses;
  for (py::ssize_t k = 0; k < array.shape(0); ++k) {
    poses.push_back(pose_of_row(array.data(k, 0), k));
  }
  return poses;
}

/// A tick with the state at its time.
struct FeltTick {
  ForceTick tick;
  std::size_t tools = 0;
  std::array<std::size_t, kMostTools> grips = {};

  template <class What>
  [[nodiscard]] py::array rows(What what) const {
    std::vector<Eigen::Vector3d> found;
    for (std::size_t k = 0; k < tools; ++k) {
      found.push_back(std::invoke(what, tick.tools[k]));
    }
    return owning(std::move(found));
  }

  [[nodiscard]] py::array command(Eigen::Vector3d ForceCommand::*what) const {
    std::vector<Eigen::Vector3d> found;
    for (std::size_t k = 0; k < tools; ++k) {
      found.push_back(tick.tools[k].command.*what);
    }
    return owning(std::move(found));
  }

  /// Number of grips of the device, for each tool.
  [[nodiscard]] std::vector<std::vector<double>> grip_efforts() const {
    std::vector<std::vector<double>> found;
    for (std::size_t k = 0; k < tools; ++k) {
      const auto& efforts = tick.tools[k].command.grips;
      found.emplace_back(efforts.begin(), efforts.begin() + static_cast<std::ptrdiff_t>(grips[k]));
    }
    return found;
  }

  [[nodiscard]] py::array joint_efforts() const {
    return owning(
        std::vector<double>(tick.joint_efforts.begin(), tick.joint_efforts.begin() + tick.joints));
  }

  [[nodiscard]] std::vector<Pose> targets() const {
    std::vector<Pose> found;
    for (std::size_t k = 0; k < tools; ++k) {
      found.push_back(tick.tools[k].target);
    }
    return found;
  }

  [[nodiscard]] std::vector<std::string> faults() const {
    std::vector<std::string> found;
    for (std::size_t k = 0; k < tools; ++k) {
      found.push_back(fault_words(tick.tools[k].faults));
    }
    return found;
  }
};

/// Converts an argument of step().
///
/// @throws py::type_error with the text `expected`, which names the argument
template <class T>
T argument(const py::object& value, const char* expected) {
  try {
    return value.cast<T>();
  } catch (const py::cast_error&) {
    throw py::type_error(expected);
  }
}

/// A session in virtual time, with its record. One thread at a time may use it.
class FeltSession {
 public:
  FeltSession(const LoadedScene& loaded, std::int64_t latency_ns)
      : setup_(with_latency(haptic_setup(loaded), latency_ns)),
        session_(setup_.scene, setup_.options),
        run_(loaded, setup_, session_.contacts().contact_distance()) {}

  FeltTick step(const py::object& handles, const py::object& all_buttons,
                const py::object& all_grips) {
    require_idle(is_busy_, "HapticSession");
    const auto buttons = argument<std::vector<std::uint32_t>>(
        all_buttons, "step: buttons: expected a whole number for each tool, its bits the buttons");
    const auto grips = argument<std::vector<std::vector<double>>>(
        all_grips, "step: grips: expected a list of numbers for each tool");
    const std::vector<std::optional<Pose>> poses = poses_from(handles);
    if (!buttons.empty() && buttons.size() != poses.size()) {
      throw std::invalid_argument("step: buttons: expected as many as poses, or none");
    }
    if (!grips.empty() && grips.size() != poses.size()) {
      throw std::invalid_argument("step: grips: expected those of each tool, or none");
    }
    std::vector<DeviceState> states;
    for (std::size_t k = 0; k < poses.size(); ++k) {
      DeviceState state;
      state.time_ns = session_.time_ns();
      state.sequence = ++count_;
      state.status = poses[k] ? DeviceStatus::live : DeviceStatus::lost;
      state.X_DH = poses[k].value_or(Pose{});
      state.buttons = buttons.empty() ? 0U : buttons[k];
      if (!grips.empty()) {
        take_grips(grips[k], k, state);
      }
      states.push_back(state);
    }
    const Busy busy(is_busy_);
    const py::gil_scoped_release release;
    FeltTick felt{.tick = session_.step(states), .tools = setup_.scene.tools.size()};
    for (std::size_t k = 0; k < felt.tools; ++k) {
      felt.grips[k] = grips_of(k);
    }
    cycle_.reset();
    if (session_.cycle() != nullptr) {
      cycle_ = run_.step(*session_.cycle(), run_.devices(felt.tick));
    }
    return felt;
  }

  /// @throws std::runtime_error while another thread takes a step, as all that reads the session
  [[nodiscard]] const HapticSession& session() const {
    require_idle(is_busy_, "HapticSession");
    return session_;
  }
  [[nodiscard]] const RunHeader& header() const { return run_.header(); }
  [[nodiscard]] const std::optional<RunStep>& cycle() const {
    require_idle(is_busy_, "HapticSession");
    return cycle_;
  }
  [[nodiscard]] const HapticSetup& setup() const { return setup_; }

  [[nodiscard]] std::vector<Pose> poses() const {
    std::vector<Pose> found;
    for (std::size_t k = 0; k < setup_.scene.tools.size(); ++k) {
      found.push_back(session().contacts().pose(k));
    }
    return found;
  }

  [[nodiscard]] py::array joints() const {
    const auto joints = session().contacts().joints();
    return owning(std::vector<double>(joints.begin(), joints.end()));
  }

  [[nodiscard]] std::vector<std::string> joint_names() const {
    std::vector<std::string> names;
    for (const HapticTool& tool : setup_.scene.tools) {
      for (const HapticJoint& joint : tool.joints) {
        names.push_back(joint.name);
      }
    }
    return names;
  }

  [[nodiscard]] py::array contacts(Eigen::Vector3d HapticContact::*what) const {
    const HapticContactSet& set = session().contacts().contact_set();
    std::vector<Eigen::Vector3d> found;
    for (std::size_t k = 0; k < set.count; ++k) {
      found.push_back(set.contacts[k].*what);
    }
    return owning(std::move(found));
  }

  [[nodiscard]] py::array gaps() const {
    const HapticContactSet& set = session().contacts().contact_set();
    std::vector<double> found;
    for (std::size_t k = 0; k < set.count; ++k) {
      found.push_back(set.contacts[k].gap);
    }
    return owning(std::move(found));
  }

 private:
  [[nodiscard]] std::size_t grips_of(std::size_t tool) const {
    return tool < setup_.options.mappings.size() ? setup_.options.mappings[tool].grips.size() : 0;
  }

  /// Whether no grip of a tool follows a value of its device.
  [[nodiscard]] bool needs_no_grips(std::size_t tool) const {
    return grips_of(tool) == 0 ||
           std::ranges::none_of(setup_.options.mappings[tool].grips,
                                [](const GripMapping& grip) { return grip.button < 0; });
  }

  /// Takes the values of a tool's grips. Grips that buttons move have none that are read.
  void take_grips(const std::vector<double>& values, std::size_t tool, DeviceState& state) const {
    if (values.size() != grips_of(tool) && !(values.empty() && needs_no_grips(tool))) {
      throw std::invalid_argument("step: grips: tool " + std::to_string(tool) + " has " +
                                  std::to_string(grips_of(tool)) + " grips, got " +
                                  std::to_string(values.size()) + " values");
    }
    std::ranges::copy(values, state.grips.begin());
  }

  static HapticSetup with_latency(HapticSetup setup, std::int64_t latency_ns) {
    setup.options.contact_latency_ns = latency_ns;
    return setup;
  }

  HapticSetup setup_;
  HapticSession session_;
  HapticRun run_;
  std::optional<RunStep> cycle_;
  std::uint64_t count_ = 0;
  bool is_busy_ = false;
};

std::unique_ptr<FeltSession> make_felt_session(const py::object& scene, double duration,
                                               double latency) {
  if (!(latency >= 0.0 && latency <= 10.0)) {
    throw std::invalid_argument("latency must be 0 to 10 s");
  }
  const auto held = py::module_::import("firstcontact._check")
                        .attr("load_scene")(scene)
                        .cast<std::shared_ptr<HeldScene>>();
  const py::gil_scoped_release release;
  Scene prepared = held->scene();
  ShapeCache cache;
  prepare_haptics(prepared, cache, duration, latency);
  const auto latency_ns = static_cast<std::int64_t>(1e9 * latency + 0.5);
  return std::make_unique<FeltSession>(held->sharing(std::move(prepared))->loaded(), latency_ns);
}

void bind_tick(py::module_& m) {
  py::class_<FeltTick>(
      m, "HapticTick",
      "A tick of a HapticSession: the forces that the devices give to the user's hand.")
      .def_property_readonly(
          "time", [](const FeltTick& t) { return 1e-9 * static_cast<double>(t.tick.time_ns); },
          "[s]")
      .def_property_readonly(
          "forces", [](const FeltTick& t) { return t.command(&ForceCommand::force_D); },
          "[N] n×3, force on each device, in its own axes.")
      .def_property_readonly(
          "torques", [](const FeltTick& t) { return t.command(&ForceCommand::torque_D); },
          "[N m] n×3, torque about each handle, in its own axes.")
      .def_property_readonly(
          "forces_world", [](const FeltTick& t) { return t.rows(&ToolTick::device_force_W); },
          "[N] n×3, force on each device at the centre of its tool, world axes.")
      .def_property_readonly(
          "torques_world", [](const FeltTick& t) { return t.rows(&ToolTick::torque_W); },
          "[N m] n×3, torque about the centre of each tool, world axes.")
      .def_property_readonly("grip_efforts", &FeltTick::grip_efforts,
                             "[J] Efforts on the grips of each device: work by their values.")
      .def_property_readonly("joint_efforts", &FeltTick::joint_efforts,
                             "[N m or N] (n,), efforts on the joints of all tools.")
      .def_property_readonly("targets", &FeltTick::targets,
                             "Poses of the tools that follow from the devices' poses.")
      .def_property_readonly(
          "target_array", [](const FeltTick& t) { return rows_of_poses(t.targets()); },
          "[m, -] n×7, the targets: position and quaternion w, x, y, z of each.")
      .def_property_readonly(
          "faults", &FeltTick::faults,
          "State of each tool as words joined by a bar; empty where all is well.")
      .def_property_readonly(
          "contact_count", [](const FeltTick& t) { return t.tick.contacts; },
          "Number of contacts of the set that acted.")
      .def_property_readonly(
          "pressing", [](const FeltTick& t) { return t.tick.pressing; },
          "Number of contacts that press.")
      .def("__repr__", [](const FeltTick& t) {
        return "<HapticTick at " + std::to_string(t.tick.time_ns) + " ns, " +
               std::to_string(t.tick.pressing) + " contacts press>";
      });
}

}  // namespace

void bind_haptics(py::module_& m) {
  bind_tick(m);
  py::class_<FeltSession>(
      m, "HapticSession",
      R"(Tools of a scene that follow haptic devices, tick by tick in virtual time.

The scene has "haptics" (see "Feel a mesh"). A tool passes through nothing, and its contacts push
back. A session is the same on every run. One thread at a time may use it.)")
      .def(
          py::init(&make_felt_session), py::arg("scene"), py::kw_only(), py::arg("duration") = 10.0,
          py::arg("latency") = 0.0,
          R"(scene: as for load_scene. duration: [s] of the record; moving bodies go on for so long.
latency: [s] duration of a cycle of the contact loop.)")
      .def("step", &FeltSession::step, py::arg("poses"), py::arg("buttons") = py::tuple(),
           py::arg("grips") = py::tuple(),
           R"(Makes the next tick of the force loop; returns a HapticTick.

poses: of the handles, a Pose for each tool; None for a lost device. Or n×7 numbers: [m] position
and [-] quaternion w, x, y, z per row; a row of NaN for a lost device. buttons: bits, one number for
each tool. grips: for each tool the values of its grips, 0 open, 1 closed; all 0 without them.)")
      .def_property_readonly(
          "time",
          [](const FeltSession& s) { return 1e-9 * static_cast<double>(s.session().time_ns()); },
          "[s] Time of the next tick.")
      .def_property_readonly(
          "dt",
          [](const FeltSession& s) {
            return 1e-9 * static_cast<double>(s.session().force_period_ns());
          },
          "[s] Time from tick to tick.")
      .def_property_readonly("poses", &FeltSession::poses, "Present poses of the tools.")
      .def_property_readonly(
          "pose_array", [](const FeltSession& s) { return rows_of_poses(s.poses()); },
          "[m, -] n×7, the present poses: position and quaternion w, x, y, z of each.")
      .def_property_readonly("joints", &FeltSession::joints,
                             "[rad or m] (n,), present positions of the joints of all tools.")
      .def_property_readonly("joint_names", &FeltSession::joint_names,
                             "Names of the joints that grips move, in the order of joints.")
      .def_property_readonly(
          "contact_points", [](const FeltSession& s) { return s.contacts(&HapticContact::point); },
          "[m] n×3, points of the newest contacts.")
      .def_property_readonly(
          "contact_normals",
          [](const FeltSession& s) { return s.contacts(&HapticContact::normal); },
          "[-] n×3, normals towards the tool.")
      .def_property_readonly("contact_gaps", &FeltSession::gaps, "[m] (n,)")
      .def_property_readonly(
          "contact_distance",
          [](const FeltSession& s) { return s.session().contacts().contact_distance(); },
          "[m] Touching tools rest at this distance up to one and a half of it.")
      .def_property_readonly(
          "header_json",
          [](const FeltSession& s) { return without_line_feed(write_run_header(s.header())); },
          "The first line of a record, for verify_run and the tool.")
      .def_property_readonly(
          "cycle", [](const FeltSession& s) { return s.cycle(); },
          "RunStep of the contact loop's cycle that the last tick began; None where it began "
          "none.");
}

}  // namespace firstcontact::python
