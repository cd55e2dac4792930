/// @file
/// Problems of a robot with thin plates put into its way.

#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/math/random_numbers.h>
#include <firstcontact/planning/plan_scene.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/robot_question.h>

#include "benchmarks/planning/fcl_places.h"

namespace firstcontact::benchmarks {

struct ThinPlates {
  int count = 0;
  double thickness = 0.003;  ///< [m]
};

/// Puts plates in front of the robot where they leave the start and the goals free.
inline Scene with_plates(const Scene& scene, const ThinPlates& plates, int problem,
                         ShapeCache& cache) {
  constexpr int kTries = 100;
  Scene made = scene;
  RandomNumbers random(static_cast<std::uint64_t>(problem));
  for (int tried = 0, put = 0; put < plates.count && tried < kTries; ++tried) {
    Scene more = made;
    const Eigen::Vector3d place(random.uniform(0.2, 0.9), random.uniform(-0.6, 0.6),
                                random.uniform(0.1, 1.0));
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(random.uniform(0.1, 1.0), random.uniform(-1.0, 1.0),
                           random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0))
            .normalized();
    add_body(more, {.name = "plate " + std::to_string(put),
                    .shape = {.source = BoxShape{{0.2, 0.2, plates.thickness}}},
                    .motion = FixedMotion{{place, turn}}});
    const ScenePlan plan = make_scene_plan(more, question_of_trajectory(more), cache);
    const EdgeChecker checker(plan.plan);
    // FCL tests links at rest among bodies at rest, too. The planners leave such pairs out.
    FclPlaces places(plan);
    if (checker.is_free(plan.start) && checker.is_free(plan.goals.front()) &&
        !places.collide(plan.start) && !places.collide(plan.goals.front())) {
      made = std::move(more);
      ++put;
    }
  }
  return made;
}

}  // namespace firstcontact::benchmarks
