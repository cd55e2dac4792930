#include <firstcontact/retiming/retime.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <firstcontact/retiming/executed_proof.h>
#include <firstcontact/retiming/joint_limits.h>
#include <firstcontact/retiming/retiming_path.h>
#include <firstcontact/retiming/write_trajectory.h>
#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/scene/shape_cache.h>

#include "arguments.h"
#include "bindings.h"
#include "errors.h"
#include "interrupts.h"
#include "query.h"
#include "scene.h"
#include "words.h"

namespace firstcontact::python {

namespace py = pybind11;

namespace {

using Texts = std::array<std::string, kTrajectoryEndings.size()>;  // Of each TrajectoryFormat.

/// The input of retiming: a scene, or else the text or the file of a path or of a scene.
struct RetimingSource {
  const HeldScene* scene = nullptr;
  std::optional<std::string> text;
  std::filesystem::path file;
  std::string which;  // The robot; may be empty.
  bool lenient = false;
};

/// The options of retiming.
struct RetimingWish {
  std::optional<std::string> limits_text;  // As a file of limits has it.
  std::optional<std::filesystem::path> limits_file;
  GivenLimits others;
  double velocity_scaling = 1.0;         // [-]
  double acceleration_scaling = 1.0;     // [-]
  std::optional<double> tracking_error;  // [rad or m]
  std::optional<double> tolerance;       // [m]
  RetimingOptions options;
};

/// A path, its scene, and its retimed motion.
struct Retiming {
  RetimingPath input;
  std::optional<LoadedRetimingScene> scene;
  RetimedMotion made;
  ExecutedProof proof;  // Of the motion as it was read back, where that was reached.
  Texts texts;
};

RetimingMode retiming_mode_from(const std::string& word) {
  const auto found = std::find(kRetimingModeWords.begin(), kRetimingModeWords.end(), word);
  if (found == kRetimingModeWords.end()) {
    throw py::value_error(R"(mode: expected "stop", "blend" or "time_optimal", got ")" + word +
                          "\"");
  }
  return static_cast<RetimingMode>(found - kRetimingModeWords.begin());
}

void require_above_zero(const std::optional<double>& number, const char* name) {
  if (number && !(*number > 0.0 && std::isfinite(*number))) {
    throw py::value_error(std::string(name) + ": expected a finite number > 0, got " +
                          std::string(py::repr(py::float_(*number))));
  }
}

RetimingPath retiming_input(const RetimingSource& source) {
  if (source.scene != nullptr) {
    return retiming_path_of(source.scene->scene(), source.which);
  }
  const ReadingOptions reading{.lenient = source.lenient};
  return source.text ? parse_path_or_scene(*source.text, source.file, source.which, reading)
                     : read_retiming_path(source.file, source.which, reading);
}

std::map<std::string, GivenLimits> given_limits(const RetimingWish& wish, const RobotModel& model) {
  if (wish.limits_text) {
    return parse_joint_limits(*wish.limits_text, "limits.json", model);
  }
  return wish.limits_file ? read_joint_limits(*wish.limits_file, model)
                          : std::map<std::string, GivenLimits>{};
}

/// Writes a proven motion in all formats. Each text is read as a controller reads it, and what is
/// read is proven.
void write_and_prove(const std::vector<RateLimits>& limits, const RobotModel& model,
                     const ProofOptions& options, Retiming& retiming) {
  std::optional<TimedMotion> proven;
  for (std::size_t k = 0; k < retiming.texts.size(); ++k) {
    retiming.texts.at(k) = write_trajectory(retiming.made.motion, static_cast<TrajectoryFormat>(k));
    TimedMotion read = parse_timed_motion(
        retiming.texts.at(k), std::string("trajectory") + kTrajectoryEndings.at(k), model);
    if (proven && read == *proven) {
      continue;
    }
    retiming.proof = prove_motion(read, limits, retiming.scene->where, options);
    if (!retiming.proof.is_proven()) {
      return;
    }
    proven = std::move(read);
  }
}

/// Without the GIL.
Retiming retimed(const RetimingSource& source, const RetimingWish& wish, std::stop_token stop) {
  Retiming retiming;
  retiming.input = retiming_input(source);
  RetimingPath& input = retiming.input;
  if (wish.tracking_error) {
    for (const std::size_t moving : input.robots) {
      SceneRobot& robot = input.scene.robots.at(moving);
      robot.tracking_error = joint_errors(robot.model, *wish.tracking_error);
    }
  }
  ShapeCache cache;
  retiming.scene = load_retiming_scene(input, cache);
  const RobotModel model = joined_model(retiming.scene->where);
  const std::map<std::string, GivenLimits> given = given_limits(wish, model);
  retiming.scene->where.positions = position_limits_of(given);
  const RetimingScene& where = retiming.scene->where;
  std::vector<RateLimits> limits = limits_of(model, input.path.joint_names, given, wish.others);
  scale_limits(wish.velocity_scaling, wish.acceleration_scaling, limits);
  RetimingOptions options = wish.options;
  options.proof.tolerance = wish.tolerance.value_or(input.scene.options.tolerance);
  options.proof.budget.stop = std::move(stop);
  retiming.made = retime(input.path, limits, where, options);
  retiming.proof = retiming.made.proof;
  if (retiming.proof.is_proven()) {
    options.proof.closest = true;
    write_and_prove(limits, model, options.proof, retiming);
  }
  return retiming;
}

/// A RetimedMoment of firstcontact/_tuples.py.
py::object moment_tuple(const RetimingScene& where, const BodyPair& members, double time,
                        const py::object& distance) {
  return tuple_type("RetimedMoment")(
      time, py::make_tuple(where.scene.name(members[0]), where.scene.name(members[1])), distance);
}

py::object contact_of(const Retiming& retiming) {
  const SceneResult& contact = retiming.proof.contact;
  if (contact.verdict == Verdict::free || !contact.first) {
    return py::none();
  }
  return moment_tuple(retiming.scene->where, contact.pairs.at(*contact.first).members,
                      retiming.proof.contact_time(), py::none());
}

py::object closest_of(const Retiming& retiming) {
  const SceneResult& contact = retiming.proof.contact;
  if (!retiming.proof.is_proven() || !contact.closest) {
    return py::none();
  }
  const PairAnswer& pair = contact.pairs.at(*contact.closest);
  return moment_tuple(retiming.scene->where, pair.members,
                      pair.closest->t * retiming.proof.duration,
                      py::float_(pair.closest->distance));
}

py::tuple rates_of(const Retiming& retiming) {
  py::list list;
  for (const RateUse& use : retiming.proof.rates) {
    list.append(tuple_type("RateUse")(retiming.input.path.joint_names.at(use.joint),
                                      kJointRateWords.at(static_cast<std::size_t>(use.what)),
                                      use.limit, use.attained, use.bound, use.time));
  }
  return py::tuple(list);
}

/// The distances that the contact pairs of a proven motion kept.
py::tuple held_pairs_of(const Retiming& retiming) {
  py::list list;
  for (const ProvenHold& hold : retiming.proof.held) {
    const RobotScene& scene = retiming.scene->where.scene;
    list.append(tuple_type("HeldPair")(
        py::make_tuple(scene.name(hold.members[0]), scene.name(hold.members[1])), hold.distance,
        hold.from, hold.to));
  }
  return py::tuple(list);
}

py::tuple left_limits_of(const Retiming& retiming) {
  py::list list;
  for (const SceneLimits& left : retiming.proof.positions) {
    for (const LimitViolation& violation : left.violations) {
      list.append(limit_tuple(retiming.input.scene.robots.at(left.robot), violation,
                              retiming.proof.duration));
    }
  }
  return py::tuple(list);
}

const char* verdict_of(const ExecutedProof& proof) {
  if (proof.is_proven()) {
    return "proven";
  }
  return proof.contact.verdict == Verdict::undecided ? "undecided" : "refused";
}

py::object answer_of(const Retiming& retiming) {
  const bool is_proven = retiming.proof.is_proven();
  py::list warnings;
  if (retiming.input.is_approximate) {
    warnings.append("the path is approximate: it ends before its goal");
  }
  const auto text = [&](TrajectoryFormat format) -> py::object {
    return is_proven ? py::object(py::str(retiming.texts.at(static_cast<std::size_t>(format))))
                     : py::none();
  };
  return tuple_type("RetimeAnswer")(
      verdict_of(retiming.proof),
      kRetimingModeWords.at(static_cast<std::size_t>(retiming.made.mode)),
      is_proven ? py::cast(trajectory_of(retiming.made.motion)) : py::none(),
      retiming.proof.duration, retiming.made.stop_duration, retiming.made.blends,
      retiming.made.shortened, retiming.made.left_out, closest_of(retiming),
      held_pairs_of(retiming), rates_of(retiming), contact_of(retiming), left_limits_of(retiming),
      py::tuple(warnings), text(TrajectoryFormat::yaml), text(TrajectoryFormat::json),
      text(TrajectoryFormat::csv));
}

py::object retime_source(OrNone<HeldScene> scene, std::optional<std::string> text,
                         std::filesystem::path file, const std::string& mode,
                         std::optional<std::string> limits_text,
                         std::optional<std::filesystem::path> limits_file,
                         std::optional<double> max_velocity, std::optional<double> max_acceleration,
                         std::optional<double> max_jerk, double velocity_scaling,
                         double acceleration_scaling, std::optional<double> tracking_error,
                         std::optional<double> tolerance, std::optional<double> blend_deviation,
                         const std::optional<std::string>& which, bool lenient, int threads,
                         OrNone<std::stop_source> stop) {
  require_above_zero(max_velocity, "max_velocity");
  require_above_zero(max_acceleration, "max_acceleration");
  require_above_zero(max_jerk, "max_jerk");
  require_scaling(velocity_scaling, "velocity_scaling");
  require_scaling(acceleration_scaling, "acceleration_scaling");
  require_above_zero(tolerance, "tolerance");
  require_above_zero(blend_deviation, "blend_deviation");
  if (tracking_error && !(*tracking_error >= 0.0 && std::isfinite(*tracking_error))) {
    throw py::value_error("tracking_error: expected a finite number >= 0, got " +
                          std::string(py::repr(py::float_(*tracking_error))));
  }
  if (scene == nullptr && !text) {
    require_file(file);
  }
  if (limits_file) {
    require_file(*limits_file);
  }
  const RetimingSource source{scene, std::move(text), std::move(file), which.value_or(""), lenient};
  RetimingWish wish{
      std::move(limits_text),
      std::move(limits_file),
      {max_velocity, max_acceleration, max_jerk},
      velocity_scaling,
      acceleration_scaling,
      tracking_error,
      tolerance,
      {.mode = retiming_mode_from(mode), .blend_deviation = blend_deviation, .proof = {}}};
  wish.options.proof.threads = threads;
  return answer_of(
      run_query(stop, [&](QueryStop& query) { return retimed(source, wish, query.token()); }));
}

}  // namespace

void bind_retiming(py::module_& m) {
  m.def("retime", &retime_source, py::arg("scene"), py::arg("text"), py::arg("file"), py::kw_only(),
        py::arg("mode"), py::arg("limits_text"), py::arg("limits_file"), py::arg("max_velocity"),
        py::arg("max_acceleration"), py::arg("max_jerk"), py::arg("velocity_scaling"),
        py::arg("acceleration_scaling"), py::arg("tracking_error"), py::arg("tolerance"),
        py::arg("blend_deviation"), py::arg("which"), py::arg("lenient"), py::arg("threads"),
        py::arg("stop"));
}

}  // namespace firstcontact::python
