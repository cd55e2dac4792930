#include <firstcontact/simulation_model/detail/step_start.h>

#include <algorithm>
#include <cstddef>

#include <Eigen/Geometry>

#include <firstcontact/simulation_model/detail/simulation_model.h>

namespace firstcontact::detail {

using Eigen::Vector3d;

Vector3d rotation_between(const Motion& motion, double from, double to) {
  const auto breaks = motion.breaks();
  const auto piece = static_cast<std::size_t>(
      std::upper_bound(breaks.begin() + 1, breaks.end() - 1, from) - breaks.begin() - 1);
  if (to <= breaks[piece + 1]) {
    const ConstantRatePath path = motion.path(piece, Vector3d::Zero());
    return path.axis() * (path.rate() * (to - from));
  }
  const Eigen::AngleAxisd turn(motion.pose(to).rotation * motion.pose(from).rotation.conjugate());
  return turn.angle() * turn.axis();
}

Pose scripted_pose(const SimulationModel& model, const StepStart& start, std::size_t body,
                   double share) {
  const SimBody& moved = model.bodies[body];
  const Pose& X_WB = start.states[body].X_WB;
  return moved.kind == BodyKind::scripted && share > 0.0
             ? motion_of(moved, X_WB, start.scripted[body]).pose(share)
             : X_WB;
}

}  // namespace firstcontact::detail
