#include "pickled_robots.h"

#include <cstdint>
#include <optional>
#include <utility>

#include <pybind11/stl.h>

#include "query.h"
#include "words.h"

namespace firstcontact::python {

namespace py = pybind11;

namespace {

py::tuple state_of(const RobotContact& contact) {
  return py::make_tuple(contact.members, contact.geometries, python::state_of(contact.contact));
}

RobotContact robot_contact_from(const py::tuple& state) {
  return {.members = state[0].cast<BodyPair>(),
          .geometries = state[1].cast<std::array<std::size_t, 2>>(),
          .contact = contact_from(state[2])};
}

py::tuple state_of(const ContactInterval& interval) {
  return py::make_tuple(interval.enter, interval.leave, interval.reason);
}

ContactInterval interval_from(const py::tuple& state) {
  return {.enter = state[0].cast<double>(),
          .leave = state[1].cast<double>(),
          .reason = state[2].cast<UndecidedReason>()};
}

py::object state_of(const std::optional<LeastClearance>& least) {
  return least ? py::object(py::make_tuple(
                     least->lower_bound, least->distance, least->t, least->reason,
                     least->closest ? py::object(python::state_of(*least->closest)) : py::none()))
               : py::none();
}

std::optional<LeastClearance> least_clearance_from(const py::object& value) {
  if (value.is_none()) {
    return std::nullopt;
  }
  const py::tuple state = value;
  return LeastClearance{
      .lower_bound = state[0].cast<double>(),
      .distance = state[1].cast<double>(),
      .t = state[2].cast<double>(),
      .reason = state[3].cast<UndecidedReason>(),
      .closest = state[4].is_none() ? std::optional<Contact>() : contact_from(state[4])};
}

template <typename T>
py::tuple states_of(const std::vector<T>& values, py::tuple (*state)(const T&)) {
  py::tuple states(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    states[k] = state(values[k]);
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

py::tuple state_of(const RobotPairAnswer& pair) {
  return py::make_tuple(pair.members, pair.threshold, pair.verdict, pair.reason, pair.t,
                        pair.t_upper, pair.tolerance_used, pair.enclosure_error,
                        states_of(pair.contacts, &state_of), states_of(pair.intervals, &state_of),
                        state_of(pair.least_clearance), pair.steps,
                        python::state_of(pair.contact_count));
}

RobotPairAnswer robot_pair_from(const py::tuple& state) {
  return {.members = state[0].cast<BodyPair>(),
          .threshold = state[1].cast<double>(),
          .verdict = state[2].cast<Verdict>(),
          .reason = state[3].cast<UndecidedReason>(),
          .t = state[4].cast<double>(),
          .t_upper = state[5].cast<std::optional<double>>(),
          .tolerance_used = state[6].cast<double>(),
          .enclosure_error = state[7].cast<double>(),
          .contacts = all_from(state[8], &robot_contact_from),
          .contact_count = contact_count_from(state[12]),
          .intervals = all_from(state[9], &interval_from),
          .least_clearance = least_clearance_from(state[10]),
          .steps = state[11].cast<std::uint64_t>()};
}

}  // namespace

py::tuple state_of(const RobotCheckResult& result) {
  return py::make_tuple(outcome_of(result), result.first, result.closest,
                        states_of<RobotPairAnswer>(result.pairs, &state_of), result.steps);
}

RobotCheckResult robot_check_result_from(const py::tuple& state) {
  auto result = with_outcome<RobotCheckResult>(state[0]);
  result.first = state[1].cast<std::optional<std::size_t>>();
  result.closest = state[2].cast<std::optional<std::size_t>>();
  result.pairs = all_from(state[3], &robot_pair_from);
  result.steps = state[4].cast<std::uint64_t>();
  return result;
}

}  // namespace firstcontact::python
