#include <firstcontact/haptics/detail/god_object_plan.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Geometry>

#include <firstcontact/contact_solver/contact_problem.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// The number of a body in the contact problem: first the environment, then the tools, then their
/// links.
std::size_t body_of_problem(std::int32_t tool, std::int32_t link, std::size_t tools) {
  return link >= 0 ? 1 + tools + static_cast<std::size_t>(link)
                   : 1 + static_cast<std::size_t>(tool);
}

/// The coordinates of a tool with joints in a contact problem: those of its body, then of its
/// joints.
class ToolMechanism {
 public:
  ToolMechanism(std::size_t tool, const ToolFrames& frames) : tool_(tool), frames_(frames) {
    for (std::size_t joint = 0; joint < frames.joint_count(); ++joint) {
      if (frames.links->tool_of_joint(joint) == tool) {
        joints_.push_back(joint);
      }
    }
  }

  [[nodiscard]] const std::vector<std::size_t>& joints() const { return joints_; }

  [[nodiscard]] ContactMechanism metric(const ToolDisplacements& wanted) const {
    const auto n = static_cast<Eigen::Index>(6 + joints_.size());
    const double mass = frames_.weights[tool_] * frames_.weights[tool_];
    const double inertia = mass * frames_.lengths[tool_] * frames_.lengths[tool_];
    ContactMechanism mechanism{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
    mechanism.inverse_mass.diagonal().head<3>().setConstant(1.0 / mass);
    mechanism.inverse_mass.diagonal().segment<3>(3).setConstant(1.0 / inertia);
    mechanism.velocity << wanted[tool_].translation, wanted[tool_].rotation_vector,
        Eigen::VectorXd::Zero(n - 6);
    for (std::size_t k = 0; k < joints_.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(6 + k);
      const double weight = frames_.joint_weights[joints_[k]];
      mechanism.inverse_mass(at, at) = 1.0 / (weight * weight);
      mechanism.velocity[at] = wanted.joints[joints_[k]];
    }
    return mechanism;
  }

  /// Makes the link: its motion is that of the tool's centre as a point of the link.
  [[nodiscard]] MechanismLink link(std::size_t mechanism, int link) const {
    MechanismLink made{mechanism, {}};
    made.J.setZero(6, static_cast<Eigen::Index>(6 + joints_.size()));
    made.J.leftCols<6>().setIdentity();
    for (; link >= 0; link = frames_.links->nodes()[static_cast<std::size_t>(link)].parent) {
      const auto number = static_cast<std::size_t>(link);
      const ToolLinks::Node& node = frames_.links->nodes()[number];
      const auto found = std::ranges::find(joints_, static_cast<std::size_t>(node.joint));
      if (node.joint >= 0) {
        const Eigen::Index column = 6 + (found - joints_.begin());
        made.J.col(column).head<3>() += rate_with_joint(number, frames_.p_WC[tool_], frames_);
        made.J.col(column).tail<3>() += node.turn * frames_.axes[number].direction;
      }
    }
    return made;
  }

 private:
  std::size_t tool_;
  const ToolFrames& frames_;
  std::vector<std::size_t> joints_;
};

/// Adds the tools with joints as mechanisms, with their links and limits.
void add_joints(const ToolDisplacements& wanted, const ToolFrames& frames, std::size_t tools,
                ContactProblem& problem) {
  if (frames.links == nullptr) {
    return;
  }
  const std::size_t first = problem.bodies.size();
  problem.bodies.resize(first + frames.links->nodes().size());
  for (std::size_t tool = 0; tool < tools; ++tool) {
    const ToolMechanism mechanism(tool, frames);
    const std::size_t number = problem.mechanisms.size();
    problem.mechanisms.push_back(mechanism.metric(wanted));
    problem.bodies[1 + tool] = {.link = mechanism.link(number, -1)};
    for (std::size_t link = 0; link < frames.links->nodes().size(); ++link) {
      if (frames.links->nodes()[link].tool == tool) {
        problem.bodies[first + link] = {.link = mechanism.link(number, static_cast<int>(link))};
      }
    }
    for (std::size_t k = 0; k < mechanism.joints().size(); ++k) {
      const std::size_t joint = mechanism.joints()[k];
      const HapticJoint& limits = frames.links->joints()[joint];
      const double at = frames.joints[joint];
      if (has_limit(limits, 1.0)) {
        problem.drives.push_back({.mechanism = number,
                                  .coordinate = 6 + k,
                                  .target = std::min(0.0, limits.lower - at),
                                  .least = 0.0});
      }
      if (has_limit(limits, -1.0)) {
        problem.drives.push_back({.mechanism = number,
                                  .coordinate = 6 + k,
                                  .target = std::max(0.0, limits.upper - at),
                                  .greatest = 0.0});
      }
    }
  }
}

/// Makes the contact problem whose unit of time is the plan. Its masses are stiffnesses by that of
/// the first tool, so that kinetic energy is that of the springs. Body 0 is the environment.
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
    point.bodies = {0, body_of_problem(contact.tool, contact.link, tools)};
    point.arm_B = contact.point - frames.p_WC[tool];
    if (contact.other >= 0) {
      const auto other = static_cast<std::size_t>(contact.other);
      point.bodies[0] = body_of_problem(contact.other, contact.other_link, tools);
      point.arm_A = contact.point - frames.p_WC[other];
    }
    point.frame = contact_axes(contact.normal);
    point.friction = touch.friction;
    const Vector3d surface = point.frame * touch.surface;
    point.least_normal_velocity = surface.x() - std::max(touch.way, least_way);
    point.sticking_velocity = surface.tail<2>();
    problem.contacts.push_back(point);
  }
  add_joints(wanted, frames, tools, problem);
  return problem;
}

/// [m]  Computes the displacement of a point by the joints on which its link hangs.
Vector3d way_by_joints(int link, const Vector3d& point, const ToolDisplacements& ways,
                       const ToolFrames& frames) {
  Vector3d way = Vector3d::Zero();
  while (link >= 0) {
    const auto number = static_cast<std::size_t>(link);
    const ToolLinks::Node& node = frames.links->nodes()[number];
    if (node.joint >= 0) {
      way += ways.joints[static_cast<std::size_t>(node.joint)] *
             rate_with_joint(number, point, frames);
    }
    link = node.parent;
  }
  return way;
}

/// [pivots]  Most pivots of the small projection, before the large solver takes over.
constexpr int kPivotsOfPlan = 300;

/// [-]  Tolerance of cuts, by the residual. It is small, as the direction of friction is as exact
/// as its root.
constexpr double kCutsOfResidual = 1e-2;

/// Plans by the projection of the force loop.
///
/// @returns  whether it was solved
bool plan_by_cuts(const ToolDisplacements& wanted, const ToolFrames& frames, std::size_t tools,
                  const std::vector<PlannedTouch>& touches, double least_way, double residual,
                  GodObjectPlan& plan) {
  const std::size_t joints = frames.joint_count();
  ConeProjection cone(frames.coordinates(tools), touches.size() + 2 * joints);
  for (const PlannedTouch& touch : touches) {
    ConeContact contact = cone_contact(*touch.contact, frames);
    const Vector3d surface = contact_axes(touch.contact->normal) * touch.surface;
    contact.shift = {surface.x(), surface.y(), surface.z()};
    contact.way = std::max(touch.way, least_way);
    contact.friction = touch.friction;
    cone.add(contact);
  }
  for (std::size_t joint = 0; joint < joints; ++joint) {
    for (const double side : {1.0, -1.0}) {
      if (has_limit(frames.links->joints()[joint], side)) {
        cone.add(limit_of_joint(joint, side, frames));
      }
    }
  }
  Coordinates x{};
  for (std::size_t k = 0; k < tools; ++k) {
    for (int i = 0; i < 3; ++i) {
      const auto at = 6 * k + static_cast<std::size_t>(i);
      x[at] = frames.weights[k] * wanted[k].translation[i];
      x[at + 3] = frames.weights[k] * frames.lengths[k] * wanted[k].rotation_vector[i];
    }
  }
  for (std::size_t joint = 0; joint < joints; ++joint) {
    x[6 * tools + joint] = frames.joint_weights[joint] * wanted.joints[joint];
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
  for (std::size_t joint = 0; joint < joints; ++joint) {
    plan.displacements.joints[joint] = found.x[6 * tools + joint] / frames.joint_weights[joint];
  }
  return found.is_solved;
}

/// [sweeps]  Sweeps of the large solver where a deadline is near. Contacts that contradict each
/// other are not solved by more of them either.
constexpr int kSweepsOfQuickPlan = 60;

/// Plans by the solver of the simulator, which copes better with many contacts and contradictions.
GodObjectPlan plan_by_solver(const ToolDisplacements& wanted, const ToolFrames& frames,
                             std::size_t tools, const std::vector<PlannedTouch>& touches,
                             double nearest, double residual, bool is_quick) {
  GodObjectPlan plan;
  ContactSolution solution;
  ProjectionOptions options{.tolerance = residual};
  if (is_quick) {
    options.space = ProjectionSpace::contact;
    options.sweeps = kSweepsOfQuickPlan;
  }
  for (const double least_way : {nearest, 0.0}) {
    solution = project_on_contacts(problem_of(wanted, frames, tools, touches, least_way), options);
    if (solution.residual <= solution.allowed || !(nearest < 0.0)) {
      break;
    }
  }
  plan.residual = solution.residual;
  plan.is_pressed = std::ranges::any_of(solution.impulses,
                                        [](const Vector3d& impulse) { return impulse.x() > 0.0; });
  for (std::size_t k = 0; k < tools; ++k) {
    if (frames.links == nullptr) {
      plan.displacements[k] = {solution.bodies[k + 1].v, solution.bodies[k + 1].w};
      continue;
    }
    const Eigen::VectorXd& found = solution.mechanisms[k];
    plan.displacements[k] = {found.head<3>(), found.segment<3>(3)};
    const ToolMechanism mechanism(k, frames);
    for (std::size_t joint = 0; joint < mechanism.joints().size(); ++joint) {
      plan.displacements.joints[mechanism.joints()[joint]] =
          found[static_cast<Eigen::Index>(6 + joint)];
    }
  }
  return plan;
}

}  // namespace

ToolDisplacements ToolDisplacements::part(double part) const {
  ToolDisplacements made = *this;
  for (Displacement& way : made.tools) {
    way.translation *= part;
    way.rotation_vector *= part;
  }
  for (double& way : made.joints) {
    way *= part;
  }
  return made;
}

double product_of(const ToolDisplacements& a, const ToolDisplacements& b, const ToolFrames& frames,
                  std::size_t tools) {
  double product = 0.0;
  for (std::size_t k = 0; k < tools; ++k) {
    const double length = frames.lengths[k];
    product += frames.weights[k] * frames.weights[k] *
               (a[k].translation.dot(b[k].translation) +
                length * length * a[k].rotation_vector.dot(b[k].rotation_vector));
  }
  for (std::size_t joint = 0; joint < frames.joint_count(); ++joint) {
    const double weight = frames.joint_weights[joint];
    product += weight * weight * a.joints[joint] * b.joints[joint];
  }
  return product;
}

Vector3d turn_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) noexcept {
  const Eigen::Quaterniond turn = to.normalized() * from.normalized().conjugate();
  const Vector3d half = turn.w() < 0.0 ? Vector3d(-turn.vec()) : Vector3d(turn.vec());
  const double sine = half.norm();
  if (!(sine > 0.0)) {
    return Vector3d::Zero();
  }
  return 2.0 * std::atan2(sine, std::abs(turn.w())) / sine * half;
}

Vector3d displacement_at(const PlannedTouch& touch, const ToolDisplacements& ways,
                         const ToolFrames& frames) {
  const HapticContact& contact = *touch.contact;
  const auto moved = [&](std::int32_t tool, std::int32_t link) -> Vector3d {
    const auto k = static_cast<std::size_t>(tool);
    return ways[k].at(contact.point - frames.p_WC[k]) +
           way_by_joints(link, contact.point, ways, frames);
  };
  Vector3d u = moved(contact.tool, contact.link) - touch.surface;
  if (contact.other >= 0) {
    u -= moved(contact.other, contact.other_link);
  }
  return u;
}

bool keeps_apart(const GodObjectPlan& plan, const ToolFrames& frames,
                 const std::vector<PlannedTouch>& touches, double slack) {
  return std::ranges::all_of(touches, [&](const PlannedTouch& touch) {
    const HapticContact& contact = *touch.contact;
    const Vector3d u = displacement_at(touch, plan.displacements, frames);
    constexpr double kNear = 5.0;            // In units of the slack.
    constexpr double kRoundingOfGap = 1e-6;  // In units of the gap.
    const double room = contact.gap > kNear * slack ? slack : kRoundingOfGap * contact.gap;
    return u.dot(contact.normal) >= -std::max(touch.way, 0.0) - room;
  });
}

GodObjectPlan plan_god_objects(const ToolDisplacements& wanted, const ToolFrames& frames,
                               std::size_t tools, const std::vector<PlannedTouch>& touches,
                               double residual, bool is_quick) {
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
  return plan_by_solver(wanted, frames, tools, touches, nearest, residual, is_quick);
}

}  // namespace firstcontact::detail
