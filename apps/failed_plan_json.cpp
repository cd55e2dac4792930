#include "failed_plan_json.h"

#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include <firstcontact/planning/plan_path.h>
#include <firstcontact/planning/plan_scene.h>

namespace firstcontact::app {

std::string failed_plan_json(const ScenePlan& scene, const PlanResult& result) {
  using Json = nlohmann::ordered_json;
  const PlanStatistics& counts = result.statistics;
  Json blocked = Json::array();
  for (const NamedBlockingPair& blocking : blocked_by_name(scene, counts)) {
    blocked.push_back({{"pair", blocking.pair}, {"count", blocking.count}});
  }
  const Json object{{"firstcontact_plan", 1},
                    {"verdict", "none"},
                    {"blocked", std::move(blocked)},
                    {"statistics",
                     {{"seconds", counts.seconds},
                      {"nodes", counts.nodes},
                      {"edges_checked", counts.edges_checked},
                      {"states_checked", counts.states_checked},
                      {"undecided", counts.undecided}}}};
  return object.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace firstcontact::app
