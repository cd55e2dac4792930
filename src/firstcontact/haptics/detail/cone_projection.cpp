#include <firstcontact/haptics/detail/cone_projection.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace firstcontact::detail {
namespace {

/// [-]  Square of the length below which the part of a row outside of the active ones counts as 0.
constexpr double kDependent = 1e-18;

/// [-]  Greatest error of s in a solved projection, by the tolerance.
constexpr double kSettled = 1000.0;

/// [rounds]  Most rounds that update s.
constexpr int kRoundsOfSlack = 10;

}  // namespace

ConeProjection::ConeProjection(std::size_t coordinates, std::size_t capacity)
    : n_(coordinates), capacity_(capacity) {
  contacts_.reserve(capacity);
  slack_.reserve(capacity);
  last_slack_.reserve(capacity);
  last_error_.reserve(capacity);
  error_.reserve(capacity);
}

void ConeProjection::clear() noexcept {
  contacts_.clear();
  slack_.clear();
  last_slack_.clear();
  last_error_.clear();
  error_.clear();
  active_count_ = 0;
  factored_ = 0;
}

void ConeProjection::add(const ConeContact& contact) noexcept {
  if (contacts_.size() == capacity_) {
    return;
  }
  contacts_.push_back(contact);
  slack_.push_back(0.0);
  last_slack_.push_back(0.0);
  last_error_.push_back(0.0);
  error_.push_back(0.0);
}

double ConeProjection::dot(const Coordinates& a, const Coordinates& b) const noexcept {
  double sum = 0.0;
  for (std::size_t k = 0; k < n_; ++k) {
    sum += a[k] * b[k];
  }
  return sum;
}

std::array<double, 3> ConeProjection::displacement(const ConeContact& contact,
                                                   const Coordinates& x) const noexcept {
  std::array<double, 3> u{};
  for (std::size_t k = 0; k < 3; ++k) {
    u[k] = dot(contact.rows[k], x) - contact.shift[k];
  }
  return u;
}

void ConeProjection::set_least(Cut& cut) const noexcept {
  const ConeContact& contact = contacts_[cut.contact];
  cut.least = -contact.way - slack_[cut.contact] + contact.shift[0] -
              contact.friction *
                  (cut.direction[0] * contact.shift[1] + cut.direction[1] * contact.shift[2]);
}

ConeProjection::Cut ConeProjection::make_cut(const Violated& violated) const noexcept {
  const ConeContact& contact = contacts_[violated.contact];
  Cut cut{.contact = violated.contact, .direction = violated.direction};
  const double a = contact.friction * violated.direction[0];
  const double b = contact.friction * violated.direction[1];
  for (std::size_t k = 0; k < n_; ++k) {
    cut.row[k] = contact.rows[0][k] - a * contact.rows[1][k] - b * contact.rows[2][k];
  }
  set_least(cut);
  return cut;
}

ConeProjection::Violated ConeProjection::most_violated(const Coordinates& x) const noexcept {
  Violated most;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const ConeContact& contact = contacts_[c];
    if (contact.friction == 0.0) {
      const double by = -(dot(contact.rows[0], x) - contact.shift[0] + contact.way);
      if (by > most.by) {
        most = {c, {}, by};
      }
      continue;
    }
    const std::array<double, 3> u = displacement(contact, x);
    const double slip = std::sqrt(u[1] * u[1] + u[2] * u[2]);
    const double by = -(u[0] + contact.way + slack_[c] - contact.friction * slip);
    if (by > most.by) {
      most = {c, {}, by};
      if (slip > 0.0) {
        most.direction = {u[1] / slip, u[2] / slip};
      }
    }
  }
  return most;
}

/// Computes Cholesky's factor of the products of the active rows. Rows before the first that
/// changed stay.
///
/// @returns  false where they depend on each other
bool ConeProjection::factorise() noexcept {
  for (std::size_t i = factored_; i < active_count_; ++i) {
    factored_ = i;
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = dot(active_[i].row, active_[j].row);
      const double whole = sum;
      for (std::size_t k = 0; k < j; ++k) {
        sum -= factor_[i][k] * factor_[j][k];
      }
      if (i != j) {
        factor_[i][j] = sum / factor_[j][j];
      } else if (sum > kDependent * whole) {
        factor_[i][i] = std::sqrt(sum);
      } else {
        return false;
      }
    }
  }
  factored_ = active_count_;
  return true;
}

void ConeProjection::solve_active(std::array<double, kMostCoordinates>& b) const noexcept {
  for (std::size_t i = 0; i < active_count_; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      b[i] -= factor_[i][k] * b[k];
    }
    b[i] /= factor_[i][i];
  }
  for (std::size_t i = active_count_; i-- > 0;) {
    for (std::size_t k = i + 1; k < active_count_; ++k) {
      b[i] -= factor_[k][i] * b[k];
    }
    b[i] /= factor_[i][i];
  }
}

void ConeProjection::remove(std::size_t k) noexcept {
  for (std::size_t i = k + 1; i < active_count_; ++i) {
    active_[i - 1] = active_[i];
  }
  --active_count_;
  factored_ = std::min(factored_, k);
}

/// Starts where the active half spaces are met with equality; those that would pull are dropped.
void ConeProjection::restart(const Coordinates& x_free) noexcept {
  for (std::size_t k = 0; k < active_count_; ++k) {
    set_least(active_[k]);
  }
  std::array<double, kMostCoordinates> impulses{};
  while (active_count_ > 0) {
    if (!factorise()) {
      remove(active_count_ - 1);
      continue;
    }
    for (std::size_t k = 0; k < active_count_; ++k) {
      impulses[k] = active_[k].least - dot(active_[k].row, x_free);
    }
    solve_active(impulses);
    const auto end = impulses.begin() + static_cast<std::ptrdiff_t>(active_count_);
    const auto least = std::min_element(impulses.begin(), end);
    if (*least > 0.0) {
      break;
    }
    remove(static_cast<std::size_t>(least - impulses.begin()));
  }
  x_ = x_free;
  for (std::size_t k = 0; k < active_count_; ++k) {
    active_[k].impulse = impulses[k];
    for (std::size_t i = 0; i < n_; ++i) {
      x_[i] += impulses[k] * active_[k].row[i];
    }
  }
}

/// Adds a half space that is violated, and drops those that would pull.
///
/// @returns  false where none can be dropped, so that no displacement meets all
bool ConeProjection::add_cut(Cut cut, int most_pivots) noexcept {
  const double length = dot(cut.row, cut.row);
  while (pivots_++ < most_pivots) {
    if (!factorise()) {
      return false;
    }
    std::array<double, kMostCoordinates> share{};
    for (std::size_t k = 0; k < active_count_; ++k) {
      share[k] = dot(active_[k].row, cut.row);
    }
    solve_active(share);
    Coordinates apart = cut.row;
    for (std::size_t k = 0; k < active_count_; ++k) {
      for (std::size_t i = 0; i < n_; ++i) {
        apart[i] -= share[k] * active_[k].row[i];
      }
    }
    constexpr double kNever = std::numeric_limits<double>::infinity();
    double until_dropped = kNever;
    std::size_t dropped = 0;
    for (std::size_t k = 0; k < active_count_; ++k) {
      if (share[k] > 0.0 && active_[k].impulse < until_dropped * share[k]) {
        until_dropped = active_[k].impulse / share[k];
        dropped = k;
      }
    }
    const double gain = dot(apart, cut.row);
    const bool is_full = active_count_ == n_ || !(gain > kDependent * length);
    const double until_met = is_full ? kNever : (cut.least - dot(cut.row, x_)) / gain;
    const double step = std::min(until_dropped, until_met);
    if (!(step < kNever)) {
      return false;
    }
    cut.impulse += step;
    for (std::size_t k = 0; k < active_count_; ++k) {
      active_[k].impulse = std::max(0.0, active_[k].impulse - step * share[k]);
    }
    if (!is_full) {
      for (std::size_t i = 0; i < n_; ++i) {
        x_[i] += step * apart[i];
      }
    }
    if (until_met <= until_dropped) {
      active_[active_count_++] = cut;
      return true;
    }
    remove(dropped);
  }
  return false;
}

bool ConeProjection::satisfy_all(double tolerance, int most_pivots) noexcept {
  while (true) {
    const Violated most = most_violated(x_);
    if (!(most.by > tolerance)) {
      return true;
    }
    if (pivots_ >= most_pivots || !add_cut(make_cut(most), most_pivots)) {
      return false;
    }
  }
}

/// Moves s of each contact towards mu |u_t|.
///
/// @returns  [m]  the greatest error of s before
double ConeProjection::renew_slacks() noexcept {
  double off = 0.0;
  double product = 0.0;
  double square = 0.0;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const std::array<double, 3> u = displacement(contacts_[c], x_);
    error_[c] = contacts_[c].friction * std::sqrt(u[1] * u[1] + u[2] * u[2]) - slack_[c];
    off = std::max(off, std::abs(error_[c]));
    const double change = error_[c] - last_error_[c];
    product += error_[c] * change;
    square += change * change;
  }
  const double part = has_last_ && square > 0.0 ? std::clamp(product / square, -4.0, 4.0) : 0.0;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const double now = slack_[c];
    const double next = now + error_[c];
    const double before = last_slack_[c] + last_error_[c];
    slack_[c] = std::max(0.0, next - part * (next - before));
    last_slack_[c] = now;
    last_error_[c] = error_[c];
  }
  has_last_ = true;
  return off;
}

ConeProjectionResult ConeProjection::project(const Coordinates& x_free, double tolerance,
                                             int most_pivots) noexcept {
  const bool has_friction = std::ranges::any_of(
      contacts_, [](const ConeContact& contact) { return contact.friction > 0.0; });
  pivots_ = 0;
  has_last_ = false;
  ConeProjectionResult result;
  for (int round = 0; round < (has_friction ? kRoundsOfSlack : 1); ++round) {
    restart(x_free);
    result.is_solved = satisfy_all(tolerance, most_pivots);
    if (!result.is_solved || !has_friction) {
      break;
    }
    const double off = renew_slacks();
    result.is_solved = off <= kSettled * tolerance;
    if (off <= tolerance) {
      break;
    }
  }
  for (std::size_t k = 0; k < active_count_; ++k) {
    const bool is_first =
        std::none_of(active_.begin(), active_.begin() + static_cast<std::ptrdiff_t>(k),
                     [&](const Cut& other) { return other.contact == active_[k].contact; });
    result.pressing += is_first ? 1 : 0;
    for (std::size_t i = 0; i < n_; ++i) {
      result.force[i] += active_[k].impulse * active_[k].row[i];
    }
  }
  for (std::size_t i = 0; i < n_; ++i) {
    result.x[i] = x_free[i] + result.force[i];
  }
  result.pivots = pivots_;
  return result;
}

bool ConeProjection::presses_on(std::size_t first, std::size_t count, const Coordinates& x_free,
                                double tolerance) const noexcept {
  const auto moves = [&](const Coordinates& row) {
    return std::any_of(row.begin() + static_cast<std::ptrdiff_t>(first),
                       row.begin() + static_cast<std::ptrdiff_t>(first + count),
                       [](double part) { return part != 0.0; });
  };
  return std::any_of(active_.begin(), active_.begin() + static_cast<std::ptrdiff_t>(active_count_),
                     [&](const Cut& cut) { return moves(cut.row); }) ||
         std::ranges::any_of(contacts_, [&](const ConeContact& contact) {
           const double gap = dot(contact.rows[0], x_free) - contact.shift[0] + contact.way;
           return gap < -tolerance && moves(contact.rows[0]);
         });
}

std::array<double, 3> ConeProjection::impulse(std::size_t contact) const noexcept {
  std::array<double, 3> sum{};
  for (std::size_t k = 0; k < active_count_; ++k) {
    if (active_[k].contact == contact) {
      sum[0] += active_[k].impulse;
      const double edge = contacts_[contact].friction * active_[k].impulse;
      sum[1] -= edge * active_[k].direction[0];
      sum[2] -= edge * active_[k].direction[1];
    }
  }
  return sum;
}

}  // namespace firstcontact::detail
