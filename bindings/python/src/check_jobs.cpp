#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <shared_mutex>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/parallel_sampling.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>

#include "arguments.h"
#include "bindings.h"
#include "errors.h"
#include "interrupts.h"
#include "query.h"
#include "robots.h"
#include "scene.h"

namespace firstcontact::python {

namespace py = pybind11;

namespace {

using SharedScene = std::shared_ptr<HeldScene>;
using SharedCache = std::shared_ptr<ShapeCache>;

/// The options of one question, in place of the scene's or in addition to them.
struct SceneQuestion {
  OtherOptions other = {};
  std::optional<double> sample_rate = {};  ///< [1/s]
  bool strict = false;                     ///< A robot beyond its joint limits is an error.
};

/// Checks one scene, whose other options are settled. Runs without the GIL.
HeldResult answer_scene(SharedScene scene, ManyBodiesWorkspace& workspace,
                        const CheckOptions& options, const SceneQuestion& question) {
  HeldResult result{.scene = std::move(scene), .answer = {}, .all_pairs = options.all_pairs};
  const LoadedScene& loaded = result.scene->loaded();
  if (question.strict) {
    require_within_limits(loaded);
  }
  result.answer = check_scene(loaded, workspace, options);
  if (question.sample_rate) {
    const auto times = times_at_rate(*question.sample_rate, loaded.scene.duration);
    result.sampling =
        report_sampling(*question.sample_rate, sample_in_parallel(loaded, times, options.stop));
  }
  return result;
}

std::shared_ptr<HeldResult> check(const SharedScene& scene,
                                  HeldWorkspace<ManyBodiesWorkspace>* workspace,
                                  CheckOptions options, const SceneQuestion& question,
                                  const py::object& progress, const std::stop_source* stop) {
  const SharedScene asked = question.other.any() ? scene->with(question.other) : scene;
  Lease<ManyBodiesWorkspace> lease(workspace);
  return run_query(stop, [&](QueryStop& query) {
    options.stop = query.token();
    options.progress = progress_of(progress, query);
    return std::make_shared<HeldResult>(answer_scene(asked, lease.get(), options, question));
  });
}

/// A scene that is not read yet.
struct SceneSource {
  std::optional<std::string> text;  // None: the content of the file.
  std::filesystem::path source;
  bool lenient = false;
};

/// Two shapes of Python; the caller keeps them alive.
struct TwoShapes {
  GivenShape A;
  GivenShape B;
};

using Job = std::variant<SharedScene, SceneSource, TwoShapes>;
using Answer = std::variant<std::exception_ptr, HeldResult, FirstContactResult>;

/// The options of every job.
struct JobOptions {
  CheckOptions check;
  SceneQuestion question;
  SharedCache shapes;
};

/// Answers jobs of any kind with the scratch memory of one thread.
class JobAnswerer {
 public:
  /// @param memory  of all threads: held alone by a job that needs all of it
  JobAnswerer(const JobOptions& options, std::shared_mutex& memory)
      : options_(options), memory_(memory) {}

  /// Answers a job. It may run out of memory because of the needs of others: it is tried once more,
  /// alone.
  Answer operator()(const Job& job) {
    {
      const std::shared_lock lock(memory_);
      try {
        return answer_any(job);
      } catch (const std::bad_alloc&) {
        many_bodies_ = {};
        two_bodies_ = {};
      } catch (...) {
        return std::current_exception();
      }
    }
    const std::unique_lock lock(memory_);
    try {
      return answer_any(job);
    } catch (...) {
      many_bodies_ = {};
      two_bodies_ = {};
      return std::current_exception();
    }
  }

 private:
  Answer answer_any(const Job& job) {
    return std::visit([this](const auto& kind) { return answer(kind); }, job);
  }

  Answer answer(const SharedScene& scene) {
    const OtherOptions& other = options_.question.other;
    return answer_scene(other.any() ? scene->with(other) : scene, many_bodies_, options_.check,
                        options_.question);
  }

  Answer answer(const SceneSource& source) {
    if (!source.text) {
      require_file(source.source);
    }
    const ReadingOptions reading{.lenient = source.lenient};
    Scene scene = source.text ? parse_scene(*source.text, source.source, 1, reading)
                              : read_scene(source.source, reading);
    return answer(std::make_shared<HeldScene>(std::move(scene), options_.shapes));
  }

  Answer answer(const TwoShapes& two) {
    FirstContactOptions options;
    const OtherOptions& other = options_.question.other;
    options.margin = other.margin.value_or(options.margin);
    options.tolerance = other.tolerance.value_or(options.tolerance);
    options.contacts = other.contacts.value_or(options.contacts);
    options.budget.deadline = deadline_in(other.deadline);
    options.budget.stop = options_.check.stop;
    return first_contact(two.A.moving(), two.B.moving(), two_bodies_, options);
  }

  const JobOptions& options_;
  std::shared_mutex& memory_;
  ManyBodiesWorkspace many_bodies_;
  Workspace two_bodies_;
};

/// @param abandoned  whether no one waits for the answers any more: the rest has none
/// @param progress   called by this thread, with the share that is done, up to 1; may be empty
std::vector<Answer> answer_all(const std::vector<Job>& jobs, const JobOptions& options,
                               std::size_t threads, const std::function<bool()>& abandoned,
                               const std::function<void(double)>& progress) {
  std::vector<Answer> answers(jobs.size());
  std::atomic<std::size_t> next = 0;
  std::atomic<std::size_t> done = 0;
  std::shared_mutex memory;
  const auto work_and_report = [&](const std::function<void(double)>& report) {
    JobAnswerer answer(options, memory);
    for (std::size_t k = next++; k < jobs.size() && !abandoned(); k = next++) {
      answers[k] = answer(jobs[k]);
      const std::size_t count = ++done;
      if (report) {
        report(static_cast<double>(count) / static_cast<double>(jobs.size()));
      }
    }
  };
  double told = 0.0;
  std::function<void(double)> report;
  if (progress) {
    report = [&](double part) {
      told = part;
      progress(part);
    };
  }
  const auto work = [&] { work_and_report({}); };
  std::vector<std::jthread> others;
  for (std::size_t k = 1; k < std::min(threads, jobs.size()); ++k) {
    others.emplace_back(work);
  }
  work_and_report(report);
  others.clear();  // Waits for them.
  if (report && told < 1.0 && done == jobs.size()) {
    report(1.0);  // Another thread answered the last job.
  }
  return answers;
}

Job job_from(py::handle value) {
  if (py::isinstance<HeldScene>(value)) {
    return value.cast<SharedScene>();
  }
  if (py::isinstance<SceneSource>(value)) {
    return value.cast<SceneSource>();
  }
  const char* const what = "a scene or two pairs (Shape, Motion)";
  if (!py::isinstance<py::sequence>(value) || py::len(value) != 2) {
    refuse_type(value, "job", what);
  }
  const auto two = argument<py::tuple>(value, "job", what);
  return TwoShapes{given_shape_from(two[0], "A"), given_shape_from(two[1], "B")};
}

/// Makes an object of Python of an answer, and drops the answer.
struct ToPython {
  py::object operator()(const std::exception_ptr& error) const { return exception_from(error); }
  py::object operator()(HeldResult& result) const {
    return py::cast(std::make_shared<HeldResult>(std::move(result)));
  }
  py::object operator()(FirstContactResult& result) const { return py::cast(std::move(result)); }
};

py::list answer_jobs(const py::iterable& given, std::size_t threads, JobOptions options,
                     const py::object& progress, const std::stop_source* stop) {
  const py::tuple kept(given);  // Keeps shapes and motions.
  std::vector<Job> jobs;
  jobs.reserve(kept.size());
  for (const py::handle job : kept) {
    jobs.push_back(job_from(job));
  }
  std::vector<Answer> answers = run_query(stop, [&](QueryStop& query) {
    options.check.stop = query.token();
    // A stopped question is answered as far as it got; after Ctrl-C there is only an exception.
    const auto abandoned = [&] {
      return query.token().stop_requested() && (stop == nullptr || !stop->stop_requested());
    };
    return answer_all(jobs, options, threads > 0 ? threads : std::thread::hardware_concurrency(),
                      abandoned, progress_of(progress, query));
  });
  py::list list(answers.size());
  for (std::size_t k = 0; k < answers.size(); ++k) {
    list[k] = std::visit(ToPython{}, answers[k]);
  }
  return list;
}

/// Defines a question about the scene that `scene_of` makes of the first arguments.
///
/// These arguments document the question, too.
template <typename Define, typename... Given, typename... Extra>
void def_check(const Define& define, SharedScene (*scene_of)(Given...), const Extra&... extra) {
  define(
      [scene_of](Given... given, OrNone<HeldWorkspace<ManyBodiesWorkspace>> workspace,
                 bool all_pairs, bool closest, bool all_contacts_in_time,
                 std::optional<double> margin, std::optional<double> tolerance,
                 std::optional<double> deadline, std::optional<ContactState> contacts,
                 std::optional<double> sample_rate, bool strict, int threads,
                 const py::object& progress, OrNone<std::stop_source> stop) {
        return check(scene_of(given...), workspace,
                     {.all_pairs = all_pairs,
                      .closest = closest,
                      .all_contacts_in_time = all_contacts_in_time,
                      .threads = threads},
                     {.other = {margin, tolerance, deadline, contacts},
                      .sample_rate = sample_rate,
                      .strict = strict},
                     progress, stop);
      },
      extra..., py::arg("workspace") = py::none(), py::kw_only(), py::arg("all_pairs") = false,
      py::arg("closest") = false, py::arg("all_contacts_in_time") = false,
      py::arg("margin") = py::none(), py::arg("tolerance") = py::none(),
      py::arg("deadline") = py::none(), py::arg("contacts") = py::none(),
      py::arg("sample_rate") = py::none(), py::arg("strict") = false, py::arg("threads") = 0,
      py::arg("progress") = py::none(), py::arg("stop") = py::none());
}

SharedScene itself(const SharedScene& scene) { return scene; }

}  // namespace

void bind_check_jobs(py::module_& m) {
  def_check([&](const auto&... extra) { m.def("check", extra...); }, &itself,
            "Checks a Scene, as firstcontact.check does.", py::arg("scene"));
  py::class_<SceneSource>(m, "SceneSource", "A scene that is not read yet.")
      .def(
          py::init([](std::optional<std::string> text, std::filesystem::path source, bool lenient) {
            return SceneSource{std::move(text), std::move(source), lenient};
          }),
          py::arg("text"), py::arg("source"), py::arg("lenient") = false)
      .def(py::pickle(
          [](const SceneSource& s) { return py::make_tuple(s.text, s.source.string(), s.lenient); },
          [](const py::tuple& state) {
            return SceneSource{state[0].cast<std::optional<std::string>>(),
                               state[1].cast<std::string>(), state[2].cast<bool>()};
          }));
  m.def(
      "answer_jobs",
      [](const py::iterable& jobs, std::size_t threads, bool all_pairs, bool closest,
         bool all_contacts_in_time, std::optional<double> margin, std::optional<double> tolerance,
         std::optional<double> deadline, std::optional<ContactState> contacts, bool strict,
         const SharedCache& shapes, const py::object& progress, OrNone<std::stop_source> stop) {
        return answer_jobs(
            jobs, threads,
            {.check = {.all_pairs = all_pairs,
                       .closest = closest,
                       .all_contacts_in_time = all_contacts_in_time,
                       .threads = 1},
             .question = {.other = {margin, tolerance, deadline, contacts}, .strict = strict},
             .shapes = shapes ? shapes : std::make_shared<ShapeCache>()},
            progress, stop);
      },
      py::arg("jobs"), py::kw_only(), py::arg("threads") = 0, py::arg("all_pairs") = false,
      py::arg("closest") = false, py::arg("all_contacts_in_time") = false,
      py::arg("margin") = py::none(), py::arg("tolerance") = py::none(),
      py::arg("deadline") = py::none(), py::arg("contacts") = py::none(), py::arg("strict") = false,
      py::arg("shapes") = py::none(), py::arg("progress") = py::none(),
      py::arg("stop") = py::none(),
      "The answers of the jobs in order; for a job that failed the exception that it raised.");
}

void bind_check_along(RobotSceneClass& type) {
  def_check([&](const auto&... extra) { type.def("check", extra...); }, &scene_along,
            R"(Finds the first contact on a trajectory: when, where, or proven never.

trajectory: a Trajectory, the path of one, or None where the robot rests. The other arguments are
those of firstcontact.check.)",
            py::arg("trajectory"));
}

}  // namespace firstcontact::python
