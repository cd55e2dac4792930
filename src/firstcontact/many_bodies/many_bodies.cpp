#include <firstcontact/many_bodies/many_bodies.h>

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include <tbb/enumerable_thread_specific.h>

#include <firstcontact/many_bodies/detail/broad_phase.h>
#include <firstcontact/parallel/detail/workers.h>
#include <firstcontact/query/detail/pair_query.h>

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
  FirstOfAll(const BodySet& bodies, const ManyBodiesOptions& options)
      : keeps_half_(options.pair.start_contacts == StartContacts::keep_half) {
    result_.tolerance_used = options.pair.tolerance;
    result_.clearance = std::numeric_limits<double>::infinity();
    for_each_tested_pair(bodies, [&](const BodyPair&, double) {
      result_.clearance = bodies.rules().least_margin();
      return false;
    });
  }

  [[nodiscard]] double horizon() const { return result_.t; }

  void take(const PairAnswer& pair) {
    const FirstContactResult& answer = pair.first_contact;
    add(answer.work, result_.work);
    result_.tolerance_used = std::max(result_.tolerance_used, answer.tolerance_used);
    result_.enclosure_error = std::max(result_.enclosure_error, answer.enclosure_error);
    if (keeps_half_) {
      result_.clearance = std::min(result_.clearance, answer.clearance);
    }
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
    result_.first.push_back(pair);
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
  bool keeps_half_;
  ManyBodiesResult result_;
};

/// Pairs searched side by side with the same horizon. Fixed, so that answers do not depend on the
/// number of threads.
constexpr std::size_t kRound = 32;

/// Asks pairs, several at once.
class PairQueries {
 public:
  PairQueries(const BodySet& bodies, detail::Workers& workers, ManyBodiesWorkspace::Data& data,
              const ManyBodiesOptions& options)
      : bodies_(bodies), workers_(workers), data_(data), options_(options) {}

  /// The answers of some pairs, each searched in the window that window_of(pair) gives.
  template <class WindowOf>
  std::span<const PairAnswer> first_contacts(std::span<const Candidate> pairs,
                                             const WindowOf& window_of) {
    data_.answers.resize(std::max(data_.answers.size(), pairs.size()));
    workers_.for_each(pairs.size(), 1, [&](std::size_t k) {
      PairAnswer& answer = data_.answers[k];
      answer.bodies = pairs[k].bodies;
      answer.margin = pairs[k].margin;
      ask(answer, window_of(pairs[k]));
    });
    return {data_.answers.data(), pairs.size()};
  }

  /// First contact over the whole step, and closest approach where that is asked.
  void answer_whole_step(std::span<PairAnswer> pairs) {
    workers_.for_each(pairs.size(), 1, [&](std::size_t k) {
      ask(pairs[k], {});
      if (options_.closest) {
        pairs[k].closest_approach = closest_approach(
            bodies_.moving_shape(pairs[k].bodies[0]), bodies_.moving_shape(pairs[k].bodies[1]),
            data_.of_thread.local(),
            {.tolerance = options_.pair.tolerance, .budget = options_.pair.budget});
      }
    });
  }

 private:
  void ask(PairAnswer& pair, const TimeWindow& window) {
    FirstContactOptions options = options_.pair;
    options.margin = pair.margin;
    detail::first_contact_within(bodies_.moving_shape(pair.bodies[0]),
                                 bodies_.moving_shape(pair.bodies[1]), window,
                                 data_.of_thread.local(), options, pair.first_contact);
  }

  const BodySet& bodies_;
  detail::Workers& workers_;
  ManyBodiesWorkspace::Data& data_;
  const ManyBodiesOptions& options_;
};

void report(const ManyBodiesOptions& options, double done) {
  if (options.progress) {
    options.progress(done);
  }
}

}  // namespace

ManyBodiesResult first_contact(const BodySet& bodies, ManyBodiesWorkspace& workspace,
                               const ManyBodiesOptions& options) {
  detail::validate(options.pair);
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
  detail::validate(options.pair);
  std::vector<PairAnswer> answers;
  for_each_tested_pair(bodies, [&](const BodyPair& pair, double margin) {
    answers.push_back({pair, margin, {}, {}});
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
