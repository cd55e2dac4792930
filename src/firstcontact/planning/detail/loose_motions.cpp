#include <firstcontact/planning/detail/loose_motions.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace firstcontact::detail {
namespace {

constexpr double kLoose = 0.1;  // [-]  Mean change of gaps, relative to that of the stiffest
                                // motion.

/// Adds J^T n of one member of a contact.
void add(const MovedMember& member, const NearContact& contact, double sign, Eigen::VectorXd& row) {
  if (member.J.cols() == 0) {
    return;
  }
  Eigen::Matrix<double, 6, 1> wrench;
  wrench << contact.n_AB_W, (contact.p_WP - member.p_WR).cross(contact.n_AB_W);
  row += sign * member.J.transpose() * wrench;
}

}  // namespace

std::vector<Eigen::VectorXd> loose_motions(const TangentSpace& tangents, const ContactsAt& at) {
  const Eigen::VectorXd scale = tangents.inverse_metric().cwiseSqrt();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(scale.size(), scale.size());
  for (const NearContact& contact : at.contacts) {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(scale.size());
    add(at.members[contact.members[0]], contact, -1.0, row);
    add(at.members[contact.members[1]], contact, 1.0, row);
    const Eigen::VectorXd scaled = scale.cwiseProduct(row);
    sum += scaled * scaled.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(sum);
  const Eigen::VectorXd& values = solver.eigenvalues();  // The least first.
  std::vector<Eigen::VectorXd> loose;
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    if (values[k] <= kLoose * kLoose * values[values.size() - 1]) {
      loose.emplace_back(scale.cwiseProduct(solver.eigenvectors().col(k)));
    }
  }
  return loose;
}

}  // namespace firstcontact::detail
