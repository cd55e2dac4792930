#include <cstddef>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl/filesystem.h>

#include <firstcontact/record/read_run.h>
#include <firstcontact/scene/links_as_bodies.h>
#include <firstcontact/scene/planned_path.h>
#include <firstcontact/scene_files/read_claims.h>
#include <firstcontact/scene_files/read_planned_path.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/verification/verify_path.h>
#include <firstcontact/verification/verify_result.h>
#include <firstcontact/verification/verify_run.h>

#include "bindings.h"
#include "errors.h"
#include "interrupts.h"
#include "query.h"
#include "reports.h"
#include "words.h"

namespace firstcontact::python {

namespace py = pybind11;

namespace {

/// A second proof, and its subject.
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

py::object to_tuple(const RunHeader& header, const std::optional<RunMoment>& moment) {
  if (!moment) {
    return py::none();
  }
  const auto& [A, B] = moment->bodies;
  const std::vector<std::string> names = names_with_links(header.scene);
  return tuple_type("RunMoment")(moment->step, moment->time,
                                 py::make_tuple(names.at(A), names.at(B)), moment->distance);
}

py::object prove_run(const std::filesystem::path& path, double scripted_tolerance, std::size_t work,
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

py::object to_tuple(const std::optional<ProofMoment>& moment) {
  return moment ? tuple_type("ProofMoment")(py::make_tuple(moment->pair[0], moment->pair[1]),
                                            moment->from, moment->to, moment->distance)
                : py::none();
}

/// The arguments of the second proof of a result or a path.
struct Asked {
  std::size_t work = 0;
  int threads = 0;
  const py::object& progress;
  const std::stop_source* stop = nullptr;
};

/// Calls `prove` for a claim, without the GIL.
template <class Prove>
auto proof_of(const std::string& source, const Asked& asked, const Prove& prove) {
  return run_query(asked.stop, [&](QueryStop& query) {
    try {
      return prove(VerifyResultOptions{.work = asked.work,
                                       .threads = asked.threads,
                                       .stop = query.token(),
                                       .progress = progress_of(asked.progress, query)});
    } catch (const std::invalid_argument& error) {
      throw ParseError(source, error.what());
    }
  });
}

py::object prove_result(const std::string& text, const std::string& source, bool lenient,
                        std::size_t work, int threads, const py::object& progress,
                        OrNone<std::stop_source> stop) {
  const ResultClaims claims = read_claims(text, source, 1, {.lenient = lenient});
  const ResultVerification found =
      proof_of(source, {work, threads, progress, stop},
               [&](const VerifyResultOptions& options) { return verify_result(claims, options); });
  return tuple_type("ResultVerification")(
      found.verdict, found.problem, to_tuple(found.problem_at), found.t, found.time,
      found.left_open, found.contact_distance, found.tolerance, found.contacts, found.has_digests,
      pair_counts_tuple(found.pair_counts), py::tuple(py::cast(found.warnings)));
}

py::object prove_path(const std::string& text, const std::string& source, bool lenient,
                      std::size_t work, int threads, const py::object& progress,
                      OrNone<std::stop_source> stop) {
  const PlannedPath path = parse_planned_path(text, source, {.lenient = lenient});
  const PathVerification found =
      proof_of(source, {work, threads, progress, stop},
               [&](const VerifyResultOptions& options) { return verify_path(path, options); });
  return tuple_type("PathVerification")(found.verdict, found.problem, to_tuple(found.problem_at),
                                        found.problem_edge, found.edges, found.reaches_goal,
                                        found.tested, py::tuple(py::cast(found.warnings)));
}

}  // namespace

void bind_verification(py::module_& m) {
  const VerifyRunOptions defaults;
  m.def("verify_run", &prove_run, py::arg("path"), py::kw_only(),
        py::arg("scripted_tolerance") = defaults.scripted_tolerance,
        py::arg("work") = defaults.work, py::arg("threads") = 0, py::arg("progress") = py::none(),
        py::arg("stop") = py::none(),
        R"(Proves by other code than the simulation's that no free body of a run interpenetrates.

It is the tool's `firstcontact verify`. path: of the file that simulate or the tool recorded.
scripted_tolerance: [m] the most by which a scripted body may be off its motion in the scene at the
end of a step; within steps the contact distance is added. work: tests of two boxes or triangles for
one pair and one step. threads: at most; 0 for one on each core; the answer does not depend on it.
progress: called with the proven time [s]. stop: ends the proof as `not_proven`, with what is proven
so far. Ctrl-C raises KeyboardInterrupt. ParseError where the file is no run.)");
  const VerifyResultOptions asked;
  for (const auto& [name, prove] : {std::pair("verify_result_text", &prove_result),
                                    std::pair("verify_path_text", &prove_path)}) {
    m.def(name, prove, py::arg("text"), py::arg("source"), py::kw_only(),
          py::arg("lenient") = false, py::arg("work") = asked.work, py::arg("threads") = 0,
          py::arg("progress") = py::none(), py::arg("stop") = py::none(),
          "As the function of that name in firstcontact/_verify.py, of a text.");
  }
}

}  // namespace firstcontact::python
