#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <firstcontact/dynamics/detail/block_cholesky.h>
#include <firstcontact/dynamics/detail/contact_rows.h>
#include <firstcontact/dynamics/detail/coulomb_cone.h>

namespace firstcontact::detail {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr int kMostRounds = 300;      // Of multipliers.
constexpr int kPatience = 8;          // Rounds without a residual of half the best one.
constexpr int kMostNewtonSteps = 40;  // In a round.
constexpr double kFirstPenalty = 1e2;
constexpr double kGreatestPenalty = 1e5;
constexpr double kPenaltyGrowth = 4.0;
/// How exactly a round is solved: in parts of the residual before it, at last of the tolerance.
constexpr double kPartOfResidual = 0.01;
constexpr double kPartOfTolerance = 1e-3;

/// A square root S of the inverse inertia, S S^T = M^-1; columns of locked axes are zero.
Matrix6d square_root(const InverseInertia& inverse) {
  Matrix6d S = Matrix6d::Zero();
  S.topLeftCorner<3, 3>() = inverse.mass.cwiseSqrt().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(inverse.rotation);
  S.bottomRightCorner<3, 3>() =
      eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  return S;
}

/// The same of a mechanism: with M^-1 = L L^T, S = L, and columns of zeros up to whole blocks.
MatrixXd square_root(const MatrixXd& inverse_mass) {
  const Index n = inverse_mass.rows();
  MatrixXd S = MatrixXd::Zero(n, (n + 5) / 6 * 6);
  S.leftCols(n) = inverse_mass.llt().matrixL();
  return S;
}

/// What moves by itself: V = V_free + S x for its velocities and its part of x.
struct Part {
  Index in_V;
  Index in_x;
  MatrixXd root;  // S
};

std::vector<Part> parts(const ContactProblem& problem, const VelocityLayout& layout) {
  std::vector<Part> parts;
  Index size = 0;
  const auto add = [&](Index in_V, MatrixXd root) {
    parts.push_back({in_V, size, std::move(root)});
    size += parts.back().root.cols();
  };
  for (std::size_t b = 0; b < problem.bodies.size(); ++b) {
    const InverseInertia& inverse = problem.bodies[b].inverse_inertia;
    if (!problem.bodies[b].link && (inverse.mass.any() || inverse.rotation.any())) {
      add(layout.body[b], square_root(inverse));
    }
  }
  for (std::size_t m = 0; m < problem.mechanisms.size(); ++m) {
    add(layout.mechanism[m], square_root(problem.mechanisms[m].inverse_mass));
  }
  return parts;
}

/// How x moves contacts or drives, in blocks of six.
template <int rows>
class BlockRows {
 public:
  using Jacobian = Eigen::Matrix<double, rows, 6>;
  struct Entry {
    Index in_x;
    Jacobian G;
  };

  void add_row() { first_.push_back(entries_.size()); }
  /// To the last row.
  template <class Derived>
  void add(Index in_x, const Eigen::MatrixBase<Derived>& G) {
    for (Index k = 0; k < G.cols(); k += 6) {
      entries_.push_back({in_x + k, G.template middleCols<6>(k)});
    }
    first_.back() = entries_.size();
  }
  [[nodiscard]] std::span<const Entry> of(std::size_t row) const {
    return {entries_.data() + first_[row], entries_.data() + first_[row + 1]};
  }
  void list_pairs(std::vector<std::array<std::size_t, 2>>& pairs) const {
    for (std::size_t row = 0; row + 1 < first_.size(); ++row) {
      for_each_pair(row, [&](const Entry& a, const Entry& b) {
        pairs.push_back({block(a), block(b)});
      });
    }
  }
  void find_places(const BlockCholesky& hessian) {
    for (std::size_t row = 0; row + 1 < first_.size(); ++row) {
      first_place_.push_back(places_.size());
      for_each_pair(row, [&](const Entry& a, const Entry& b) {
        places_.push_back(hessian.place(block(a), block(b)));
      });
    }
  }

  /// Adds G^T D G.
  void add_to(BlockCholesky& hessian, std::size_t row,
              const Eigen::Matrix<double, rows, rows>& D) const {
    std::size_t place = first_place_[row];
    for_each_pair(row, [&](const Entry& a, const Entry& b) {
      const BlockCholesky::Place& at = places_[place++];
      if (at.is_turned) {
        hessian.at(at).noalias() += b.G.transpose() * (D * a.G);
      } else {
        hessian.at(at).noalias() += a.G.transpose() * (D * b.G);
      }
    });
  }

 private:
  static std::size_t block(const Entry& entry) { return static_cast<std::size_t>(entry.in_x / 6); }
  template <class Use>
  void for_each_pair(std::size_t row, const Use& use) const {
    const auto entries = of(row);
    for (std::size_t a = 0; a < entries.size(); ++a) {
      for (std::size_t b = a; b < entries.size(); ++b) {
        use(entries[a], entries[b]);
      }
    }
  }

  std::vector<Entry> entries_;
  std::vector<std::size_t> first_ = {0};  // Of each row in entries_, and the end.
  std::vector<BlockCholesky::Place> places_;
  std::vector<std::size_t> first_place_;
};

/// The augmented Lagrangian over x, with V = V_free + S x for each body and mechanism: its metric
/// is then |x|^2, and bodies that nothing moves fall out.
class Lagrangian {
 public:
  Lagrangian(const ContactProblem& problem, const ContactRows& rows)
      : rows_(rows), parts_(parts(problem, rows.layout)) {
    for (const Part& part : parts_) {
      size_ += part.root.cols();
    }
    part_at_.assign(static_cast<std::size_t>(rows.layout.size), nullptr);
    for (const Part& part : parts_) {
      part_at_[static_cast<std::size_t>(part.in_V)] = &part;
    }
    for (const ContactRow& row : rows.contacts) {
      contacts_.add_row();
      for (const RowSide& side : row.sides) {
        add_side(side);
      }
      u_free_.push_back(row.excess_velocity(rows.free_velocities));
    }
    for (const DriveRow& row : rows.drives) {
      drives_.add_row();
      const Part& part = *part_of(row.at);
      drives_.add(part.in_x, part.root.row(row.place - row.at));
    }
  }

  [[nodiscard]] Index size() const { return size_; }

  /// For all Hessians.
  [[nodiscard]] BlockCholesky factorisation() {
    std::vector<std::array<std::size_t, 2>> pairs;
    contacts_.list_pairs(pairs);
    drives_.list_pairs(pairs);
    BlockCholesky hessian(static_cast<std::size_t>(size_ / 6), pairs);
    contacts_.find_places(hessian);
    drives_.find_places(hessian);
    return hessian;
  }

  [[nodiscard]] VectorXd velocities_at(const VectorXd& x) const {
    VectorXd V = rows_.free_velocities;
    for (const Part& part : parts_) {
      V.segment(part.in_V, part.root.rows()) += part.root * x.segment(part.in_x, part.root.cols());
    }
    return V;
  }

  /// What impulses do: x with V(x) = V_free + M^-1 J^T r.
  [[nodiscard]] VectorXd moved_by(const Impulses& impulses) const {
    VectorXd x = VectorXd::Zero(size_);
    for (std::size_t k = 0; k < rows_.contacts.size(); ++k) {
      for (const auto& entry : contacts_.of(k)) {
        x.segment<6>(entry.in_x) += entry.G.transpose() * impulses.contacts[k];
      }
    }
    for (std::size_t k = 0; k < rows_.drives.size(); ++k) {
      for (const auto& entry : drives_.of(k)) {
        x.segment<6>(entry.in_x) += entry.G.transpose() * impulses.drives[k];
      }
    }
    return x;
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
      drives_.add_to(hessian, k, Eigen::Matrix<double, 1, 1>(point.stiffness[k]));
    }
  }

 private:
  /// Null of what nothing moves.
  [[nodiscard]] const Part* part_of(Index in_V) const {
    return part_at_[static_cast<std::size_t>(in_V)];
  }

  void add_side(const RowSide& side) {
    const Part* part = part_of(side.at);
    const bool is_there = side.is_link() || side.J.any();  // Two links may be one side.
    if (part != nullptr && is_there) {
      contacts_.add(part->in_x, side.is_link() ? Eigen::Matrix3Xd(side.J_q * part->root)
                                               : Eigen::Matrix3Xd(side.J * part->root));
    }
  }

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
    Vector3d u = u_free_[k];
    u[0] += round.bias[k];
    for (const auto& entry : contacts_.of(k)) {
      u += entry.G * point.x.segment<6>(entry.in_x);
    }
    const double rho = this->rho(round, row.greatest());
    point.shifted.emplace_back(round.multipliers.contacts[k] - rho * u);
    const Vector3d r = project_on_cone(point.shifted.back(), row.friction);
    point.next.contacts.push_back(r);
    point.value += r.squaredNorm() / (2.0 * rho);
    for (const auto& entry : contacts_.of(k)) {
      point.gradient.segment<6>(entry.in_x) -= entry.G.transpose() * r;
    }
  }

  /// A drive answers as a spring between bounds. Its energy is the greatest over r between them of
  /// r y / rho - r^2 (compliance + 1 / rho) / 2, with y = r_0 - rho (u - target).
  void add_drive(const Round& round, std::size_t k, Point& point) const {
    const DriveRow& row = rows_.drives[k];
    double u = rows_.free_velocities[row.place];
    for (const auto& entry : drives_.of(k)) {
      u += entry.G.dot(point.x.segment<6>(entry.in_x));
    }
    const double rho = round.penalty / row.own;
    const double y = round.multipliers.drives[k] - rho * (u - row.target);
    const double soft = 1.0 + rho * row.compliance;
    const double r = std::clamp(y / soft, row.least, row.greatest);
    point.next.drives.push_back(r);
    point.stiffness.push_back(r == y / soft ? rho / soft : 0.0);
    point.value += (r * y - 0.5 * r * r * soft) / rho;
    for (const auto& entry : drives_.of(k)) {
      point.gradient.segment<6>(entry.in_x) -= r * entry.G.transpose();
    }
  }

  const ContactRows& rows_;
  std::vector<Part> parts_;
  std::vector<const Part*> part_at_;  // Where its velocities begin.
  std::vector<Vector3d> u_free_;      // [m/s]  Of contacts, at x = 0.
  BlockRows<3> contacts_;
  BlockRows<1> drives_;
  Index size_ = 0;
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

void project_in_motion_space(const ContactProblem& problem, const ContactRows& rows,
                             const ProjectionOptions& options, Projection& projection) {
  Lagrangian lagrangian(problem, rows);
  BlockCholesky hessian = lagrangian.factorisation();
  Lagrangian::Round round;
  round.multipliers = projection.impulses;
  round.bias.assign(rows.contacts.size(), 0.0);
  VectorXd x = lagrangian.moved_by(projection.impulses);
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
      round.bias[i] = row.friction * row.velocity(V).tail<2>().norm();
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
