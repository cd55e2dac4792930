#include <firstcontact/haptics/detail/god_object_plan.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

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

/// [pivots]  Of the small projection; then the large solver is asked.
constexpr int kPivotsOfPlan = 300;

/// [-]  Cuts are made to this part of the residual, as the direction of friction is of its root.
constexpr double kCutsOfResidual = 1e-2;

/// Plans by the projection of the force loop.
///
/// @returns  whether it was solved
bool plan_by_cuts(const ToolDisplacements& wanted, const ToolFrames& frames, std::size_t tools,
                  const std::vector<PlannedTouch>& touches, double least_way, double residual,
                  GodObjectPlan& plan) {
  ConeProjection cone(6 * tools, touches.size());
  for (const PlannedTouch& touch : touches) {
    ConeContact contact = cone_contact(*touch.contact, frames, 0.0);
    const Vector3d surface = contact_axes(touch.contact->normal) * touch.surface;
    contact.shift = {surface.x(), surface.y(), surface.z()};
    contact.way = std::max(touch.way, least_way);
    cone.add(contact);
  }
  Coordinates x{};
  for (std::size_t k = 0; k < tools; ++k) {
    for (int i = 0; i < 3; ++i) {
      const auto at = 6 * k + static_cast<std::size_t>(i);
      x[at] = frames.weights[k] * wanted[k].translation[i];
      x[at + 3] = frames.weights[k] * frames.lengths[k] * wanted[k].rotation_vector[i];
    }
  }
  const double tolerance = kCutsOfResidual * residual;
  const ConeProjectionResult found = cone.project(x, tolerance, kPivotsOfPlan);
  plan.residual = tolerance;
  plan.is_pressed = found.pressing > 0;
  for (std::size_t k = 0; k < tools; ++k) {
    for (int i = 0; i < 3; ++i) {
      const auto at = 6 * k + static_cast<std::size_t>(i);
      plan.displacements[k].translation[i] = found.x[at] / frames.weights[k];
      plan.displacements[k].rotation_vector[i] =
          found.x[at + 3] / (frames.weights[k] * frames.lengths[k]);
    }
  }
  return found.is_solved;
}

/// Plans by the solver of the simulator, which minds many contacts and contradictions less.
GodObjectPlan plan_by_solver(const ToolDisplacements& wanted, const ToolFrames& frames,
                             std::size_t tools, const std::vector<PlannedTouch>& touches,
                             double nearest, double residual) {
  GodObjectPlan plan;
  ContactSolution solution;
  for (const double least_way : {nearest, 0.0}) {
    solution = project_on_contacts(problem_of(wanted, frames, tools, touches, least_way),
                                   {.tolerance = residual});
    if (solution.residual <= solution.allowed || !(nearest < 0.0)) {
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

}  // namespace

Vector3d turn_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) noexcept {
  const Eigen::Quaterniond turn = to.normalized() * from.normalized().conjugate();
  const Vector3d half = turn.w() < 0.0 ? Vector3d(-turn.vec()) : Vector3d(turn.vec());
  const double sine = half.norm();
  if (!(sine > 0.0)) {
    return Vector3d::Zero();
  }
  return 2.0 * std::atan2(sine, std::abs(turn.w())) / sine * half;
}

bool keeps_apart(const GodObjectPlan& plan, const ToolFrames& frames,
                 const std::vector<PlannedTouch>& touches, double slack) {
  const auto moved = [&](std::int32_t tool, const Vector3d& point) -> Vector3d {
    const auto k = static_cast<std::size_t>(tool);
    return plan.displacements[k].at(point - frames.p_WC[k]);
  };
  return std::ranges::all_of(touches, [&](const PlannedTouch& touch) {
    const HapticContact& contact = *touch.contact;
    Vector3d u = moved(contact.tool, contact.point) - touch.surface;
    if (contact.other >= 0) {
      u -= moved(contact.other, contact.point);
    }
    constexpr double kNear = 5.0;            // Slacks.
    constexpr double kRoundingOfGap = 1e-6;  // Of the gap.
    const double room = contact.gap > kNear * slack ? slack : kRoundingOfGap * contact.gap;
    return u.dot(contact.normal) >= -std::max(touch.way, 0.0) - room;
  });
}

GodObjectPlan plan_god_objects(const ToolDisplacements& wanted, const ToolFrames& frames,
                               std::size_t tools, const std::vector<PlannedTouch>& touches,
                               double residual) {
  if (touches.empty()) {
    return {.displacements = wanted};
  }
  const double nearest = std::ranges::min_element(touches, {}, [](const PlannedTouch& touch) {
                           return touch.way;
                         })->way;
  GodObjectPlan plan;
  if (plan_by_cuts(wanted, frames, tools, touches, nearest, residual, plan) ||
      (nearest < 0.0 && plan_by_cuts(wanted, frames, tools, touches, 0.0, residual, plan))) {
    return plan;
  }
  return plan_by_solver(wanted, frames, tools, touches, nearest, residual);
}

}  // namespace firstcontact::detail
