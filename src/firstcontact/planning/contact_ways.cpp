#include <firstcontact/planning/contact_ways.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include <tbb/enumerable_thread_specific.h>

#include <firstcontact/planning/detail/contact_steering.h>
#include <firstcontact/planning/detail/gap_sampler.h>
#include <firstcontact/planning/detail/plan_range.h>
#include <firstcontact/planning/detail/plan_work.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
struct ContactWays::Data {
  /// The data of one thread.
  struct Worker {
    Worker(const EdgeChecker& edges, const PlanOptions& options, double range)
        : work(edges, options, detail::PlanWork::Clock::now(),
               edges.options().deadline.value_or(detail::PlanWork::Clock::time_point::max())),
          steering(work, edges.scene(), range) {}

    detail::PlanWork work;
    detail::ContactSteering steering;
    std::optional<detail::GapSampler> gaps;  // Made at the first use.
  };

  std::shared_ptr<const EdgeChecker> edges;
  double range = 0.0;
  PlanOptions options = {};
  mutable tbb::enumerable_thread_specific<std::unique_ptr<Worker>> workers = {};

  [[nodiscard]] Worker& worker() const {
    std::unique_ptr<Worker>& mine = workers.local();
    if (!mine) {
      mine = std::make_unique<Worker>(*edges, options, range);
    }
    return *mine;
  }

  [[nodiscard]] bool is_free(const Configuration& from, const Configuration& to) const {
    return edges->check_quickly(from, to).verdict == EdgeVerdict::free;
  }

  /// Adds places to a way up to the first whose edge is not free; returns whether all were added.
  ///
  /// Some are rounded places of a longer edge that was proven.
  [[nodiscard]] bool append(const std::vector<Configuration>& places, ProvenWay& way) const {
    for (const Configuration& next : places) {
      if (!is_free(way.places.back(), next)) {
        return false;
      }
      way.places.push_back(next);
    }
    return true;
  }
};

ContactWays::ContactWays(std::shared_ptr<const EdgeChecker> edges, double range)
    : data_(std::make_unique<Data>()) {
  if (!(range >= 0.0) || !std::isfinite(range)) {
    throw std::invalid_argument("ContactWays: the range must be finite and >= 0");
  }
  if (const auto joint = edges->space().unbounded(); joint && range == 0.0) {
    throw std::invalid_argument("ContactWays: joint " + detail::in_quotes(*joint) +
                                " slides without limits; give it bounds, or give a range");
  }
  data_->range = range > 0.0 ? range : detail::default_range(edges->space());
  data_->options.stop = edges->options().stop;
  data_->edges = std::move(edges);
}

ContactWays::~ContactWays() = default;
ContactWays::ContactWays(ContactWays&&) noexcept = default;
ContactWays& ContactWays::operator=(ContactWays&&) noexcept = default;

const EdgeChecker& ContactWays::edges() const { return *data_->edges; }

double ContactWays::range() const { return data_->range; }

ProvenWay ContactWays::follow(const Configuration& from, const Configuration& target) const {
  const EdgeAnswer straight = data_->edges->check(from, target);
  if (straight.verdict == EdgeVerdict::free) {
    return {{from, target}, true};
  }
  ProvenWay way{{from}, false};
  if (straight.fraction > 0.0) {
    Configuration at_contact = data_->edges->space().interpolate(
        from, target, detail::kShortOfContact * straight.fraction);
    if (data_->is_free(from, at_contact)) {
      way.places.push_back(std::move(at_contact));
    }
  }
  const detail::ContactWay slid = data_->worker().steering.slide(way.places.back(), target);
  way.reaches_target = data_->append(slid.places, way) && slid.reaches_target;
  return way;
}

ProvenWay ContactWays::passage(RandomNumbers& random) const {
  Data::Worker& worker = data_->worker();
  const ConfigurationSpace& space = data_->edges->space();
  if (!worker.gaps) {
    worker.gaps.emplace(data_->edges->scene());
  }
  const std::optional<detail::GapSampler::Place> place = worker.gaps->draw(random);
  if (!place || !space.holds(place->q) || !data_->edges->is_free(place->q)) {
    return {};
  }
  Eigen::VectorXd open = Eigen::VectorXd::Zero(6);
  open.head<3>() = data_->range * place->open;
  ProvenWay way{{place->q}, false};
  (void)data_->append(worker.steering.push(place->q, open).places, way);
  std::reverse(way.places.begin(), way.places.end());
  (void)data_->append(worker.steering.push(place->q, -open).places, way);
  return way;
}

}  // namespace firstcontact
