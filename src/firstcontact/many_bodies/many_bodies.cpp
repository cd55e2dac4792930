#include <firstcontact/many_bodies/many_bodies.h>

#include <algorithm>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include <tbb/enumerable_thread_specific.h>

#include <firstcontact/many_bodies/detail/broad_phase.h>
#include <firstcontact/many_bodies/detail/contact_intervals.h>
#include <firstcontact/math/number_text.h>
#include <firstcontact/parallel/detail/workers.h>
#include <firstcontact/query/detail/pair_query.h>
#include <firstcontact/query/distance.h>

namespace firstcontact {

struct ManyBodiesWorkspace::Data {
  tbb::enumerable_thread_specific<Workspace> of_thread;
  detail::BroadPhaseData broad_phase;
  std::vector<PairAnswer> answers;
};

ManyBodiesWorkspace::ManyBodiesWorkspace() : data_(std::make_unique<Data>()) {}
ManyBodiesWorkspace::~ManyBodiesWorkspace() = default;
ManyBodiesWorkspace::ManyBodiesWorkspace(ManyBodiesWorkspace&&) noexcept = default;
ManyBodiesWorkspace& ManyBodiesWorkspace::operator=(ManyBodiesWorkspace&&) noexcept = default;

namespace {

using detail::Candidate;

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

/// Combines the answers of pairs. A pair that ends the proven time hides all after it.
class FirstOfAll {
 public:
  FirstOfAll(const BodySet& bodies, const ManyBodiesOptions& options)
      : keeps_half_(options.pair.start_contacts == StartContacts::keep_half) {
    static_cast<Outcome&>(result_) = outcome_of_no_pair(options.pair.tolerance);
    for_each_tested_pair(bodies, [&](const BodyPair&, double) {
      result_.clearance = bodies.rules().least_margin();
      return false;
    });
  }

  [[nodiscard]] double horizon() const { return result_.t; }

  void take(const PairAnswer& pair) {
    const double horizon = result_.t;
    const double clearance = result_.clearance;
    result_.work += pair.work;
    merge(pair, result_);
    if (!keeps_half_) {
      result_.clearance = clearance;  // It stays the margin, whenever the pair was in contact.
    }
    if (pair.verdict == Verdict::free || pair.t > horizon) {
      return;
    }
    if (pair.t < horizon) {
      result_.pairs.clear();
    }
    result_.pairs.push_back(pair);
  }

  SceneResult result() {
    std::sort(result_.pairs.begin(), result_.pairs.end(),
              [](const PairAnswer& x, const PairAnswer& y) { return x.members < y.members; });
    result_.first = deciding_pair(result_.pairs);
    if (result_.first) {  // Pairs came in another order.
      result_.verdict = result_.pairs[*result_.first].verdict;
      result_.reason = result_.pairs[*result_.first].reason;
    }
    return std::move(result_);
  }

 private:
  bool keeps_half_;
  SceneResult result_;
};

/// Number of pairs that are searched side by side with the same horizon. It is fixed, so that
/// answers do not depend on the number of threads.
constexpr std::size_t kRound = 32;

/// Queries of pairs, several at once.
class PairQueries {
 public:
  PairQueries(const BodySet& bodies, detail::Workers& workers, ManyBodiesWorkspace::Data& data,
              const ManyBodiesOptions& options)
      : bodies_(bodies), workers_(workers), data_(data), options_(options) {}

  /// Answers some pairs, each in the window that window_of(pair) gives.
  template <class WindowOf>
  std::span<const PairAnswer> first_contacts(std::span<const Candidate> pairs,
                                             const WindowOf& window_of) {
    data_.answers.resize(std::max(data_.answers.size(), pairs.size()));
    workers_.for_each(pairs.size(), 1, [&](std::size_t k) {
      PairAnswer& answer = data_.answers[k];
      answer.members = pairs[k].bodies;
      answer.margin = pairs[k].margin;
      ask(answer, window_of(pairs[k]));
    });
    return {data_.answers.data(), pairs.size()};
  }

  /// Finds the first contact over the whole step, and the closest approach where it is wanted.
  void answer_whole_step(std::span<PairAnswer> pairs) {
    workers_.for_each(pairs.size(), 1, [&](std::size_t k) {
      ask(pairs[k], {});
      if (options_.all_contacts_in_time) {
        find_intervals(pairs[k]);
      }
      if (options_.closest) {
        find_closest(pairs[k]);
      }
    });
  }

 private:
  void find_intervals(PairAnswer& pair) {
    const MovingShape A = bodies_.moving_shape(pair.members[0]);
    const MovingShape B = bodies_.moving_shape(pair.members[1]);
    FirstContactOptions options = options_.pair;
    options.margin = pair.margin;
    options.contacts = ContactState::none;
    Workspace& workspace = data_.of_thread.local();
    const detail::ContactQueries queries{
        .first_contact =
            [&](const TimeWindow& window) {
              FirstContactResult found;
              detail::first_contact_within(A, B, window, workspace, options, found);
              return found;
            },
        .distance = [&](double t) { return distance(A, B, t, workspace).distance; }};
    detail::IntervalsFound found = detail::contact_intervals(
        pair, {.window = {}, .margin = pair.margin, .resolution = options_.time_resolution},
        queries);
    pair.intervals = detail::joined(std::move(found.intervals), options_.time_resolution);
    pair.tolerance_used = std::max(pair.tolerance_used, found.tolerance_used);
    pair.work += found.work;
  }

  void find_closest(PairAnswer& pair) {
    const ClosestApproachResult found =
        closest_approach(bodies_.moving_shape(pair.members[0]),
                         bodies_.moving_shape(pair.members[1]), data_.of_thread.local(),
                         {.tolerance = options_.pair.tolerance, .budget = options_.pair.budget});
    pair.closest = found;
    pair.clearance = std::max(pair.clearance, found.lower_bound);
    pair.work += found.work;
  }

  void ask(PairAnswer& pair, const TimeWindow& window) {
    FirstContactOptions options = options_.pair;
    options.margin = pair.margin;
    detail::first_contact_within(bodies_.moving_shape(pair.members[0]),
                                 bodies_.moving_shape(pair.members[1]), window,
                                 data_.of_thread.local(), options, pair);
  }

  const BodySet& bodies_;
  detail::Workers& workers_;
  ManyBodiesWorkspace::Data& data_;
  const ManyBodiesOptions& options_;
};

void validate(const ManyBodiesOptions& options) {
  detail::validate(options.pair);
  if (!(options.time_resolution > 0.0 && options.time_resolution <= 1.0)) {
    throw std::invalid_argument("ManyBodiesOptions::time_resolution must be in (0, 1], got " +
                                detail::shortest(options.time_resolution));
  }
}

void report(const ManyBodiesOptions& options, double done) {
  if (options.progress) {
    options.progress(done);
  }
}

}  // namespace

SceneResult first_contact(const BodySet& bodies, ManyBodiesWorkspace& workspace,
                          const ManyBodiesOptions& options) {
  validate(options);
  ManyBodiesWorkspace::Data& data = workspace.data();
  detail::Workers workers(options.threads);
  PairQueries queries(bodies, workers, data, options);
  FirstOfAll first(bodies, options);
  const auto search = [&](const TimeWindow& window, std::span<const Candidate> left) {
    while (!left.empty()) {
      const double end = std::min(window.end, first.horizon());
      const auto may_touch = [end](const Candidate& c) { return c.free_until <= end; };
      const auto round = left.first(std::min(kRound, left.size()));
      const auto due = round.first(static_cast<std::size_t>(
          std::partition_point(round.begin(), round.end(), may_touch) - round.begin()));
      if (due.empty()) {
        break;
      }
      report(options, std::min(due.front().free_until, first.horizon()));
      const auto in_window = [end](const Candidate& c) { return TimeWindow{c.free_until, end}; };
      for (const PairAnswer& answer : queries.first_contacts(due, in_window)) {
        first.take(answer);
      }
      left = left.subspan(due.size());
    }
    return first.horizon() > window.end;
  };
  detail::BroadPhase(bodies, workers, data.broad_phase).for_each_interval(search);
  return first.result();
}

std::vector<PairAnswer> answer_each_pair(const BodySet& bodies, ManyBodiesWorkspace& workspace,
                                         const ManyBodiesOptions& options) {
  validate(options);
  std::vector<PairAnswer> answers;
  for_each_tested_pair(bodies, [&](const BodyPair& pair, double margin) {
    PairAnswer& answer = answers.emplace_back();
    answer.members = pair;
    answer.margin = margin;
    return true;
  });
  detail::Workers workers(options.threads);
  PairQueries queries(bodies, workers, workspace.data(), options);
  const std::span<PairAnswer> all = answers;
  for (std::size_t begin = 0; begin < all.size(); begin += kRound) {
    report(options, static_cast<double>(begin) / static_cast<double>(all.size()));
    queries.answer_whole_step(all.subspan(begin, std::min(kRound, all.size() - begin)));
  }
  return answers;
}

}  // namespace firstcontact
