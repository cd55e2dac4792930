#include <firstcontact/haptics/detail/god_object_plan.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include <firstcontact/contact_solver/contact_problem.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// The contact problem whose unit of time is the plan. Its masses are stiffnesses by that of the
/// first tool, so that kinetic energy is that of the springs. Body 0 is the surroundings.
ContactProblem problem_of(const ToolDisplacements& wanted, const ToolFrames& frames,
                          std::size_t tools, const std::vector<PlannedTouch>& touches,
                          double least_way) {
  ContactProblem problem;
  problem.bodies.emplace_back();
  for (std::size_t k = 0; k < tools; ++k) {
    const double mass = frames.weights[k] * frames.weights[k];
    ContactBody body;
    body.inverse_inertia.mass = Vector3d::Constant(1.0 / mass);
    body.inverse_inertia.rotation =
        Eigen::Matrix3d::Identity() / (mass * frames.lengths[k] * frames.lengths[k]);
    body.v = wanted[k].translation;
    body.w = wanted[k].rotation_vector;
    problem.bodies.push_back(body);
  }
  for (const PlannedTouch& touch : touches) {
    const HapticContact& contact = *touch.contact;
    const auto tool = static_cast<std::size_t>(contact.tool);
    ContactPoint point;
    point.bodies = {0, tool + 1};
    point.arm_B = contact.point - frames.p_WC[tool];
    if (contact.other >= 0) {
      const auto other = static_cast<std::size_t>(contact.other);
      point.bodies[0] = other + 1;
      point.arm_A = contact.point - frames.p_WC[other];
    }
    point.frame = contact_axes(contact.normal);
    point.friction = contact.friction;
    const Vector3d surface = point.frame * touch.surface;
    point.least_normal_velocity = surface.x() - std::max(touch.way, least_way);
    point.sticking_velocity = surface.tail<2>();
    problem.contacts.push_back(point);
  }
  return problem;
}

}  // namespace

Vector3d shortest_turn(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) noexcept {
  const Eigen::Quaterniond turn = to.normalized() * from.normalized().conjugate();
  const Vector3d half = turn.w() < 0.0 ? Vector3d(-turn.vec()) : Vector3d(turn.vec());
  const double sine = half.norm();
  if (!(sine > 0.0)) {
    return Vector3d::Zero();
  }
  return 2.0 * std::atan2(sine, std::abs(turn.w())) / sine * half;
}

GodObjectPlan plan_god_objects(const ToolDisplacements& wanted, const ToolFrames& frames,
                               std::size_t tools, const std::vector<PlannedTouch>& touches,
                               double residual) {
  GodObjectPlan plan{.displacements = wanted};
  if (touches.empty()) {
    return plan;
  }
  const auto nearest =
      std::ranges::min_element(touches, {}, [](const PlannedTouch& touch) { return touch.way; });
  const ProjectionOptions options{.tolerance = residual};
  ContactSolution solution;
  for (const double least_way : {nearest->way, 0.0}) {
    solution = project_on_contacts(problem_of(wanted, frames, tools, touches, least_way), options);
    if (solution.residual <= solution.allowed || !(nearest->way < 0.0)) {
      break;
    }
  }
  plan.residual = solution.residual;
  plan.is_pressed = std::ranges::any_of(solution.impulses,
                                        [](const Vector3d& impulse) { return impulse.x() > 0.0; });
  for (std::size_t k = 0; k < tools; ++k) {
    plan.displacements[k] = {solution.bodies[k + 1].v, solution.bodies[k + 1].w};
  }
  return plan;
}

}  // namespace firstcontact::detail
