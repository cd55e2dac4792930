#include <firstcontact/query/many_bodies.h>

#include <algorithm>
#include <limits>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/query/detail/ball_path.h>
#include <firstcontact/query/detail/box_join.h>
#include <firstcontact/query/detail/pair_query.h>

namespace firstcontact {
namespace {

using detail::BallPath;
using detail::Window;

/// A pair that may touch in an interval.
struct Candidate {
  double free_until = 0.0;  // [-]  Proven, of this pair.
  BodyPair bodies = {};
  double margin = 0.0;

  friend bool operator<(const Candidate& x, const Candidate& y) {
    return x.free_until != y.free_until ? x.free_until < y.free_until : x.bodies < y.bodies;
  }
};

}  // namespace

struct ManyBodiesWorkspace::Data {
  tbb::enumerable_thread_specific<Workspace> of_thread;
  std::vector<Eigen::AlignedBox3d> boxes;
  detail::BoxJoin join;
  std::vector<BodyPair> overlaps;
  std::vector<Candidate> candidates;
  std::vector<FirstContactResult> results;
};

ManyBodiesWorkspace::ManyBodiesWorkspace() : data_(std::make_unique<Data>()) {}
ManyBodiesWorkspace::~ManyBodiesWorkspace() = default;
ManyBodiesWorkspace::ManyBodiesWorkspace(ManyBodiesWorkspace&&) noexcept = default;
ManyBodiesWorkspace& ManyBodiesWorkspace::operator=(ManyBodiesWorkspace&&) noexcept = default;

namespace {

constexpr double kFree = std::numeric_limits<double>::infinity();

/// What both queries share: the broad phase and the parallel search of pairs.
class BroadPhase {
 public:
  BroadPhase(const BodySet& bodies, ManyBodiesWorkspace::Data& data,
             const ManyBodiesOptions& options)
      : bodies_(bodies),
        data_(data),
        options_(options),
        arena_(usable_threads(options.threads)),
        margins_(bodies.rules().greatest_margins(bodies.size())) {}

  /// Walks the step in intervals, in the order of time, until use(window) returns false; it finds
  /// the pairs that may touch in data.candidates, by the time until which they are proven free.
  template <class Use>
  void for_each_interval(const Use& use) {
    std::vector<Window> left{{0.0, 1.0}};
    while (!left.empty()) {
      const Window window = left.back();
      left.pop_back();
      if (!find_overlaps(window)) {
        const double middle = 0.5 * (window.begin + window.end);
        left.push_back({middle, window.end});
        left.push_back({window.begin, middle});
        continue;
      }
      find_candidates(window);
      if (!use(window)) {
        return;
      }
    }
  }

  /// Searches a few of the candidates, each in its window; answers are in data.results.
  template <class WindowOf>
  void search(std::size_t begin, std::size_t end, const WindowOf& window_of) {
    data_.results.resize(std::max(data_.results.size(), end - begin));
    in_parallel(end - begin, 1, [&](std::size_t k) {
      const Candidate& candidate = data_.candidates[begin + k];
      FirstContactOptions options = options_.pair;
      options.margin = candidate.margin;
      detail::first_contact_within(bodies_.moving_shape(candidate.bodies[0]),
                                   bodies_.moving_shape(candidate.bodies[1]), window_of(candidate),
                                   data_.of_thread.local(), options, data_.results[k]);
    });
  }

 private:
  static constexpr std::size_t kPairsPerBody = 8;  // More are worth the work of shorter intervals.
  static constexpr double kShortest = 0x1p-10;

  /// TBB complains about more than it may have.
  static int usable_threads(int asked) {
    const auto most = static_cast<int>(
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
    return asked > 0 ? std::min(asked, most) : most;
  }

  template <class Use>
  void in_parallel(std::size_t count, std::size_t grain, const Use& use) {
    arena_.execute([&] {
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                        [&](const tbb::blocked_range<std::size_t>& range) {
                          const FloatEnvironmentGuard guard;
                          for (std::size_t k = range.begin(); k < range.end(); ++k) {
                            use(k);
                          }
                        });
    });
  }

  [[nodiscard]] BallPath ball(std::size_t body, double more) const {
    const Shape& shape = bodies_.shape(body);
    return {bodies_.centre_path(body), shape.hierarchy().radius + shape.radius() + more};
  }

  /// Half of a pair's margin, at least, belongs to each body.
  void place_boxes(const Window& window) {
    data_.boxes.resize(bodies_.size());
    in_parallel(bodies_.size(), 64, [&](std::size_t k) {
      data_.boxes[k] = detail::swept_box(ball(k, 0.5 * margins_[k]), window);
    });
  }

  bool join(const Window& window, std::size_t most) {
    place_boxes(window);
    data_.overlaps.clear();
    return data_.join.join(data_.boxes, most, data_.overlaps);
  }

  /// False where the interval is better halved: the bodies sweep over many more others than they
  /// overlap at one time.
  bool find_overlaps(const Window& window) {
    const std::size_t usual = kPairsPerBody * bodies_.size();
    if (join(window, usual)) {
      return true;
    }
    if (window.end - window.begin <= kShortest) {
      return join(window, kUnlimited);
    }
    const double middle = 0.5 * (window.begin + window.end);
    join({middle, middle}, kUnlimited);
    const std::size_t at_one_time = data_.overlaps.size();
    return 2 * at_one_time > usual && join(window, 4 * at_one_time);
  }

  void find_candidates(const Window& window) {
    const FloatEnvironmentGuard guard;
    std::vector<Candidate>& candidates = data_.candidates;
    candidates.clear();
    for (const BodyPair& pair : data_.overlaps) {
      if (const std::optional<double> margin = bodies_.rules().margin(pair)) {
        candidates.push_back({0.0, pair, *margin});
      }
    }
    in_parallel(candidates.size(), 32, [&](std::size_t k) {
      Candidate& candidate = candidates[k];
      candidate.free_until = detail::apart_until(
          ball(candidate.bodies[0], 0.0), ball(candidate.bodies[1], 0.0), candidate.margin, window);
    });
    std::erase_if(candidates, [](const Candidate& c) { return c.free_until == kFree; });
    std::sort(candidates.begin(), candidates.end());
  }

  static constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max() / 8;

  const BodySet& bodies_;
  ManyBodiesWorkspace::Data& data_;
  const ManyBodiesOptions& options_;
  tbb::task_arena arena_;
  std::vector<double> margins_;
};

void add(const WorkCount& work, WorkCount& sum) {
  sum.node_groups += work.node_groups;
  sum.triangle_pairs += work.triangle_pairs;
  sum.steps += work.steps;
}

bool is_contact(const FirstContactResult& result) {
  return result.verdict == Verdict::contact || result.verdict == Verdict::contact_at_start;
}

/// Calls use(pair, margin) for each tested pair, in order, until it returns false.
template <class Use>
void for_each_tested_pair(const BodySet& bodies, const Use& use) {
  for (std::size_t first = 0; first < bodies.size(); ++first) {
    for (std::size_t second = first + 1; second < bodies.size(); ++second) {
      const BodyPair pair = {first, second};
      const std::optional<double> margin = bodies.rules().margin(pair);
      if (margin && !use(pair, *margin)) {
        return;
      }
    }
  }
}

/// Takes the answers of pairs together; a pair that ends what is proven hides all after it.
class FirstOfAll {
 public:
  explicit FirstOfAll(const BodySet& bodies, const ManyBodiesOptions& options) {
    result_.tolerance_used = options.pair.tolerance;
    result_.clearance = std::numeric_limits<double>::infinity();
    for_each_tested_pair(bodies, [&](const BodyPair&, double) {
      result_.clearance = options.pair.start_contacts == StartContacts::report
                              ? bodies.rules().least_margin()
                              : 0.0;
      return false;
    });
  }

  [[nodiscard]] double horizon() const { return result_.t; }

  void take(const Candidate& candidate, const FirstContactResult& answer) {
    add(answer.work, result_.work);
    result_.tolerance_used = std::max(result_.tolerance_used, answer.tolerance_used);
    if (answer.t_upper) {
      result_.t_upper = std::min(result_.t_upper.value_or(1.0), *answer.t_upper);
    }
    if (answer.verdict == Verdict::free || answer.t > result_.t) {
      return;
    }
    if (answer.t < result_.t) {
      result_.t = answer.t;
      result_.first.clear();
    }
    result_.first.push_back({candidate.bodies, candidate.margin, answer});
  }

  /// A contact holds for the set even beside an undecided pair: no pair touches before it.
  ManyBodiesResult result() {
    std::stable_sort(result_.first.begin(), result_.first.end(),
                     [](const PairAnswer& x, const PairAnswer& y) {
                       const bool contact_x = is_contact(x.first_contact);
                       const bool contact_y = is_contact(y.first_contact);
                       return contact_x != contact_y ? contact_x : x.bodies < y.bodies;
                     });
    if (!result_.first.empty()) {
      result_.verdict = result_.first.front().first_contact.verdict;
      result_.reason = result_.first.front().first_contact.reason;
    }
    return std::move(result_);
  }

 private:
  ManyBodiesResult result_;
};

void report(const ManyBodiesOptions& options, double done) {
  if (options.progress) {
    options.progress(done);
  }
}

/// Of a pair that the balls around its bodies prove free.
PairAnswer proven_free(const BodyPair& pair, double margin, const ManyBodiesOptions& options) {
  PairAnswer answer{pair, margin, {}};
  answer.first_contact.verdict = Verdict::free;
  answer.first_contact.t = 1.0;
  answer.first_contact.clearance =
      options.pair.start_contacts == StartContacts::report ? margin : 0.0;
  answer.first_contact.tolerance_used = options.pair.tolerance;
  return answer;
}

/// Pairs searched side by side with the same horizon. Fixed, so that answers do not depend on the
/// number of threads.
constexpr std::size_t kRound = 32;

}  // namespace

ManyBodiesResult first_contact(const BodySet& bodies, ManyBodiesWorkspace& workspace,
                               const ManyBodiesOptions& options) {
  detail::validate(options.pair);
  ManyBodiesWorkspace::Data& data = workspace.data();
  BroadPhase broad_phase(bodies, data, options);
  FirstOfAll first(bodies, options);
  broad_phase.for_each_interval([&](const Window& window) {
    const std::vector<Candidate>& candidates = data.candidates;
    for (std::size_t begin = 0; begin < candidates.size();) {
      const double end_of_search = std::min(window.end, first.horizon());
      std::size_t end = begin;
      while (end < candidates.size() && end < begin + kRound &&
             candidates[end].free_until <= end_of_search) {
        ++end;
      }
      if (begin == end) {
        break;
      }
      report(options, std::min(candidates[begin].free_until, first.horizon()));
      broad_phase.search(begin, end, [&](const Candidate& candidate) {
        return Window{candidate.free_until, end_of_search};
      });
      for (std::size_t k = begin; k < end; ++k) {
        first.take(candidates[k], data.results[k - begin]);
      }
      begin = end;
    }
    return first.horizon() > window.end;
  });
  return first.result();
}

std::vector<PairAnswer> first_contact_of_each_pair(const BodySet& bodies,
                                                   ManyBodiesWorkspace& workspace,
                                                   const ManyBodiesOptions& options) {
  detail::validate(options.pair);
  ManyBodiesWorkspace::Data& data = workspace.data();
  BroadPhase broad_phase(bodies, data, options);
  std::vector<Candidate>& candidates = data.candidates;
  std::vector<Candidate> close;
  broad_phase.for_each_interval([&](const Window&) {
    close.insert(close.end(), candidates.begin(), candidates.end());
    return true;
  });
  const auto by_bodies = [](const auto& x, const auto& y) { return x.bodies < y.bodies; };
  const auto same_bodies = [](const auto& x, const auto& y) { return x.bodies == y.bodies; };
  std::sort(close.begin(), close.end(), by_bodies);
  close.erase(std::unique(close.begin(), close.end(), same_bodies), close.end());
  candidates = std::move(close);

  std::vector<PairAnswer> answers;
  for_each_tested_pair(bodies, [&](const BodyPair& pair, double margin) {
    answers.push_back(proven_free(pair, margin, options));
    return true;
  });
  auto answer = answers.begin();  // Both lists are in the same order.
  for (std::size_t begin = 0; begin < candidates.size(); begin += kRound) {
    report(options, static_cast<double>(begin) / static_cast<double>(candidates.size()));
    const std::size_t end = std::min(begin + kRound, candidates.size());
    broad_phase.search(begin, end, [](const Candidate&) { return Window{}; });
    for (std::size_t k = begin; k < end; ++k) {
      answer = std::lower_bound(answer, answers.end(), candidates[k], by_bodies);
      answer->first_contact = std::move(data.results[k - begin]);
    }
  }
  return answers;
}

}  // namespace firstcontact
