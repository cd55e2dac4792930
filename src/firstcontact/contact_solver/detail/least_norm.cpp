#include <firstcontact/contact_solver/detail/least_norm.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/QR>

#include <firstcontact/contact_solver/detail/constants.h>

namespace firstcontact::detail {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// A contact that may press.
struct Closed {
  std::size_t contact;
  bool presses = true;
  bool slides = false;
  Vector3d direction = Vector3d::UnitX();  // [-]  Of the impulse, where it slides; by its normal.
  double weight = 1.0;                     // [-]  Of friction, where it sticks.

  [[nodiscard]] Index size() const { return slides ? 1 : 3; }
  [[nodiscard]] Matrix3d basis() const {
    return slides ? Matrix3d(direction * Vector3d::UnitX().transpose())
                  : Matrix3d(Vector3d(1.0, weight, weight).asDiagonal());
  }
};

/// The velocity at one contact that an impulse at another one makes.
Matrix3d response(const ContactRow& at, const ContactRow& to) {
  Matrix3d sum = Matrix3d::Zero();
  for (const RowSide& a : at.sides) {
    for (const RowSide& b : to.sides) {
      if (a.at != b.at) {
        continue;
      }
      if (a.is_link() && b.is_link()) {
        sum += a.J_q * b.response_q;
      } else if (!a.is_link() && !b.is_link()) {
        sum += a.J * b.response;
      }
    }
  }
  return sum;
}

class Sharing {
 public:
  Sharing(const ContactRows& rows, double tolerance, const Projection& given)
      : rows_(rows), tolerance_(tolerance), given_(given), now_(given) {
    for (std::size_t k = 0; k < rows.contacts.size(); ++k) {
      const ContactRow& row = rows.contacts[k];
      if (row.greatest() > 0.0 &&
          (given.impulses.contacts[k].any() || !(gap(k) > kMovesOfTolerance * tolerance))) {
        closed_.push_back({.contact = k});
      }
    }
  }

  /// Finds the projection with even shares; nothing where there is none, or no choice.
  std::optional<Projection> find() {
    set_directions();
    if (closed_.size() < 2 || size() > kMostShares) {
      return std::nullopt;
    }
    prepare();
    for (double before = std::numeric_limits<double>::infinity();; before = now_.residual) {
      const std::optional<VectorXd> shares = least_shares(response_to_shares());
      if (!shares) {
        return std::nullopt;
      }
      take(*shares);
      if (now_.residual <= tolerance_) {
        return is_short() ? std::optional(std::move(now_)) : std::nullopt;
      }
      if (!(now_.residual <= kGainOfSharing * before)) {
        return std::nullopt;
      }
      set_weights();
      set_directions();
    }
  }

 private:
  using Decomposition = Eigen::CompleteOrthogonalDecomposition<MatrixXd>;

  /// The number of shares.
  [[nodiscard]] Index size() const {
    Index size = 0;
    for (const Closed& closed : closed_) {
      size += closed.size();
    }
    return size;
  }

  [[nodiscard]] double gap(std::size_t k) const {
    return rows_.contacts[k].excess_velocity(given_.velocities)[0];
  }

  /// Computes the responses, and the velocities without contacts.
  void prepare() {
    const auto size = static_cast<Index>(3 * closed_.size());
    W_.resize(size, size);
    for (std::size_t i = 0; i < closed_.size(); ++i) {
      for (std::size_t j = 0; j < closed_.size(); ++j) {
        W_.block<3, 3>(3 * static_cast<Index>(i), 3 * static_cast<Index>(j)) =
            response(rows_.contacts[closed_[i].contact], rows_.contacts[closed_[j].contact]);
      }
    }
    Impulses others = given_.impulses;
    std::ranges::fill(others.contacts, Vector3d::Zero());
    const VectorXd V = velocities_after(rows_, others);
    u_.resize(size);
    for (std::size_t i = 0; i < closed_.size(); ++i) {
      u_.segment<3>(3 * static_cast<Index>(i)) =
          rows_.contacts[closed_[i].contact].excess_velocity(V);
    }
  }

  /// Lets the impulses of contacts that slide point against their velocities.
  void set_directions() {
    for (Closed& closed : closed_) {
      const ContactRow& row = rows_.contacts[closed.contact];
      const Eigen::Vector2d u_t = row.excess_velocity(now_.velocities).tail<2>();
      closed.slides = row.friction == 0.0 || u_t.norm() > kMovesOfTolerance * tolerance_;
      closed.direction << 1.0, -row.friction * u_t.stableNormalized();
    }
  }

  /// Lets contacts that stick share friction in proportion to their normal impulses.
  void set_weights() {
    double sum = 0.0;
    for (const Closed& closed : closed_) {
      sum += now_.impulses.contacts[closed.contact][0];
    }
    for (Closed& closed : closed_) {
      const double normal = now_.impulses.contacts[closed.contact][0];
      closed.weight = std::sqrt(static_cast<double>(closed_.size()) * normal / sum);
    }
  }

  /// [m/s]  The velocities that impulses have to make.
  [[nodiscard]] VectorXd targets() const {
    VectorXd targets(size());
    Index at = 0;
    for (std::size_t i = 0; i < closed_.size(); ++i) {
      targets.segment(at, closed_[i].size()) =
          -u_.segment(3 * static_cast<Index>(i), closed_[i].size());
      at += closed_[i].size();
    }
    return targets;
  }

  /// Computes the velocities that shares make, also those of contacts that do not press.
  [[nodiscard]] MatrixXd response_to_shares() const {
    MatrixXd A(size(), size());
    Index at = 0;
    for (std::size_t i = 0; i < closed_.size(); ++i) {
      Index from = 0;
      for (std::size_t j = 0; j < closed_.size(); ++j) {
        const Matrix3d block =
            W_.block<3, 3>(3 * static_cast<Index>(i), 3 * static_cast<Index>(j)) *
            closed_[j].basis();
        A.block(at, from, closed_[i].size(), closed_[j].size()) =
            block.topLeftCorner(closed_[i].size(), closed_[j].size());
        from += closed_[j].size();
      }
      at += closed_[i].size();
    }
    return A;
  }

  /// Decomposes the columns of contacts that press; those of others are 0.
  [[nodiscard]] Decomposition decomposed(MatrixXd A) const {
    Index at = 0;
    for (const Closed& closed : closed_) {
      if (!closed.presses) {
        A.middleCols(at, closed.size()).setZero();
      }
      at += closed.size();
    }
    Decomposition decomposition;
    decomposition.setThreshold(kLeastPivotOfSharing);
    decomposition.compute(A);
    return decomposition;
  }

  /// [N s]  Finds the shares of least norm without a contact that pulls, by an active set. It
  /// begins with the present impulses, which do not pull. Nothing where the laws leave no choice.
  std::optional<VectorXd> least_shares(const MatrixXd& A) {
    std::vector<double> normal;
    for (Closed& closed : closed_) {
      closed.presses = true;
      normal.push_back(now_.impulses.contacts[closed.contact][0]);
    }
    for (std::size_t step = 0; step < kStepsOfSharing * closed_.size(); ++step) {
      const Decomposition decomposition = decomposed(A);
      if (!has_choice_ && decomposition.rank() == A.cols()) {
        return std::nullopt;
      }
      has_choice_ = true;
      const VectorXd shares = decomposition.solve(targets());
      const double zero = kZeroShare * shares.cwiseAbs().maxCoeff();
      if (open_pulling(shares, zero, normal)) {
        continue;
      }
      if (std::ranges::all_of(closed_, &Closed::presses)) {
        return shares;
      }
      const MatrixXd inverse = decomposition.pseudoInverse();
      if (!close_wanted(A.transpose() * (inverse.transpose() * shares), zero)) {
        return shares;
      }
    }
    return std::nullopt;
  }

  /// Goes towards the shares until the first contacts would pull, and opens these. Returns whether
  /// there were any.
  bool open_pulling(const VectorXd& shares, double zero, std::vector<double>& normal) {
    std::vector<double> part;  // [-]  Of the way, that each contact allows.
    Index at = 0;
    for (std::size_t i = 0; i < closed_.size(); ++i) {
      const double share = shares[at];
      const bool pulls = closed_[i].presses && share < -zero;
      part.push_back(pulls ? std::max(0.0, normal[i]) / (std::max(0.0, normal[i]) - share) : 1.0);
      at += closed_[i].size();
    }
    const double least = std::ranges::min(part);
    at = 0;
    for (std::size_t i = 0; i < closed_.size(); ++i) {
      normal[i] += least * (shares[at] - normal[i]);
      closed_[i].presses = closed_[i].presses && (part[i] == 1.0 || part[i] > least + kZeroShare);
      at += closed_[i].size();
    }
    return least < 1.0;
  }

  /// Closes the contact that would make the norm least, by the slope of the norm along its impulse.
  /// Returns whether there is one.
  bool close_wanted(const VectorXd& slopes, double zero) {
    Closed* best = nullptr;
    double greatest = zero;
    Index at = 0;
    for (Closed& closed : closed_) {
      if (!closed.presses && slopes[at] > greatest) {
        best = &closed;
        greatest = slopes[at];
      }
      at += closed.size();
    }
    if (best != nullptr) {
      best->presses = true;
    }
    return best != nullptr;
  }

  void take(const VectorXd& shares) {
    std::ranges::fill(now_.impulses.contacts, Vector3d::Zero());
    Index at = 0;
    for (const Closed& closed : closed_) {
      now_.impulses.contacts[closed.contact] =
          closed.basis().leftCols(closed.size()) * shares.segment(at, closed.size());
      at += closed.size();
    }
    now_.velocities = velocities_after(rows_, now_.impulses);
    now_.residual = greatest_residual(rows_, now_.impulses, now_.velocities);
  }

  /// Whether the impulses are about as long as the given ones. Where responses nearly leave a
  /// choice, rounding alone could make great impulses that cancel each other.
  [[nodiscard]] bool is_short() const {
    const auto length = [](const Projection& projection) {
      double sum = 0.0;
      for (const Vector3d& impulse : projection.impulses.contacts) {
        sum += impulse.squaredNorm();
      }
      return std::sqrt(sum);
    };
    return length(now_) <= kMostLengthOfSharing * length(given_);
  }

  const ContactRows& rows_;
  double tolerance_;
  const Projection& given_;
  Projection now_;
  std::vector<Closed> closed_ = {};
  MatrixXd W_ = {};  // [1/kg]
  VectorXd u_ = {};  // [m/s]  Excess velocities without contacts.
  bool has_choice_ = false;
};

}  // namespace

void share_evenly(const ContactRows& rows, double tolerance, Projection& projection) {
  if (rows.contacts.size() < 2 || rows.contacts.size() > kMostToShare) {
    return;
  }
  if (std::optional<Projection> even = Sharing(rows, tolerance, projection).find()) {
    projection = std::move(*even);
  }
}

}  // namespace firstcontact::detail
