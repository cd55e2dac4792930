#include <firstcontact/planning/plan_scene.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/write_planned_path.h>

#include "arrays.h"
#include "bindings.h"
#include "interrupts.h"
#include "query.h"
#include "scene.h"
#include "words.h"

namespace firstcontact::python {

namespace py = pybind11;

namespace {

PlanQuestion question_of(const HeldScene& scene) {
  if (!scene.scene().plan) {
    throw std::invalid_argument("scene: expected \"plan\": what moves, and its goal; it has none");
  }
  return *scene.scene().plan;
}

ScenePlan plan_of(const HeldScene& scene) {
  const py::gil_scoped_release release;
  ShapeCache cache;
  return make_scene_plan(scene.scene(), question_of(scene), cache);
}

/// A class of firstcontact/_tuples.py.
py::object tuple_of_planning(const char* name) {
  return py::module_::import("firstcontact._tuples").attr(name);
}

double or_nan(const std::optional<double>& number) {
  return number.value_or(std::numeric_limits<double>::quiet_NaN());
}

py::array rows_from(const std::vector<Configuration>& rows, std::size_t columns) {
  py::array_t<double> array({rows.size(), columns});
  auto numbers = array.mutable_unchecked<2>();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    for (std::size_t j = 0; j < columns; ++j) {
      numbers(static_cast<py::ssize_t>(k), static_cast<py::ssize_t>(j)) = rows[k][j];
    }
  }
  return array;
}

std::vector<Configuration> places_from(py::handle value, const char* name, std::size_t columns) {
  const py::array_t<double> array = matrix_from(value, name);
  if (array.ndim() != 2 || static_cast<std::size_t>(array.shape(1)) != columns) {
    throw py::value_error(std::string(name) + ": expected n×" + std::to_string(columns) +
                          " numbers, one configuration per row");
  }
  const auto numbers = array.unchecked<2>();
  std::vector<Configuration> places(static_cast<std::size_t>(array.shape(0)));
  for (std::size_t k = 0; k < places.size(); ++k) {
    for (std::size_t j = 0; j < columns; ++j) {
      places[k].push_back(numbers(static_cast<py::ssize_t>(k), static_cast<py::ssize_t>(j)));
    }
  }
  return places;
}

/// The defect of a place; empty where an edge may begin or end there.
///
/// Joints may be beyond their limits, and quaternions of any length that is not rounding.
std::string problem_of(const ConfigurationSpace& space, const Configuration& place) {
  if (!std::ranges::all_of(place, [](double number) { return std::abs(number) <= 1e8; })) {
    return space.defect(place).value_or("expected finite numbers");
  }
  if (space.poses().empty()) {
    return "";
  }
  try {
    for (std::size_t mover = 0; mover < space.mover_count(); ++mover) {
      (void)space.motion(place, place, mover);
    }
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

void require_places_of(const ConfigurationSpace& space, const std::vector<Configuration>& places,
                       const char* name) {
  for (std::size_t k = 0; k < places.size(); ++k) {
    const std::string problem = problem_of(space, places[k]);
    if (!problem.empty()) {
      throw py::value_error(std::string(name) + ": row " + std::to_string(k) + ": " + problem);
    }
  }
}

void require_threads(int threads) {
  constexpr int kMost = 1024;
  if (threads < 0 || threads > kMost) {
    throw py::value_error("threads: expected a whole number from 0 to " + std::to_string(kMost) +
                          ", got " + std::to_string(threads));
  }
}

/// Edges of the question of a scene.
class HeldEdges {
 public:
  HeldEdges(ScenePlan plan, const EdgeCheckOptions& options)
      : plan_(std::move(plan)), checker_(plan_.plan, options) {}

  [[nodiscard]] std::size_t size() const { return plan_.plan.space.size(); }
  [[nodiscard]] const ScenePlan& plan() const { return plan_; }

  /// @param closest  whether clearances are the proven least distances along the edges, one by one
  py::object check(py::handle from, py::handle to, bool closest, int threads) const {
    require_threads(threads);
    const std::vector<Configuration> begins = places_from(from, "start", size());
    const std::vector<Configuration> ends = places_from(to, "end", size());
    require_places_of(plan_.plan.space, begins, "start");
    require_places_of(plan_.plan.space, ends, "end");
    const std::vector<EdgeAnswer> answers = [&] {
      const py::gil_scoped_release release;
      return closest ? check_closely(begins, ends) : checker_.check(begins, ends, threads);
    }();
    const auto count = static_cast<py::ssize_t>(answers.size());
    py::array_t<bool> is_free(count);
    py::array_t<bool> is_undecided(count);
    py::array_t<double> fractions(count);
    py::array_t<double> clearances(count);
    for (std::size_t k = 0; k < answers.size(); ++k) {
      const auto at = static_cast<py::ssize_t>(k);
      is_free.mutable_at(at) = answers[k].verdict == EdgeVerdict::free;
      is_undecided.mutable_at(at) = answers[k].verdict == EdgeVerdict::undecided;
      fractions.mutable_at(at) = answers[k].fraction;
      clearances.mutable_at(at) = or_nan(answers[k].clearance);
    }
    return tuple_of_planning("EdgeAnswers")(is_free, is_undecided, fractions, clearances);
  }

  /// Whether each place is within the limits of its joints, or a pose.
  py::array within_limits(py::handle places) const {
    const std::vector<Configuration> all = places_from(places, "places", size());
    py::array_t<bool> within(static_cast<py::ssize_t>(all.size()));
    for (std::size_t k = 0; k < all.size(); ++k) {
      within.mutable_at(static_cast<py::ssize_t>(k)) = !plan_.plan.space.defect(all[k]);
    }
    return within;
  }

  /// [m]  The clearance at each place: 0 where it is not free, NaN where no pair is tested.
  py::array clearances(py::handle places) const {
    const std::vector<Configuration> all = places_from(places, "places", size());
    require_places_of(plan_.plan.space, all, "places");
    std::vector<double> found;
    {
      const py::gil_scoped_release release;
      for (const Configuration& place : all) {
        found.push_back(or_nan(checker_.state(place).clearance));
      }
    }
    return owning(std::move(found));
  }

 private:
  [[nodiscard]] std::vector<EdgeAnswer> check_closely(
      const std::vector<Configuration>& begins, const std::vector<Configuration>& ends) const {
    if (begins.size() != ends.size()) {
      throw std::invalid_argument("expected as many begins of edges as ends");
    }
    std::vector<EdgeAnswer> answers;
    for (std::size_t k = 0; k < begins.size(); ++k) {
      answers.push_back(checker_.check_closely(begins[k], ends[k]));
    }
    return answers;
  }

  ScenePlan plan_;
  EdgeChecker checker_;
};

std::vector<std::string> joint_names_of(const HeldEdges& edges) {
  const ConfigurationSpace& space = edges.plan().plan.space;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < space.size() && !space.is_body(); ++k) {
    names.push_back(space.number_name(k));
  }
  return names;
}

ContactUse contact_use_from(const std::string& word) {
  const auto found = std::find(kContactUseWords.begin(), kContactUseWords.end(), word);
  if (found == kContactUseWords.end()) {
    throw py::value_error("contacts: expected \"none\", \"sample\", \"slide\" or \"both\", got \"" +
                          word + "\"");
  }
  return static_cast<ContactUse>(found - kContactUseWords.begin());
}

Planner planner_from(const std::string& word) {
  const auto found = std::find(kPlannerWords.begin(), kPlannerWords.end(), word);
  if (found == kPlannerWords.end()) {
    throw py::value_error("planner: expected \"rrt_connect\" or \"lazy_prm_star\", got \"" + word +
                          "\"");
  }
  return static_cast<Planner>(found - kPlannerWords.begin());
}

/// Hands a planner's progress to Python.
///
/// @param stop  of the running query; an exception that the callback raises ends it
std::function<void(const PlanProgress&)> plan_progress_of(const py::object& callback,
                                                          QueryStop& stop) {
  if (callback.is_none()) {
    return {};
  }
  return [&callback, &stop](const PlanProgress& done) {
    const py::gil_scoped_acquire acquire;
    try {
      callback(done.seconds, done.nodes, done.cost);
    } catch (const py::error_already_set&) {
      stop.fail(std::current_exception());
    }
  };
}

py::object plan(const HeldScene& scene, const std::optional<std::string>& planner,
                const std::optional<std::string>& contacts,
                const std::optional<std::uint64_t>& seed, const std::optional<double>& time,
                const std::optional<double>& margin, const std::optional<double>& tolerance,
                std::size_t shortcuts, bool approximate, int threads, const py::object& progress,
                OrNone<std::stop_source> stop) {
  PlanQuestion question = question_of(scene);
  question.margin = margin ? margin : question.margin;
  if (planner) {
    question.planner = planner_from(*planner);
  }
  if (contacts) {
    question.contacts = contact_use_from(*contacts);
  }
  question.seed = seed ? seed : question.seed;
  question.time = time ? time : question.time;
  std::optional<ScenePlan> made;
  PlanOptions options;
  const PlanResult result = run_query(stop, [&](QueryStop& query) {
    ShapeCache cache;
    Scene asked = scene.scene();
    asked.options.tolerance = tolerance.value_or(asked.options.tolerance);
    made = make_scene_plan(std::move(asked), question, cache, query.token());
    require_goals_apart(*made, question);
    options = made->options;
    options.shortcuts = shortcuts;
    options.approximate = approximate;
    options.threads = threads;
    options.stop = query.token();
    options.progress = plan_progress_of(progress, query);
    return plan_path(made->plan, made->start, made->goals, options);
  });
  const ScenePlan& asked = *made;
  std::vector<double> clearances;
  for (const std::optional<double>& clearance : result.clearances) {
    clearances.push_back(or_nan(clearance));
  }
  py::list blocked;
  for (const NamedBlockingPair& blocking : blocked_by_name(asked, result.statistics)) {
    blocked.append(py::make_tuple(blocking.pair[0], blocking.pair[1], blocking.count));
  }
  const auto text_of_path = [&] {
    PlannedPath path = planned_path(asked, options, result);
    path.sources = path_sources(asked.loaded.scene.files_read);
    return write_planned_path(path);
  };
  return tuple_of_planning("PlanAnswer")(
      kPlanVerdictWords.at(static_cast<std::size_t>(result.verdict)),
      rows_from(result.path, asked.plan.space.size()), owning(std::vector<double>(result.times)),
      owning(std::move(clearances)), result.cost, result.goal, result.distance_to_goal,
      py::tuple(blocked), py::tuple(py::cast(result.warnings)),
      result.verdict != PlanVerdict::none ? py::object(py::str(text_of_path())) : py::none());
}

}  // namespace

void bind_planning(py::module_& m) {
  const EdgeCheckOptions defaults;
  py::class_<HeldEdges>(m, "EdgeChecker",
                        R"(Checker of a planner's edges and places, which proves them free.

scene: with "plan", which gives the mover, starts and goals. extra_clearance: [m] distance that
edges keep beyond the margins. effort: steps of the search for each two geometries; with more an
edge is undecided. Pairs of "contact_pairs" in "plan" keep their margins here. Many threads may use
one checker at a time.)")
      .def(py::init([](const HeldScene& scene, double extra_clearance, std::uint64_t effort) {
             ScenePlan asked = plan_of(scene);
             const double tolerance = asked.options.tolerance;
             return std::make_unique<HeldEdges>(
                 std::move(asked),
                 EdgeCheckOptions{
                     .tolerance = tolerance, .extra_clearance = extra_clearance, .effort = effort});
           }),
           py::arg("scene"), py::kw_only(), py::arg("extra_clearance") = defaults.extra_clearance,
           py::arg("effort") = defaults.effort)
      .def_property_readonly("joints", &joint_names_of,
                             "The coordinates of a configuration; empty for a body.")
      .def_property_readonly(
          "start", [](const HeldEdges& edges) { return owning(edges.plan().start); },
          "The start of the scene's plan.")
      .def_property_readonly(
          "goals",
          [](const HeldEdges& edges) { return rows_from(edges.plan().goals, edges.size()); },
          "The goals of the scene's plan, one per row.")
      .def("check", &HeldEdges::check, py::arg("start"), py::arg("end"), py::kw_only(),
           py::arg("closest") = false, py::arg("threads") = 0,
           R"(Checks edges, n×d numbers each: the k-th leads from start[k] to end[k].

The clearance of a free edge is its extra_clearance; with closest, the proven least distance of
tested pairs along it, which takes longer and one thread. threads: at most; 0 for one on each core.
Limits of joints do not count here: see within_limits. Other threads of Python run meanwhile.)")
      .def("within_limits", &HeldEdges::within_limits, py::arg("places"),
           R"(Says for each place whether its joints are within their limits.

places: n×d numbers. For a body: whether it is a pose, with a quaternion of length 1.)")
      .def("clearance", &HeldEdges::clearances, py::arg("places"),
           R"(Computes [m] a proven lower bound of the distances of tested pairs at each place.

places: n×d numbers. 0 where a place is not free; NaN where no pair is tested.)");
  m.def("plan", &plan, py::arg("scene"), py::kw_only(), py::arg("planner"), py::arg("contacts"),
        py::arg("seed"), py::arg("time"), py::arg("margin"), py::arg("tolerance"),
        py::arg("shortcuts"), py::arg("approximate"), py::arg("threads"), py::arg("progress"),
        py::arg("stop"));
}

}  // namespace firstcontact::python
