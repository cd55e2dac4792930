// The index of places against a scan of all of them: the same place, also where distances are
// equal.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/math/detail/nearest_index.h>
#include <firstcontact/math/random_numbers.h>
#include <firstcontact/planning/detail/plan_tree.h>
#include <firstcontact/robot/coordinate_path.h>

namespace firstcontact::test {
namespace {

/// Seven joints, of which every other one turns the short way round.
ConfigurationSpace arm_space() {
  RobotDescription robot{.name = "arm", .links = {{.name = "l0"}}, .joints = {}};
  std::vector<std::string> names;
  for (int k = 0; k < 7; ++k) {
    const std::string link = "l" + std::to_string(k + 1);
    robot.links.push_back({.name = link});
    Joint joint{.name = "j" + std::to_string(k),
                .type = k % 2 == 0 ? JointType::continuous : JointType::revolute,
                .parent = "l" + std::to_string(k),
                .child = link};
    if (k % 2 == 1) {
      joint.limits.lower = -2.0;
      joint.limits.upper = 2.5;
    }
    names.push_back(joint.name);
    robot.joints.push_back(joint);
  }
  std::map<std::string, JointMotion> held;
  for (const std::string& name : names) {
    held.emplace(name, CoordinatePath::constant(0.0));
  }
  return ConfigurationSpace::of_joints(RobotModel(robot), names, std::move(held));
}

ConfigurationSpace body_space(BodyEdges edges) {
  return ConfigurationSpace::of_body("body", make_box({0.2, 0.4, 0.6}), {-1.0, -1.0, -1.0},
                                     {1.0, 1.0, 1.0}, edges);
}

std::vector<ConfigurationSpace> spaces() {
  return {arm_space(), body_space(BodyEdges::straight), body_space(BodyEdges::screw)};
}

/// Walks that begin at earlier places, as a planner's tree grows; some places stand twice.
Configuration next_place(const ConfigurationSpace& space, const std::vector<Configuration>& places,
                         RandomNumbers& random) {
  const Configuration& from = places[random.below(places.size())];
  const std::size_t kind = random.below(8);
  if (kind == 0) {
    return from;
  }
  return kind < 3 ? space.sample(random) : space.interpolate(from, space.sample(random), 0.1);
}

std::size_t scan(const ConfigurationSpace& space, const std::vector<Configuration>& places,
                 const Configuration& q) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double distance = space.distance(places[k], q);
    if (distance < least) {
      least = distance;
      best = k;
    }
  }
  return best;
}

TEST(PlanTree, FindsTheNearestPlaceOfAScan) {
  for (const ConfigurationSpace& space : spaces()) {
    RandomNumbers random(5);
    std::vector<Configuration> places{space.sample(random)};
    detail::PlanTree tree(space);
    tree.add(places[0], detail::kNoParent);
    for (int k = 1; k < 3000; ++k) {
      places.push_back(next_place(space, places, random));
      tree.add(places.back(), 0);
      const Configuration q = next_place(space, places, random);
      ASSERT_EQ(tree.nearest(q), scan(space, places, q)) << k;
    }
  }
}

// A lattice has many equal distances.
TEST(NearestIndex, TakesTheFirstOfEqualDistances) {
  std::vector<std::array<int, 2>> points;
  detail::NearestIndex index;
  const auto distance = [](const std::array<int, 2>& a, const std::array<int, 2>& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1]);
  };
  RandomNumbers random(6);
  const auto draw = [&] {
    return std::array{static_cast<int>(random.below(12)), static_cast<int>(random.below(12))};
  };
  for (std::size_t k = 0; k < 2000; ++k) {
    points.push_back(draw());
    index.add(k, [&](std::size_t a, std::size_t b) { return distance(points[a], points[b]); });
    const std::array<int, 2> q = draw();
    const auto counts = [&](std::size_t item) { return item % 3 != 0; };
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (counts(i) && (!best || distance(points[i], q) < distance(points[*best], q))) {
        best = i;
      }
    }
    const auto to = [&](std::size_t i) { return distance(points[i], q); };
    ASSERT_EQ(index.nearest(to, counts), best);
    std::vector<std::size_t> all;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (counts(i)) {
        all.push_back(i);
      }
    }
    std::ranges::stable_sort(all, {}, to);
    all.resize(std::min<std::size_t>(all.size(), 7));
    ASSERT_EQ(index.nearest_few(7, to, counts), all);
  }
}

// Far fewer distances than a scan: else it would be a scan with more work.
TEST(NearestIndex, MeasuresFewOfManyDistances) {
  const ConfigurationSpace space = arm_space();
  RandomNumbers random(7);
  std::vector<Configuration> places{space.sample(random)};
  detail::NearestIndex index;
  std::size_t count = 0;
  std::size_t built = 0;
  for (std::size_t k = 0; k < 20000; ++k) {
    index.add(k, [&](std::size_t a, std::size_t b) {
      ++built;
      return space.distance(places[a], places[b]);
    });
    const Configuration& from = places[random.below(places.size())];
    places.push_back(space.interpolate(from, space.sample(random), 0.1));
  }
  constexpr std::size_t kQueries = 200;
  for (std::size_t k = 0; k < kQueries; ++k) {
    const Configuration q = space.sample(random);
    const auto to = [&](std::size_t item) {
      ++count;
      return space.distance(places[item], q);
    };
    EXPECT_TRUE(index.nearest(to, [](std::size_t) { return true; }).has_value());
  }
  RecordProperty("distances_a_query", std::to_string(count / kQueries));
  RecordProperty("distances_a_place", std::to_string(built / 20000));
  EXPECT_LT(count / kQueries, 4000u);
  EXPECT_LT(built / 20000, 100u);
}

}  // namespace
}  // namespace firstcontact::test
