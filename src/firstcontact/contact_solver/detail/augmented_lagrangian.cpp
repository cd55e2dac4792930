#include <firstcontact/contact_solver/detail/augmented_lagrangian.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/contact_solver/detail/block_cholesky.h>
#include <firstcontact/contact_solver/detail/contact_rows.h>
#include <firstcontact/contact_solver/detail/coulomb_cone.h>
#include <firstcontact/contact_solver/detail/mass_whitened_coordinates.h>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Matrix1d = Eigen::Matrix<double, 1, 1>;

constexpr int kMostRounds = 300;      // Of multipliers.
constexpr int kPatience = 8;          // Rounds without a residual of half the best one.
constexpr int kMostNewtonSteps = 40;  // In a round.
constexpr double kFirstPenalty = 1e2;
constexpr double kGreatestPenalty = 1e5;
constexpr double kPenaltyGrowth = 4.0;
/// How exactly a round is solved: in parts of the residual before it, at last of the tolerance.
constexpr double kPartOfResidual = 0.01;
constexpr double kPartOfTolerance = 1e-3;

/// The augmented Lagrangian over kinetic coordinates x.
class Lagrangian {
 public:
  Lagrangian(const MassWhitenedCoordinates& coordinates, const ContactRows& rows)
      : rows_(rows), contacts_(coordinates.contacts()), drives_(coordinates.drives()) {
    for (const ContactRow& row : rows.contacts) {
      u_free_.push_back(row.excess_velocity(rows.free_velocities));
    }
  }

  /// Multipliers and what they are held against: the next of a round.
  struct Round {
    Impulses multipliers = {};
    std::vector<double> bias = {};   // [m/s]  mu |u_t|
    double penalty = kFirstPenalty;  // Times the inverse of a row's response.
  };

  /// What the Lagrangian is at some x.
  struct Point {
    VectorXd x;
    double value = 0.0;
    VectorXd gradient = {};              // x - G^T r
    Impulses next = {};                  // r, the next multipliers of the round.
    std::vector<Vector3d> shifted = {};  // Of contacts; what is projected on their cones.
    std::vector<double> stiffness = {};  // Of drives.
  };

  [[nodiscard]] Point at(const Round& round, VectorXd x) const {
    Point point{.x = std::move(x)};
    point.value = 0.5 * point.x.squaredNorm();
    point.gradient = point.x;
    for (std::size_t k = 0; k < rows_.contacts.size(); ++k) {
      add_contact(round, k, point);
    }
    for (std::size_t k = 0; k < rows_.drives.size(); ++k) {
      add_drive(round, k, point);
    }
    return point;
  }

  void find_hessian(const Round& round, const Point& point, BlockCholesky& hessian) const {
    hessian.set_identity();
    for (std::size_t k = 0; k < rows_.contacts.size(); ++k) {
      const ContactRow& row = rows_.contacts[k];
      if (point.next.contacts[k].any()) {
        const Matrix3d D =
            rho(round, row.greatest()) * cone_projection_derivative(point.shifted[k], row.friction);
        contacts_.add_to(hessian, k, D);
      }
    }
    for (std::size_t k = 0; k < rows_.drives.size(); ++k) {
      drives_.add_to(hessian, k, Matrix1d(point.stiffness[k]));
    }
  }

 private:
  [[nodiscard]] static double rho(const Round& round, double response) {
    return response > 0.0 ? round.penalty / response : 0.0;
  }

  /// Projects r - rho (u' + mu |u_t| n) on the cone.
  void add_contact(const Round& round, std::size_t k, Point& point) const {
    const ContactRow& row = rows_.contacts[k];
    if (!(row.greatest() > 0.0)) {
      point.shifted.emplace_back(Vector3d::Zero());
      point.next.contacts.emplace_back(Vector3d::Zero());
      return;
    }
    Vector3d u = u_free_[k] + contacts_.times(k, point.x);
    u[0] += round.bias[k];
    const double rho = this->rho(round, row.greatest());
    point.shifted.emplace_back(round.multipliers.contacts[k] - rho * u);
    const Vector3d r = project_on_cone(point.shifted.back(), row.friction);
    point.next.contacts.push_back(r);
    point.value += r.squaredNorm() / (2.0 * rho);
    contacts_.add_transposed(k, -r, point.gradient);
  }

  /// A drive answers as a spring between bounds. Its energy is the greatest over r between them of
  /// r y / rho - r^2 (compliance + 1 / rho) / 2, with y = r_0 - rho (u - target).
  void add_drive(const Round& round, std::size_t k, Point& point) const {
    const DriveRow& row = rows_.drives[k];
    if (!(row.own > 0.0)) {  // Of two bodies that nothing moves.
      point.next.drives.push_back(0.0);
      point.stiffness.push_back(0.0);
      return;
    }
    const double u = row.velocity(rows_.free_velocities) + drives_.times(k, point.x).value();
    const double rho = round.penalty / row.own;
    const double y = round.multipliers.drives[k] - rho * (u - row.target);
    const double soft = 1.0 + rho * row.compliance;
    const double r = std::clamp(y / soft, row.least, row.greatest);
    point.next.drives.push_back(r);
    point.stiffness.push_back(r == y / soft ? rho / soft : 0.0);
    point.value += (r * y - 0.5 * r * r * soft) / rho;
    drives_.add_transposed(k, Matrix1d(-r), point.gradient);
  }

  const ContactRows& rows_;
  const BlockRows<3>& contacts_;
  const BlockRows<1>& drives_;
  std::vector<Vector3d> u_free_;  // [m/s]  Of contacts, at x = 0.
};

/// Minimises from a point on. Returns the factorisations that it took.
int minimise(const Lagrangian& lagrangian, const Lagrangian::Round& round, double precision,
             BlockCholesky& hessian, Lagrangian::Point& point) {
  for (int step = 0; step < kMostNewtonSteps; ++step) {
    if (point.gradient.norm() <= precision) {
      return step;
    }
    lagrangian.find_hessian(round, point, hessian);
    hessian.factorise();
    const VectorXd direction = -hessian.solve(point.gradient);
    const double slope = point.gradient.dot(direction);
    double length = 1.0;
    Lagrangian::Point next = lagrangian.at(round, point.x + direction);
    // Where rounding hides the descent, the gradient tells whether the whole step is one.
    bool is_better = next.gradient.norm() < 0.5 * point.gradient.norm();
    while (!(next.value <= point.value + 1e-4 * length * slope) && !is_better && length > 1e-6) {
      length *= 0.5;
      next = lagrangian.at(round, point.x + length * direction);
    }
    if (!(next.value < point.value) && !is_better) {
      return step + 1;
    }
    point = std::move(next);
  }
  return kMostNewtonSteps;
}

/// [1/kg]
double greatest_response(const ContactRows& rows) {
  double greatest = 0.0;
  for (const ContactRow& row : rows.contacts) {
    greatest = std::max(greatest, row.greatest());
  }
  for (const DriveRow& row : rows.drives) {
    greatest = std::max(greatest, row.own);
  }
  return greatest;
}

}  // namespace

void project_by_augmented_lagrangian(const ContactProblem& problem, const ContactRows& rows,
                                     const ProjectionOptions& options, Projection& projection) {
  MassWhitenedCoordinates coordinates(problem, rows);
  auto hessian = coordinates.factorisation();
  const Lagrangian lagrangian(coordinates, rows);
  Lagrangian::Round round;
  round.multipliers = projection.impulses;
  round.bias.assign(rows.contacts.size(), 0.0);
  VectorXd x = coordinates.moved_by(projection.impulses);
  VectorXd V = projection.velocities;
  // A gradient of 1 changes velocities at a contact by at most the root of the trace of its
  // response.
  const double per_gradient = std::sqrt(3.0 * greatest_response(rows));
  double residual = projection.residual;
  double least = std::numeric_limits<double>::infinity();
  double goal = least;  // What the next rounds have to reach.
  int waited = 0;
  int factorisations = 0;
  for (int k = 0; k < kMostRounds && least > options.tolerance && waited < kPatience; ++k) {
    for (std::size_t i = 0; i < rows.contacts.size(); ++i) {
      const ContactRow& row = rows.contacts[i];
      round.bias[i] = row.friction * row.excess_velocity(V).tail<2>().norm();
    }
    Lagrangian::Point point = lagrangian.at(round, std::move(x));
    const double precision =
        std::max({kPartOfTolerance * options.tolerance / per_gradient,
                  kPartOfResidual * residual / per_gradient, 1e-15 * (1.0 + point.x.norm())});
    factorisations += minimise(lagrangian, round, precision, hessian, point);
    x = std::move(point.x);
    round.multipliers = std::move(point.next);
    V = velocities_after(rows, round.multipliers);
    residual = greatest_residual(rows, round.multipliers, V);
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
