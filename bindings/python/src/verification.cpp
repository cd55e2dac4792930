#include <firstcontact/scene/links_as_bodies.h>
#include <firstcontact/verification/verify_run.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <optional>
#include <utility>

#include <pybind11/stl/filesystem.h>

#include <firstcontact/record/read_run.h>

#include "bindings.h"
#include "errors.h"
#include "interrupts.h"
#include "query.h"
#include "reports.h"
#include "words.h"

namespace firstcontact::python {

namespace py = pybind11;

namespace {

/// What was proven, and of what.
struct Verified {
  RunHeader header;
  RunVerification found;
  bool is_cut_off = false;
};

Verified verify_file(const std::filesystem::path& path, const VerifyRunOptions& options) {
  std::ifstream stream(path, std::ios::binary);
  RunReader run(stream, path.string());
  RunVerification found = verify_run(
      run.header(), [&] { return run.next(); }, options);
  return {run.header(), std::move(found), run.is_cut_off()};
}

/// A class of firstcontact/_tuples.py.
py::object tuple_type(const char* name) {
  return py::module_::import("firstcontact._tuples").attr(name);
}

py::object to_tuple(const RunHeader& header, const std::optional<RunMoment>& moment) {
  if (!moment) {
    return py::none();
  }
  const auto& [A, B] = moment->bodies;
  const std::vector<std::string> names = names_with_links(header.scene);
  return tuple_type("RunMoment")(moment->step, moment->time,
                                 py::make_tuple(names.at(A), names.at(B)), moment->distance);
}

py::object verify(const std::filesystem::path& path, double scripted_tolerance, std::size_t work,
                  int threads, const py::object& progress, OrNone<std::stop_source> stop) {
  require_file(path);
  const Verified verified = run_query(stop, [&](QueryStop& query) {
    return verify_file(path, {.scripted_tolerance = scripted_tolerance,
                              .work = work,
                              .threads = threads,
                              .stop = query.token(),
                              .progress = progress_of(progress, query)});
  });
  const RunVerification& found = verified.found;
  return tuple_type("RunVerification")(
      found.verdict, found.problem, to_tuple(verified.header, found.problem_at), found.steps,
      found.time, found.time_lost, found.least_distance, to_tuple(verified.header, found.closest),
      found.greatest_jump, found.scripted_deviation, found.greatest_behind, verified.is_cut_off,
      pair_counts_tuple(found.pair_counts), py::tuple(py::cast(found.warnings)));
}

}  // namespace

void bind_verify_run(py::module_& m) {
  const VerifyRunOptions defaults;
  m.def(
      "verify_run", &verify, py::arg("path"), py::kw_only(),
      py::arg("scripted_tolerance") = defaults.scripted_tolerance, py::arg("work") = defaults.work,
      py::arg("threads") = 0, py::arg("progress") = py::none(), py::arg("stop") = py::none(),
      R"(Proves of a recorded run, with other code than the simulation's, that no free body interpenetrates.

As the tool's `firstcontact verify`. path: of the file that simulate or the tool recorded.
scripted_tolerance: [m] so far a scripted body may be from where its motion in the scene puts it at
the end of a step; within steps the contact distance is added.
work: tests of two boxes or triangles for one pair and one step. threads: at most; 0 for one on each
core; the answer does not depend on it. progress: called with the time that is proven, in s. stop:
ends it `not_proven`, with what is proven so far. Ctrl-C raises KeyboardInterrupt. ParseError where
the file is no run.)");
}

}  // namespace firstcontact::python
