#include <firstcontact/contact_solver/detail/interior_point.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/contact_solver/detail/block_cholesky.h>
#include <firstcontact/contact_solver/detail/contact_rows.h>
#include <firstcontact/contact_solver/detail/mass_whitened_coordinates.h>
#include <firstcontact/contact_solver/detail/projected_gauss_seidel.h>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kSweeps = 20;  // Sweeps after each round.
// [-]  Fall of the residual in a round; a smaller fall ends the rounds.
constexpr double kFall = 0.7;
constexpr int kMostSteps = 40;
constexpr double kConvexTolerance = 5.0;  // Multiple of the tolerance; sweeps follow.
constexpr int kPatience = 5;              // Steps without a residual of half the best one.

/// Fraction of the sliding speeds that is taken. Where one is too small the contact opens; where it
/// is too great the bodies would come nearer.
constexpr double kShareOfSliding = 0.95;

constexpr double kRounding = 1e-12;  // [-]  Rounding of a discriminant.

/// [-]  A shorter step is replaced by one back to the middle of the cones.
constexpr double kShortStep = 0.1;
constexpr double kLeastStep = 1e-4;  // [-]  A shorter step ends the search.
// Fraction of the way to the side of a cone that a step may go.
constexpr double kShareOfWay = 0.99;

/// The least complementarity as a fraction of the work of the velocities' error. With less, near
/// the sides of its cones, a step could not make up for that error.
constexpr double kPartOfMissing = 0.1;

/// The least complementarity after one step, as a fraction of the one before. With less, the
/// equations would have no digits left.
constexpr double kGreatestFall = 0.001;

/// The least complementarity of all, as a fraction of that at the tolerance.
constexpr double kShareOfTolerance = 0.25;

/// Computes y_0^2 - |y_t|^2.
double determinant(const Vector3d& y) {
  const double t = y.tail<2>().norm();
  return (y[0] - t) * (y[0] + t);
}

/// Computes J y, the tangents reversed.
Vector3d mirrored(const Vector3d& y) { return {y[0], -y[1], -y[2]}; }

/// The product and the quotient of the cone's algebra.
Vector3d product(const Vector3d& a, const Vector3d& b) {
  Vector3d ab;
  ab[0] = a.dot(b);
  ab.tail<2>() = a[0] * b.tail<2>() + b[0] * a.tail<2>();
  return ab;
}
Vector3d quotient(const Vector3d& d, const Vector3d& by) {
  Vector3d q;
  q[0] = by.dot(mirrored(d)) / determinant(by);
  q.tail<2>() = (d.tail<2>() - q[0] * by.tail<2>()) / by[0];
  return q;
}

/// Finds the length of the step dy for which y stays in the cone.
double way_inside(const Vector3d& y, const Vector3d& dy) {
  const double a = determinant(dy);
  const double b = y.dot(mirrored(dy));
  const double c = determinant(y);
  const double root = b * b - a * c;
  if (root < -kRounding * b * b) {
    return std::numeric_limits<double>::infinity();
  }
  const double divisor = std::sqrt(std::max(0.0, root)) - b;
  return divisor > 0.0 ? c / divisor : std::numeric_limits<double>::infinity();
}

/// The scaling of Nesterov and Todd: W z = W^-1 y.
struct Scaling {
  Scaling(const Vector3d& y, const Vector3d& z) {
    const double det_y = determinant(y);
    const double det_z = determinant(z);
    const Vector3d y_1 = y / std::sqrt(det_y);
    const Vector3d z_1 = z / std::sqrt(det_z);
    const double gamma = std::sqrt(0.5 * (1.0 + y_1.dot(z_1)));
    const Vector3d w = (y_1 + mirrored(z_1)) / (2.0 * gamma);
    const double eta = std::sqrt(std::sqrt(det_y / det_z));
    Matrix3d W_1;
    W_1(0, 0) = w[0];
    W_1.block<1, 2>(0, 1) = w.tail<2>().transpose();
    W_1.block<2, 1>(1, 0) = w.tail<2>();
    W_1.block<2, 2>(1, 1) =
        Eigen::Matrix2d::Identity() + w.tail<2>() * w.tail<2>().transpose() / (1.0 + w[0]);
    W = eta * W_1;
    inverse = W_1;
    inverse.block<1, 2>(0, 1) *= -1.0;
    inverse.block<2, 1>(1, 0) *= -1.0;
    inverse /= eta;
    point = W * z;
  }

  Matrix3d W;
  Matrix3d inverse;
  Vector3d point;  // Lambda, the scaled point of both.
};

class InteriorPoint {
 public:
  InteriorPoint(const ContactProblem& problem, const ContactRows& rows)
      : problem_(problem),
        rows_(rows),
        coordinates_(problem, rows),
        matrix_(coordinates_.factorisation()) {
    add_contacts();
  }

  void solve(const ProjectionOptions& options, Projection& projection) {
    VectorXd V = projection.velocities;
    double last = std::numeric_limits<double>::infinity();
    int steps = 0;
    for (int round = 0; round < options.rounds; ++round) {
      set_sliding(V);
      steps += solve_convex(options);
      Projection swept{.impulses = impulses()};
      swept.velocities = velocities_after(rows_, swept.impulses);
      swept.residual = greatest_residual(rows_, swept.impulses, swept.velocities);
      project_by_gauss_seidel(problem_, rows_, {.tolerance = options.tolerance, .sweeps = kSweeps},
                              swept);
      V = swept.velocities;
      const double residual = swept.residual;
      if (residual < projection.residual) {
        projection = std::move(swept);
      }
      if (residual <= options.tolerance || residual > kFall * last) {
        break;
      }
      last = residual;
    }
    projection.iterations = steps;
  }

 private:
  /// A contact in the rounds. P = diag(1, mu, mu) maps Coulomb's cone to that of Lorentz, its own
  /// dual.
  struct Contact {
    std::size_t row;
    Vector3d u_free;                // [m/s]  At x = 0, without the least normal velocity.
    Vector3d scale;                 // P
    double sliding = 0.0;           // [m/s]  mu |u_t|, as it is fixed for the round.
    Vector3d y = Vector3d::Zero();  // [m/s]  P u + sliding n
    Vector3d z = Vector3d::Zero();  // [N s]  P^-1 r
    // Data of a step.
    Scaling scaling = Scaling(Vector3d::UnitX(), Vector3d::UnitX());
    Vector3d missing = Vector3d::Zero();  // [m/s]  P u + sliding n - y
    Vector3d dy = Vector3d::Zero();
    Vector3d dz = Vector3d::Zero();
  };

  void add_contacts() {
    for (std::size_t k = 0; k < rows_.contacts.size(); ++k) {
      const ContactRow& row = rows_.contacts[k];
      if (row.greatest() > 0.0) {
        contacts_.push_back({.row = k,
                             .u_free = row.excess_velocity(rows_.free_velocities),
                             .scale = {1.0, row.friction, row.friction}});
      }
    }
  }

  void set_sliding(const VectorXd& V) {
    for (Contact& contact : contacts_) {
      const ContactRow& row = rows_.contacts[contact.row];
      contact.sliding = kShareOfSliding * row.friction * row.excess_velocity(V).tail<2>().norm();
    }
  }

  /// [1/kg]  The least normal response of one side of a contact.
  [[nodiscard]] double heaviest_response() const {
    double least = std::numeric_limits<double>::infinity();
    for (const Contact& contact : contacts_) {
      for (const RowSide& side : rows_.contacts[contact.row].sides) {
        const double own = side.is_link() ? side.J_q.row(0).dot(side.response_q.col(0))
                                          : side.J.row(0).dot(side.response.col(0));
        least = own > 0.0 ? std::min(least, own) : least;
      }
    }
    return least;
  }

  /// Starts in the middle of the cones, with impulses that would stop the heaviest body. From great
  /// impulses steps are long. Small ones could grow only slowly where light bodies bear heavy ones.
  void start(const ProjectionOptions& options) {
    x_ = VectorXd::Zero(coordinates_.size());
    double fastest = std::numeric_limits<double>::min();
    double response = std::numeric_limits<double>::min();
    for (const Contact& contact : contacts_) {
      fastest = std::max(fastest, contact.u_free.cwiseAbs().maxCoeff());
      response = std::max(response, rows_.contacts[contact.row].greatest());
    }
    const double impulse = fastest / std::min(response, heaviest_response());
    for (Contact& contact : contacts_) {
      contact.y = fastest * Vector3d::UnitX();
      contact.z = impulse * Vector3d::UnitX();
    }
    least_complementarity_ = kShareOfTolerance * options.tolerance * options.tolerance / response;
  }

  /// Solves the problem with these sliding speeds. Returns the number of steps.
  int solve_convex(const ProjectionOptions& options) {
    start(options);
    // Residual that the next steps have to reach.
    double goal = std::numeric_limits<double>::infinity();
    int waited = 0;
    int steps = 0;
    for (; steps < kMostSteps && waited < kPatience; ++steps) {
      find_missing();
      const double residual = convex_residual();
      ++waited;
      if (residual <= goal) {
        goal = 0.5 * residual;
        waited = 0;
      }
      if (residual <= kConvexTolerance * options.tolerance || !(advance() > kLeastStep)) {
        break;
      }
    }
    return steps;
  }

  void find_missing() {
    for (Contact& contact : contacts_) {
      const Vector3d u = contact.u_free + coordinates_.contacts().times(contact.row, x_);
      contact.missing = contact.scale.cwiseProduct(u) - contact.y;
      contact.missing[0] += contact.sliding;
    }
  }

  /// [m/s]  The residual as in contact_residual(), with these sliding speeds.
  [[nodiscard]] double convex_residual() const {
    const VectorXd x = coordinates_.moved_by(impulses());
    double greatest = 0.0;
    for (const Contact& contact : contacts_) {
      const ContactRow& row = rows_.contacts[contact.row];
      Vector3d u = contact.u_free + coordinates_.contacts().times(contact.row, x);
      u[0] += contact.sliding;
      const Vector3d r = contact.scale.cwiseProduct(contact.z);
      const Vector3d change = r - project_on_cone(r - u / row.greatest(), row.friction);
      greatest = std::max(greatest, change.norm() * row.greatest());
    }
    return greatest;
  }

  [[nodiscard]] Impulses impulses() const {
    Impulses impulses{.contacts = std::vector<Vector3d>(rows_.contacts.size(), Vector3d::Zero()),
                      .drives = std::vector<double>(rows_.drives.size(), 0.0)};
    for (const Contact& contact : contacts_) {
      impulses.contacts[contact.row] = contact.scale.cwiseProduct(contact.z);
    }
    return impulses;
  }

  /// [J]  The mean complementarity of the contacts.
  [[nodiscard]] double complementarity() const {
    double sum = 0.0;
    for (const Contact& contact : contacts_) {
      sum += contact.y.dot(contact.z);
    }
    return sum / static_cast<double>(contacts_.size());
  }
  [[nodiscard]] double missing_work() const {
    double sum = 0.0;
    for (const Contact& contact : contacts_) {
      sum += contact.missing.norm() * contact.z[0];
    }
    return sum / static_cast<double>(contacts_.size());
  }

  void factorise() {
    matrix_.set_identity();
    for (Contact& contact : contacts_) {
      contact.scaling = Scaling(contact.y, contact.z);
      const Matrix3d& W_inverse = contact.scaling.inverse;
      const Matrix3d W_inverse_P = W_inverse * contact.scale.asDiagonal();
      coordinates_.contacts().add_to(matrix_, contact.row, W_inverse_P.transpose() * W_inverse_P);
    }
    matrix_.factorise();
  }

  /// Finds Newton's step to x = G^T r, P u + sliding n = y, and W dz + W^-1 dy = wanted for each
  /// contact. Returns dx.
  template <class Wanted>
  VectorXd find_step(const Wanted& wanted) {
    const BlockRows<3>& G = coordinates_.contacts();
    VectorXd right = -x_;
    for (Contact& contact : contacts_) {
      const Matrix3d& W_inverse = contact.scaling.inverse;
      contact.dz = W_inverse * (wanted(contact) - W_inverse * contact.missing);
      G.add_transposed(contact.row, contact.scale.cwiseProduct(contact.z + contact.dz), right);
    }
    VectorXd dx = matrix_.solve(right);
    for (Contact& contact : contacts_) {
      const Matrix3d& W_inverse = contact.scaling.inverse;
      const Vector3d dy = contact.scale.cwiseProduct(G.times(contact.row, dx));
      contact.dy = dy + contact.missing;
      contact.dz -= W_inverse * (W_inverse * dy);
    }
    return dx;
  }

  [[nodiscard]] double step_length() const {
    double length = std::numeric_limits<double>::infinity();
    for (const Contact& contact : contacts_) {
      length =
          std::min({length, way_inside(contact.y, contact.dy), way_inside(contact.z, contact.dz)});
    }
    return length;
  }

  /// Makes a step: predicts it, and corrects by the predicted second order. Returns its length.
  double advance() {
    factorise();
    find_step([](const Contact& contact) { return Vector3d(-contact.scaling.point); });
    const double left = 1.0 - std::min(1.0, step_length());
    const double now = complementarity();
    const double target =
        std::max({least_complementarity_, left * left * left * now,
                  std::min(now, std::max(kGreatestFall * now, kPartOfMissing * missing_work()))});
    VectorXd dx = find_step([&](const Contact& contact) {
      const Scaling& scaling = contact.scaling;
      const Vector3d second = product(scaling.inverse * contact.dy, scaling.W * contact.dz);
      return quotient(target * Vector3d::UnitX() - product(scaling.point, scaling.point) - second,
                      scaling.point);
    });
    double length = std::min(1.0, kShareOfWay * step_length());
    if (length < kShortStep) {
      dx = find_step([&](const Contact& contact) {
        const Vector3d& point = contact.scaling.point;
        return quotient(now * Vector3d::UnitX() - product(point, point), point);
      });
      length = std::min(1.0, kShareOfWay * step_length());
    }
    x_ += length * dx;
    for (Contact& contact : contacts_) {
      contact.y += length * contact.dy;
      contact.z += length * contact.dz;
    }
    return length;
  }

  const ContactProblem& problem_;
  const ContactRows& rows_;
  MassWhitenedCoordinates coordinates_;
  BlockCholesky matrix_;
  double least_complementarity_ = 0.0;  // [J]
  VectorXd x_;
  std::vector<Contact> contacts_;
};

}  // namespace

void project_by_interior_point(const ContactProblem& problem, const ContactRows& rows,
                               const ProjectionOptions& options, Projection& projection) {
  InteriorPoint(problem, rows).solve(options, projection);
}

}  // namespace firstcontact::detail
