#include <firstcontact/articulated/detail/part_search.h>

#include <chrono>
#include <utility>

namespace firstcontact::detail {
namespace {

const Shape& shape_of(const RobotTimeline& timeline, std::size_t part) {
  return *timeline.parts()[part].shape;
}

}  // namespace

UndecidedReason spent(const WorkBudget& budget) {
  if (budget.stop.stop_requested()) {
    return UndecidedReason::cancelled;
  }
  const bool late = budget.deadline && std::chrono::steady_clock::now() >= *budget.deadline;
  return late ? UndecidedReason::deadline : UndecidedReason::none;
}

PartSearch::PartSearch(const RobotTimeline& timeline, const PartCandidate& candidate,
                       const RobotCheckOptions& options, LinkWorkspace& workspace)
    : timeline_(timeline),
      candidate_(candidate),
      options_(options),
      workspace_(workspace),
      paths_(timeline.paths(candidate.parts[0], candidate.parts[1],
                            0.5 * (candidate.window.begin + candidate.window.end))),
      X_FA_(std::vector<LinkPath>{paths_.A.X_FS}),
      X_FB_(std::vector<LinkPath>{paths_.B.X_FS}),
      A_(shape_of(timeline, candidate.parts[0])),
      B_(shape_of(timeline, candidate.parts[1])) {}

FirstContactResult PartSearch::first_contact(double t_begin, double t_end, double margin,
                                             double tolerance) {
  FirstContactOptions query;
  query.margin = margin;
  query.tolerance = tolerance;
  query.contacts = options_.contacts;
  query.budget = options_.budget;
  FirstContactResult result;
  detail::first_contact({A_, X_FA_}, {B_, X_FB_}, {t_begin, t_end}, workspace_, query, result);
  return result;
}

FirstContactResult PartSearch::first_contact(double t_begin, double t_end) {
  return first_contact(t_begin, t_end, candidate_.threshold, options_.tolerance);
}

double PartSearch::distance(double t) {
  return detail::distance({A_, X_FA_}, {B_, X_FB_}, t, workspace_).distance;
}

bool PartSearch::is_inside(double t) {
  return (A_.is_solid() || B_.is_solid()) && distance(t) == 0.0;
}

bool PartSearch::touch(double t, double tolerance_used) {
  return !(distance(t) > candidate_.threshold + tolerance_used);
}

Contact PartSearch::closest(double t) {
  return detail::distance({A_, X_FA_}, {B_, X_FB_}, t, workspace_).closest.value();
}

std::vector<RobotContact> PartSearch::in_world(const std::vector<Contact>& contacts,
                                               double t) const {
  const auto parts = timeline_.parts();
  const auto& [a, b] = candidate_.parts;
  LinkPose X_WF;
  if (paths_.frame) {
    const RobotMotion& motion = timeline_.scene().robot_motion(paths_.frame->robot);
    X_WF = motion.path(paths_.frame->link, t).pose(t);
  }
  std::vector<RobotContact> all;
  for (const Contact& contact : contacts) {
    RobotContact placed{
        {parts[a].member, parts[b].member}, {parts[a].geometry, parts[b].geometry}, contact};
    placed.contact.p_WA = X_WF.p_OL + X_WF.R_FL * contact.p_WA;
    placed.contact.p_WB = X_WF.p_OL + X_WF.R_FL * contact.p_WB;
    if (contact.n_AB_W) {
      placed.contact.n_AB_W = X_WF.R_FL * *contact.n_AB_W;
    }
    all.push_back(std::move(placed));
  }
  return all;
}

}  // namespace firstcontact::detail
