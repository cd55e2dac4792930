#include "query.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <utility>

#include <pybind11/stl.h>

#include <firstcontact/many_bodies/body_set.h>
#include <firstcontact/many_bodies/many_bodies.h>
#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/query/closest_approach.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/robot/joint_path.h>
#include <firstcontact/scene_files/write_result.h>

#include "arrays.h"
#include "bindings.h"
#include "interrupts.h"
#include "words.h"

namespace firstcontact::python {

namespace py = pybind11;

using PairWorkspace = HeldWorkspace<Workspace>;
using SetWorkspace = HeldWorkspace<ManyBodiesWorkspace>;

namespace {

const std::uint64_t kAllSteps = WorkBudget{}.steps;
const std::size_t kMemory = WorkBudget{}.memory;

// Contacts and results

py::tuple state_of(const Feature& feature) {
  return py::make_tuple(feature.type, feature.index, feature.triangle);
}

Feature feature_from(const py::tuple& state) {
  return {.type = state[0].cast<FeatureType>(),
          .index = state[1].cast<std::uint32_t>(),
          .triangle = state[2].cast<std::uint32_t>()};
}

py::tuple plain(const Eigen::Vector3d& v) { return py::make_tuple(v.x(), v.y(), v.z()); }

py::tuple state_of(const WorkCount& work) {
  return py::make_tuple(work.node_groups, work.triangle_pairs, work.steps);
}

WorkCount work_from(const py::tuple& state) {
  return {.node_groups = state[0].cast<std::uint64_t>(),
          .triangle_pairs = state[1].cast<std::uint64_t>(),
          .steps = state[2].cast<std::uint64_t>()};
}

py::tuple state_of(const ContactCount& count) {
  return py::make_tuple(count.at_least, count.is_exact);
}

ContactCount contact_count_from(const py::tuple& state) {
  return {state[0].cast<std::uint64_t>(), state[1].cast<bool>()};
}

py::tuple state_of(const ClosestApproach& found);
py::tuple state_of(const ContactInterval& interval);
using python::state_of;

/// Of a value that may be missing.
template <typename T>
py::object state_or_none(const std::optional<T>& value) {
  return value ? py::object(state_of(*value)) : py::none();
}

template <typename T>
std::optional<T> value_or_none(const py::object& state, T (*from)(const py::tuple&)) {
  return state.is_none() ? std::nullopt : std::optional(from(state));
}

/// Of several values, in order.
template <typename T>
py::tuple states_of(const std::vector<T>& values) {
  py::tuple states(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    states[k] = state_of(values[k]);
  }
  return states;
}

template <typename T>
std::vector<T> all_from(const py::handle& states, T (*from)(const py::tuple&)) {
  std::vector<T> values;
  for (const py::handle state : states) {
    values.push_back(from(state.cast<py::tuple>()));
  }
  return values;
}

py::tuple state_of_outcome(const Outcome& outcome) {
  return py::make_tuple(outcome.verdict, outcome.reason, outcome.t, outcome.t_upper,
                        outcome.clearance, outcome.tolerance_used, outcome.enclosure_error);
}

Outcome outcome_from(const py::tuple& state) {
  return {.verdict = state[0].cast<Verdict>(),
          .reason = state[1].cast<UndecidedReason>(),
          .t = state[2].cast<double>(),
          .t_upper = state[3].cast<std::optional<double>>(),
          .clearance = state[4].cast<double>(),
          .tolerance_used = state[5].cast<double>(),
          .enclosure_error = state[6].cast<double>()};
}

py::tuple state_of(const ClosestApproach& found) {
  return py::make_tuple(found.distance, found.lower_bound, found.t, found.reason,
                        state_or_none(found.closest));
}

ClosestApproach closest_approach_from(const py::tuple& state) {
  return {.distance = state[0].cast<double>(),
          .lower_bound = state[1].cast<double>(),
          .t = state[2].cast<double>(),
          .reason = state[3].cast<UndecidedReason>(),
          .closest = value_or_none<Contact>(state[4], &contact_from)};
}

py::tuple state_of(const ClosestApproachResult& result) {
  return py::make_tuple(state_of(static_cast<const ClosestApproach&>(result)),
                        result.tolerance_used, result.enclosure_error, state_of(result.work));
}

ClosestApproachResult closest_approach_result_from(const py::tuple& state) {
  ClosestApproachResult result;
  static_cast<ClosestApproach&>(result) = closest_approach_from(state[0]);
  result.tolerance_used = state[1].cast<double>();
  result.enclosure_error = state[2].cast<double>();
  result.work = work_from(state[3]);
  return result;
}

py::tuple state_of(const ContactInterval& interval) {
  return py::make_tuple(interval.enter, interval.leave, interval.reason);
}

ContactInterval interval_from(const py::tuple& state) {
  return {.enter = state[0].cast<double>(),
          .leave = state[1].cast<double>(),
          .reason = state[2].cast<UndecidedReason>()};
}

py::tuple state_of(const FirstContactResult& result) {
  return py::make_tuple(state_of_outcome(result), states_of(result.contacts),
                        state_of(result.contact_count), state_of(result.work));
}

FirstContactResult first_contact_result_from(const py::tuple& state) {
  FirstContactResult result;
  static_cast<Outcome&>(result) = outcome_from(state[0]);
  result.contacts = all_from<Contact>(state[1], &contact_from);
  result.contact_count = contact_count_from(state[2]);
  result.work = work_from(state[3]);
  return result;
}

py::tuple state_of(const DistanceResult& result) {
  return py::make_tuple(result.distance, result.lower_bound, result.enclosure_error,
                        state_or_none(result.closest), state_of(result.work));
}

DistanceResult distance_result_from(const py::tuple& state) {
  return {.distance = state[0].cast<double>(),
          .lower_bound = state[1].cast<double>(),
          .enclosure_error = state[2].cast<double>(),
          .closest = value_or_none<Contact>(state[3], &contact_from),
          .work = work_from(state[4])};
}

/// Defines pickling by a state.
template <typename T, typename... Options>
void add_pickling(py::class_<T, Options...>& type, py::tuple (*state)(const T&),
                  T (*from)(const py::tuple&)) {
  type.def(py::pickle([state](const T& value) { return state(value); },
                      [from](const py::tuple& kept) { return from(kept); }));
}

std::string number_text(double number) { return py::repr(py::float_(number)); }

std::string describe(const Feature& feature) {
  return std::string(word(feature.type)) + " " + std::to_string(feature.index);
}

void bind_contact(py::module_& m) {
  py::class_<Feature> feature(m, "Feature",
                              "A vertex, a unique edge or a face of a shape, by its index.");
  feature.def_readonly("type", &Feature::type)
      .def_readonly("index", &Feature::index, "Of the vertex, the edge or the triangle.")
      .def_readonly("triangle", &Feature::triangle, "A triangle that the feature belongs to.")
      .def("__eq__",
           [](const Feature& a, const py::object& b) {
             return py::isinstance<Feature>(b) && a == b.cast<const Feature&>();
           })
      .def("__hash__", [](const Feature& value) { return py::hash(state_of(value)); })
      .def("__repr__", [](const Feature& value) { return "<Feature: " + describe(value) + ">"; });
  add_pickling<Feature>(feature, &state_of, &feature_from);

  py::class_<Contact> contact(m, "Contact",
                              "Two features within the contact band at the reported time.");
  contact
      .def_property_readonly(
          "features", [](const Contact& c) { return py::make_tuple(c.feature_A, c.feature_B); },
          "Of A and of B.")
      .def_property_readonly(
          "triangles",
          [](const Contact& c) {
            return py::make_tuple(c.feature_A.triangle, c.feature_B.triangle);
          },
          "A triangle of each feature.")
      .def_property_readonly(
          "points",
          [](const Contact& c) {
            const std::array<double, 6> rows{c.p_WA.x(), c.p_WA.y(), c.p_WA.z(),
                                             c.p_WB.x(), c.p_WB.y(), c.p_WB.z()};
            return py::array_t<double>({2, 3}, rows.data());
          },
          "[m] 2×3, world frame: the closest points on A's and B's thickened surfaces.")
      .def_property_readonly(
          "normal",
          [](const Contact& c) { return c.n_AB_W ? py::object(copied(*c.n_AB_W)) : py::none(); },
          "[-] (3,), unit, world frame, from A to B; None where no feature normal decides.")
      .def_readonly("distance", &Contact::distance, "[m] Negative: depth of thickened features.")
      .def_readonly("normal_velocity", &Contact::normal_velocity,
                    "[m per step] Of B's point relative to A's along the normal; negative when "
                    "closing. In the result of a scene [m/s].")
      .def("__repr__", [](const Contact& c) {
        return "<Contact: " + describe(c.feature_A) + " and " + describe(c.feature_B) +
               ", distance " + number_text(c.distance) + " m>";
      });
  add_pickling<Contact>(contact, &python::state_of, &contact_from);

  py::class_<WorkCount> work(m, "WorkCount", "Work done: counts, outside of what is proven.");
  work.def_readonly("node_groups", &WorkCount::node_groups,
                    "Evaluations of up to 16 pairs of boxes.")
      .def_readonly("triangle_pairs", &WorkCount::triangle_pairs, "Triangle pairs visited.")
      .def_readonly("steps", &WorkCount::steps, "Certified steps of triangle pairs.")
      .def("__repr__", [](const WorkCount& count) {
        return "<WorkCount: " + std::to_string(count.node_groups) + " node groups, " +
               std::to_string(count.triangle_pairs) + " triangle pairs, " +
               std::to_string(count.steps) + " steps>";
      });
  add_pickling<WorkCount>(work, &state_of, &work_from);
}

/// Defines what every answer begins with.
template <typename T, typename... Options>
void add_outcome(py::class_<T, Options...>& type, const char* t, const char* clearance,
                 const char* tolerance_used, const char* enclosure_error) {
  type.def_readonly("verdict", &T::verdict)
      .def_readonly("reason", &T::reason, "Why it is undecided.")
      .def_readonly("t", &T::t, t)
      .def_readonly("t_upper", &T::t_upper,
                    "[-] For `contact` t; for `undecided` a later time that is proven to be in "
                    "contact, if one is known.")
      .def_readonly("clearance", &T::clearance, clearance)
      .def_readonly("tolerance_used", &T::tolerance_used, tolerance_used)
      .def_readonly("enclosure_error", &T::enclosure_error, enclosure_error)
      .def_readonly("work", &T::work);
}

void bind_pair_results(py::module_& m) {
  using Result = FirstContactResult;
  py::class_<Result> first(m, "FirstContactResult", "First contact of two moving shapes.");
  add_outcome(first,
              "[-] Before it the shapes are farther apart than the margin: proven. 1 when free.",
              "[m] Proven lower bound of the distance before t.",
              "[m] Holds in place of the asked one; larger only if doubles need it.",
              "[m] Of both shapes: adds to the tolerance of a contact.");
  first
      .def_property_readonly(
          "contacts", [](const Result& result) { return contact_tuple(result.contacts); },
          "At t, sorted by features; those that were asked for.")
      .def_property_readonly(
          "contact_count", [](const Result& result) { return result.contact_count.at_least; },
          "How many there are, those included that are not listed.")
      .def_property_readonly(
          "contact_count_is_exact",
          [](const Result& result) { return result.contact_count.is_exact; },
          "Not where only the first was asked for, or counting ended early: then there may be "
          "more.")
      .def("__repr__", [](const Result& result) {
        return "<FirstContactResult: " + verdict_text(result) + ">";
      });
  add_pickling<Result>(first, &state_of, &first_contact_result_from);

  py::class_<ClosestApproach> approach(m, "ClosestApproach",
                                       "Where two shapes are closest over the step.");
  approach
      .def_readonly("distance", &ClosestApproach::distance,
                    "[m] Attained at t; an upper bound of the least distance over the step.")
      .def_readonly("lower_bound", &ClosestApproach::lower_bound, "[m] Proven for all t in [0, 1].")
      .def_readonly("t", &ClosestApproach::t, "[-] A time where `distance` is attained.")
      .def_readonly("reason", &ClosestApproach::reason, "Not `none`: the budget ended the search.")
      .def_readonly("closest", &ClosestApproach::closest, "The closest feature pair at t, or None.")
      .def("__repr__", [](const ClosestApproach& found) {
        return "<ClosestApproach: " + number_text(found.distance) +
               " m at t = " + number_text(found.t) + ">";
      });
  add_pickling<ClosestApproach>(approach, &state_of, &closest_approach_from);
  using Closest = ClosestApproachResult;
  py::class_<Closest, ClosestApproach> closest(
      m, "ClosestApproachResult", "Closest approach of two moving shapes over the step.");
  closest.def_readonly("tolerance_used", &Closest::tolerance_used, "[m]")
      .def_readonly("enclosure_error", &Closest::enclosure_error,
                    "[m] Of both shapes: the bodies may be farther apart by this.")
      .def_readonly("work", &Closest::work)
      .def("__repr__", [](const Closest& result) {
        return "<ClosestApproachResult: " + number_text(result.distance) +
               " m at t = " + number_text(result.t) + ">";
      });
  add_pickling<Closest>(closest, &state_of, &closest_approach_result_from);

  using Distance = DistanceResult;
  py::class_<Distance> distance(m, "DistanceResult", "Distance of two shapes at one instant.");
  distance
      .def_readonly("distance", &Distance::distance,
                    "[m] Of the closest points found, 0 when the shapes meet.")
      .def_readonly("lower_bound", &Distance::lower_bound,
                    "[m] Proven: the shapes are at least this far apart.")
      .def_readonly("enclosure_error", &Distance::enclosure_error,
                    "[m] Of both: the bodies may be farther apart by this.")
      .def_readonly("closest", &Distance::closest, "The closest feature pair, or None.")
      .def_readonly("work", &Distance::work)
      .def("__repr__", [](const Distance& result) {
        return "<DistanceResult: " + number_text(result.distance) + " m>";
      });
  add_pickling<Distance>(distance, &state_of, &distance_result_from);
}

void bind_set_results(py::module_& m) {
  py::class_<PairAnswer, FirstContactResult> answer(
      m, "PairAnswer", "What one pair of bodies answered: its first contact, and what was asked.");
  answer
      .def_property_readonly(
          "members", [](const PairAnswer& a) { return py::make_tuple(a.members[0], a.members[1]); },
          "Their numbers, the smaller first.")
      .def_readonly("margin", &PairAnswer::margin, "[m] Closer than this counts as contact.")
      .def_property_readonly(
          "intervals", [](const PairAnswer& a) { return states_of(a.intervals); },
          "Of contact, in order: tuples of enter, leave and reason; where "
          "all_contacts_in_time was asked.")
      .def_readonly("closest", &PairAnswer::closest,
                    "A ClosestApproach; None where it was not asked.")
      .def("__repr__", [](const PairAnswer& a) {
        return "<PairAnswer of " + std::to_string(a.members[0]) + " and " +
               std::to_string(a.members[1]) + ": " + verdict_text(a) + ">";
      });
  add_pickling<PairAnswer>(answer, &python::state_of, &pair_answer_from);

  py::class_<SceneResult> result(m, "SceneResult", "The first contact of a set of bodies.");
  add_outcome(result, "[-] No pair is in contact before it: proven. 1 when free.",
              "[m] Proven lower bound of every pair's distance up to t; infinite where there are "
              "no pairs.",
              "[m] The greatest of the pairs that were searched.", "[m] The greatest of these.");
  result
      .def_readonly("first", &SceneResult::first,
                    "The index in pairs of the one that decides t; None when free.")
      .def_property_readonly(
          "pairs", [](const SceneResult& r) { return py::tuple(py::cast(r.pairs)); },
          "PairAnswers of the pairs that decide t, by their order; none when free.")
      .def("__repr__",
           [](const SceneResult& r) { return "<SceneResult: " + verdict_text(r) + ">"; });
  add_pickling<SceneResult>(result, &python::state_of, &scene_result_from);
}

// Questions

FirstContactResult ask_first_contact(const py::object& A, const py::object& B,
                                     PairWorkspace* workspace, FirstContactOptions options,
                                     const std::stop_source* stop) {
  const MovingShape a = moving_shape_from(A, "A");
  const MovingShape b = moving_shape_from(B, "B");
  Lease<Workspace> lease(workspace);
  return run_query(stop, [&](const QueryStop& query) {
    options.budget.stop = query.token();
    return first_contact(a, b, lease.get(), options);
  });
}

void bind_pair_questions(py::module_& m) {
  m.def(
      "first_contact",
      [](const FirstShape& A, const py::object& B, OrNone<PairWorkspace> workspace, double margin,
         double tolerance, StartContacts start_contacts, ContactState contacts, double contact_band,
         std::uint64_t steps, std::size_t memory, std::optional<double> deadline,
         OrNone<std::stop_source> stop) {
        return ask_first_contact(A.value, B, workspace,
                                 {.margin = margin,
                                  .tolerance = tolerance,
                                  .start_contacts = start_contacts,
                                  .contacts = contacts,
                                  .contact_band = contact_band,
                                  .budget = {.steps = steps,
                                             .memory = memory,
                                             .deadline = deadline_in(deadline),
                                             .stop = {}}},
                                 stop);
      },
      py::arg("A"), py::arg("B"), py::arg("workspace") = py::none(), py::kw_only(),
      py::arg("margin") = 0.0, py::arg("tolerance") = 1e-6,
      py::arg("start_contacts") = StartContacts::report,
      py::arg("contacts") = ContactState::nearest(), py::arg("contact_band") = 0.0,
      py::arg("steps") = kAllSteps, py::arg("memory") = kMemory, py::arg("deadline") = py::none(),
      py::arg("stop") = py::none(),
      R"(Finds the first contact of A and B during the step.

A, B: pairs (Shape, Motion). margin: [m] closer than this counts as contact. tolerance: [m] a
reported contact is no farther than margin + tolerance. contact_band: [m] reports pairs within
margin + tolerance + band. contacts: which feature pairs are listed; a number: so many at most, the
nearest and some of every region. steps, memory [byte], deadline [s], stop: a budget; spending it gives
`undecided`, never a guess.

Safe to act on whatever the verdict: before t the shapes are farther apart than the margin.
Symmetric in A and B, and the same on every run without a deadline or a stop.
Other threads run meanwhile. Ctrl-C raises KeyboardInterrupt.)");
  m.def(
      "closest_approach",
      [](const py::object& A, const py::object& B, OrNone<PairWorkspace> workspace,
         double tolerance, std::uint64_t steps, std::size_t memory, std::optional<double> deadline,
         OrNone<std::stop_source> stop) {
        const MovingShape a = moving_shape_from(A, "A");
        const MovingShape b = moving_shape_from(B, "B");
        ClosestApproachOptions options{
            .tolerance = tolerance,
            .budget = {
                .steps = steps, .memory = memory, .deadline = deadline_in(deadline), .stop = {}}};
        Lease<Workspace> lease(workspace);
        return run_query(stop, [&](const QueryStop& query) {
          options.budget.stop = query.token();
          return closest_approach(a, b, lease.get(), options);
        });
      },
      py::arg("A"), py::arg("B"), py::arg("workspace") = py::none(), py::kw_only(),
      py::arg("tolerance") = 1e-6, py::arg("steps") = kAllSteps, py::arg("memory") = kMemory,
      py::arg("deadline") = py::none(), py::arg("stop") = py::none(),
      R"(Least distance of A and B over the step, to the tolerance [m], with a time where it is attained.

A, B: pairs (Shape, Motion). The budget as of first_contact.)");
  m.def(
      "distance",
      [](const py::object& A, const py::object& B, double t, OrNone<PairWorkspace> workspace) {
        const MovingShape a = moving_shape_from(A, "A");
        const MovingShape b = moving_shape_from(B, "B");
        Lease<Workspace> lease(workspace);
        return run_query(nullptr, [&](const QueryStop&) { return distance(a, b, t, lease.get()); });
      },
      py::arg("A"), py::arg("B"), py::arg("t"), py::arg("workspace") = py::none(),
      "Distance of A(t) and B(t), pairs (Shape, Motion). t: [-] in [0, 1].");
}

/// A question about a set of bodies, as it comes from Python.
struct SetQuery {
  HeldBodySet& set;
  SetWorkspace* workspace;
  ManyBodiesOptions options;
  const py::object& progress;
  const std::stop_source* stop;
};

/// Calls `ask` with the workspace and the options, without the GIL.
template <typename Ask>
auto ask_set(SetQuery query, const Ask& ask) {
  const Reading reading(query.set);
  Lease<ManyBodiesWorkspace> lease(query.workspace);
  return run_query(query.stop, [&](QueryStop& stop) {
    query.options.pair.budget.stop = stop.token();
    query.options.progress = progress_of(query.progress, stop);
    return ask(query.set.bodies, lease.get(), query.options);
  });
}

/// Defines a question about a set of bodies; `extra` are its documentation and arguments of its
/// own.
template <typename Question, typename... Extra>
void bind_set_question(py::module_& m, const char* name, Question question, const Extra&... extra) {
  m.def(name, question, py::arg("bodies"), py::arg("workspace") = py::none(), py::kw_only(),
        py::arg("tolerance") = 1e-6, py::arg("start_contacts") = StartContacts::report,
        py::arg("contacts") = ContactState::nearest(), py::arg("contact_band") = 0.0,
        py::arg("steps") = kAllSteps, py::arg("memory") = kMemory, py::arg("deadline") = py::none(),
        py::arg("threads") = 0, py::arg("progress") = py::none(), py::arg("stop") = py::none(),
        extra...);
}

ManyBodiesOptions set_options(double tolerance, StartContacts start_contacts, ContactState contacts,
                              double contact_band, std::uint64_t steps, std::size_t memory,
                              std::optional<double> deadline) {
  return {
      .pair = {
          .tolerance = tolerance,
          .start_contacts = start_contacts,
          .contacts = contacts,
          .contact_band = contact_band,
          .budget = {
              .steps = steps, .memory = memory, .deadline = deadline_in(deadline), .stop = {}}}};
}

void bind_set_questions(py::module_& m) {
  bind_set_question(
      m, "first_contact",
      [](HeldBodySet& bodies, OrNone<SetWorkspace> workspace, double tolerance,
         StartContacts start_contacts, ContactState contacts, double contact_band,
         std::uint64_t steps, std::size_t memory, std::optional<double> deadline, int threads,
         const py::object& progress, OrNone<std::stop_source> stop) {
        ManyBodiesOptions options =
            set_options(tolerance, start_contacts, contacts, contact_band, steps, memory, deadline);
        options.threads = threads;
        return ask_set(
            {bodies, workspace, options, progress, stop},
            [](const BodySet& set, ManyBodiesWorkspace& scratch, const ManyBodiesOptions& asked) {
              return first_contact(set, scratch, asked);
            });
      },
      R"(Finds the first contact of all pairs of bodies that the rules do not ignore.

threads: at most; 0 for one on each core; the answer does not depend on it. progress: called now
and then with the time that is proven free so far. The rest as for two bodies; margins are in the
rules, the budget holds for each pair.)");
  bind_set_question(
      m, "answer_each_pair",
      [](HeldBodySet& bodies, OrNone<SetWorkspace> workspace, double tolerance,
         StartContacts start_contacts, ContactState contacts, double contact_band,
         std::uint64_t steps, std::size_t memory, std::optional<double> deadline, int threads,
         const py::object& progress, OrNone<std::stop_source> stop, bool closest,
         bool all_contacts_in_time) {
        ManyBodiesOptions options =
            set_options(tolerance, start_contacts, contacts, contact_band, steps, memory, deadline);
        options.threads = threads;
        options.closest = closest;
        options.all_contacts_in_time = all_contacts_in_time;
        return ask_set(
            {bodies, workspace, options, progress, stop},
            [](const BodySet& set, ManyBodiesWorkspace& scratch, const ManyBodiesOptions& asked) {
              return answer_each_pair(set, scratch, asked);
            });
      },
      py::arg("closest") = false, py::arg("all_contacts_in_time") = false,
      R"(The answer of every pair that the rules do not ignore, over the whole step, by their order.

closest: also the closest approach of each. all_contacts_in_time: also from when to when each is in
contact. progress: called with the part that is done. The rest as
of first_contact.)");
}

// Sets of bodies

/// Rules of their own, or those of a set.
struct HeldRules {
  PairRules own;
  py::object set;  // None for rules of their own.

  PairRules& get() { return set.is_none() ? own : set.cast<HeldBodySet&>().bodies.rules(); }
  PairRules& changed() { return set.is_none() ? own : set.cast<HeldBodySet&>().changed().rules(); }
};

BodyPair ordered(const BodyPair& pair) {
  return {std::min(pair[0], pair[1]), std::max(pair[0], pair[1])};
}

std::size_t require_body(const HeldBodySet& set, std::size_t body) {
  if (body >= set.bodies.size()) {
    throw py::index_error("body " + std::to_string(body) + " of " +
                          std::to_string(set.bodies.size()));
  }
  return body;
}

void bind_rules(py::module_& m) {
  py::class_<HeldRules>(m, "PairRules",
                        R"(Rules for pairs of bodies, by their numbers, and for groups of them.

A pair that any rule ignores is not tested. Else its own margin holds; or the greatest that groups
give it; or the general one.)")
      .def(py::init([](double margin) {
             return HeldRules{PairRules(margin), py::none()};
           }),
           py::arg("margin") = 0.0, "margin: [m] of every pair without another one; >= 0.")
      .def(
          "ignore",
          [](HeldRules& rules, const BodyPair& pair) { rules.changed().ignore(ordered(pair)); },
          py::arg("pair"), "Does not test this pair.")
      .def(
          "set_margin",
          [](HeldRules& rules, const BodyPair& pair, double margin) {
            rules.changed().set_margin(ordered(pair), margin);
          },
          py::arg("pair"), py::arg("margin"), "margin: [m] >= 0.")
      .def(
          "add_group",
          [](HeldRules& rules, std::vector<std::size_t> bodies) {
            return rules.changed().add_group(std::move(bodies));
          },
          py::arg("bodies"), "Returns the number of the group.")
      .def(
          "ignore_groups",
          [](HeldRules& rules, std::size_t group, std::size_t other) {
            rules.changed().ignore_groups(group, other);
          },
          py::arg("group"), py::arg("other"),
          "Tests no body of one with a body of the other; with itself: no pair inside it.")
      .def(
          "set_group_margin",
          [](HeldRules& rules, std::size_t group, std::size_t other, double margin) {
            rules.changed().set_group_margin(group, other, margin);
          },
          py::arg("group"), py::arg("other"), py::arg("margin"), "margin: [m] >= 0.")
      .def(
          "margin",
          [](HeldRules& rules, const BodyPair& pair) { return rules.get().margin(ordered(pair)); },
          py::arg("pair"), "[m] None where the pair is not tested.");
}

void bind_body_set(py::module_& m) {
  py::class_<HeldBodySet> type(m, "BodySet",
                               R"(Moving bodies, numbered from 0, and the rules for their pairs.

Replacing one body's shape or motion costs what that body needs; nothing else is rebuilt. Several
threads may query one set at once; it cannot change meanwhile.)");
  type.def(py::init([](HeldRules* rules) {
             return HeldBodySet{BodySet(rules != nullptr ? rules->get() : PairRules()), {}, {}, 0};
           }),
           py::arg("rules") = py::none(), "rules: a PairRules, which is copied.")
      .def_property_readonly(
          "rules",
          [](const py::object& self) {
            return HeldRules{PairRules(), self};
          },
          "The rules of this set, to be changed.")
      .def(
          "add",
          [](HeldBodySet& set, const py::object& shape, const py::object& X_WS) {
            const std::size_t body = set.changed().add(shape.cast<const Shape&>(),
                                                       X_WS.cast<const RecordedMotion&>().motion);
            set.shapes.push_back(shape);
            set.motions.push_back(X_WS);
            return body;
          },
          py::arg("shape"), py::arg("X_WS"), "Returns the body's number.")
      .def(
          "set_shape",
          [](HeldBodySet& set, std::size_t body, const py::object& shape) {
            set.changed().set_shape(require_body(set, body), shape.cast<const Shape&>());
            set.shapes[body] = shape;
          },
          py::arg("body"), py::arg("shape"))
      .def(
          "set_motion",
          [](HeldBodySet& set, std::size_t body, const py::object& X_WS) {
            set.changed().set_motion(require_body(set, body),
                                     X_WS.cast<const RecordedMotion&>().motion);
            set.motions[body] = X_WS;
          },
          py::arg("body"), py::arg("X_WS"))
      .def(
          "shape",
          [](const HeldBodySet& set, std::size_t body) {
            return set.shapes[require_body(set, body)];
          },
          py::arg("body"))
      .def(
          "motion",
          [](const HeldBodySet& set, std::size_t body) {
            return set.motions[require_body(set, body)];
          },
          py::arg("body"))
      .def("__len__", [](const HeldBodySet& set) { return set.bodies.size(); })
      .def("__repr__", [](const HeldBodySet& set) {
        return "<BodySet of " + std::to_string(set.bodies.size()) + " bodies>";
      });
}

void bind_helpers(py::module_& m) {
  py::class_<PairWorkspace>(
      m, "Workspace",
      R"(Scratch memory that queries of two shapes reuse; it carries no state from one to the next.

One for each thread. Without one, a query takes memory that an earlier one left behind.)")
      .def(py::init<>());
  py::class_<SetWorkspace>(m, "ManyBodiesWorkspace",
                           "Scratch memory of the queries of many bodies, as Workspace.")
      .def(py::init<>());
  py::class_<std::stop_source>(m, "StopSource",
                               R"(Ends the queries that it was given to, with what is proven so far.

A copy that was sent to another process never stops anything.)")
      .def(py::init<>())
      .def("request_stop", &std::stop_source::request_stop,
           "From any thread. Returns whether it is the first request.")
      .def_property_readonly("stop_requested", &std::stop_source::stop_requested)
      .def(py::pickle([](const std::stop_source&) { return py::make_tuple(); },
                      [](const py::tuple&) { return std::stop_source(); }));
}

}  // namespace

std::optional<std::chrono::steady_clock::time_point> deadline_in(std::optional<double> seconds) {
  using Clock = std::chrono::steady_clock;
  if (!seconds) {
    return std::nullopt;
  }
  if (!(*seconds > 0.0)) {
    throw std::invalid_argument("deadline must be > 0, got " + std::to_string(*seconds));
  }
  constexpr double kYear = 3e7;  // [s]  Longer ones are none, and would overflow the clock.
  return *seconds > kYear
             ? std::nullopt
             : std::optional(Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                std::chrono::duration<double>(*seconds)));
}

MovingShape moving_shape_from(py::handle value, const char* name) {
  if (PyTuple_Check(value.ptr()) && PyTuple_GET_SIZE(value.ptr()) == 2) {
    py::detail::make_caster<Shape> shape;
    py::detail::make_caster<RecordedMotion> motion;
    if (shape.load(PyTuple_GET_ITEM(value.ptr(), 0), false) &&
        motion.load(PyTuple_GET_ITEM(value.ptr(), 1), false)) {
      return {py::detail::cast_op<const Shape&>(shape),
              py::detail::cast_op<const RecordedMotion&>(motion).motion};
    }
  }
  throw py::type_error(std::string(name) + ": expected a pair (Shape, Motion), got " +
                       std::string(py::repr(value)));
}

py::tuple contact_tuple(const std::vector<Contact>& contacts) {
  py::tuple tuple(contacts.size());
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    tuple[k] = contacts[k];
  }
  return tuple;
}

std::string verdict_text(const Outcome& outcome) {
  std::string text = word(outcome.verdict);
  if (outcome.verdict == Verdict::undecided) {
    text += std::string(" (") + word(outcome.reason) + "), free until";
  } else if (outcome.verdict == Verdict::contact) {
    text += " at";
  } else {
    return text;
  }
  return text + " t = " + number_text(outcome.t);
}

py::tuple state_of(const Contact& contact) {
  return py::make_tuple(state_of(contact.feature_A), state_of(contact.feature_B),
                        plain(contact.p_WA), plain(contact.p_WB),
                        contact.n_AB_W ? py::object(plain(*contact.n_AB_W)) : py::none(),
                        contact.distance, contact.normal_velocity, contact.geometries);
}

Contact contact_from(const py::tuple& state) {
  Contact contact;
  contact.feature_A = feature_from(state[0]);
  contact.feature_B = feature_from(state[1]);
  contact.p_WA = vector_from(state[2], "p_WA");
  contact.p_WB = vector_from(state[3], "p_WB");
  if (!state[4].is_none()) {
    contact.n_AB_W = vector_from(state[4], "n_AB_W");
  }
  contact.distance = state[5].cast<double>();
  contact.normal_velocity = state[6].cast<double>();
  contact.geometries = state[7].cast<std::array<std::size_t, 2>>();
  return contact;
}

py::tuple state_of(const PairAnswer& answer) {
  return py::make_tuple(state_of(static_cast<const FirstContactResult&>(answer)), answer.members,
                        answer.margin, states_of(answer.intervals), state_or_none(answer.closest));
}

PairAnswer pair_answer_from(const py::tuple& state) {
  PairAnswer answer;
  static_cast<FirstContactResult&>(answer) = first_contact_result_from(state[0]);
  answer.members = state[1].cast<BodyPair>();
  answer.margin = state[2].cast<double>();
  answer.intervals = all_from<ContactInterval>(state[3], &interval_from);
  answer.closest = value_or_none<ClosestApproach>(state[4], &closest_approach_from);
  return answer;
}

py::tuple state_of(const SceneResult& result) {
  return py::make_tuple(state_of_outcome(result), result.first, result.closest,
                        states_of(result.pairs), state_of(result.work));
}

SceneResult scene_result_from(const py::tuple& state) {
  SceneResult result;
  static_cast<Outcome&>(result) = outcome_from(state[0]);
  result.first = state[1].cast<std::optional<std::size_t>>();
  result.closest = state[2].cast<std::optional<std::size_t>>();
  result.pairs = all_from<PairAnswer>(state[3], &pair_answer_from);
  result.work = work_from(state[4]);
  return result;
}

void bind_query(py::module_& m) {
  watch_signals();
  bind_contact(m);
  bind_pair_results(m);
  bind_set_results(m);
  bind_helpers(m);
  bind_rules(m);
  bind_body_set(m);
  bind_pair_questions(m);  // First, as they take less time.
  bind_set_questions(m);
}

}  // namespace firstcontact::python
