// The boxes and pairs from which the simulator chooses what to search: nothing may be left out.

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/geometry/detail/overlap_tree.h>
#include <firstcontact/scene/links_as_bodies.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/simulation_model/detail/move.h>
#include <firstcontact/simulation_model/detail/obstacles.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>
#include <firstcontact/simulation_model/detail/step_start.h>

#include "simulation/random_body.h"

namespace firstcontact::detail {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;
using test::random_rotation;
using test::random_vector;
using test::tetrahedron;

TEST(SweptBox, HoldsEveryCornerAtEveryTime) {
  std::mt19937 rng(1);
  for (int i = 0; i < 200; ++i) {
    const SimBody body = tetrahedron(rng);
    const Pose X_WB{random_vector(rng, 3.0), random_rotation(rng)};
    const Move move{random_vector(rng, 1.0), random_vector(rng, 0.1 * (i % 30))};
    const AlignedBox3d box = swept_box(body, X_WB, move);
    const Motion motion = motion_of(body, X_WB, move);
    for (int k = 0; k <= 50; ++k) {
      const Pose at = motion.pose(k / 50.0);
      for (const Vector3d& v : body.shape.mesh().vertices) {
        ASSERT_LE(box.exteriorDistance(at.position + at.rotation * v), 1e-13) << i << " " << k;
      }
    }
  }
}

TEST(SweptBox, IsTheBoxOfWhatRestsOrIsShifted) {
  std::mt19937 rng(2);
  const SimBody body = tetrahedron(rng);
  const Vector3d shift(1.0, -2.0, 0.5);
  const AlignedBox3d box = swept_box(body, {}, {.translation = shift});
  AlignedBox3d exact = body.box_B;
  exact.extend(AlignedBox3d(exact.min() + shift, exact.max() + shift));
  EXPECT_LE((box.min() - exact.min()).norm() + (box.max() - exact.max()).norm(), 1e-9);
}

std::vector<AlignedBox3d> random_boxes(std::mt19937& rng, int count) {
  std::vector<AlignedBox3d> boxes;
  for (int k = 0; k < count; ++k) {
    const Vector3d centre = random_vector(rng, 3.0);
    const Vector3d half = random_vector(rng, 1.0).cwiseAbs();
    boxes.emplace_back(centre - half, centre + half);
  }
  return boxes;
}

TEST(OverlapTree, FindsAllThatOverlapOrTouch) {
  std::mt19937 rng(3);
  for (int i = 0; i < 50; ++i) {
    const std::vector<AlignedBox3d> boxes = random_boxes(rng, i);
    const OverlapTree tree(boxes);
    std::vector<AlignedBox3d> asked = random_boxes(rng, 20);
    for (const AlignedBox3d& box : boxes) {
      const Vector3d corner = box.max();
      asked.emplace_back(corner, corner + Vector3d::Ones());
    }
    for (const AlignedBox3d& box : asked) {
      std::vector<std::size_t> expected;
      for (std::size_t k = 0; k < boxes.size(); ++k) {
        if (boxes[k].intersects(box)) {
          expected.push_back(k);
        }
      }
      std::vector<std::size_t> found;
      tree.for_each_overlap(box, [&](std::size_t k) { found.push_back(k); });
      std::ranges::sort(found);
      ASSERT_EQ(found, expected) << i;
    }
  }
}

std::vector<std::array<std::size_t, 2>> overlapping_among_all(
    const std::vector<AlignedBox3d>& boxes) {
  std::vector<std::array<std::size_t, 2>> pairs;
  for (std::size_t a = 0; a < boxes.size(); ++a) {
    for (std::size_t b = a + 1; b < boxes.size(); ++b) {
      if (boxes[a].intersects(boxes[b])) {
        pairs.push_back({a, b});
      }
    }
  }
  return pairs;
}

TEST(OverlappingPairs, AreAllThatOverlap) {
  std::mt19937 rng(3);
  for (int i = 0; i < 50; ++i) {
    const std::vector<AlignedBox3d> boxes = random_boxes(rng, i);
    ASSERT_EQ(overlapping_pairs(boxes), overlapping_among_all(boxes)) << i;
  }
}

// Boxes on a lattice, whose faces just touch; a few are large, many without volume.
TEST(OverlappingPairs, AreAllThatTouch) {
  std::mt19937 rng(4);
  for (const double far : {0.0, 1e6}) {
    const auto on_lattice = [&](unsigned most) { return 0.25 * static_cast<double>(rng() % most); };
    std::vector<AlignedBox3d> boxes;
    for (int k = 0; k < 700; ++k) {
      const Vector3d least(far + on_lattice(40), far + on_lattice(40), on_lattice(8));
      const unsigned most = k % 50 == 0 ? 40 : 5;
      boxes.emplace_back(least,
                         least + Vector3d(on_lattice(most), on_lattice(most), on_lattice(most)));
    }
    EXPECT_EQ(overlapping_pairs(boxes), overlapping_among_all(boxes));
  }
}

// Neither a box over part of the step nor one at its end is left out.
TEST(Obstacles, HoldScriptedBodiesOverTheWholeStep) {
  ShapeCache cache;
  const LoadedScene loaded =
      load_scene(parse_scene(R"({"firstcontact": 1, "simulation": {}, "bodies": [
      {"name": "rests", "shape": {"box": {"size": [1, 1, 1]}}, "pose": {"position": [0, 5, 0]}},
      {"name": "free", "shape": {"box": {"size": [1, 1, 1]}}, "dynamics": {}},
      {"name": "moves", "shape": {"box": {"size": [1, 1, 1]}}}]})",
                             "test.json"),
                 cache);
  const LinksAsBodies linked = links_as_bodies(loaded);
  SimulationModel model(loaded, linked);
  model.bodies[2].kind = BodyKind::scripted;
  StepStart start{.h = 1.0, .states = std::vector<RigidState>(3), .scripted = {{}, {}, {}}};
  start.states[0].X_WB.position = {0.0, 5.0, 0.0};
  start.scripted[2].translation = {10.0, 0.0, 0.0};
  const Obstacles around(model, start);
  const auto near = [&](const Vector3d& point) {
    std::vector<std::size_t> bodies;
    around.for_each_overlap(AlignedBox3d(point, point),
                            [&](std::size_t b) { bodies.push_back(b); });
    return bodies;
  };
  EXPECT_EQ(near({0.0, 0.0, 0.0}), std::vector<std::size_t>{2});
  EXPECT_EQ(near({5.0, 0.2, 0.0}), std::vector<std::size_t>{2});
  EXPECT_EQ(near({10.4, 0.0, 0.0}), std::vector<std::size_t>{2});
  EXPECT_EQ(near({0.0, 5.2, 0.0}), std::vector<std::size_t>{0});
  EXPECT_EQ(near({0.0, 2.0, 0.0}), std::vector<std::size_t>{});
}

}  // namespace
}  // namespace firstcontact::detail
