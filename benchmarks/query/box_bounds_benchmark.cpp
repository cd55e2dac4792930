// Times the kernel of the search on each instruction set that this processor has: 16 pairs of
// boxes.

#include <cstddef>
#include <cstdint>
#include <string>

#include <benchmark/benchmark.h>
#include <hwy/targets.h>

#include <firstcontact/motion/constant_rate_pair.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/moving_pairs/detail/moving_pair.h>
#include <firstcontact/narrowphase/detail/box_bounds.h>

#include "benchmarks/support/normalised_mesh.h"
#include "benchmarks/support/torus_knot.h"

namespace firstcontact::benchmarks {
namespace {

using Eigen::Vector3d;

void choose(std::int64_t targets) {
  hwy::SetSupportedTargetsForTest(targets);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

/// Times the bounds of nodes of two knots that move and turn, one pair of nodes at a time or two.
///
/// The nodes differ each time; all of them are in the cache.
void bound_knots(benchmark::State& state, std::int64_t target, std::size_t at_once) {
  choose(target);
  const Hierarchy knot = build_hierarchy(normalised(torus_knot(1'000)));
  const Motion motion_A = Motion::constant_velocity({}, Vector3d::Zero(), {0.3, 0.2, 1.0});
  const Motion motion_B =
      Motion::constant_velocity({.position = {1.5, 0.2, 0.1}}, {-1.0, 0.1, 0.0}, {0.8, 0.1, -0.2});
  ConstantRatePair motion(motion_A, motion_B, knot.centre, knot.centre, 1e-6);
  motion.enter(0.0);
  const detail::MovingPair pair(knot, knot, motion);
  detail::BoxFrame frame = pair.box_frame();
  pair.place(motion.state(0.5), 1e-9, frame);
  frame.horizon = 0.5f;
  detail::BoxBounds bounds[2];
  std::size_t i = 0;
  const std::size_t count = knot.nodes.size();
  const auto a = [&](std::size_t k) -> const HierarchyNode& { return knot.nodes[k % count]; };
  const auto b = [&](std::size_t k) -> const HierarchyNode& { return knot.nodes[k * 7 % count]; };
  for (auto _ : state) {
    if (at_once == 1) {
      detail::bound_boxes(frame, a(i), b(i), bounds[0]);
    } else {
      detail::bound_boxes(frame, a(i), b(i), bounds[0], a(i + 1), b(i + 1), bounds[1]);
    }
    benchmark::DoNotOptimize(bounds);
    i += at_once;
  }
  state.SetItemsProcessed(state.iterations() * 16 * static_cast<std::int64_t>(at_once));
  choose(0);  // Back to all instruction sets that the processor has.
}

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int argc, char** argv) {
  for (std::int64_t all = firstcontact::detail::box_bounds_targets(); all != 0; all &= all - 1) {
    const std::int64_t target = all & -all;
    const std::string name = hwy::TargetName(target);
    for (const std::size_t at_once : {1, 2}) {
      benchmark::RegisterBenchmark((at_once == 1 ? name : name + ", two at once").c_str(),
                                   [target, at_once](benchmark::State& state) {
                                     firstcontact::benchmarks::bound_knots(state, target, at_once);
                                   });
    }
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
