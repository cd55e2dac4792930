#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

#include <firstcontact/scene/gap_bound.h>
#include <firstcontact/scene/gap_curve.h>
#include <firstcontact/scene/parallel_sampling.h>
#include <firstcontact/scene/write_page.h>

#include "arrays.h"
#include "bindings.h"
#include "interrupts.h"
#include "query.h"
#include "scene.h"
#include "words.h"

namespace firstcontact::python {

namespace py = pybind11;

namespace {

using SharedResult = std::shared_ptr<const HeldResult>;

/// A contact as scenes tell it: bodies by name, velocities in seconds.
struct SceneContact : Contact {
  std::array<std::string, 2> bodies;
};

/// The answer of one pair.
struct ScenePair {
  SharedResult result;
  std::size_t index = 0;

  [[nodiscard]] const PairAnswer& answer() const { return result->answer.pairs[index]; }
};

/// Its closest approach.
struct SceneClosest {
  ScenePair pair;

  [[nodiscard]] const ClosestApproachResult& found() const {
    return *pair.answer().closest_approach;
  }
};

std::array<std::string, 2> names_of(const HeldResult& result, const BodyPair& bodies) {
  const std::vector<Body>& all = result.scene->scene().bodies;
  return {all[bodies[0]].name, all[bodies[1]].name};
}

double duration(const HeldResult& result) { return result.scene->scene().duration; }

void append_contacts(const HeldResult& result, const PairAnswer& pair, py::list& list) {
  for (const Contact& found : pair.first_contact.contacts) {
    SceneContact contact{found, names_of(result, pair.bodies)};
    contact.normal_velocity = found.normal_velocity / duration(result);
    list.append(std::move(contact));
  }
}

/// Of every pair that touches at the scene's t.
py::tuple contacts_of(const HeldResult& result) {
  py::list list;
  for (const PairAnswer& pair : result.answer.pairs) {
    if (result.answer.first && pair.first_contact.t == result.answer.t) {
      append_contacts(result, pair, list);
    }
  }
  return py::tuple(list);
}

py::object first_pair(const HeldResult& result) {
  const SceneResult& answer = result.answer;
  return answer.first
             ? py::cast(names_of(result, answer.pairs[*answer.first].bodies)).cast<py::tuple>()
             : py::object(py::none());
}

py::object closest_pair(const SharedResult& result) {
  const SceneResult& answer = result->answer;
  return answer.closest ? py::cast(SceneClosest{{result, *answer.closest}})
                        : py::object(py::none());
}

py::tuple pairs_of(const SharedResult& result) {
  py::tuple pairs(result->answer.pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    pairs[k] = ScenePair{result, k};
  }
  return pairs;
}

std::string to_json(const HeldResult& result) {
  return write_result(loaded_without_gil(*result.scene), result.answer,
                      {.all_pairs = result.all_pairs, .sampling = result.sampling});
}

py::object to_dict(const HeldResult& result) {
  return py::module_::import("json").attr("loads")(to_json(result));
}

/// Samples of the gap and its proven lower bound.
struct GapLines {
  std::vector<GapSample> samples;
  std::vector<GapPoint> lower_bound;
};

/// Without the GIL.
GapLines gap_lines(const HeldResult& result, const std::stop_token& stop) {
  const LoadedScene& loaded = result.scene->loaded();
  GapLines lines;
  lines.samples = gap_curve(loaded, time_of_interest(result.answer), stop);
  lines.lower_bound = gap_lower_bound(loaded, result.answer, lines.samples);
  return lines;
}

py::object gap_curve_of(const HeldResult& result) {
  const GapLines lines =
      run_query(nullptr, [&](const QueryStop& stop) { return gap_lines(result, stop.token()); });
  std::vector<double> t;
  std::vector<double> distance;
  std::vector<double> lower_bound;
  for (const GapSample& sample : lines.samples) {
    t.push_back(sample.t);
    distance.push_back(sample.distance);
    lower_bound.push_back(sample.lower_bound);
  }
  std::vector<double> corner_t;
  std::vector<double> corner_distance;
  for (const GapPoint& point : lines.lower_bound) {
    corner_t.push_back(point.t);
    corner_distance.push_back(point.distance);
  }
  const auto tuples = py::module_::import("firstcontact._tuples");
  return py::make_tuple(
      tuples.attr("GapSamples")(owning(std::move(t)), owning(std::move(distance)),
                                owning(std::move(lower_bound))),
      tuples.attr("GapPoints")(owning(std::move(corner_t)), owning(std::move(corner_distance))));
}

/// As the tool's --html.
std::string fill_page(const HeldResult& result, const std::string& page_template) {
  return run_query(nullptr, [&](const QueryStop& stop) {
    const LoadedScene& loaded = result.scene->loaded();
    const GapLines lines = gap_lines(result, stop.token());
    return write_page(
        page_template, loaded,
        write_result(loaded, result.answer, {.all_pairs = true, .sampling = result.sampling}),
        {lines.samples, lines.lower_bound});
  });
}

std::string describe(const HeldResult& result) {
  const SceneResult& answer = result.answer;
  std::string text = "<Result " + std::string(py::repr(py::str(result.scene->scene().id))) + ": " +
                     verdict_text(answer.verdict, answer.reason, answer.t);
  if (answer.first) {
    const auto names = names_of(result, answer.pairs[*answer.first].bodies);
    text += ", " + names[0] + " and " + names[1];
  }
  return text + ">";
}

py::tuple state_of(const HeldResult& result) {
  const SceneResult& answer = result.answer;
  py::list pairs;
  for (const PairAnswer& pair : answer.pairs) {
    pairs.append(python::state_of(pair));
  }
  py::object sampling = py::none();
  if (result.sampling) {
    const SamplingReport& report = *result.sampling;
    sampling = py::make_tuple(
        report.rate, report.samples, report.in_contact,
        report.least ? py::object(py::make_tuple(report.least->t, report.least->distance,
                                                 report.least->lower_bound, report.least->contact))
                     : py::none());
  }
  return py::make_tuple(result.scene, answer.verdict, answer.reason, answer.t, answer.t_upper,
                        answer.clearance, answer.tolerance_used, answer.first, answer.closest,
                        py::tuple(pairs), answer.work, result.all_pairs, sampling);
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
  SceneResult& answer = result->answer;
  answer.verdict = state[1].cast<Verdict>();
  answer.reason = state[2].cast<UndecidedReason>();
  answer.t = state[3].cast<double>();
  answer.t_upper = state[4].cast<std::optional<double>>();
  answer.clearance = state[5].cast<double>();
  answer.tolerance_used = state[6].cast<double>();
  answer.first = state[7].cast<std::optional<std::size_t>>();
  answer.closest = state[8].cast<std::optional<std::size_t>>();
  for (const py::handle pair : state[9]) {
    answer.pairs.push_back(pair_answer_from(pair.cast<py::tuple>()));
  }
  answer.work = state[10].cast<WorkCount>();
  result->all_pairs = state[11].cast<bool>();
  if (!state[12].is_none()) {
    result->sampling = report_from(state[12]);
  }
  return result;
}

void bind_parts(py::module_& m) {
  py::class_<SceneContact, Contact>(m, "SceneContact",
                                    "A contact in a scene: `normal_velocity` is in m/s.")
      .def_property_readonly(
          "bodies", [](const SceneContact& c) { return py::make_tuple(c.bodies[0], c.bodies[1]); },
          "The names of the two bodies.")
      .def(py::pickle(
          [](const SceneContact& c) {
            return py::make_tuple(static_cast<const Contact&>(c), c.bodies);
          },
          [](const py::tuple& state) {
            return SceneContact{state[0].cast<Contact>(),
                                state[1].cast<std::array<std::string, 2>>()};
          }));

  py::class_<SceneClosest>(m, "SceneClosest", "The closest approach of a pair in a scene.")
      .def_property_readonly(
          "pair",
          [](const SceneClosest& c) {
            return py::tuple(py::cast(names_of(*c.pair.result, c.pair.answer().bodies)));
          },
          "The names of the two bodies.")
      .def_property_readonly(
          "distance", [](const SceneClosest& c) { return c.found().distance; },
          "[m] Attained at t; an upper bound of the least distance over the step.")
      .def_property_readonly(
          "lower_bound", [](const SceneClosest& c) { return c.found().lower_bound; },
          "[m] Proven for the whole step.")
      .def_property_readonly(
          "t", [](const SceneClosest& c) { return c.found().t; },
          "[-] A time where `distance` is attained.")
      .def_property_readonly(
          "time", [](const SceneClosest& c) { return c.found().t * duration(*c.pair.result); },
          "[s]")
      .def_property_readonly(
          "reason", [](const SceneClosest& c) { return c.found().reason; },
          "Not `none`: the budget ended the search.")
      .def_property_readonly(
          "points",
          [](const SceneClosest& c) {
            return c.found().closest ? py::cast(*c.found().closest).attr("points")
                                     : py::object(py::none());
          },
          "[m] 2×3, world frame: the closest points at t; None where no pair was reached.")
      .def("__repr__",
           [](const SceneClosest& c) {
             return "<SceneClosest: " + std::string(py::repr(py::float_(c.found().distance))) +
                    " m at t = " + std::string(py::repr(py::float_(c.found().t))) + ">";
           })
      .def(py::pickle(
          [](const SceneClosest& c) {
            return py::make_tuple(std::const_pointer_cast<HeldResult>(c.pair.result), c.pair.index);
          },
          [](const py::tuple& state) {
            return SceneClosest{
                {state[0].cast<std::shared_ptr<HeldResult>>(), state[1].cast<std::size_t>()}};
          }));

  py::class_<ScenePair>(m, "ScenePair", "The answer of one pair of bodies in a scene.")
      .def_property_readonly(
          "pair",
          [](const ScenePair& p) {
            return py::tuple(py::cast(names_of(*p.result, p.answer().bodies)));
          },
          "The names of the two bodies.")
      .def_property_readonly(
          "margin", [](const ScenePair& p) { return p.answer().margin; }, "[m]")
      .def_property_readonly("verdict",
                             [](const ScenePair& p) { return p.answer().first_contact.verdict; })
      .def_property_readonly("reason",
                             [](const ScenePair& p) { return p.answer().first_contact.reason; })
      .def_property_readonly(
          "t", [](const ScenePair& p) { return p.answer().first_contact.t; },
          "[-] Before it the pair is farther apart than its margin: proven.")
      .def_property_readonly(
          "t_upper", [](const ScenePair& p) { return p.answer().first_contact.t_upper; },
          "[-] A time that is proven to be in contact, if one is known.")
      .def_property_readonly(
          "time",
          [](const ScenePair& p) { return p.answer().first_contact.t * duration(*p.result); },
          "[s] t times the duration.")
      .def_property_readonly(
          "contacts",
          [](const ScenePair& p) {
            py::list list;
            append_contacts(*p.result, p.answer(), list);
            return py::tuple(list);
          },
          "At t.")
      .def_property_readonly(
          "clearance", [](const ScenePair& p) { return p.answer().first_contact.clearance; },
          "[m] Proven lower bound of the distance before t.")
      .def_property_readonly(
          "tolerance_used",
          [](const ScenePair& p) { return p.answer().first_contact.tolerance_used; }, "[m]")
      .def_property_readonly(
          "closest",
          [](const ScenePair& p) {
            return p.answer().closest_approach ? py::cast(SceneClosest{p}) : py::object(py::none());
          },
          "Its closest approach; None where that was not asked.")
      .def("__repr__",
           [](const ScenePair& p) {
             const auto names = names_of(*p.result, p.answer().bodies);
             const FirstContactResult& found = p.answer().first_contact;
             return "<ScenePair " + names[0] + " and " + names[1] + ": " +
                    verdict_text(found.verdict, found.reason, found.t) + ">";
           })
      .def(py::pickle(
          [](const ScenePair& p) {
            return py::make_tuple(std::const_pointer_cast<HeldResult>(p.result), p.index);
          },
          [](const py::tuple& state) {
            return ScenePair{state[0].cast<std::shared_ptr<HeldResult>>(),
                             state[1].cast<std::size_t>()};
          }));
}

/// A method that firstcontact/_page.py has.
template <typename... Arguments>
py::object page_function(const char* name, const Arguments&... arguments) {
  return py::module_::import("firstcontact._page").attr(name)(arguments...);
}

void bind_page(py::class_<HeldResult, std::shared_ptr<HeldResult>>& type) {
  type.def(
          "to_html", [](const py::object& self) { return page_function("to_html", self); },
          R"(The page that plays this result: one file that needs nothing else.

As `firstcontact check --html` makes it. FileNotFoundError where the package was built without it.)")
      .def(
          "save_html",
          [](const py::object& self, const py::object& path) {
            page_function("save_html", self, path);
          },
          py::arg("path"), "Writes to_html() to a file.")
      .def("_fill_page", &fill_page, py::arg("template"))
      .def("_repr_html_",
           [](const py::object& self) { return page_function("notebook_view", self); })
      .def("gap_curve", &gap_curve_of, R"(The gap over time, for plots: (GapSamples, GapPoints).

Samples lie where the gap bends; they prove nothing between them. The points are corners of a
polyline that the gap is proven not to be below, at any time.)");
}

}  // namespace

void bind_result(py::module_& m) {
  bind_parts(m);
  py::class_<HeldResult, std::shared_ptr<HeldResult>> type(m, "Result",
                                                           R"(The answer of a scene; never changes.

Times are normalised to the duration of the scene (t) or in seconds (time).)");
  type.def_property_readonly("id", [](const HeldResult& r) { return r.scene->scene().id; })
      .def_property_readonly("verdict", [](const HeldResult& r) { return r.answer.verdict; })
      .def_property_readonly(
          "reason", [](const HeldResult& r) { return r.answer.reason; }, "Why it is undecided.")
      .def_property_readonly(
          "t", [](const HeldResult& r) { return r.answer.t; },
          "[-] No pair is in contact before it: proven. 1 when free.")
      .def_property_readonly(
          "t_upper", [](const HeldResult& r) { return r.answer.t_upper; },
          "[-] A time that is proven to be in contact, if one is known.")
      .def_property_readonly(
          "time", [](const HeldResult& r) { return r.answer.t * duration(r); },
          "[s] t times the duration.")
      .def_property_readonly("pair", &first_pair,
                             "The names of the bodies that decide t; None when free.")
      .def_property_readonly("contacts", &contacts_of, "At t, of every pair that touches there.")
      .def_property_readonly(
          "clearance", [](const HeldResult& r) { return r.answer.clearance; },
          "[m] Proven lower bound of every pair's distance up to t; infinite "
          "where no pair is tested.")
      .def_property_readonly(
          "closest", [](const std::shared_ptr<HeldResult>& r) { return closest_pair(r); },
          "The pair that comes closest; None where that was not asked.")
      .def_property_readonly(
          "pairs", [](const std::shared_ptr<HeldResult>& r) { return pairs_of(r); },
          "Every tested pair where that was asked, else those that decide t.")
      .def_property_readonly(
          "tolerance_used", [](const HeldResult& r) { return r.answer.tolerance_used; },
          "[m] The greatest of the pairs that were searched.")
      .def_property_readonly(
          "enclosure_error",
          [](const HeldResult& r) { return to_dict(r).attr("get")("enclosure_error", 0.0); },
          "[m] Of cylinders and cones: adds to the tolerance.")
      .def_property_readonly("work", [](const HeldResult& r) { return r.answer.work; })
      .def_property_readonly("scene", [](const HeldResult& r) { return r.scene; })
      .def("to_json", &to_json, "The result as `firstcontact check --json` writes it, on one line.")
      .def("to_dict", &to_dict, "The same as a dict.")
      .def("__repr__", [](const HeldResult& r) { return describe(r); })
      .def(py::pickle([](const HeldResult& r) { return state_of(r); },
                      [](const py::tuple& state) { return result_from(state); }));
  bind_page(type);
}

}  // namespace firstcontact::python
