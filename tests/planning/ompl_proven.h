/// @file
/// A space of OMPL with proven edges, and the second proof of its paths.

#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <utility>

#include <ompl/base/Planner.h>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <firstcontact/edges/edge_checker.h>

#include "firstcontact_ompl/proven_edges.h"

namespace firstcontact::test {

/// Fixes the seed of all of OMPL's random numbers, once, and keeps OMPL silent.
///
/// OMPL takes a seed only before its first random numbers, which the set-up of a space may draw.
inline bool seed_ompl() {
  static const bool is_done = [] {
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    ompl::RNG::setSeed(1);
    return true;
  }();
  return is_done;
}

/// A space of OMPL with proven edges.
struct Proven {
  explicit Proven(PlanScene scene)
      : is_seeded(seed_ompl()),
        edges(std::make_shared<EdgeChecker>(std::move(scene))),
        space(make_ompl_space(edges->space())),
        si(std::make_shared<ompl::base::SpaceInformation>(space)),
        validator(std::make_shared<ProvenEdges>(si, edges)) {
    si->setStateValidityChecker(std::make_shared<ProvenStates>(si, edges));
    si->setMotionValidator(validator);
    si->setup();
  }

  ompl::base::State* state(const Configuration& q) const {
    ompl::base::State* made = si->allocState();
    OmplStates(*space, edges->space()).write(q, made);
    return made;
  }

  bool is_seeded = false;  // First: before anything of OMPL is made.
  std::shared_ptr<EdgeChecker> edges;
  ompl::base::StateSpacePtr space;
  ompl::base::SpaceInformationPtr si;
  std::shared_ptr<ProvenEdges> validator;
};

/// Finds the first edge of a path that a new checker does not prove; none where all are proven.
///
/// Pieces of proven edges keep the margin, whatever splits them: so nothing is added to it.
inline std::optional<std::size_t> unproven_edge(const Proven& proven,
                                                const ompl::geometric::PathGeometric& path) {
  const EdgeChecker strict(proven.edges->scene(), {.tolerance = 1e-10, .extra_clearance = 0.0});
  const OmplStates states(*proven.space, proven.edges->space());
  for (unsigned int k = 0; k + 1 < path.getStateCount(); ++k) {
    const Configuration from = states.read(path.getState(k));
    const Configuration to = states.read(path.getState(k + 1));
    if (strict.check(from, to).verdict != EdgeVerdict::free) {
      return k;
    }
  }
  return std::nullopt;
}

/// The problem from one configuration to another.
inline ompl::base::ProblemDefinitionPtr problem_between(const Proven& proven,
                                                        const Configuration& start,
                                                        const Configuration& goal,
                                                        double threshold = 1e-6) {
  auto problem = std::make_shared<ompl::base::ProblemDefinition>(proven.si);
  ompl::base::ScopedState<> from(proven.space);
  ompl::base::ScopedState<> to(proven.space);
  const OmplStates states(*proven.space, proven.edges->space());
  states.write(start, from.get());
  states.write(goal, to.get());
  problem->setStartAndGoalStates(from, to, threshold);
  return problem;
}

/// Lets a planner look for a path to the goal; null where it finds none in 30 s.
inline std::shared_ptr<ompl::geometric::PathGeometric> solve(
    ompl::base::Planner& planner, const ompl::base::ProblemDefinitionPtr& problem) {
  planner.setProblemDefinition(problem);
  planner.setup();
  const ompl::base::PlannerTerminationCondition found([&] { return problem->hasExactSolution(); });
  planner.solve(ompl::base::plannerOrTerminationCondition(
      found, ompl::base::timedPlannerTerminationCondition(30.0)));
  return problem->hasExactSolution()
             ? std::dynamic_pointer_cast<ompl::geometric::PathGeometric>(problem->getSolutionPath())
             : nullptr;
}

}  // namespace firstcontact::test
