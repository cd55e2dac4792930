// Planners of OMPL that slide along contacts: their paths are proven, edge by edge, and they get
// through passages that are seldom sampled.

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/planners/est/EST.h>
#include <ompl/geometric/planners/kpiece/BKPIECE1.h>
#include <ompl/geometric/planners/kpiece/KPIECE1.h>
#include <ompl/geometric/planners/pdst/PDST.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/geometric/planners/rrt/RRT.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <firstcontact/math/random_numbers.h>

#include "firstcontact_ompl/contact_space.h"
#include "firstcontact_ompl/proven_edges.h"
#include "planning/ompl_planners.h"
#include "planning/plan_cases.h"
#include "support/narrow_passages.h"
#include "support/random.h"

namespace firstcontact::test {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

/// A space of OMPL in which motions slide.
struct Sliding {
  explicit Sliding(PlanScene scene, const ContactSpaceOptions& options = {})
      : edges(std::make_shared<EdgeChecker>(std::move(scene))),
        space(std::make_shared<ContactStateSpace>(make_ompl_space(edges->space()), edges, options)),
        si(std::make_shared<ob::SpaceInformation>(space)) {
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    si->setStateValidityChecker(std::make_shared<ProvenStates>(si, edges));
    si->setMotionValidator(std::make_shared<ContactEdges>(si));
    si->setup();
  }

  ob::ScopedState<> state(const Configuration& q) const {
    ob::ScopedState<> made(space);
    space->states().write(q, made.get());
    return made;
  }

  /// The path of a planner, simplified; none where it found none in the time.
  std::shared_ptr<og::PathGeometric> plan(const MakePlanner& make, const Configuration& start,
                                          const Configuration& goal, double seconds) const {
    auto problem = std::make_shared<ob::ProblemDefinition>(si);
    problem->setStartAndGoalStates(state(start), state(goal), 1e-6);
    const ob::PlannerPtr planner = make(si);
    planner->setProblemDefinition(problem);
    planner->setup();
    const ob::PlannerTerminationCondition found([&] { return problem->hasExactSolution(); });
    planner->solve(
        ob::plannerOrTerminationCondition(found, ob::timedPlannerTerminationCondition(seconds)));
    if (!problem->hasExactSolution()) {
      return nullptr;
    }
    auto path = std::dynamic_pointer_cast<og::PathGeometric>(problem->getSolutionPath());
    og::PathSimplifier(si).reduceVertices(*path);
    return path;
  }

  std::shared_ptr<EdgeChecker> edges;
  std::shared_ptr<ContactStateSpace> space;
  ob::SpaceInformationPtr si;
};

void expect_proven(const Sliding& sliding, og::PathGeometric& path, const std::string& name) {
  ASSERT_TRUE(sliding.space->expand(path)) << name;
  const EdgeChecker strict(sliding.edges->scene(), {.tolerance = 1e-10, .extra_clearance = 0.0});
  for (std::size_t k = 0; k + 1 < path.getStateCount(); ++k) {
    const auto place = [&](std::size_t at) {
      return sliding.space->states().read(path.getState(static_cast<unsigned int>(at)));
    };
    ASSERT_EQ(strict.check(place(k), place(k + 1)).verdict, EdgeVerdict::free)
        << name << ", edge " << k;
  }
}

TEST(OmplContacts, LetPlannersThroughANarrowPeg) {
  const NarrowPassage passage = narrow_passage("peg", 0.003);
  const Sliding sliding(passage.scene);
  ompl::RNG::setSeed(1);
  const auto path =
      sliding.plan(planner<og::RRTConnect>("").second, passage.start, passage.goal, 60.0);
  ASSERT_TRUE(path);
  expect_proven(sliding, *path, "RRTConnect");
}

TEST(OmplContacts, GiveProvenPathsOfPlannersOfAllKinds) {
  const std::vector<std::pair<std::string, MakePlanner>> planners = {
      planner<og::RRT>("RRT"),
      {"RRT with intermediate states",
       [](const ob::SpaceInformationPtr& si) { return std::make_shared<og::RRT>(si, true); }},
      planner<og::RRTConnect>("RRTConnect"),
      planner<og::RRTstar>("RRTstar"),
      planner<og::PRM>("PRM"),
      planner<og::EST>("EST"),
      planner<og::KPIECE1>("KPIECE1"),
      planner<og::BKPIECE1>("BKPIECE1"),
      planner<og::PDST>("PDST")};
  std::size_t solved = 0;
  for (const auto& [name, make] : planners) {
    ompl::RNG::setSeed(1);
    const Sliding sliding(with_gantry(thin_wall(0.15)));
    // This one gives its path at the end of its time only.
    const double seconds = name == "RRTstar" ? 1.0 : 10.0;
    const auto path = sliding.plan(make, {-1.5, 1.2, -0.7}, {1.5, 1.1, -0.9}, seconds);
    if (path) {
      ++solved;
      expect_proven(sliding, *path, name);
    }
  }
  EXPECT_GE(solved, planners.size() - 2);
}

TEST(OmplContacts, DrawWaysThroughGaps) {
  const NarrowPassage passage = narrow_passage("peg", 0.003);
  const Sliding sliding(passage.scene);
  RandomNumbers random(1);
  int found = 0;
  for (int k = 0; k < 200; ++k) {
    const std::vector<Configuration> way = sliding.space->passage(random);
    if (way.size() < 2) {
      continue;
    }
    ++found;
    og::PathGeometric path(sliding.si, sliding.state(way.front()).get(),
                           sliding.state(way.back()).get());
    expect_proven(sliding, path, "passage " + std::to_string(k));
    EXPECT_EQ(path.getStateCount(), way.size());
  }
  EXPECT_GT(found, 5);
  const Sliding robot(with_gantry(thin_wall(0.15)));
  EXPECT_TRUE(robot.space->passage(random).empty());
}

TEST(OmplContacts, LetNothingThroughAPassageThatIsTooNarrow) {
  const NarrowPassage passage = narrow_passage("peg", -0.001);
  const Sliding sliding(passage.scene);
  EXPECT_FALSE(sliding.plan(planner<og::RRTConnect>("").second, passage.start, passage.goal, 2.0));
}

TEST(OmplContacts, GiveALastValidStateThatIsReachedByAWay) {
  const Sliding sliding(with_gantry(thin_wall(0.15)));
  Random random(3);
  int blocked = 0;
  int slid = 0;
  for (int k = 0; k < 60; ++k) {
    const Configuration begin = {-1.0, random.uniform(-1, 1), random.uniform(-1, 1)};
    const Configuration end = {1.0, random.uniform(-1, 1), random.uniform(-1, 1)};
    const ob::ScopedState<> from = sliding.state(begin);
    ob::ScopedState<> to = sliding.state(end);
    const bool is_valid = sliding.si->checkMotion(from.get(), to.get());
    std::pair<ob::State*, double> nowhere(nullptr, -1.0);
    EXPECT_EQ(sliding.si->checkMotion(from.get(), to.get(), nowhere), is_valid);
    std::pair<ob::State*, double> last(to.get(), -1.0);
    ASSERT_EQ(sliding.si->checkMotion(from.get(), to.get(), last), is_valid);
    og::PathGeometric path(sliding.si, from.get(), to.get());
    expect_proven(sliding, path, "way " + std::to_string(k));
    slid += path.getStateCount() > 2 ? 1 : 0;
    if (is_valid) {
      EXPECT_EQ(last.second, -1.0);
    } else {
      ++blocked;
      EXPECT_EQ(nowhere.second, last.second);
      EXPECT_GE(last.second, 0.0);
      EXPECT_LT(last.second, 1.0);
      EXPECT_NE(sliding.space->states().read(to.get()), end);
    }
  }
  EXPECT_GT(blocked, 20);
  EXPECT_GT(slid, 20);
}

TEST(OmplContacts, PiecesOfAWayAreProven) {
  const Sliding sliding(with_gantry(thin_wall(0.15)));
  Random random(5);
  int ways = 0;
  for (int k = 0; k < 40; ++k) {
    const Configuration begin = {-1.0, random.uniform(-1, 1), random.uniform(-1, 1)};
    const std::vector<Configuration> way =
        sliding.space->way(begin, {1.0, random.uniform(-1, 1), random.uniform(-1, 1)});
    if (way.size() < 3) {
      continue;
    }
    ++ways;
    const ob::ScopedState<> from = sliding.state(begin);
    const ob::ScopedState<> to = sliding.state(way.back());
    ob::ScopedState<> between(sliding.space);
    sliding.space->interpolate(from.get(), to.get(), random.uniform(0.0, 1.0), between.get());
    og::PathGeometric path(sliding.si, from.get(), between.get());
    path.append(to.get());
    expect_proven(sliding, path, "way " + std::to_string(k));
    EXPECT_EQ(path.getStateCount(), way.size() + 1);
  }
  EXPECT_GT(ways, 10);
}

// A goal in a corner, nearer to its sides than slides keep: they lead away from there.
TEST(OmplContacts, EndWhereAGoalIsInACorner) {
  RobotScene scene;
  const auto side = [&](const char* name, const Eigen::Vector3d& place) {
    scene.add_body(name, make_box({0.6, 0.6, 0.6}), resting_at(place));
  };
  side("under", {0.0, 0.0, -0.4001});
  side("behind", {-0.4001, 0.0, 0.0});
  side("beside", {0.0, -0.4001, 0.0});
  const Sliding sliding(with_bar(std::move(scene), {0.2, 0.2, 0.2}));
  for (int seed = 1; seed <= 5; ++seed) {
    ompl::RNG::setSeed(static_cast<std::uint_fast32_t>(seed));
    const auto path = sliding.plan(planner<og::RRTConnect>("").second, {0.9, 0.9, 0.9, 1, 0, 0, 0},
                                   {0, 0, 0, 1, 0, 0, 0}, 10.0);
    ASSERT_TRUE(path) << seed;
    expect_proven(sliding, *path, "seed " + std::to_string(seed));
  }
}

/// A bar of 0.6 m that goes along y and turns about z, the short way round.
PlanScene spinner(RobotScene scene) {
  RobotDescription robot{.name = "spinner", .links = {{"base"}, {"slider"}, {"bar"}}, .joints = {}};
  robot.links[2].collision.push_back({.name = "",
                                      .X_LG = {{0.3, 0.0, 0.0}, Eigen::Quaterniond::Identity()},
                                      .source = SphereGeometry{},
                                      .shape = make_box({0.6, 0.1, 0.1})});
  Joint slide{.name = "y",
              .type = JointType::prismatic,
              .parent = "base",
              .child = "slider",
              .axis = Eigen::Vector3d::UnitY()};
  slide.limits = {.lower = -2.0, .upper = 2.0};
  robot.joints.push_back(slide);
  robot.joints.push_back({.name = "turn",
                          .type = JointType::continuous,
                          .parent = "slider",
                          .child = "bar",
                          .axis = Eigen::Vector3d::UnitZ()});
  const RobotMotion rest = at_rest(RobotModel(robot));
  const std::vector<std::string> names = {"y", "turn"};
  const std::size_t index = scene.add_robot("spinner", rest);
  return {.scene = std::move(scene),
          .robots = {index},
          .space = ConfigurationSpace::of_joints(rest.model(), names, detail::given_motions(rest))};
}

TEST(OmplContacts, SlideAcrossHalfATurn) {
  RobotScene scene;
  scene.add_body("post", make_box({0.1, 0.1, 0.5}), resting_at({-0.5, 0.05, 0.0}));
  const Sliding sliding(spinner(std::move(scene)));
  ASSERT_TRUE(sliding.edges->space().coordinates()[1].turns_short);
  int slid = 0;
  for (const double end : {-3.0, -2.9, -2.7, -2.5}) {
    for (const Configuration& begin : {Configuration{0.0, 2.6}, Configuration{0.1, 2.5}}) {
      const std::vector<Configuration> way = sliding.space->way(begin, {-0.2, end});
      const ob::ScopedState<> from = sliding.state(begin);
      const ob::ScopedState<> to = sliding.state(way.back());
      ob::ScopedState<> between(sliding.space);
      sliding.space->interpolate(from.get(), to.get(), 0.7, between.get());
      EXPECT_TRUE(sliding.space->satisfiesBounds(between.get()));
      og::PathGeometric path(sliding.si, from.get(), between.get());
      path.append(to.get());
      expect_proven(sliding, path, "to " + std::to_string(end));
      slid += way.size() > 2 && way.back()[1] < 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(slid, 0);
}

TEST(OmplContacts, RefuseHalfATurnOfABody) {
  for (const bool slides : {true, false}) {
    const Sliding sliding(with_bar(RobotScene(), {0.1, 0.2, 0.3}), {.slides = slides});
    const ob::ScopedState<> from = sliding.state({0, 0, 0, 1, 0, 0, 0});
    const ob::ScopedState<> half = sliding.state({0, 0, 0, 0, 0, 0, -1});
    EXPECT_FALSE(sliding.si->checkMotion(from.get(), half.get()));
    og::PathGeometric path(sliding.si, from.get(), half.get());
    EXPECT_FALSE(sliding.space->expand(path));
    const ob::ScopedState<> nearly = sliding.state({0, 0, 0, 1e-12, 0, 0, -1});
    EXPECT_TRUE(sliding.si->checkMotion(from.get(), nearly.get()));
  }
}

TEST(OmplContacts, AreNotProvenWhereTheyCollide) {
  const Sliding sliding(with_gantry(thin_wall(0.15)));
  const ob::ScopedState<> inside = sliding.state({0.0, 1.0, 0.0});
  EXPECT_FALSE(sliding.si->checkMotion(inside.get(), inside.get()));
  og::PathGeometric path(sliding.si, inside.get());
  EXPECT_FALSE(sliding.space->expand(path));
  path.append(inside.get());
  EXPECT_FALSE(sliding.space->expand(path));
}

TEST(OmplContacts, ForgetTheirWays) {
  const Sliding sliding(with_gantry(thin_wall(0.15)));
  const std::vector<Configuration> way = sliding.space->way({-1.0, 0.4, 0.3}, {1.0, 0.1, 0.2});
  ASSERT_GT(way.size(), 2u);
  EXPECT_EQ(sliding.space->way(way.front(), way.back()), way);
  EXPECT_EQ(sliding.space->way(way.back(), way.front()),
            std::vector<Configuration>(way.rbegin(), way.rend()));
  sliding.space->forget();
  og::PathGeometric path(sliding.si, sliding.state(way.front()).get(),
                         sliding.state(way.back()).get());
  if (sliding.space->expand(path)) {  // It may find a way once more.
    expect_proven(sliding, path, "again");
  }
}

TEST(OmplContacts, WriteWhatTheyReadToTheBit) {
  const Sliding sliding(with_bar(thin_wall(0.15), {0.1, 0.1, 0.1}));
  ob::ScopedState<> state(sliding.space);
  const ob::StateSamplerPtr sampler = sliding.space->allocStateSampler();
  ob::ScopedState<> copy(sliding.space);
  for (int k = 0; k < 100; ++k) {
    sampler->sampleUniform(state.get());
    const Configuration q = sliding.space->states().read(state.get());
    sliding.space->states().write(q, copy.get());
    EXPECT_EQ(sliding.space->states().read(copy.get()), q);
  }
}

TEST(OmplContacts, AreOfTheirOwnSpace) {
  const auto edges = std::make_shared<EdgeChecker>(with_gantry(thin_wall(0.15)));
  const auto si = std::make_shared<ob::SpaceInformation>(make_ompl_space(edges->space()));
  EXPECT_THROW(ContactEdges{si}, std::invalid_argument);
  EXPECT_THROW(ContactStateSpace(make_ompl_space(edges->space()), edges, {.range = -1.0}),
               std::invalid_argument);
  EXPECT_THROW(ContactStateSpace(std::make_shared<ob::RealVectorStateSpace>(2), edges),
               std::invalid_argument);
  const auto one = std::make_shared<ContactStateSpace>(make_ompl_space(edges->space()), edges);
  EXPECT_THROW(ContactStateSpace(one, edges), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact::test
