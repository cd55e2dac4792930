#include "query.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <pybind11/stl.h>

#include <firstcontact/many_bodies/scene_result.h>
#include <firstcontact/query/closest_approach.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/scene_files/write_result.h>

#include "arrays.h"
#include "words.h"

namespace firstcontact::python {

namespace py = pybind11;

namespace {

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

/// The state of a value that may be missing.
template <typename T>
py::object state_or_none(const std::optional<T>& value) {
  return value ? py::object(state_of(*value)) : py::none();
}

template <typename T>
std::optional<T> value_or_none(const py::object& state, T (*from)(const py::tuple&)) {
  return state.is_none() ? std::nullopt : std::optional(from(state));
}

/// The states of several values, in order.
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
      .def_readonly("index", &Feature::index, "Index of the vertex, the edge or the triangle.")
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
      .def_readonly("distance", &Contact::distance,
                    "[m] Distance of the points; negative: depth of thickened features.")
      .def_readonly("normal_velocity", &Contact::normal_velocity,
                    "[m per step] Velocity of B's point relative to A's along the normal; negative "
                    "when closing. In the result of a scene [m/s].")
      .def("__repr__", [](const Contact& c) {
        return "<Contact: " + describe(c.feature_A) + " and " + describe(c.feature_B) +
               ", distance " + number_text(c.distance) + " m>";
      });
  add_pickling<Contact>(contact, &python::state_of, &contact_from);

  py::class_<WorkCount> work(m, "WorkCount", "Counts of work; no part of the proof.");
  work.def_readonly("node_groups", &WorkCount::node_groups,
                    "Number of evaluations of up to 16 pairs of boxes.")
      .def_readonly("triangle_pairs", &WorkCount::triangle_pairs,
                    "Number of triangle pairs visited.")
      .def_readonly("steps", &WorkCount::steps, "Number of certified steps of triangle pairs.")
      .def("__repr__", [](const WorkCount& count) {
        return "<WorkCount: " + std::to_string(count.node_groups) + " node groups, " +
               std::to_string(count.triangle_pairs) + " triangle pairs, " +
               std::to_string(count.steps) + " steps>";
      });
  add_pickling<WorkCount>(work, &state_of, &work_from);
}

/// Defines the fields that every answer has.
template <typename T, typename... Options>
void add_outcome(py::class_<T, Options...>& type, const char* t, const char* clearance,
                 const char* tolerance_used, const char* enclosure_error) {
  refuse_as_condition(type);
  type.def_readonly("verdict", &T::verdict)
      .def_readonly("reason", &T::reason, "The reason of `undecided`.")
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
  add_outcome(
      first,
      "[-] Time before which the shapes are proven farther apart than the margin; 1 when free.",
      "[m] Proven lower bound of the distance before t.",
      "[m] Tolerance that holds in place of the one asked for; larger only if doubles need it.",
      "[m] Sum of both shapes' enclosure errors: adds to the tolerance of a contact.");
  first
      .def_property_readonly(
          "contacts", [](const Result& result) { return contact_tuple(result.contacts); },
          "The contacts at t that were asked for, sorted by features.")
      .def_property_readonly(
          "contact_count", [](const Result& result) { return result.contact_count.at_least; },
          "Number of contacts at t, those included that are not listed.")
      .def_property_readonly(
          "contact_count_is_exact",
          [](const Result& result) { return result.contact_count.is_exact; },
          "False where only the first was asked for, or counting ended early: then there may be "
          "more.")
      .def("__repr__", [](const Result& result) {
        return "<FirstContactResult: " + verdict_text(result) + ">";
      });
  add_pickling<Result>(first, &state_of, &first_contact_result_from);

  py::class_<ClosestApproach> approach(m, "ClosestApproach",
                                       "Closest approach of two shapes over the step.");
  approach
      .def_readonly("distance", &ClosestApproach::distance,
                    "[m] Distance at t; an upper bound of the least distance over the step.")
      .def_readonly("lower_bound", &ClosestApproach::lower_bound,
                    "[m] Lower bound of the distance, proven for all t in [0, 1].")
      .def_readonly("t", &ClosestApproach::t, "[-] A time where `distance` is attained.")
      .def_readonly("reason", &ClosestApproach::reason,
                    "Not `none` where the budget ended the search.")
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
      .def_readonly(
          "enclosure_error", &Closest::enclosure_error,
          "[m] Sum of both shapes' enclosure errors: the bodies may be farther apart by this.")
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
                    "[m] Distance of the closest points found; 0 when the shapes meet.")
      .def_readonly("lower_bound", &Distance::lower_bound,
                    "[m] Proven: the shapes are at least this far apart.")
      .def_readonly(
          "enclosure_error", &Distance::enclosure_error,
          "[m] Sum of both shapes' enclosure errors: the bodies may be farther apart by this.")
      .def_readonly("closest", &Distance::closest, "The closest feature pair, or None.")
      .def_readonly("work", &Distance::work)
      .def("__repr__", [](const Distance& result) {
        return "<DistanceResult: " + number_text(result.distance) + " m>";
      });
  add_pickling<Distance>(distance, &state_of, &distance_result_from);
}

void bind_set_results(py::module_& m) {
  py::class_<PairAnswer, FirstContactResult> answer(
      m, "PairAnswer",
      "Answer of one pair of bodies: its first contact, and what else was asked for.");
  answer
      .def_property_readonly(
          "members", [](const PairAnswer& a) { return py::make_tuple(a.members[0], a.members[1]); },
          "The numbers of the two bodies, the smaller first.")
      .def_readonly("margin", &PairAnswer::margin, "[m] Closer than this counts as contact.")
      .def_property_readonly(
          "intervals", [](const PairAnswer& a) { return states_of(a.intervals); },
          "Intervals of contact in order, as tuples of enter, leave and reason; with "
          "all_contacts_in_time.")
      .def_readonly("closest", &PairAnswer::closest,
                    "The ClosestApproach; None where it was not asked for.")
      .def("__repr__", [](const PairAnswer& a) {
        return "<PairAnswer of " + std::to_string(a.members[0]) + " and " +
               std::to_string(a.members[1]) + ": " + verdict_text(a) + ">";
      });
  add_pickling<PairAnswer>(answer, &python::state_of, &pair_answer_from);

  py::class_<SceneResult> result(m, "SceneResult", "The first contact of a set of bodies.");
  add_outcome(result, "[-] Time before which no pair is in contact, proven; 1 when free.",
              "[m] Proven lower bound of every pair's distance up to t; infinite where there are "
              "no pairs.",
              "[m] The greatest of the pairs that were searched.", "[m] The greatest of these.");
  result
      .def_readonly("first", &SceneResult::first,
                    "The index in pairs of the one that determines t; None when free.")
      .def_property_readonly(
          "pairs", [](const SceneResult& r) { return py::tuple(py::cast(r.pairs)); },
          "PairAnswers of the pairs that determine t, in their order; none when free.")
      .def("__repr__",
           [](const SceneResult& r) { return "<SceneResult: " + verdict_text(r) + ">"; });
  add_pickling<SceneResult>(result, &python::state_of, &scene_result_from);
}

}  // namespace

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

void bind_query_results(py::module_& m) {
  bind_contact(m);
  bind_pair_results(m);
  bind_set_results(m);
}

}  // namespace firstcontact::python
