#include <firstcontact/planning/detail/contact_motion.h>

#include <algorithm>
#include <utility>

#include <firstcontact/contact_solver/contact_problem.h>

namespace firstcontact::detail {
namespace {

constexpr double kWeightOfGap = 100.0;  // [-]  Weight of the gap against that of the motion.
constexpr int kSweeps = 100;

/// Rows: the normal, and two tangents.
Eigen::Matrix3d frame_of(const Eigen::Vector3d& n) {
  Eigen::Matrix3d frame;
  const Eigen::Vector3d t = n.unitOrthogonal();
  frame << n.transpose(), t.transpose(), n.cross(t).transpose();
  return frame;
}

using LinkJacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// The Jacobian of a member, with a column for the gap.
LinkJacobian with_gap(const MovedMember& member, Eigen::Index n) {
  LinkJacobian J = LinkJacobian::Zero(6, n + 1);
  if (member.J.cols() == n) {
    J.leftCols(n) = member.J;
  }
  return J;
}

}  // namespace

ContactMotion contact_motion(const TangentSpace& tangents, const ContactsAt& at,
                             const Eigen::VectorXd& wanted, double hover) {
  if (at.contacts.empty()) {
    return {wanted, hover, 0};
  }
  const Eigen::Index n = tangents.size();
  ContactProblem problem;
  problem.mechanisms.resize(1);
  Eigen::VectorXd inverse(n + 1);
  inverse << tangents.inverse_metric(), 1.0 / kWeightOfGap;
  problem.mechanisms[0].inverse_mass = inverse.asDiagonal();
  problem.mechanisms[0].velocity.resize(n + 1);
  problem.mechanisms[0].velocity << wanted, hover;
  for (const MovedMember& member : at.members) {
    problem.bodies.push_back({.link = MechanismLink{0, with_gap(member, n)}});
  }
  for (const NearContact& contact : at.contacts) {
    const auto [a, b] = contact.members;
    // Member A of the contact moves with the gap, too: the relative velocity is J dq - s.
    LinkJacobian J = with_gap(at.members[a], n);
    J.col(n).head<3>() = contact.n_AB_W;
    problem.bodies.push_back({.link = MechanismLink{0, std::move(J)}});
    problem.contacts.push_back({.bodies = {problem.bodies.size() - 1, b},
                                .arm_A = contact.p_WP - at.members[a].p_WR,
                                .arm_B = contact.p_WP - at.members[b].p_WR,
                                .frame = frame_of(contact.n_AB_W),
                                .least_normal_velocity = -contact.gap});
  }
  const ContactSolution solution = project_on_contacts(
      problem, {.tolerance = 1e-4 * hover, .space = ProjectionSpace::contact, .sweeps = kSweeps});
  ContactMotion motion;
  motion.dq = solution.mechanisms[0].head(n);
  motion.gap = solution.mechanisms[0][n];
  motion.active = static_cast<std::size_t>(
      std::count_if(solution.impulses.begin(), solution.impulses.end(),
                    [](const Eigen::Vector3d& impulse) { return impulse.x() > 0.0; }));
  return motion;
}

}  // namespace firstcontact::detail
