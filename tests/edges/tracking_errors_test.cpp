// Edges with tracking errors: what is free stays free, piece by piece.

#include <gtest/gtest.h>

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/geometry/primitives.h>

#include "planning/plan_cases.h"
#include "robot/planar_arm.h"
#include "support/random.h"
#include "support/rounds.h"

namespace firstcontact::test {
namespace {

/// An arm of three bars beside a ball, each of whose joints errs.
PlanScene erring_arm(double error) {
  const RobotMotion rest =
      planar_motion(std::vector<CoordinatePath>(3, CoordinatePath::constant(0.0)));
  RobotScene scene;
  scene.add_body("ball", make_sphere(0.2), resting_at({1.9, 0.3, 0.0}));
  const std::size_t arm = scene.add_robot("arm", rest);
  const std::vector<std::string> names = {"j0", "j1", "j2"};
  for (const std::string& name : names) {
    scene.set_tracking_error(arm, name, {.angle = error});
  }
  return {.scene = std::move(scene),
          .robots = {arm},
          .space = ConfigurationSpace::of_joints(rest.model(), names, detail::given_motions(rest))};
}

/// An edge that passes the ball as near as a checker takes for free, to 1e-12 rad.
std::optional<std::pair<Configuration, Configuration>> nearest_free(const EdgeChecker& checker,
                                                                    Configuration from,
                                                                    Configuration to) {
  const auto turned = [&](double angle) {
    std::pair<Configuration, Configuration> edge = {from, to};
    edge.first[0] += angle;
    edge.second[0] += angle;
    return edge;
  };
  const auto is_free = [&](double angle) {
    const auto [begin, end] = turned(angle);
    return checker.check_quickly(begin, end).verdict == EdgeVerdict::free;
  };
  double blocked = 0.0;
  double free = 1.0;
  if (is_free(blocked) || !is_free(free)) {
    return std::nullopt;
  }
  while (free - blocked > 1e-12) {
    const double middle = 0.5 * (free + blocked);
    (is_free(middle) ? free : blocked) = middle;
  }
  return turned(free);
}

// A plan keeps the extra and two tolerances; its proof, which is about pieces of its edges, does
// not. So a piece of a free edge has to be free whatever its windows of time.
TEST(TrackingErrors, LeaveNoPieceOfAFreeEdgeBlocked) {
  const EdgeCheckOptions in_proof = {.tolerance = 1e-6, .extra_clearance = 1e-9};
  const EdgeCheckOptions in_search = {.tolerance = 1e-6, .extra_clearance = 1e-9 + 2e-6};
  Random random(3);
  int near = 0;
  for (const double error : {1e-3, 1e-2, 5e-2}) {
    const EdgeChecker search(erring_arm(error), in_search);
    const EdgeChecker proof(erring_arm(error), in_proof);
    for (int k = 0; k < rounds(150, 40); ++k) {
      const auto place = [&] {
        return Configuration{random.uniform(-0.8, 0.3), random.uniform(-1.0, 1.0),
                             random.uniform(-1.0, 1.0)};
      };
      const auto edge = nearest_free(search, place(), place());
      if (!edge) {
        continue;
      }
      ++near;
      const auto& [from, to] = *edge;
      double a = 0.0;
      for (const double b : {0.1, random.uniform(0.11, 0.6), random.uniform(0.61, 0.98), 1.0}) {
        const Configuration begin = search.space().interpolate(from, to, a);
        const Configuration end = b == 1.0 ? to : search.space().interpolate(from, to, b);
        EXPECT_EQ(proof.check(begin, end).verdict, EdgeVerdict::free) << error << ' ' << k;
        EXPECT_EQ(proof.check_closely(begin, end).verdict, EdgeVerdict::free) << error << ' ' << k;
        EXPECT_EQ(proof.check_quickly(begin, end).verdict, EdgeVerdict::free) << error << ' ' << k;
        a = b;
      }
    }
  }
  EXPECT_GT(near, 30);
}

}  // namespace
}  // namespace firstcontact::test
