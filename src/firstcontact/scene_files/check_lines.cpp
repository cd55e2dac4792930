#include <firstcontact/scene_files/check_lines.h>

#include <atomic>
#include <exception>
#include <mutex>
#include <new>
#include <shared_mutex>
#include <stdexcept>
#include <utility>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_result.h>
#include <firstcontact/text/parse_error.h>

namespace firstcontact {
namespace {

/// Number of lines that each thread may be ahead of the slowest.
constexpr std::size_t kLead = 64;

class LineChecker {
 public:
  LineChecker(const std::filesystem::path& file, const CheckLinesOptions& options)
      : file_(file), options_(options) {}

  /// Answers a line; none where the stop token may have cut it short.
  ///
  /// A line may run out of memory because of the needs of others: it is tried once more, alone.
  std::optional<LineAnswer> answer(const SceneLine& line) {
    std::optional<LineAnswer> answer = answer_beside_others(line);
    if (!answer) {
      answer = answer_alone(line);
    }
    if (options_.stop.stop_requested()) {
      return std::nullopt;
    }
    return answer;
  }

 private:
  /// Answers a line beside others; none where memory ran out.
  std::optional<LineAnswer> answer_beside_others(const SceneLine& line) {
    const std::shared_lock lock(memory_);
    try {
      return find_answer(line);
    } catch (const std::bad_alloc&) {
      return std::nullopt;
    }
  }

  LineAnswer answer_alone(const SceneLine& line) {
    const std::unique_lock lock(memory_);
    forget();
    try {
      return find_answer(line);
    } catch (const std::bad_alloc&) {
      forget();
    }
    const std::string error =
        ParseError(file_.string(), line.number, "not enough memory to answer this scene").what();
    return {.line = line.number,
            .text = write_error("", file_.string(), line.number, error, UndecidedReason::memory),
            .verdict = {},
            .error = error};
  }

  /// Drops the memory of other lines, while no other thread answers one.
  void forget() {
    workspaces_.clear();
    cache_.emplace();
  }

  /// Answers a line.
  ///
  /// @throws std::bad_alloc
  LineAnswer find_answer(const SceneLine& line) {
    LineAnswer answer{.line = line.number, .text = {}, .verdict = {}, .error = {}};
    std::string id;
    try {
      Scene scene = parse_scene(line.text, file_, line.number, options_.reading);
      id = scene.id;
      check(std::move(scene), answer);
    } catch (const std::invalid_argument& error) {
      answer.error = ParseError(file_.string(), error.what()).what();
    } catch (const ParseError& error) {
      answer.error = error.what();
    }
    if (!answer.error.empty()) {
      answer.text = write_error(id, file_.string(), line.number, answer.error);
    }
    return answer;
  }

  void check(Scene scene, LineAnswer& answer) {
    if (options_.adjust) {
      options_.adjust(scene.options);
    }
    const LoadedScene loaded = load_scene(std::move(scene), *cache_);
    // Each scene has one thread; the other threads have scenes of their own.
    const SceneResult result = check_scene(loaded, workspaces_.local(),
                                           {.all_pairs = options_.all_pairs,
                                            .closest = options_.closest,
                                            .all_contacts_in_time = options_.all_contacts_in_time,
                                            .threads = 1,
                                            .stop = options_.stop,
                                            .progress = {}});
    answer.verdict = result.verdict;
    answer.text = write_result(loaded, result,
                               {.all_pairs = options_.all_pairs || options_.all_contacts_in_time,
                                .line = answer.line,
                                .sampling = {}});
  }

  const std::filesystem::path& file_;
  const CheckLinesOptions& options_;
  std::shared_mutex memory_;  // Held alone by a line that needs all of it.
  std::optional<ShapeCache> cache_ = std::make_optional<ShapeCache>();
  tbb::enumerable_thread_specific<ManyBodiesWorkspace> workspaces_;
};

/// The first exception of several threads, kept until they are done.
///
/// oneTBB's pipeline does not destroy unfinished items when one of its filters throws.
class FirstException {
 public:
  /// Calls the function; keeps what it throws.
  template <class Function>
  void guard(const Function& function) {
    try {
      function();
    } catch (...) {
      std::call_once(first_, [this] {
        exception_ = std::current_exception();
        thrown_ = true;
      });
    }
  }
  [[nodiscard]] bool thrown() const { return thrown_; }
  /// Throws the exception, after all threads are done.
  void rethrow() const {
    if (exception_) {
      std::rethrow_exception(exception_);
    }
  }

 private:
  std::once_flag first_;
  std::atomic<bool> thrown_ = false;
  std::exception_ptr exception_;
};

}  // namespace

void check_lines(const std::filesystem::path& file,
                 const std::function<std::optional<SceneLine>()>& next,
                 const std::function<void(const LineAnswer&)>& take,
                 const CheckLinesOptions& options) {
  const std::size_t threads = options.threads > 0
                                  ? options.threads
                                  : static_cast<std::size_t>(tbb::info::default_concurrency());
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, threads);
  tbb::task_arena arena(static_cast<int>(threads));
  LineChecker checker(file, options);
  bool cut_short = false;
  FirstException exception;
  const auto read = tbb::make_filter<void, SceneLine>(
      tbb::filter_mode::serial_in_order, [&](tbb::flow_control& flow) {
        std::optional<SceneLine> line;
        if (!options.stop.stop_requested() && !exception.thrown()) {
          exception.guard([&] { line = next(); });
        }
        if (!line) {
          flow.stop();
        }
        return std::move(line).value_or(SceneLine{});
      });
  const auto answer = tbb::make_filter<SceneLine, std::optional<LineAnswer>>(
      tbb::filter_mode::parallel, [&](const SceneLine& line) {
        // Isolated: a thread that waits for parts of its scene must not begin another scene, which
        // would need the same workspace.
        std::optional<LineAnswer> answered;
        tbb::this_task_arena::isolate(
            [&] { exception.guard([&] { answered = checker.answer(line); }); });
        return answered;
      });
  const auto hand_over = tbb::make_filter<std::optional<LineAnswer>, void>(
      tbb::filter_mode::serial_in_order, [&](const std::optional<LineAnswer>& answered) {
        cut_short = cut_short || !answered;
        if (!cut_short && !exception.thrown()) {
          exception.guard([&] { take(*answered); });
        }
      });
  arena.execute([&] { tbb::parallel_pipeline(kLead * threads, read & answer & hand_over); });
  exception.rethrow();
}

}  // namespace firstcontact
