#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

#include <firstcontact/many_bodies/many_bodies.h>
#include <firstcontact/motion/time_window.h>
#include <firstcontact/query/contact.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/robot/limit_report.h>
#include <firstcontact/robot_check/check_robots.h>
#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/pair_counts.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/scene/trajectory.h>

#include "arrays.h"
#include "bindings.h"
#include "interrupts.h"
#include "query.h"
#include "reports.h"
#include "scene.h"
#include "words.h"

namespace firstcontact::python {

namespace py = pybind11;

namespace {

using SharedResult = std::shared_ptr<const HeldResult>;

/// The answer of one pair.
struct ScenePair {
  SharedResult result;
  std::size_t index = 0;

  [[nodiscard]] const PairAnswer& answer() const { return result->answer.pairs[index]; }
};

/// Its closest approach.
struct SceneClosest {
  ScenePair pair;

  [[nodiscard]] const ClosestApproach& found() const { return *pair.answer().closest; }
};

/// A contact of a scene: members by name, velocities per second.
struct SceneContact : Contact {
  std::array<std::string, 2> bodies;
};

double duration(const HeldResult& result) { return result.scene->scene().duration; }

std::array<std::string, 2> pair_names(const HeldResult& result, const PairAnswer& pair) {
  const Scene& scene = result.scene->scene();
  return {member_name(scene, pair.members[0]), member_name(scene, pair.members[1])};
}

py::tuple name_tuple(const ScenePair& pair) {
  return py::cast(pair_names(*pair.result, pair.answer())).cast<py::tuple>();
}

void append_contacts(const HeldResult& result, const PairAnswer& pair, py::list& list) {
  for (const Contact& found : pair.contacts) {
    SceneContact contact{found, pair_names(result, pair)};
    contact.normal_velocity /= duration(result);
    list.append(std::move(contact));
  }
}

/// Calls use(pair) for every pair that touches at the scene's t.
template <typename Use>
void for_each_deciding(const HeldResult& result, const Use& use) {
  for (const PairAnswer& pair : result.answer.pairs) {
    if (result.answer.first && pair.t == result.answer.t) {
      use(pair);
    }
  }
}

py::tuple contacts_of(const HeldResult& result) {
  py::list list;
  for_each_deciding(result, [&](const PairAnswer& pair) { append_contacts(result, pair, list); });
  return py::tuple(list);
}

py::tuple contacts_of_pair(const ScenePair& pair) {
  py::list list;
  append_contacts(*pair.result, pair.answer(), list);
  return py::tuple(list);
}

ContactCount contact_count_of(const HeldResult& result) {
  ContactCount count{0, true};
  for_each_deciding(result, [&](const PairAnswer& pair) { count += pair.contact_count; });
  return count;
}

/// The first cast refuses an object that `__new__` alone has made; that to a holder says so badly.
SharedResult shared(const py::object& self) {
  (void)self.cast<const HeldResult&>();
  return self.cast<std::shared_ptr<HeldResult>>();
}

py::object names_of_first(const SharedResult& result) {
  const auto first = result->answer.first;
  return first ? py::object(name_tuple({result, *first})) : py::object(py::none());
}

py::object closest_of(const SharedResult& result) {
  const auto closest = result->answer.closest;
  return closest ? py::cast(SceneClosest{{result, *closest}}) : py::object(py::none());
}

py::tuple pairs_of(const SharedResult& result) {
  py::tuple pairs(result->answer.pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    pairs[k] = ScenePair{result, k};
  }
  return pairs;
}

py::tuple intervals_of(const ScenePair& pair) {
  const py::object interval = tuple_type("ContactInterval");
  const double seconds = duration(*pair.result);
  py::list list;
  for (const ContactInterval& found : pair.answer().intervals) {
    list.append(interval(found.enter, found.leave, found.enter * seconds, found.leave * seconds,
                         found.reason));
  }
  return py::tuple(list);
}

}  // namespace

py::object limit_tuple(const SceneRobot& robot, const LimitViolation& violation, double duration) {
  std::vector<double> intervals;
  for (const TimeWindow& interval : violation.intervals) {
    intervals.push_back(interval.begin * duration);
    intervals.push_back(interval.end * duration);
  }
  const auto rows = static_cast<py::ssize_t>(violation.intervals.size());
  return tuple_type("LimitViolation")(
      robot.name, robot.model.joints()[violation.joint].name, violation.what, violation.limit,
      violation.excess, violation.t_excess * duration,
      py::array_t<double>({rows, py::ssize_t{2}}, intervals.data()));
}

namespace {

py::tuple limits_of(const HeldResult& result) {
  const LoadedScene& loaded = loaded_without_gil(*result.scene);
  py::list list;
  for (const SceneLimits& limits : loaded.limits) {
    for (const LimitViolation& violation : limits.violations) {
      list.append(limit_tuple(loaded.scene.robots[limits.robot], violation, loaded.scene.duration));
    }
  }
  return py::tuple(list);
}

py::tuple turns_of(const HeldResult& result) {
  const Scene& scene = loaded_without_gil(*result.scene).scene;
  py::list list;
  for (const SceneRobot& robot : scene.robots) {
    for (const JointTurn& turn : joint_turns(robot.model, robot.trajectory)) {
      list.append(tuple_type("JointTurn")(robot.name, turn.joint, turn.from, turn.to, turn.turned,
                                          turn.turning));
    }
  }
  return py::tuple(list);
}

std::string to_json(const HeldResult& result) {
  return write_result(loaded_without_gil(*result.scene), result.answer,
                      {.all_pairs = result.all_pairs, .sampling = result.sampling});
}

py::object to_dict(const HeldResult& result) {
  return py::module_::import("json").attr("loads")(to_json(result));
}

std::string describe(const HeldResult& result) {
  const SceneResult& answer = result.answer;
  std::string text = "<Result " + std::string(py::repr(py::str(result.scene->scene().id))) + ": " +
                     verdict_text(answer);
  if (answer.first) {
    const auto names = pair_names(result, answer.pairs[*answer.first]);
    text += ", " + printable(names[0] + " and " + names[1]);
  }
  const PairCounts& counts = loaded_without_gil(*result.scene).pair_counts;
  return text + "; " + pairs_text(counts.tested) + " tested>";
}

py::tuple state_of(const HeldResult& result) {
  py::object sampling = py::none();
  if (result.sampling) {
    const SamplingReport& report = *result.sampling;
    sampling = py::make_tuple(
        report.rate, report.samples, report.in_contact,
        report.least ? py::object(py::make_tuple(report.least->t, report.least->distance,
                                                 report.least->lower_bound, report.least->contact))
                     : py::none());
  }
  return py::make_tuple(result.scene, python::state_of(result.answer), result.all_pairs, sampling);
}

SamplingReport report_from(const py::tuple& state) {
  SamplingReport report{.rate = state[0].cast<double>(),
                        .samples = state[1].cast<std::size_t>(),
                        .in_contact = state[2].cast<std::size_t>(),
                        .least = {}};
  if (!state[3].is_none()) {
    const py::tuple least = state[3];
    report.least = GapSample{.t = least[0].cast<double>(),
                             .distance = least[1].cast<double>(),
                             .lower_bound = least[2].cast<double>(),
                             .contact = least[3].cast<bool>()};
  }
  return report;
}

std::shared_ptr<HeldResult> result_from(const py::tuple& state) {
  auto result = std::make_shared<HeldResult>();
  result->scene = state[0].cast<std::shared_ptr<HeldScene>>();
  result->answer = scene_result_from(state[1]);
  result->all_pairs = state[2].cast<bool>();
  if (!state[3].is_none()) {
    result->sampling = report_from(state[3]);
  }
  return result;
}

/// A getter of a field of a pair.
template <typename T, typename Of>
auto of_pair(T Of::*what) {
  return [what](const ScenePair& pair) { return pair.answer().*what; };
}

/// A getter of a field of a closest approach.
template <typename T>
auto of_closest(T ClosestApproach::*what) {
  return [what](const SceneClosest& closest) { return closest.found().*what; };
}

/// Both are pickled as their result and their index in it.
py::tuple state_of(const ScenePair& pair) {
  return py::make_tuple(std::const_pointer_cast<HeldResult>(pair.result), pair.index);
}

ScenePair scene_pair_from(const py::tuple& state) {
  return {state[0].cast<std::shared_ptr<HeldResult>>(), state[1].cast<std::size_t>()};
}

void bind_contact_of_scene(py::module_& m) {
  py::class_<SceneContact, Contact>(m, "SceneContact",
                                    "A contact in a scene: `normal_velocity` is in m/s.")
      .def_property_readonly(
          "bodies", [](const SceneContact& c) { return py::make_tuple(c.bodies[0], c.bodies[1]); },
          "The names of the two bodies; those of links are \"robot/link\".")
      .def_property_readonly(
          "geometries",
          [](const SceneContact& c) { return py::make_tuple(c.geometries[0], c.geometries[1]); },
          "The geometry of each body that the features belong to: links may have several.")
      .def(py::pickle(
          [](const SceneContact& c) {
            return py::make_tuple(static_cast<const Contact&>(c), c.bodies);
          },
          [](const py::tuple& state) {
            return SceneContact{state[0].cast<Contact>(),
                                state[1].cast<std::array<std::string, 2>>()};
          }));
}

void bind_closest(py::module_& m) {
  py::class_<SceneClosest>(m, "SceneClosest", "The closest approach of a pair in a scene.")
      .def_property_readonly(
          "pair", [](const SceneClosest& c) { return name_tuple(c.pair); },
          "The names of the two bodies.")
      .def_property_readonly(
          "distance", of_closest(&ClosestApproach::distance),
          "[m] Distance at t; an upper bound of the least distance over the step.")
      .def_property_readonly("lower_bound", of_closest(&ClosestApproach::lower_bound),
                             "[m] Lower bound of the distance, proven for the whole step.")
      .def_property_readonly("t", of_closest(&ClosestApproach::t),
                             "[-] A time where `distance` is attained.")
      .def_property_readonly(
          "time", [](const SceneClosest& c) { return c.found().t * duration(*c.pair.result); },
          "[s]")
      .def_property_readonly("reason", of_closest(&ClosestApproach::reason),
                             "Not `none` where the budget ended the search.")
      .def_property_readonly(
          "points",
          [](const SceneClosest& c) {
            const ClosestApproach& found = c.found();
            return found.closest ? py::cast(*found.closest).attr("points") : py::object(py::none());
          },
          "[m] 2×3, world frame: the closest points at t; None where no pair was reached.")
      .def("__repr__",
           [](const SceneClosest& c) {
             return "<SceneClosest: " + std::string(py::repr(py::float_(c.found().distance))) +
                    " m at t = " + std::string(py::repr(py::float_(c.found().t))) + ">";
           })
      .def(py::pickle([](const SceneClosest& c) { return state_of(c.pair); },
                      [](const py::tuple& state) { return SceneClosest{scene_pair_from(state)}; }));
}

void bind_pair(py::module_& m) {
  py::class_<ScenePair>(m, "ScenePair", "The answer of one pair of bodies in a scene.")
      .def_property_readonly(
          "pair", [](const ScenePair& p) { return name_tuple(p); },
          "The names of the two bodies; those of links are \"robot/link\".")
      .def_property_readonly("margin", of_pair(&PairAnswer::margin),
                             "[m] The margin, with paddings and the effect of tracking errors.")
      .def_property_readonly("verdict", of_pair(&PairAnswer::verdict))
      .def_property_readonly("reason", of_pair(&PairAnswer::reason))
      .def_property_readonly(
          "t", of_pair(&PairAnswer::t),
          "[-] Time before which the pair is proven farther apart than its margin.")
      .def_property_readonly("t_upper", of_pair(&PairAnswer::t_upper),
                             "[-] A time that is proven to be in contact, if one is known.")
      .def_property_readonly(
          "time", [](const ScenePair& p) { return p.answer().t * duration(*p.result); },
          "[s] t times the duration.")
      .def_property_readonly("contacts", &contacts_of_pair,
                             "The contacts at t that were asked for.")
      .def_property_readonly(
          "contact_count", [](const ScenePair& p) { return p.answer().contact_count.at_least; },
          "Number of contacts at t, those included that are not listed.")
      .def_property_readonly(
          "contact_count_is_exact",
          [](const ScenePair& p) { return p.answer().contact_count.is_exact; },
          "False where only the first was asked for or counting ended early: there may be more.")
      .def_property_readonly("clearance", of_pair(&PairAnswer::clearance),
                             "[m] Proven lower bound of the distance before t.")
      .def_property_readonly("tolerance_used", of_pair(&PairAnswer::tolerance_used), "[m]")
      .def_property_readonly(
          "closest",
          [](const ScenePair& p) {
            return p.answer().closest ? py::cast(SceneClosest{p}) : py::object(py::none());
          },
          "Its closest approach; None where that was not asked for.")
      .def_property_readonly("intervals", &intervals_of,
                             "ContactIntervals in order, where all_contacts_in_time was asked for.")
      .def("__repr__",
           [](const ScenePair& p) {
             const auto names = pair_names(*p.result, p.answer());
             return "<ScenePair " + printable(names[0] + " and " + names[1]) + ": " +
                    verdict_text(p.answer()) + ">";
           })
      .def(py::pickle([](const ScenePair& p) { return state_of(p); }, &scene_pair_from));
}

}  // namespace

void bind_result(py::module_& m) {
  bind_contact_of_scene(m);
  bind_closest(m);
  bind_pair(m);
  ResultClass type(m, "Result", R"(The answer of a scene; never changes.

Times are normalised to the duration of the scene (t) or in seconds (time).)");
  type.def_property_readonly("id", [](const HeldResult& r) { return r.scene->scene().id; })
      .def_property_readonly("verdict", [](const HeldResult& r) { return r.answer.verdict; })
      .def_property_readonly(
          "reason", [](const HeldResult& r) { return r.answer.reason; },
          "The reason of `undecided`.")
      .def_property_readonly(
          "t", [](const HeldResult& r) { return r.answer.t; },
          "[-] Time before which no pair is in contact, proven; 1 when free.")
      .def_property_readonly(
          "t_upper", [](const HeldResult& r) { return r.answer.t_upper; },
          "[-] A time that is proven to be in contact, if one is known.")
      .def_property_readonly(
          "time", [](const HeldResult& r) { return r.answer.t * duration(r); },
          "[s] t times the duration.")
      .def_property_readonly(
          "pair", [](const py::object& r) { return names_of_first(shared(r)); },
          "The names of the bodies that determine t; None when free.")
      .def_property_readonly(
          "contacts", &contacts_of,
          "The contacts at t of every pair that touches there; those that were asked for.")
      .def_property_readonly(
          "contact_count", [](const HeldResult& r) { return contact_count_of(r).at_least; },
          "Number of contacts at t, those included that are not listed.")
      .def_property_readonly(
          "contact_count_is_exact",
          [](const HeldResult& r) { return contact_count_of(r).is_exact; },
          "False where only the first was asked for or counting ended early: there may be more.")
      .def_property_readonly(
          "clearance", [](const HeldResult& r) { return r.answer.clearance; },
          "[m] Proven lower bound of all distances up to t; infinite where no pair is tested.")
      .def_property_readonly(
          "closest", [](const py::object& r) { return closest_of(shared(r)); },
          "The pair that comes closest; None where that was not asked for.")
      .def_property_readonly(
          "pairs", [](const py::object& r) { return pairs_of(shared(r)); },
          "Every tested pair where that was asked for, else those that determine t.")
      .def_property_readonly("turns", &turns_of,
                             "JointTurns: the way of continuous joints, and its length.")
      .def_property_readonly("limits", &limits_of,
                             "LimitViolations: the joint limits that robots leave.")
      .def_property_readonly(
          "warnings",
          [](const HeldResult& r) { return check_warnings(loaded_without_gil(*r.scene)); },
          "Warnings: those of readers, sizes that look wrong, bodies that begin inside of others, "
          "limits that robots leave, and that no pair is tested.")
      .def_property_readonly(
          "pair_counts",
          [](const HeldResult& r) {
            return pair_counts_tuple(loaded_without_gil(*r.scene).pair_counts);
          },
          "PairCounts: the pairs that the answer is about.")
      .def_property_readonly(
          "files",
          [](const HeldResult& r) { return files_tuple(loaded_without_gil(*r.scene).files); },
          "FileReports: the reports on all files that were read.")
      .def_property_readonly(
          "tolerance_used", [](const HeldResult& r) { return r.answer.tolerance_used; },
          "[m] The greatest of the pairs that were searched.")
      .def_property_readonly(
          "enclosure_error", [](const HeldResult& r) { return r.answer.enclosure_error; },
          "[m] Errors of curved shapes that are tested by their triangles: they add to the "
          "tolerance.")
      .def_property_readonly("work", [](const HeldResult& r) { return r.answer.work; })
      .def_property_readonly("scene", [](const HeldResult& r) { return r.scene; })
      .def("to_json", &to_json, "The result as `firstcontact check --json` writes it, on one line.")
      .def("to_dict", &to_dict, "The result as a dict.")
      .def("__repr__", [](const HeldResult& r) { return describe(r); })
      .def(py::pickle([](const HeldResult& r) { return state_of(r); },
                      [](const py::tuple& state) { return result_from(state); }));
  refuse_as_condition(type);
  bind_result_page(type);
}

}  // namespace firstcontact::python
