#include "planning/ompl_planners.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <ompl/geometric/planners/cforest/CForest.h>
#include <ompl/geometric/planners/est/BiEST.h>
#include <ompl/geometric/planners/est/EST.h>
#include <ompl/geometric/planners/est/ProjEST.h>
#include <ompl/geometric/planners/fmt/BFMT.h>
#include <ompl/geometric/planners/fmt/FMT.h>
#include <ompl/geometric/planners/informedtrees/ABITstar.h>
#include <ompl/geometric/planners/informedtrees/AITstar.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/kpiece/BKPIECE1.h>
#include <ompl/geometric/planners/kpiece/KPIECE1.h>
#include <ompl/geometric/planners/kpiece/LBKPIECE1.h>
#include <ompl/geometric/planners/pdst/PDST.h>
#include <ompl/geometric/planners/prm/LazyPRM.h>
#include <ompl/geometric/planners/prm/LazyPRMstar.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/geometric/planners/prm/PRMstar.h>
#include <ompl/geometric/planners/prm/SPARS.h>
#include <ompl/geometric/planners/prm/SPARStwo.h>
#include <ompl/geometric/planners/rlrt/BiRLRT.h>
#include <ompl/geometric/planners/rlrt/RLRT.h>
#include <ompl/geometric/planners/rrt/BiTRRT.h>
#include <ompl/geometric/planners/rrt/InformedRRTstar.h>
#include <ompl/geometric/planners/rrt/LBTRRT.h>
#include <ompl/geometric/planners/rrt/LazyLBTRRT.h>
#include <ompl/geometric/planners/rrt/LazyRRT.h>
#include <ompl/geometric/planners/rrt/RRT.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTXstatic.h>
#include <ompl/geometric/planners/rrt/RRTsharp.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/geometric/planners/rrt/SORRTstar.h>
#include <ompl/geometric/planners/rrt/TRRT.h>
#include <ompl/geometric/planners/rrt/pRRT.h>
#include <ompl/geometric/planners/sbl/SBL.h>
#include <ompl/geometric/planners/sbl/pSBL.h>
#include <ompl/geometric/planners/sst/SST.h>
#include <ompl/geometric/planners/stride/STRIDE.h>

namespace firstcontact::test {

namespace ob = ompl::base;
namespace og = ompl::geometric;

std::vector<std::pair<std::string, MakePlanner>> all_planners() {
  return {planner<og::RRT>("RRT"),
          {"RRT with intermediate states",
           [](const ob::SpaceInformationPtr& si) { return std::make_shared<og::RRT>(si, true); }},
          planner<og::RRTConnect>("RRTConnect"),
          {"RRTConnect with intermediate states",
           [](const ob::SpaceInformationPtr& si) {
             return std::make_shared<og::RRTConnect>(si, true);
           }},
          planner<og::RRTstar>("RRTstar"),
          planner<og::RRTXstatic>("RRTXstatic"),
          planner<og::RRTsharp>("RRTsharp"),
          planner<og::InformedRRTstar>("InformedRRTstar"),
          planner<og::SORRTstar>("SORRTstar"),
          planner<og::TRRT>("TRRT"),
          planner<og::BiTRRT>("BiTRRT"),
          planner<og::LBTRRT>("LBTRRT"),
          planner<og::LazyLBTRRT>("LazyLBTRRT"),
          planner<og::LazyRRT>("LazyRRT"),
          planner<og::pRRT>("pRRT"),
          planner<og::PRM>("PRM"),
          planner<og::PRMstar>("PRMstar"),
          planner<og::LazyPRM>("LazyPRM"),
          planner<og::LazyPRMstar>("LazyPRMstar"),
          planner<og::SPARS>("SPARS"),
          planner<og::SPARStwo>("SPARStwo"),
          planner<og::EST>("EST"),
          planner<og::BiEST>("BiEST"),
          planner<og::ProjEST>("ProjEST"),
          planner<og::SBL>("SBL"),
          planner<og::pSBL>("pSBL"),
          planner<og::SST>("SST"),
          planner<og::KPIECE1>("KPIECE1"),
          planner<og::BKPIECE1>("BKPIECE1"),
          planner<og::LBKPIECE1>("LBKPIECE1"),
          planner<og::STRIDE>("STRIDE"),
          planner<og::PDST>("PDST"),
          planner<og::RLRT>("RLRT"),
          planner<og::BiRLRT>("BiRLRT"),
          planner<og::FMT>("FMT"),
          planner<og::BFMT>("BFMT"),
          planner<og::BITstar>("BITstar"),
          planner<og::ABITstar>("ABITstar"),
          planner<og::AITstar>("AITstar"),
          planner<og::CForest>("CForest")};
}

}  // namespace firstcontact::test
