/// @file
/// The bodies around free ones; they follow the scene, or rest.

#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/geometry/detail/overlap_tree.h>

namespace firstcontact::detail {

struct StepStart;
struct SimulationModel;

/// The fixed and scripted bodies of a step, by their places in it.
class Obstacles {
 public:
  Obstacles(const SimulationModel& model, const StepStart& start);

  /// Calls use(body) for each body whose box over the whole step overlaps this one.
  template <class Use>
  void for_each_overlap(const Eigen::AlignedBox3d& box, const Use& use) const {
    tree_.for_each_overlap(box, [&](std::size_t k) { use(bodies_[k]); });
  }

 private:
  std::vector<std::size_t> bodies_;
  OverlapTree tree_;
};

}  // namespace firstcontact::detail
