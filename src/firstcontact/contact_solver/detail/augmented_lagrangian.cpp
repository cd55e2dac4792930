#include <firstcontact/contact_solver/detail/augmented_lagrangian.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include <firstcontact/contact_solver/detail/block_cholesky.h>
#include <firstcontact/contact_solver/detail/contact_rows.h>
#include <firstcontact/contact_solver/detail/contradiction.h>
#include <firstcontact/contact_solver/detail/coulomb_cone.h>
#include <firstcontact/contact_solver/detail/mass_whitened_coordinates.h>
#include <firstcontact/contact_solver/detail/projected_gauss_seidel.h>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Matrix1d = Eigen::Matrix<double, 1, 1>;

constexpr int kMostRounds = 300;      // Rounds of multipliers.
constexpr int kPatience = 8;          // Rounds without a residual of half the best one.
constexpr int kMostNewtonSteps = 40;  // Newton's steps in a round.
constexpr double kFirstPenalty = 1e2;
constexpr double kGreatestPenalty = 1e5;
constexpr double kPenaltyGrowth = 4.0;
/// The precision of a round, as a fraction of the residual before it and of the tolerance at last.
constexpr double kPartOfResidual = 0.01;
constexpr double kPartOfTolerance = 1e-3;
/// [velocities]  Size up to which rounds that gain little have sliding speeds as unknowns: their
/// matrix is full. With drives all rounds are so at first: that halves the factorisations of a
/// humanoid that falls.
constexpr Eigen::Index kMostWithSliding = 120;
constexpr int kMostSlidingSteps = 20;  // Newton's steps in such a round.
constexpr int kMostHalvings = 5;       // Halvings of one of these steps.
/// Most turns of sweeps and of rounds with sliding speeds, where rounds end short of an answer.
/// Sweeps find other points to begin at.
constexpr int kMostTurns = 10;
constexpr int kPatienceOfTurns = 3;  // Turns without a residual of half the best one.
constexpr int kSweepsOfTurn = 50;
constexpr int kRoundsOfTurn = 3;
constexpr double kPenaltyOfTurn = 1e3;         // Penalty of the first round of a turn...
constexpr double kPenaltyGrowthInTurn = 10.0;  // ... which then grows.

/// The augmented Lagrangian over mass-whitened coordinates x.
class Lagrangian {
 public:
  Lagrangian(const MassWhitenedCoordinates& coordinates, const ContactRows& rows)
      : rows_(rows), contacts_(coordinates.contacts()), drives_(coordinates.drives()) {
    for (const ContactRow& row : rows.contacts) {
      u_free_.push_back(row.excess_velocity(rows.free_velocities));
    }
  }

  /// The data of a round: its multipliers, its fixed sliding speeds and its penalty.
  struct Round {
    Impulses multipliers = {};
    std::vector<double> bias = {};   // [m/s]  mu |u_t|
    double penalty = kFirstPenalty;  // Penalty, times the inverse of a row's response.
  };

  /// The Lagrangian at some x.
  struct Point {
    VectorXd x;
    double value = 0.0;
    VectorXd gradient = {};  // x - G^T r
    Impulses next = {};      // r, the next multipliers after the round.
    // For each contact the vector that is projected on its cone.
    std::vector<Vector3d> shifted = {};
    std::vector<double> stiffness = {};  // Stiffness of each drive.
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
    add_stiffness(point, hessian);
  }

  /// Evaluates with the sliding speeds of x itself, which become those of the round. No value is
  /// minimised then: the gradient is 0 where the laws hold with these multipliers.
  Point with_own_sliding(Round& round, VectorXd x) const {
    for (std::size_t k = 0; k < rows_.contacts.size(); ++k) {
      const Vector3d u = u_free_[k] + contacts_.times(k, x);
      round.bias[k] = rows_.contacts[k].friction * u.tail<2>().norm();
    }
    return at(round, std::move(x));
  }

  /// Computes the derivative of that gradient. It is not symmetric: sliding speeds open contacts,
  /// but no impulse along the normal makes them slide.
  [[nodiscard]] MatrixXd derivative_with_sliding(const Round& round, const Point& point) const {
    MatrixXd derivative = MatrixXd::Identity(point.x.size(), point.x.size());
    for (std::size_t k = 0; k < rows_.contacts.size(); ++k) {
      if (point.next.contacts[k].any()) {
        const ContactRow& row = rows_.contacts[k];
        const Eigen::Vector2d u_t = (u_free_[k] + contacts_.times(k, point.x)).tail<2>();
        Matrix3d opened = Matrix3d::Identity();
        opened.block<1, 2>(0, 1) = row.friction * u_t.stableNormalized().transpose();
        const Matrix3d D =
            rho(round, row.greatest()) * cone_projection_derivative(point.shifted[k], row.friction);
        contacts_.add_to(derivative, k, D * opened);
      }
    }
    add_stiffness(point, derivative);
    return derivative;
  }

 private:
  /// Adds the stiffness of the drives. Most drives of a robot are stops that do not act.
  template <class Matrix>
  void add_stiffness(const Point& point, Matrix& matrix) const {
    for (std::size_t k = 0; k < rows_.drives.size(); ++k) {
      if (point.stiffness[k] != 0.0) {
        drives_.add_to(matrix, k, Matrix1d(point.stiffness[k]));
      }
    }
  }

  [[nodiscard]] static double rho(const Round& round, double response) {
    return response > 0.0 ? round.penalty / response : 0.0;
  }

  /// Adds a contact: projects r - rho (u' + mu |u_t| n) on the cone.
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

  /// Adds a drive: it acts as a spring between bounds. Its energy is the greatest over r between
  /// them of r y / rho - r^2 (compliance + 1 / rho) / 2, with y = r_0 - rho (u - target).
  void add_drive(const Round& round, std::size_t k, Point& point) const {
    const DriveRow& row = rows_.drives[k];
    if (!(row.own > 0.0)) {  // Between two bodies that nothing moves.
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
  std::vector<Vector3d> u_free_;  // [m/s]  u of each contact at x = 0.
};

/// Minimises from a point on. Returns the number of factorisations.
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
    // Where rounding hides the descent, the gradient decides about the whole step.
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

/// Runs Newton's method on the laws with sliding speeds as unknowns (P. Alart, A. Curnier, "A mixed
/// formulation for frictional contact problems prone to Newton like solution methods", Computer
/// Methods in Applied Mechanics and Engineering 92 (1991)). Only steps that make the gradient
/// smaller are taken. Returns the number of factorisations.
int solve_with_sliding(const Lagrangian& lagrangian, double precision, Lagrangian::Round& round,
                       Lagrangian::Point& point) {
  point = lagrangian.with_own_sliding(round, std::move(point.x));
  for (int step = 0; step < kMostSlidingSteps; ++step) {
    const double gradient = point.gradient.norm();
    if (gradient <= precision) {
      return step;
    }
    VectorXd way =
        lagrangian.derivative_with_sliding(round, point).partialPivLu().solve(-point.gradient);
    Lagrangian::Point next = lagrangian.with_own_sliding(round, point.x + way);
    for (int k = 0; k < kMostHalvings && !(next.gradient.norm() < gradient); ++k) {
      way *= 0.5;
      next = lagrangian.with_own_sliding(round, point.x + way);
    }
    if (!(next.gradient.norm() < gradient)) {
      return step + 1;
    }
    point = std::move(next);
  }
  return kMostSlidingSteps;
}

/// Solves a round. With `with_sliding` it tries to find sliding speeds as well. Returns the number
/// of factorisations.
int solve_round(const Lagrangian& lagrangian, double precision, bool with_sliding,
                BlockCholesky& hessian, Lagrangian::Round& round, Lagrangian::Point& point) {
  int factorisations = 0;
  if (with_sliding && point.x.size() <= kMostWithSliding) {
    Lagrangian::Round sliding = round;
    Lagrangian::Point found = point;
    factorisations = solve_with_sliding(lagrangian, precision, sliding, found);
    if (found.gradient.norm() <= precision) {
      round = std::move(sliding);
      point = std::move(found);
      return factorisations;
    }
  }
  return factorisations + minimise(lagrangian, round, precision, hessian, point);
}

/// [1/kg]  The greatest response of all rows.
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

/// A counter of rounds without a residual of half the best one.
class Patience {
 public:
  explicit Patience(int most) : most_(most) {}

  void take(double residual) {
    ++waited_;
    if (residual <= goal_) {
      goal_ = 0.5 * residual;
      waited_ = 0;
    }
  }
  [[nodiscard]] bool waits() const { return waited_ > 0; }
  [[nodiscard]] bool is_over() const { return waited_ >= most_; }

 private:
  int most_;
  int waited_ = 0;
  double goal_ = std::numeric_limits<double>::infinity();
};

class Multipliers {
 public:
  Multipliers(const ContactProblem& problem, const ContactRows& rows,
              const ProjectionOptions& options)
      : problem_(problem),
        rows_(rows),
        options_(options),
        coordinates_(problem, rows),
        hessian_(coordinates_.factorisation()),
        lagrangian_(coordinates_, rows),
        contradiction_(problem, rows, coordinates_),
        per_gradient_(std::sqrt(3.0 * greatest_response(rows))) {}

  void solve(Projection& projection) {
    best_ = projection;
    best_.residual = std::numeric_limits<double>::infinity();
    if (!rows_.drives.empty() && coordinates_.size() <= kMostWithSliding) {
      run_rounds(projection, /*with_sliding=*/true);
    }
    run_rounds(projection, /*with_sliding=*/false);
    if (!is_contradiction_ && coordinates_.size() <= kMostWithSliding) {
      take_turns();
    }
    projection = std::move(best_);
    projection.iterations = factorisations_;
  }

 private:
  [[nodiscard]] bool is_solved() const { return best_.residual <= options_.tolerance; }

  /// Runs rounds of multipliers.
  ///
  /// @param with_sliding  every round has sliding speeds as unknowns; else those that gain little
  void run_rounds(Projection now, bool with_sliding) {
    Lagrangian::Round round;
    Patience patience(kPatience);
    VectorXd x = coordinates_.moved_by(now.impulses);
    for (int k = 0; k < kMostRounds && !is_solved() && !patience.is_over() && !is_contradiction_;
         ++k) {
      set(round, now);
      Lagrangian::Point point = lagrangian_.at(round, std::move(x));
      factorisations_ += solve_round(lagrangian_, precision(point, now.residual),
                                     with_sliding || patience.waits(), hessian_, round, point);
      x = std::move(point.x);
      now = after(std::move(point.next));
      patience.take(now.residual);
      is_contradiction_ = contradiction_.is_shown_by(now.impulses, round.bias, now.velocities);
      round.penalty = std::min(kGreatestPenalty, kPenaltyGrowth * round.penalty);
    }
  }

  /// Alternates sweeps and rounds with sliding speeds as unknowns.
  void take_turns() {
    Projection swept = best_;
    Patience patience(kPatienceOfTurns);
    for (int k = 0; k < kMostTurns && !is_solved() && !patience.is_over(); ++k) {
      project_by_gauss_seidel(problem_, rows_,
                              {.tolerance = options_.tolerance, .sweeps = kSweepsOfTurn}, swept);
      keep(swept);
      run_sliding_rounds(swept);
      patience.take(best_.residual);
    }
  }

  void run_sliding_rounds(Projection now) {
    Lagrangian::Round round;
    round.penalty = kPenaltyOfTurn;
    for (int k = 0; k < kRoundsOfTurn && !is_solved(); ++k) {
      set(round, now);
      Lagrangian::Point point{.x = coordinates_.moved_by(now.impulses)};
      factorisations_ +=
          solve_with_sliding(lagrangian_, precision(point, now.residual), round, point);
      const double before = now.residual;
      now = after(std::move(point.next));
      if (now.residual > 0.5 * before) {
        break;
      }
      round.penalty = std::min(kGreatestPenalty, kPenaltyGrowthInTurn * round.penalty);
    }
  }

  void set(Lagrangian::Round& round, const Projection& now) const {
    round.multipliers = now.impulses;
    round.bias.resize(rows_.contacts.size());
    for (std::size_t k = 0; k < rows_.contacts.size(); ++k) {
      const ContactRow& row = rows_.contacts[k];
      round.bias[k] = row.friction * row.excess_velocity(now.velocities).tail<2>().norm();
    }
  }

  /// The precision of the gradient for a residual. A gradient of 1 changes velocities at a contact
  /// by at most the root of the trace of its response.
  [[nodiscard]] double precision(const Lagrangian::Point& point, double residual) const {
    return std::max({kPartOfTolerance * options_.tolerance / per_gradient_,
                     kPartOfResidual * residual / per_gradient_, 1e-15 * (1.0 + point.x.norm())});
  }

  Projection after(Impulses impulses) {
    Projection now{.velocities = velocities_after(rows_, impulses),
                   .impulses = std::move(impulses)};
    now.residual = greatest_residual(rows_, now.impulses, now.velocities);
    keep(now);
    return now;
  }
  void keep(const Projection& now) {
    if (now.residual < best_.residual) {
      best_ = now;
    }
  }

  const ContactProblem& problem_;
  const ContactRows& rows_;
  const ProjectionOptions& options_;
  MassWhitenedCoordinates coordinates_;
  BlockCholesky hessian_;
  Lagrangian lagrangian_;
  Contradiction contradiction_;
  double per_gradient_;  // [m/s]  Change of a velocity by a gradient of 1.
  Projection best_ = {};
  bool is_contradiction_ = false;
  int factorisations_ = 0;
};

}  // namespace

void project_by_augmented_lagrangian(const ContactProblem& problem, const ContactRows& rows,
                                     const ProjectionOptions& options, Projection& projection) {
  Multipliers(problem, rows, options).solve(projection);
}

}  // namespace firstcontact::detail
