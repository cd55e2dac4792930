/// @file
/// Planners of OMPL by name.

#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <ompl/base/Planner.h>
#include <ompl/base/SpaceInformation.h>

namespace firstcontact::test {

using MakePlanner = std::function<ompl::base::PlannerPtr(const ompl::base::SpaceInformationPtr&)>;

template <class Planner>
std::pair<std::string, MakePlanner> planner(const std::string& name) {
  return {name,
          [](const ompl::base::SpaceInformationPtr& si) { return std::make_shared<Planner>(si); }};
}

/// Every geometric planner of OMPL 1.5.2 that needs nothing but a space.
[[nodiscard]] std::vector<std::pair<std::string, MakePlanner>> all_planners();

}  // namespace firstcontact::test
