#include <firstcontact/planning/detail/end_check.h>

#include <firstcontact/edges/detail/blocked_place.h>
#include <firstcontact/planning/detail/contact_ends.h>
#include <firstcontact/planning/detail/plan_in_time.h>
#include <firstcontact/planning/detail/timed_edges.h>

namespace firstcontact::detail {

EndCheck::EndCheck(const PlanScene& plan, const Configuration& start, PathEnd at, double tolerance,
                   const std::stop_token& stop)
    : plan_(plan),
      options_{.tolerance = tolerance,
               .extra_clearance = PlanOptions().extra_clearance + 2.0 * tolerance,
               .stop = stop} {
  if (plan.times) {
    t_ = at == PathEnd::start ? 0.0 : plan.times->duration;
    edges_ = std::make_unique<TimedEdges>(plan, options_);
    return;
  }
  const ContactEnds contacts(plan, start, {}, options_.extra_clearance, tolerance);
  const bool opens = at == PathEnd::start && contacts.opens(at);
  options_.held = contacts.held_in_search(opens ? EdgePlace::at_start : EdgePlace::inner);
  checker_.emplace(plan, options_);
}

EndCheck::~EndCheck() = default;

bool EndCheck::is_free(const Configuration& q) {
  return checker_ ? checker_->is_free(q) : edges_->at({q, t_}).verdict == Verdict::free;
}

std::string EndCheck::describe(const Configuration& q, const std::string& what) {
  return checker_ ? describe_blocked(*checker_, q, what)
                  : describe_blocked(plan_, options_, *edges_, {q, t_}, what + at_time());
}

std::string EndCheck::describe_briefly(const Configuration& q, const std::string& what) {
  return name_blocked(plan_,
                      checker_ ? checker_->check_quickly(q, q).pair : edges_->at({q, t_}).pair,
                      what + at_time());
}

std::string EndCheck::at_time() const {
  return checker_ ? "" : t_ > 0.0 ? ", at the end of the time," : ", at the time 0,";
}

}  // namespace firstcontact::detail
