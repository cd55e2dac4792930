// A long trajectory is checked side by side, left at its first contact, and answered alike.

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <tbb/global_control.h>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/robot_check/check_robots.h>

#include "robot/planar_arm.h"
#include "support/random.h"
#include "support/rounds.h"

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;

/// An arm of four bars that waves about in `segments` cubics, among balls above and below.
RobotScene waving_arm(std::size_t segments, std::uint64_t seed, double distance) {
  Random random(seed);
  std::vector<double> times;
  for (std::size_t k = 0; k <= segments; ++k) {
    times.push_back(static_cast<double>(k) / static_cast<double>(segments));
  }
  std::vector<CoordinatePath> paths;
  for (std::size_t joint = 0; joint < 4; ++joint) {
    const double phase = random.uniform(0.0, 6.0);
    std::vector<double> q;
    std::vector<double> v;
    for (const double t : times) {
      q.push_back(0.3 * std::sin(phase + 9.0 * t) + 0.2 * t);
      v.push_back(0.3 * 9.0 * std::cos(phase + 9.0 * t) + 0.2);
    }
    paths.push_back(CoordinatePath::cubic(times, q, v));
  }
  RobotScene scene(PairRules(1e-3));
  scene.add_robot("arm", planar_motion(paths));
  for (int k = 0; k < 8; ++k) {
    const double side = k % 2 == 0 ? 1.0 : -1.0;
    scene.add_body(
        "ball" + std::to_string(k), make_sphere(0.1),
        Motion::fixed({{0.5 * k, side * distance, 0.0}, Eigen::Quaterniond(1, 0, 0, 0)}));
  }
  return scene;
}

/// All numbers of an answer.
std::vector<std::uint64_t> bits(const SceneResult& result) {
  std::vector<std::uint64_t> all;
  const auto add = [&](double value) { all.push_back(std::bit_cast<std::uint64_t>(value)); };
  const auto add_vector = [&](const Vector3d& v) {
    for (int k = 0; k < 3; ++k) {
      add(v[k]);
    }
  };
  all.push_back(static_cast<std::uint64_t>(result.verdict));
  all.push_back(static_cast<std::uint64_t>(result.reason));
  for (const double value : {result.t, result.t_upper.value_or(-1.0), result.clearance,
                             result.tolerance_used, result.enclosure_error}) {
    add(value);
  }
  all.push_back(result.first.value_or(99));
  all.push_back(result.closest.value_or(99));
  for (const PairAnswer& pair : result.pairs) {
    all.insert(all.end(), {pair.members[0], pair.members[1]});
    all.push_back(static_cast<std::uint64_t>(pair.verdict));
    add(pair.margin);
    add(pair.t);
    for (const Contact& contact : pair.contacts) {
      all.insert(all.end(),
                 {contact.geometries[0], contact.feature_A.index, contact.feature_B.index});
      add_vector(contact.p_WA);
      add_vector(contact.p_WB);
      add_vector(contact.n_AB_W.value_or(Vector3d::Zero()));
      add(contact.distance);
    }
    for (const ContactInterval& interval : pair.intervals) {
      add(interval.enter);
      add(interval.leave);
    }
    if (pair.closest) {
      add(pair.closest->distance);
      add(pair.closest->lower_bound);
      add(pair.closest->t);
      if (pair.closest->closest) {
        add_vector(pair.closest->closest->p_WA);
        add_vector(pair.closest->closest->p_WB);
      }
    }
  }
  return all;
}

TEST(CheckRobotsThreads, AnswersDoNotDependOnTheirNumber) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(rounds(6, 2)); ++seed) {
    RobotScene scene = waving_arm(100, seed, 0.8);
    if (seed % 2 == 1) {
      scene.set_tracking_error(0, "j1", {.angle = 0.01});
    }
    for (const int kind : {0, 1, 2, 3}) {
      RobotCheckOptions options;
      options.all_pairs = kind == 1;
      options.all_contacts_in_time = kind == 2;
      options.closest = (kind == 2 && seed == 0) || kind == 3;
      options.time_resolution = 0.01;
      options.threads = 1;
      const std::vector<std::uint64_t> alone = bits(check_robots(scene, options));
      for (const int threads : {2, 3, 8, 0}) {
        options.threads = threads;
        ASSERT_EQ(bits(check_robots(scene, options)), alone) << seed << ' ' << kind;
      }
    }
  }
}

TEST(CheckRobotsThreads, AThousandSegmentsAreLeftAtTheFirstContact) {
  const RobotScene near_scene = waving_arm(1000, 3, 0.8);
  const RobotScene far_scene = waving_arm(1000, 3, 9.0);
  const SceneResult touching = check_robots(near_scene);
  const SceneResult free = check_robots(far_scene);
  EXPECT_EQ(free.verdict, Verdict::free);
  ASSERT_EQ(touching.verdict, Verdict::contact);
  RobotCheckOptions options;
  options.all_pairs = true;
  const SceneResult whole = check_robots(near_scene, options);
  EXPECT_EQ(whole.t, touching.t);
  EXPECT_LT(touching.work.total(), whole.work.total());
}

/// Progress rises, comes from the calling thread, and ends at 1 or at the contact.
TEST(CheckRobotsThreads, ReportsItsProgress) {
  for (const auto& [distance, all] : {std::pair(0.8, false), {0.8, true}, {9.0, false}}) {
    const RobotScene scene = waving_arm(500, 3, distance);
    RobotCheckOptions options;
    options.all_pairs = all;
    const std::thread::id caller = std::this_thread::get_id();
    double last = 0.0;
    options.progress = [&](double done) {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      EXPECT_GE(done, last);
      last = done;
    };
    const SceneResult result = check_robots(scene, options);
    EXPECT_EQ(last, all ? 1.0 : result.t);
  }
}

}  // namespace
}  // namespace firstcontact::test
