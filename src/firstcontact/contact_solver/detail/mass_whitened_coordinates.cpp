#include <firstcontact/contact_solver/detail/mass_whitened_coordinates.h>

#include <array>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace firstcontact::detail {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

/// Computes S of a mechanism: with M^-1 = L L^T, S = L, with columns of zeros up to whole blocks.
MatrixXd square_root(const MatrixXd& inverse_mass) {
  const Index n = inverse_mass.rows();
  MatrixXd S = MatrixXd::Zero(n, (n + 5) / 6 * 6);
  S.leftCols(n) = inverse_mass.llt().matrixL();
  return S;
}

}  // namespace

Eigen::Matrix<double, 6, 6> square_root(const InverseInertia& inverse) {
  Eigen::Matrix<double, 6, 6> S = Eigen::Matrix<double, 6, 6>::Zero();
  S.topLeftCorner<3, 3>() = inverse.mass.cwiseSqrt().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(inverse.rotation);
  S.bottomRightCorner<3, 3>() =
      eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  return S;
}

MassWhitenedCoordinates::MassWhitenedCoordinates(const ContactProblem& problem,
                                                 const ContactRows& rows)
    : part_at_(static_cast<std::size_t>(rows.layout.size), kNone) {
  for (std::size_t b = 0; b < problem.bodies.size(); ++b) {
    if (is_movable(problem.bodies[b])) {
      add_part(rows.layout.body[b], square_root(problem.bodies[b].inverse_inertia));
    }
  }
  for (std::size_t m = 0; m < problem.mechanisms.size(); ++m) {
    add_part(rows.layout.mechanism[m], square_root(problem.mechanisms[m].inverse_mass));
  }
  for (const ContactRow& row : rows.contacts) {
    contacts_.add_row();
    for (const RowSide& side : row.sides) {
      add_side(side);
    }
  }
  for (const DriveRow& row : rows.drives) {
    drives_.add_row();
    if (row.tie.empty()) {
      const Part& part = *part_of(row.at);
      drives_.add(part.in_x, part.root.row(row.place - row.at));
    }
    for (const TieRowSide& side : row.tie) {
      if (const Part* part = part_of(side.at)) {
        drives_.add(part->in_x, Eigen::MatrixXd(side.J.transpose() * part->root));
      }
    }
  }
}

void MassWhitenedCoordinates::add_part(Index in_V, MatrixXd root) {
  part_at_[static_cast<std::size_t>(in_V)] = parts_.size();
  parts_.push_back({in_V, size_, std::move(root)});
  size_ += parts_.back().root.cols();
}

/// Finds the part with a velocity; null for a body that nothing moves.
const MassWhitenedCoordinates::Part* MassWhitenedCoordinates::part_of(Index in_V) const {
  const std::size_t part = part_at_[static_cast<std::size_t>(in_V)];
  return part == kNone ? nullptr : &parts_[part];
}

void MassWhitenedCoordinates::add_side(const RowSide& side) {
  const Part* part = part_of(side.at);
  const bool is_there = side.J_q.any() || side.J.any();  // Two links may be one side.
  if (part != nullptr && is_there) {
    contacts_.add(part->in_x, side.is_link() ? Eigen::Matrix3Xd(side.J_q * part->root)
                                             : Eigen::Matrix3Xd(side.J * part->root));
  }
}

VectorXd MassWhitenedCoordinates::moved_by(const Impulses& impulses) const {
  VectorXd x = VectorXd::Zero(size_);
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    contacts_.add_transposed(k, impulses.contacts[k], x);
  }
  for (std::size_t k = 0; k < drives_.size(); ++k) {
    drives_.add_transposed(k, Eigen::Matrix<double, 1, 1>(impulses.drives[k]), x);
  }
  return x;
}

BlockCholesky MassWhitenedCoordinates::factorisation() {
  BlockCholesky matrix(static_cast<std::size_t>(size_ / 6), connected_blocks());
  contacts_.find_places(matrix);
  drives_.find_places(matrix);
  return matrix;
}

std::vector<std::array<std::size_t, 2>> MassWhitenedCoordinates::connected_blocks() const {
  std::vector<std::array<std::size_t, 2>> pairs;
  contacts_.list_pairs(pairs);
  drives_.list_pairs(pairs);
  return pairs;
}

}  // namespace firstcontact::detail
