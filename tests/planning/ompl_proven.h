/// @file
/// A space of OMPL with proven edges, and the second proof of its paths.

#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <utility>

#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateSpace.h>
#include <ompl/geometric/PathGeometric.h>

#include <firstcontact/edges/edge_checker.h>

#include "firstcontact_ompl/proven_edges.h"

namespace firstcontact::test {

/// A space of OMPL with proven edges.
struct Proven {
  explicit Proven(PlanScene scene)
      : edges(std::make_shared<EdgeChecker>(std::move(scene))),
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

}  // namespace firstcontact::test
