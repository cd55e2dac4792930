#include <firstcontact/planning/detail/plan_work.h>

#include <algorithm>

namespace firstcontact::detail {

void PlanWork::count(const EdgeAnswer& answer) {
  counts_.undecided += answer.verdict == EdgeVerdict::undecided ? 1 : 0;
  if (answer.verdict != EdgeVerdict::free && answer.pair) {
    ++blocked_[*answer.pair];
  }
}

EdgeAnswer PlanWork::check(const Configuration& from, const Configuration& to) {
  ++counts_.edges_checked;
  EdgeAnswer answer = now_->check(from, to);
  count(answer);
  return answer;
}

bool PlanWork::is_free(const Configuration& from, const Configuration& to) {
  ++counts_.edges_checked;
  const EdgeAnswer answer = now_->check_quickly(from, to);
  count(answer);
  return answer.verdict == EdgeVerdict::free;
}

bool PlanWork::is_free(const Configuration& q) {
  ++counts_.states_checked;
  const EdgeAnswer answer = now_->check_quickly(q, q);
  count(answer);
  return answer.verdict == EdgeVerdict::free;
}

bool PlanWork::is_over() const { return options_.stop.stop_requested() || Clock::now() >= end_; }

double PlanWork::seconds() const {
  return std::chrono::duration<double>(Clock::now() - begin_).count();
}

void PlanWork::report(std::size_t nodes, const std::optional<double>& cost) {
  if (options_.progress) {
    options_.progress({seconds(), nodes, cost});
  }
}

PlanStatistics PlanWork::statistics() const {
  PlanStatistics statistics = counts_;
  for (const auto& [members, count] : blocked_) {
    statistics.blocked.push_back({members, count});
  }
  std::stable_sort(statistics.blocked.begin(), statistics.blocked.end(),
                   [](const BlockingPair& x, const BlockingPair& y) { return x.count > y.count; });
  return statistics;
}

PlanWork::Clock::duration time_in_clock(double seconds) {
  return std::chrono::duration_cast<PlanWork::Clock::duration>(
      std::chrono::duration<double>(std::min(seconds, 1e9)));
}

double cost_of(const ConfigurationSpace& space, const std::vector<Configuration>& path) {
  double cost = 0.0;
  for (std::size_t k = 0; k + 1 < path.size(); ++k) {
    cost += space.distance(path[k], path[k + 1]);
  }
  return cost;
}

}  // namespace firstcontact::detail
