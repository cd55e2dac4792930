#include <firstcontact/simulation_model/detail/meeting.h>

#include <Eigen/Geometry>

#include <firstcontact/geometry/detail/overlap_tree.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/simulation_model/detail/move.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>

namespace firstcontact::detail {

std::optional<BodyPair> find_meeting(const SimulationModel& model,
                                     const std::vector<RigidState>& states,
                                     const std::function<bool(std::size_t)>& concerns,
                                     Workspace& workspace) {
  std::vector<Eigen::AlignedBox3d> boxes;
  const auto slack = Eigen::Vector3d::Constant(0.5 * model.laws.greatest_margin());
  for (std::size_t b = 0; b < states.size(); ++b) {
    const Eigen::AlignedBox3d box = swept_box(model.bodies[b], states[b].X_WB, {});
    boxes.emplace_back(box.min() - slack, box.max() + slack);
  }
  for (const auto& [a, b] : overlapping_pairs(boxes)) {
    const bool is_held =
        model.bodies[a].kind != BodyKind::free && model.bodies[b].kind != BodyKind::free;
    const std::optional<double> margin = model.laws.margin({a, b});
    if (is_held || !margin || !(concerns(a) || concerns(b))) {
      continue;
    }
    const Motion A = Motion::fixed(states[a].X_WB);
    const Motion B = Motion::fixed(states[b].X_WB);
    const DistanceResult found =
        distance({model.bodies[a].shape, A}, {model.bodies[b].shape, B}, 0.0, workspace);
    if (!(found.lower_bound > *margin)) {
      return BodyPair{a, b};
    }
  }
  return std::nullopt;
}

}  // namespace firstcontact::detail
