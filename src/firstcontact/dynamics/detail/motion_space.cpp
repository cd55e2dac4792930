#include <algorithm>
#include <cmath>
#include <limits>

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

/// The augmented Lagrangian over x, with V = V_free + S x for each body: its metric is then |x|^2,
/// and bodies that nothing moves fall out.
class Lagrangian {
 public:
  Lagrangian(const ContactProblem& problem, const std::vector<ContactRow>& rows)
      : rows_(rows), V_free_(velocities(problem.bodies)), place_(problem.bodies.size(), kNone) {
    std::size_t count = 0;
    for (std::size_t b = 0; b < problem.bodies.size(); ++b) {
      const InverseInertia& inverse = problem.bodies[b].inverse_inertia;
      if (inverse.mass.any() || inverse.rotation.any()) {
        place_[b] = static_cast<Eigen::Index>(6 * count++);
        roots_.push_back(square_root(inverse));
      }
    }
    size_ = static_cast<Eigen::Index>(6 * count);
    for (const ContactRow& row : rows) {
      G_.push_back({side(row, 0), side(row, 1)});
    }
  }

  [[nodiscard]] Eigen::Index size() const { return size_; }

  [[nodiscard]] std::vector<Velocity> velocities_at(const VectorXd& x) const {
    std::vector<Velocity> V = V_free_;
    for (std::size_t b = 0; b < V.size(); ++b) {
      if (place_[b] != kNone) {
        V[b] += roots_[place_[b] / 6] * x.segment<6>(place_[b]);
      }
    }
    return V;
  }

  /// Multipliers and what they are held against: the next of a round.
  struct Round {
    std::vector<Vector3d> multipliers;  // [N s]
    std::vector<double> bias;           // [m/s]  mu |u_t|
    double penalty = kFirstPenalty;     // Times the inverse of a contact's response.
  };

  /// r - rho (u' + mu |u_t| n)
  [[nodiscard]] Vector3d shifted(const Round& round, std::size_t k,
                                 const std::vector<Velocity>& V) const {
    Vector3d u = rows_[k].excess_velocity(V);
    u[0] += round.bias[k];
    return round.multipliers[k] - rho(round, k) * u;
  }

  [[nodiscard]] double rho(const Round& round, std::size_t k) const {
    return rows_[k].greatest() > 0.0 ? round.penalty / rows_[k].greatest() : 0.0;
  }

  [[nodiscard]] double value(const Round& round, const VectorXd& x) const {
    const std::vector<Velocity> V = velocities_at(x);
    double sum = 0.5 * x.squaredNorm();
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      if (rows_[k].greatest() > 0.0) {
        sum += project_on_cone(shifted(round, k, V), rows_[k].friction).squaredNorm() /
               (2.0 * rho(round, k));
      }
    }
    return sum;
  }

  /// The gradient, and the Hessian where it is asked for.
  void differentiate(const Round& round, const VectorXd& x, VectorXd& gradient,
                     MatrixXd& hessian) const {
    const std::vector<Velocity> V = velocities_at(x);
    gradient = x;
    hessian.setIdentity(size_, size_);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      if (!(rows_[k].greatest() > 0.0)) {
        continue;
      }
      const Vector3d y = shifted(round, k, V);
      const Vector3d r = project_on_cone(y, rows_[k].friction);
      const Matrix3d D = rho(round, k) * cone_projection_derivative(y, rows_[k].friction);
      add(k, r, D, gradient, hessian);
    }
  }

 private:
  static constexpr Eigen::Index kNone = -1;

  [[nodiscard]] Jacobian side(const ContactRow& row, int s) const {
    const Eigen::Index place = place_[row.bodies[s]];
    return place == kNone ? Jacobian(Jacobian::Zero()) : Jacobian(row.J[s] * roots_[place / 6]);
  }

  void add(std::size_t k, const Vector3d& r, const Matrix3d& D, VectorXd& gradient,
           MatrixXd& hessian) const {
    for (int a = 0; a < 2; ++a) {
      const Eigen::Index i = place_[rows_[k].bodies[a]];
      if (i == kNone) {
        continue;
      }
      gradient.segment<6>(i) -= G_[k][a].transpose() * r;
      for (int b = 0; b < 2; ++b) {
        const Eigen::Index j = place_[rows_[k].bodies[b]];
        if (j != kNone) {
          hessian.block<6, 6>(i, j) += G_[k][a].transpose() * D * G_[k][b];
        }
      }
    }
  }

  const std::vector<ContactRow>& rows_;
  std::vector<Velocity> V_free_;
  std::vector<Eigen::Index> place_;  // In x; kNone: nothing moves the body.
  std::vector<Matrix6d> roots_;
  std::vector<std::array<Jacobian, 2>> G_;
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
      return step + 1;  // No descent that rounding would show.
    }
    x = next;
    value = next_value;
  }
  return kMostNewtonSteps;
}

}  // namespace

void project_in_motion_space(const ContactProblem& problem, const std::vector<ContactRow>& rows,
                             const ProjectionOptions& options, Projection& projection) {
  const Lagrangian lagrangian(problem, rows);
  Lagrangian::Round round;
  round.multipliers = projection.impulses;
  round.bias.assign(rows.size(), 0.0);
  VectorXd x = VectorXd::Zero(lagrangian.size());
  std::vector<Velocity> V = projection.velocities;
  double least = std::numeric_limits<double>::infinity();
  double goal = least;  // What the next rounds have to reach.
  int waited = 0;
  int factorisations = 0;
  for (int k = 0; k < kMostRounds && least > options.tolerance && waited < kPatience; ++k) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      round.bias[i] = rows[i].friction * rows[i].velocity(V).tail<2>().norm();
    }
    factorisations += minimise(lagrangian, round, 1e-15 * (1.0 + x.norm()), x);
    V = lagrangian.velocities_at(x);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      round.multipliers[i] = project_on_cone(lagrangian.shifted(round, i, V), rows[i].friction);
    }
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
