#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <firstcontact/dynamics/detail/contact_rows.h>
#include <firstcontact/dynamics/detail/coulomb_cone.h>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr int kMostRounds = 300;      // Of multipliers.
constexpr int kPatience = 8;          // Rounds without a residual of half the best one.
constexpr int kMostNewtonSteps = 40;  // In a round.
constexpr double kFirstPenalty = 1e2;
constexpr double kGreatestPenalty = 1e6;
constexpr double kPenaltyGrowth = 4.0;

/// A square root S of the inverse inertia, S S^T = M^-1; columns of locked axes are zero.
Matrix6d square_root(const InverseInertia& inverse) {
  Matrix6d S = Matrix6d::Zero();
  S.topLeftCorner<3, 3>() = inverse.mass.cwiseSqrt().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(inverse.rotation);
  S.bottomRightCorner<3, 3>() =
      eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  return S;
}

/// The same of a mechanism: with M^-1 = L L^T, S = L.
MatrixXd square_root(const MatrixXd& inverse_mass) { return inverse_mass.llt().matrixL(); }

/// The augmented Lagrangian over x, with V = V_free + S x for each body and mechanism: its metric
/// is then |x|^2, and bodies that nothing moves fall out.
class Lagrangian {
 public:
  Lagrangian(const ContactProblem& problem, const ContactRows& rows) : rows_(rows) {
    for (std::size_t b = 0; b < problem.bodies.size(); ++b) {
      const InverseInertia& inverse = problem.bodies[b].inverse_inertia;
      if (!problem.bodies[b].link && (inverse.mass.any() || inverse.rotation.any())) {
        add_block(rows.layout.body[b], square_root(inverse));
      }
    }
    for (std::size_t m = 0; m < problem.mechanisms.size(); ++m) {
      add_block(rows.layout.mechanism[m], square_root(problem.mechanisms[m].inverse_mass));
    }
    for (const ContactRow& row : rows.contacts) {
      G_.push_back({side(row.sides[0]), side(row.sides[1])});
    }
  }

  [[nodiscard]] Eigen::Index size() const { return size_; }

  [[nodiscard]] VectorXd velocities_at(const VectorXd& x) const {
    VectorXd V = rows_.free_velocities;
    for (const Block& block : blocks_) {
      const Eigen::Index n = block.root.cols();
      V.segment(block.in_V, n) += block.root * x.segment(block.in_x, n);
    }
    return V;
  }

  /// Multipliers and what they are held against: the next of a round.
  struct Round {
    Impulses multipliers = {};
    std::vector<double> bias = {};   // [m/s]  mu |u_t|
    double penalty = kFirstPenalty;  // Times the inverse of a row's response.
  };

  /// The next multipliers of a round.
  [[nodiscard]] Impulses next(const Round& round, const VectorXd& V) const {
    Impulses impulses;
    for (std::size_t k = 0; k < rows_.contacts.size(); ++k) {
      impulses.contacts.push_back(
          project_on_cone(shifted_contact(round, k, V), rows_.contacts[k].friction));
    }
    for (std::size_t k = 0; k < rows_.drives.size(); ++k) {
      impulses.drives.push_back(driven(round, k, V).impulse);
    }
    return impulses;
  }

  [[nodiscard]] double value(const Round& round, const VectorXd& x) const {
    const VectorXd V = velocities_at(x);
    double sum = 0.5 * x.squaredNorm();
    for (std::size_t k = 0; k < rows_.contacts.size(); ++k) {
      const ContactRow& row = rows_.contacts[k];
      if (row.greatest() > 0.0) {
        sum += project_on_cone(shifted_contact(round, k, V), row.friction).squaredNorm() /
               (2.0 * rho(round, row.greatest()));
      }
    }
    for (std::size_t k = 0; k < rows_.drives.size(); ++k) {
      sum += driven(round, k, V).energy;
    }
    return sum;
  }

  /// The gradient, and the Hessian where it is asked for.
  void differentiate(const Round& round, const VectorXd& x, VectorXd& gradient,
                     MatrixXd& hessian) const {
    const VectorXd V = velocities_at(x);
    gradient = x;
    hessian.setIdentity(size_, size_);
    for (std::size_t k = 0; k < rows_.contacts.size(); ++k) {
      const ContactRow& row = rows_.contacts[k];
      if (!(row.greatest() > 0.0)) {
        continue;
      }
      const Vector3d y = shifted_contact(round, k, V);
      const Vector3d r = project_on_cone(y, row.friction);
      const Matrix3d D = rho(round, row.greatest()) * cone_projection_derivative(y, row.friction);
      add_contact(k, r, D, gradient, hessian);
    }
    for (std::size_t k = 0; k < rows_.drives.size(); ++k) {
      const Driven driven = this->driven(round, k, V);
      const DriveRow& row = rows_.drives[k];
      const Block& block = blocks_[block_at(row.at)];
      const VectorXd g = block.root.row(row.place - row.at).transpose();
      gradient.segment(block.in_x, g.size()) -= driven.impulse * g;
      hessian.block(block.in_x, block.in_x, g.size(), g.size()) +=
          driven.stiffness * g * g.transpose();
    }
  }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// Velocities that impulses change together.
  struct Block {
    Eigen::Index in_V;
    Eigen::Index in_x;
    MatrixXd root;  // S
  };

  /// One of the two bodies of a contact, as x moves it.
  struct Side {
    std::size_t block = kNone;
    Eigen::Matrix3Xd G = {};
  };

  /// How a drive answers in a round: a spring between bounds. Its energy is the greatest over r
  /// between its bounds of r y / rho - r^2 (compliance + 1 / rho) / 2, with y = r_0 - rho (u -
  /// target).
  struct Driven {
    double impulse;
    double stiffness;
    double energy;
  };

  void add_block(Eigen::Index in_V, MatrixXd root) {
    blocks_.push_back({in_V, size_, std::move(root)});
    size_ += blocks_.back().root.cols();
  }

  [[nodiscard]] std::size_t block_at(Eigen::Index in_V) const {
    const auto found = std::ranges::lower_bound(blocks_, in_V, {}, &Block::in_V);
    return found != blocks_.end() && found->in_V == in_V
               ? static_cast<std::size_t>(found - blocks_.begin())
               : kNone;
  }

  [[nodiscard]] Side side(const RowSide& row) const {
    const std::size_t block = block_at(row.at);
    if (block == kNone) {
      return {};
    }
    return {block, row.is_link() ? Eigen::Matrix3Xd(row.J_q * blocks_[block].root)
                                 : Eigen::Matrix3Xd(row.J * blocks_[block].root)};
  }

  [[nodiscard]] static double rho(const Round& round, double response) {
    return response > 0.0 ? round.penalty / response : 0.0;
  }

  /// r - rho (u' + mu |u_t| n)
  [[nodiscard]] Vector3d shifted_contact(const Round& round, std::size_t k,
                                         const VectorXd& V) const {
    const ContactRow& row = rows_.contacts[k];
    Vector3d u = row.excess_velocity(V);
    u[0] += round.bias[k];
    return round.multipliers.contacts[k] - rho(round, row.greatest()) * u;
  }

  [[nodiscard]] Driven driven(const Round& round, std::size_t k, const VectorXd& V) const {
    const DriveRow& row = rows_.drives[k];
    const double rho = round.penalty / row.own;
    const double y = round.multipliers.drives[k] - rho * (V[row.place] - row.target);
    const double soft = 1.0 + rho * row.compliance;
    const double r = std::clamp(y / soft, row.least, row.greatest);
    const bool is_held = r == y / soft;
    return {r, is_held ? rho / soft : 0.0, (r * y - 0.5 * r * r * soft) / rho};
  }

  void add_contact(std::size_t k, const Vector3d& r, const Matrix3d& D, VectorXd& gradient,
                   MatrixXd& hessian) const {
    for (const Side& a : G_[k]) {
      if (a.block == kNone) {
        continue;
      }
      const Eigen::Index i = blocks_[a.block].in_x;
      gradient.segment(i, a.G.cols()) -= a.G.transpose() * r;
      for (const Side& b : G_[k]) {
        if (b.block != kNone) {
          hessian.block(i, blocks_[b.block].in_x, a.G.cols(), b.G.cols()) +=
              a.G.transpose() * (D * b.G);
        }
      }
    }
  }

  const ContactRows& rows_;
  std::vector<Block> blocks_;  // In order of place.
  std::vector<std::array<Side, 2>> G_;
  Eigen::Index size_ = 0;
};

/// Minimises over x. Returns the factorisations that it took.
int minimise(const Lagrangian& lagrangian, const Lagrangian::Round& round, double precision,
             VectorXd& x) {
  VectorXd gradient;
  MatrixXd hessian;
  double value = lagrangian.value(round, x);
  for (int step = 0; step < kMostNewtonSteps; ++step) {
    lagrangian.differentiate(round, x, gradient, hessian);
    if (gradient.norm() <= precision) {
      return step;
    }
    const VectorXd direction = -hessian.llt().solve(gradient);
    const double slope = gradient.dot(direction);
    double length = 1.0;
    VectorXd next = x + direction;
    double next_value = lagrangian.value(round, next);
    while (!(next_value <= value + 1e-4 * length * slope) && length > 1e-6) {
      length *= 0.5;
      next = x + length * direction;
      next_value = lagrangian.value(round, next);
    }
    if (!(next_value < value)) {
      // Rounding hides the descent: the gradient tells whether the whole step is one.
      next = x + direction;
      VectorXd next_gradient;
      lagrangian.differentiate(round, next, next_gradient, hessian);
      if (!(next_gradient.norm() < 0.5 * gradient.norm())) {
        return step + 1;
      }
      next_value = lagrangian.value(round, next);
    }
    x = next;
    value = next_value;
  }
  return kMostNewtonSteps;
}

}  // namespace

void project_in_motion_space(const ContactProblem& problem, const ContactRows& rows,
                             const ProjectionOptions& options, Projection& projection) {
  const Lagrangian lagrangian(problem, rows);
  Lagrangian::Round round;
  round.multipliers = projection.impulses;
  round.bias.assign(rows.contacts.size(), 0.0);
  VectorXd x = VectorXd::Zero(lagrangian.size());
  VectorXd V = projection.velocities;
  double least = std::numeric_limits<double>::infinity();
  double goal = least;  // What the next rounds have to reach.
  int waited = 0;
  int factorisations = 0;
  for (int k = 0; k < kMostRounds && least > options.tolerance && waited < kPatience; ++k) {
    for (std::size_t i = 0; i < rows.contacts.size(); ++i) {
      const ContactRow& row = rows.contacts[i];
      round.bias[i] = row.friction * row.velocity(V).tail<2>().norm();
    }
    factorisations += minimise(lagrangian, round, 1e-15 * (1.0 + x.norm()), x);
    V = lagrangian.velocities_at(x);
    round.multipliers = lagrangian.next(round, V);
    const double residual = greatest_residual(rows, round.multipliers, V);
    ++waited;
    if (residual <= goal) {
      goal = 0.5 * residual;
      waited = 0;
    }
    if (residual < least) {
      least = residual;
      projection = {V, round.multipliers, residual, factorisations};
    }
    round.penalty = std::min(kGreatestPenalty, kPenaltyGrowth * round.penalty);
  }
  projection.iterations = factorisations;
}

}  // namespace firstcontact::detail
