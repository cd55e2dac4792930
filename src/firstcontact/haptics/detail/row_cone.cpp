#include <firstcontact/haptics/detail/row_cone.h>

#include <algorithm>
#include <cmath>

namespace firstcontact::detail {
namespace {

/// [pivots]  Most rows that are added in one search.
constexpr int kMostAdded = 60;

/// [-]  Product with the rest above which a unit row is worth adding.
constexpr double kWorth = 1e-12;

/// [-]  Square of the part of a unit row outside of the active ones below which it depends on them.
constexpr double kDependent = 1e-18;

}  // namespace

void RowCone::add(const Coordinates& row) {
  rows_.insert(rows_.end(), row.begin(), row.begin() + static_cast<std::ptrdiff_t>(n_));
}

double RowCone::product(const double* a, const double* b) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < n_; ++k) {
    sum += a[k] * b[k];
  }
  return sum;
}

/// Finds the shares of the active rows whose sum is nearest to a row, by Cholesky's factor.
///
/// @returns  false where the rows depend on each other
bool RowCone::solve(const Coordinates& row) {
  const std::size_t count = active_.size();
  wanted_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = product(row_at(active_[i]), row_at(active_[j]));
      for (std::size_t k = 0; k < j; ++k) {
        sum -= factor_[i][k] * factor_[j][k];
      }
      if (i == j && !(sum > kDependent)) {
        return false;
      }
      factor_[i][j] = i == j ? std::sqrt(sum) : sum / factor_[j][j];
    }
    double sum = product(row_at(active_[i]), row.data());
    for (std::size_t k = 0; k < i; ++k) {
      sum -= factor_[i][k] * wanted_[k];
    }
    wanted_[i] = sum / factor_[i][i];
  }
  for (std::size_t i = count; i-- > 0;) {
    for (std::size_t k = i + 1; k < count; ++k) {
      wanted_[i] -= factor_[k][i] * wanted_[k];
    }
    wanted_[i] /= factor_[i][i];
  }
  return true;
}

/// Moves the shares to those that solve() finds, and drops rows whose share would be negative.
bool RowCone::meet(const Coordinates& row) {
  while (true) {
    if (!solve(row)) {
      return false;
    }
    double part = 1.0;
    for (std::size_t k = 0; k < active_.size(); ++k) {
      if (!(wanted_[k] > 0.0)) {
        part = std::min(part, shares_[k] / (shares_[k] - wanted_[k]));
      }
    }
    for (std::size_t k = 0; k < active_.size(); ++k) {
      shares_[k] += part * (wanted_[k] - shares_[k]);
    }
    if (!(part < 1.0)) {
      return true;
    }
    std::size_t kept = 0;
    for (std::size_t k = 0; k < active_.size(); ++k) {
      if (shares_[k] > 0.0 && (wanted_[k] > 0.0 || shares_[k] > 1e-15)) {
        active_[kept] = active_[k];
        shares_[kept++] = shares_[k];
      }
    }
    active_.resize(kept);
    shares_.resize(kept);
  }
}

void RowCone::measure(const Coordinates& row) {
  std::copy(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(n_), rest_.begin());
  for (std::size_t k = 0; k < active_.size(); ++k) {
    const double* active = row_at(active_[k]);
    for (std::size_t i = 0; i < n_; ++i) {
      rest_[i] -= shares_[k] * active[i];
    }
  }
}

bool RowCone::is_near(const Coordinates& row, double distance) {
  active_.clear();
  shares_.clear();
  measure(row);
  const std::size_t count = rows_.size() / n_;
  for (int added = 0; added < kMostAdded; ++added) {
    if (product(rest_.data(), rest_.data()) <= distance * distance) {
      return true;
    }
    double most = kWorth;
    std::size_t best = count;
    for (std::size_t k = 0; k < count; ++k) {
      const double gain = product(row_at(k), rest_.data());
      if (gain > most) {
        most = gain;
        best = k;
      }
    }
    if (best == count || active_.size() == n_ ||
        std::ranges::find(active_, best) != active_.end()) {
      return false;
    }
    active_.push_back(best);
    shares_.push_back(0.0);
    if (!meet(row)) {
      return false;
    }
    measure(row);
  }
  return false;
}

}  // namespace firstcontact::detail
