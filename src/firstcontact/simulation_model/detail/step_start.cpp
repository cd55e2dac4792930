#include <firstcontact/simulation_model/detail/step_start.h>

#include <algorithm>
#include <cstddef>

#include <Eigen/Geometry>

#include <firstcontact/simulation_model/detail/simulation_model.h>

namespace firstcontact::detail {

using Eigen::Vector3d;

Pose scripted_pose(const SimulationModel& model, const StepStart& start, std::size_t body,
                   double share) {
  const SimBody& moved = model.bodies[body];
  const Pose& X_WB = start.states[body].X_WB;
  return moved.kind == BodyKind::scripted && share > 0.0
             ? motion_of(moved, X_WB, start.scripted[body]).pose(share)
             : X_WB;
}

}  // namespace firstcontact::detail
