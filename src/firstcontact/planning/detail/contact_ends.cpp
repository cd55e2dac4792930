#include <firstcontact/planning/detail/contact_ends.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>

#include <Eigen/Core>

#include <firstcontact/edges/detail/blocked_place.h>
#include <firstcontact/edges/detail/straight_ways.h>
#include <firstcontact/query/detail/pair_query.h>
#include <firstcontact/robot_check/detail/geometry_search.h>
#include <firstcontact/robot_check/detail/pair_holds.h>
#include <firstcontact/robot_check/detail/robot_timeline.h>
#include <firstcontact/text/quantity.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

constexpr double kToleranceShare = 0.125;  // [-]  Part of the difference of distance and hold.
constexpr double kSearchTolerances = 2.0;  // [-]  Tolerances by which the hold of a search exceeds
                                           // that of the proof.

std::string names_of(const PlanScene& plan, const BodyPair& members) {
  return in_quotes(plan.name(members[0])) + " and " + in_quotes(plan.name(members[1]));
}

/// The gap of two members at a place, as far as a hold needs it.
StartGap gap_at(const PlanScene& plan, const Configuration& q, const BodyPair& members, double kept,
                double tolerance) {
  RobotScene scene = plan.scene;
  plan.set_motions(scene, q, q);
  const RobotTimeline timeline(scene);
  const auto found = std::ranges::find(timeline.pairs(), members, &TestedPair::members);
  if (found == timeline.pairs().end() || !timeline.is_tested(*found, 0)) {
    throw std::invalid_argument("contact_pairs: " + names_of(plan, members) +
                                " are not tested against each other; leave the pair out");
  }
  const auto pair = static_cast<std::size_t>(found - timeline.pairs().begin());
  RobotCheckOptions options;
  options.tolerance = tolerance;
  LinkWorkspace workspace;
  WorkCount work;
  StartGap gap;
  for (const auto& geometries : timeline.geometry_pairs(*found)) {
    const GeometryCandidate candidate{.window = timeline.piece(0),
                                      .pair = pair,
                                      .geometries = geometries,
                                      .threshold = found->margin + kept};
    GeometrySearch search(timeline, candidate, options, workspace);
    gap = nearer(gap, search.start_gap(work));
  }
  return gap;
}

bool is_apart(const StartGap& gap) { return gap.apart > 1024.0 * gap.error; }

}  // namespace

ContactEnds::ContactEnds(const PlanScene& plan, const Configuration& start,
                         const std::vector<Configuration>& goals, double kept, double tolerance) {
  for (const ContactPair& pair : plan.contact_pairs) {
    const auto contradicts = [&](const ContactPair& other) {
      const bool opens = other.policy == ContactPolicy::must_open &&
                         pair.policy == ContactPolicy::must_open && other.at != pair.at;
      return other.members == pair.members && !opens;
    };
    if (std::ranges::count_if(plan.contact_pairs, contradicts) > 1) {
      throw std::invalid_argument("contact_pairs: " + names_of(plan, pair.members) +
                                  " are named twice; expected each pair once, or must_open at both "
                                  "ends");
    }
    measure(plan, pair, pair.at == PathEnd::start ? std::vector<Configuration>{start} : goals, kept,
            tolerance);
  }
}

void ContactEnds::measure(const PlanScene& plan, const ContactPair& pair,
                          const std::vector<Configuration>& places, double kept, double tolerance) {
  double least = std::numeric_limits<double>::infinity();
  std::vector<const Configuration*> touching;
  for (const Configuration& place : places) {
    const StartGap gap = gap_at(plan, place, pair.members, kept, tolerance);
    if (is_apart(gap)) {
      least = std::min(least, gap.apart);
    } else {
      touching.push_back(&place);
    }
  }
  const std::string end = pair.at == PathEnd::start ? "the start" : "the goal";
  if (touching.size() == places.size()) {
    std::vector<HeldPair> barely;
    for (const ContactPair& one : plan.contact_pairs) {
      if (std::ranges::find(barely, one.members, &HeldPair::members) == barely.end()) {
        barely.push_back({one.members, tolerance, kToleranceShare * tolerance});
      }
    }
    const EdgeChecker checker(
        plan, {.tolerance = tolerance, .extra_clearance = kept, .held = std::move(barely)});
    throw std::invalid_argument(
        describe_pair(test_of(checker), *touching.front(), pair.members, end + " is not free") +
        "; a contact pair has to be apart, as a distance of 0 leaves nothing to hold: by " +
        quantity(tolerance, "m") + " in the configuration that was found");
  }
  if (!std::isfinite(least)) {
    warnings_.push_back("contact_pairs: " + names_of(plan, pair.members) +
                        " are not in contact at " + end + "; they keep their margin");
    return;
  }
  pairs_.push_back({pair, kept_share(pair.policy) * least,
                    kToleranceShare * (1.0 - kept_share(pair.policy)) * least});
}

bool ContactEnds::opens(PathEnd at) const {
  return std::ranges::any_of(pairs_, [&](const PlannedContact& one) {
    return one.pair.policy == ContactPolicy::must_open && one.pair.at == at;
  });
}

std::vector<HeldPair> ContactEnds::held(EdgePlace place) const {
  std::vector<HeldPair> all;
  for (const PlannedContact& one : pairs_) {
    const EdgePlace opens_at =
        one.pair.at == PathEnd::start ? EdgePlace::at_start : EdgePlace::at_goal;
    if (one.pair.policy != ContactPolicy::must_open || opens_at == place) {
      all.push_back({one.pair.members, one.distance, one.tolerance});
    }
  }
  return all;
}

std::vector<HeldPair> ContactEnds::held_in_search(EdgePlace place) const {
  std::vector<HeldPair> all = held(place);
  for (HeldPair& pair : all) {
    pair.distance += kSearchTolerances * pair.tolerance;
  }
  return all;
}

std::optional<Configuration> find_opening(const OpeningQuestion& question, RandomNumbers& random,
                                          const std::function<bool()>& is_over) {
  const ConfigurationSpace& space = question.strict.space();
  const std::vector<Eigen::VectorXd> directions = directions_at(space, question.end, random);
  double way = question.first_step;
  for (int k = 0; k < kWayDoublings; ++k, way *= 2.0) {
    for (const Eigen::VectorXd& direction : directions) {
      if (is_over()) {
        return std::nullopt;
      }
      Configuration place = behind_way(space, question.end, direction, way);
      const bool leaves = question.at == PathEnd::start;
      if (!space.defect(place) && question.strict.is_free(place) &&
          question.held.check_quickly(leaves ? question.end : place, leaves ? place : question.end)
                  .verdict == EdgeVerdict::free) {
        return place;
      }
    }
  }
  return std::nullopt;
}

}  // namespace firstcontact::detail
