#include "query.h"

#include <algorithm>
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
#include <firstcontact/math/number_text.h>
#include <firstcontact/query/closest_approach.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/robot/joint_path.h>

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

/// @param deadline  [s]  from now
WorkBudget budget_of(std::optional<std::uint64_t> steps, std::size_t memory,
                     std::optional<double> deadline) {
  return {.steps = steps.value_or(kAllSteps),
          .memory = memory,
          .deadline = deadline_in(deadline),
          .stop = {}};
}

FirstContactResult ask_first_contact(const py::object& A, const py::object& B,
                                     PairWorkspace* workspace, FirstContactOptions options,
                                     const std::stop_source* stop) {
  const GivenShape a = given_shape_from(A, "A");
  const GivenShape b = given_shape_from(B, "B");
  Lease<Workspace> lease(workspace);
  return run_query(stop, [&](const QueryStop& query) {
    options.budget.stop = query.token();
    return first_contact(a.moving(), b.moving(), lease.get(), options);
  });
}

void bind_pair_questions(py::module_& m) {
  m.def(
      "first_contact",
      [](const FirstShape& A, const py::object& B, OrNone<PairWorkspace> workspace, double margin,
         double tolerance, StartContacts start_contacts, ContactState contacts, double contact_band,
         std::optional<std::uint64_t> steps, std::size_t memory, std::optional<double> deadline,
         OrNone<std::stop_source> stop) {
        return ask_first_contact(A.value, B, workspace,
                                 {.margin = margin,
                                  .tolerance = tolerance,
                                  .start_contacts = start_contacts,
                                  .contacts = contacts,
                                  .contact_band = contact_band,
                                  .budget = budget_of(steps, memory, deadline)},
                                 stop);
      },
      py::arg("A"), py::arg("B"), py::arg("workspace") = py::none(), py::kw_only(),
      py::arg("margin") = 0.0, py::arg("tolerance") = 1e-6,
      py::arg("start_contacts") = StartContacts::report,
      py::arg("contacts") = ContactState::nearest(), py::arg("contact_band") = 0.0,
      py::arg("steps") = py::none(), py::arg("memory") = kMemory, py::arg("deadline") = py::none(),
      py::arg("stop") = py::none(),
      R"(Finds the first contact of A and B during the step.

A, B: pairs (Shape, Motion), or (Shape, Pose) where one rests. margin: [m] closer than this counts
as contact. tolerance: [m] a reported contact is no farther than margin + tolerance. contact_band:
[m] reports pairs within margin + tolerance + band. contacts: the choice of listed feature pairs; a
number: at most so many, the nearest and some of every region. steps, memory [byte], deadline [s],
stop: a budget; spending it gives `undecided`, never a guess.

Safe to act on whatever the verdict: before t the shapes are farther apart than the margin.
Symmetric in A and B, and the same on every run without a deadline or a stop.
Other threads run meanwhile. Ctrl-C raises KeyboardInterrupt.)");
  m.def(
      "closest_approach",
      [](const py::object& A, const py::object& B, OrNone<PairWorkspace> workspace,
         double tolerance, std::optional<std::uint64_t> steps, std::size_t memory,
         std::optional<double> deadline, OrNone<std::stop_source> stop) {
        const GivenShape a = given_shape_from(A, "A");
        const GivenShape b = given_shape_from(B, "B");
        ClosestApproachOptions options{.tolerance = tolerance,
                                       .budget = budget_of(steps, memory, deadline)};
        Lease<Workspace> lease(workspace);
        return run_query(stop, [&](const QueryStop& query) {
          options.budget.stop = query.token();
          return closest_approach(a.moving(), b.moving(), lease.get(), options);
        });
      },
      py::arg("A"), py::arg("B"), py::arg("workspace") = py::none(), py::kw_only(),
      py::arg("tolerance") = 1e-6, py::arg("steps") = py::none(), py::arg("memory") = kMemory,
      py::arg("deadline") = py::none(), py::arg("stop") = py::none(),
      R"(Finds the least distance of A and B over the step, to the tolerance [m], with a time of it.

A, B, and the budget: as for first_contact.)");
  m.def(
      "distance",
      [](const py::object& A, const py::object& B, double t, OrNone<PairWorkspace> workspace) {
        const GivenShape a = given_shape_from(A, "A");
        const GivenShape b = given_shape_from(B, "B");
        Lease<Workspace> lease(workspace);
        return run_query(nullptr, [&](const QueryStop&) {
          return distance(a.moving(), b.moving(), t, lease.get());
        });
      },
      py::arg("A"), py::arg("B"), py::arg("t") = 0.0, py::arg("workspace") = py::none(),
      R"(Finds the distance of A(t) and B(t).

A, B: pairs (Shape, Motion), or (Shape, Pose) where one rests. t: [-] in [0, 1].)");
}

/// A question about a set of bodies, with its arguments from Python.
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

/// Defines a question about a set of bodies.
///
/// @param extra  its documentation, and arguments of its own
template <typename Question, typename... Extra>
void bind_set_question(py::module_& m, const char* name, Question question, const Extra&... extra) {
  m.def(name, question, py::arg("bodies"), py::arg("workspace") = py::none(), py::kw_only(),
        py::arg("tolerance") = 1e-6, py::arg("start_contacts") = StartContacts::report,
        py::arg("contacts") = ContactState::nearest(), py::arg("contact_band") = 0.0,
        py::arg("steps") = py::none(), py::arg("memory") = kMemory,
        py::arg("deadline") = py::none(), py::arg("threads") = 0, py::arg("progress") = py::none(),
        py::arg("stop") = py::none(), extra...);
}

ManyBodiesOptions set_options(double tolerance, StartContacts start_contacts, ContactState contacts,
                              double contact_band, std::optional<std::uint64_t> steps,
                              std::size_t memory, std::optional<double> deadline) {
  return {.pair = {.tolerance = tolerance,
                   .start_contacts = start_contacts,
                   .contacts = contacts,
                   .contact_band = contact_band,
                   .budget = budget_of(steps, memory, deadline)}};
}

void bind_set_questions(py::module_& m) {
  bind_set_question(
      m, "first_contact",
      [](HeldBodySet& bodies, OrNone<SetWorkspace> workspace, double tolerance,
         StartContacts start_contacts, ContactState contacts, double contact_band,
         std::optional<std::uint64_t> steps, std::size_t memory, std::optional<double> deadline,
         int threads, const py::object& progress, OrNone<std::stop_source> stop) {
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
and then with the time that is proven free so far. The other arguments are those for two bodies.
Margins are in the rules, and the budget holds for each pair.)");
  bind_set_question(
      m, "answer_each_pair",
      [](HeldBodySet& bodies, OrNone<SetWorkspace> workspace, double tolerance,
         StartContacts start_contacts, ContactState contacts, double contact_band,
         std::optional<std::uint64_t> steps, std::size_t memory, std::optional<double> deadline,
         int threads, const py::object& progress, OrNone<std::stop_source> stop, bool closest,
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
      R"(Answers every pair that the rules do not ignore, over the whole step, in their order.

closest: also the closest approach of each. all_contacts_in_time: also all intervals of contact of
each. progress: called with the share that is done. The other arguments are those of
first_contact.)");
}

// Sets of bodies

/// Rules of their own, or the rules of a set.
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

A pair that any rule ignores is not tested. Otherwise its own margin holds, or the greatest one of
its groups, or the general one.)")
      .def(py::init([](double margin) {
             return HeldRules{PairRules(margin), py::none()};
           }),
           py::arg("margin") = 0.0, "margin: [m] of every pair without another one; >= 0.")
      .def(
          "ignore",
          [](HeldRules& rules, const BodyPair& pair) { rules.changed().ignore(ordered(pair)); },
          py::arg("pair"), "Excludes a pair from the tests.")
      .def(
          "set_margin",
          [](HeldRules& rules, const BodyPair& pair, double margin) {
            rules.changed().set_margin(ordered(pair), margin);
          },
          py::arg("pair"), py::arg("margin"), "Sets the margin of a pair. margin: [m] >= 0.")
      .def(
          "add_group",
          [](HeldRules& rules, std::vector<std::size_t> bodies) {
            return rules.changed().add_group(std::move(bodies));
          },
          py::arg("bodies"), "Adds a group and returns its number.")
      .def(
          "ignore_groups",
          [](HeldRules& rules, std::size_t group, std::size_t other) {
            rules.changed().ignore_groups(group, other);
          },
          py::arg("group"), py::arg("other"),
          "Excludes the pairs of two groups from the tests; with one group twice, all pairs inside "
          "it.")
      .def(
          "set_group_margin",
          [](HeldRules& rules, std::size_t group, std::size_t other, double margin) {
            rules.changed().set_group_margin(group, other, margin);
          },
          py::arg("group"), py::arg("other"), py::arg("margin"),
          "Sets the margin of the pairs of two groups. margin: [m] >= 0.")
      .def(
          "margin",
          [](HeldRules& rules, const BodyPair& pair) { return rules.get().margin(ordered(pair)); },
          py::arg("pair"), "[m] The margin of a pair; None where it is not tested.");
}

void bind_body_set(py::module_& m) {
  py::class_<HeldBodySet> type(m, "BodySet",
                               R"(Moving bodies, numbered from 0, and the rules for their pairs.

Replacing one body's shape or motion costs only the work for that body. Several threads may query
one set at once; it cannot change meanwhile.)");
  type.def(py::init([](HeldRules* rules) {
             return HeldBodySet{BodySet(rules != nullptr ? rules->get() : PairRules()), {}, {}, 0};
           }),
           py::arg("rules") = py::none(), "rules: a PairRules, which is copied.")
      .def_property_readonly(
          "rules",
          [](const py::object& self) {
            (void)self.cast<const HeldBodySet&>();  // refuses an object that holds nothing
            return HeldRules{PairRules(), self};
          },
          "The rules of this set; they may be changed.")
      .def(
          "add",
          [](HeldBodySet& set, const py::object& shape, const py::object& X_WS) {
            const std::size_t body = set.changed().add(shape.cast<const Shape&>(),
                                                       X_WS.cast<const RecordedMotion&>().motion);
            set.shapes.push_back(shape);
            set.motions.push_back(X_WS);
            return body;
          },
          py::arg("shape"), py::arg("X_WS"), "Adds a body and returns its number.")
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
                           "Scratch memory of the queries of many bodies, used like Workspace.")
      .def(py::init<>());
  py::class_<std::stop_source>(m, "StopSource",
                               R"(Stop signal for queries: they end with what is proven so far.

A copy that was sent to another process never stops anything.)")
      .def(py::init<>())
      .def("request_stop", &std::stop_source::request_stop,
           "Requests the stop, from any thread. Returns whether it is the first request.")
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
    throw std::invalid_argument("deadline must be > 0, got " + detail::shortest(*seconds));
  }
  constexpr double kYear = 3e7;  // [s]  Longer ones are none, and would overflow the clock.
  return *seconds > kYear
             ? std::nullopt
             : std::optional(Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                std::chrono::duration<double>(*seconds)));
}

GivenShape given_shape_from(py::handle value, const char* name) {
  if (PyTuple_Check(value.ptr()) && PyTuple_GET_SIZE(value.ptr()) == 2) {
    py::detail::make_caster<Shape> shape;
    py::detail::make_caster<RecordedMotion> motion;
    py::detail::make_caster<Pose> pose;
    const py::handle moved = PyTuple_GET_ITEM(value.ptr(), 1);
    if (shape.load(PyTuple_GET_ITEM(value.ptr(), 0), false)) {
      const auto& given = py::detail::cast_op<const Shape&>(shape);
      if (motion.load(moved, false)) {
        return {&given, &py::detail::cast_op<const RecordedMotion&>(motion).motion};
      }
      if (pose.load(moved, false)) {
        auto rest =
            std::make_shared<const Motion>(Motion::fixed(py::detail::cast_op<const Pose&>(pose)));
        return {&given, rest.get(), rest};
      }
    }
  }
  throw py::type_error(std::string(name) +
                       ": expected a pair (Shape, Motion) or (Shape, Pose), got " +
                       std::string(py::repr(value)));
}

void bind_query(py::module_& m) {
  watch_signals();
  bind_query_results(m);
  bind_helpers(m);
  bind_rules(m);
  bind_body_set(m);
  bind_pair_questions(m);  // First, as they take less time.
  bind_set_questions(m);
}

}  // namespace firstcontact::python
