/// @file
/// Matrices that map velocities in blocks of six to contacts or drives.

#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/contact_solver/detail/block_cholesky.h>

namespace firstcontact::detail {

/// A matrix G whose rows have `rows` lines each, and few blocks of six columns.
template <int rows>
class BlockRows {
 public:
  using Vector = Eigen::Matrix<double, rows, 1>;
  using Square = Eigen::Matrix<double, rows, rows>;

  /// Begins a new row.
  void add_row() { first_.push_back(entries_.size()); }
  /// Adds columns to the last row, from `in_x` on.
  template <class Derived>
  void add(Eigen::Index in_x, const Eigen::MatrixBase<Derived>& G) {
    for (Eigen::Index k = 0; k < G.cols(); k += 6) {
      entries_.push_back({in_x + k, G.template middleCols<6>(k)});
    }
    first_.back() = entries_.size();
  }

  [[nodiscard]] std::size_t size() const { return first_.size() - 1; }

  /// Computes G x of a row.
  [[nodiscard]] Vector times(std::size_t row, const Eigen::VectorXd& x) const {
    Vector u = Vector::Zero();
    for (const Entry& entry : of(row)) {
      u += entry.G * x.segment<6>(entry.in_x);
    }
    return u;
  }
  /// Adds G^T r of a row to x.
  void add_transposed(std::size_t row, const Vector& r, Eigen::VectorXd& x) const {
    for (const Entry& entry : of(row)) {
      x.segment<6>(entry.in_x) += entry.G.transpose() * r;
    }
  }

  /// Lists the blocks that G^T D G has.
  void list_pairs(std::vector<std::array<std::size_t, 2>>& pairs) const {
    for (std::size_t row = 0; row < size(); ++row) {
      for_each_pair(row, [&](const Entry& a, const Entry& b) {
        pairs.push_back({block(a), block(b)});
      });
    }
  }
  /// Finds the places of these blocks in a matrix.
  void find_places(const BlockCholesky& matrix) {
    for (std::size_t row = 0; row < size(); ++row) {
      first_place_.push_back(places_.size());
      for_each_pair(row, [&](const Entry& a, const Entry& b) {
        places_.push_back(matrix.place(block(a), block(b)));
      });
    }
  }
  /// Adds G^T D G of a row to a matrix, with a symmetric D.
  void add_to(BlockCholesky& matrix, std::size_t row, const Square& D) const {
    const BlockPattern::Place* place = &places_[first_place_[row]];
    const auto entries = of(row);
    for (std::size_t b = 0; b < entries.size(); ++b) {
      const Eigen::Matrix<double, rows, 6> DG = D * entries[b].G;
      for (std::size_t a = 0; a <= b; ++a, ++place) {
        if (place->is_turned) {
          matrix.at(*place).noalias() += DG.transpose() * entries[a].G;
        } else {
          matrix.at(*place).noalias() += entries[a].G.transpose() * DG;
        }
      }
    }
  }

  /// Adds G^T D G of a row to a full matrix, with any D.
  void add_to(Eigen::MatrixXd& matrix, std::size_t row, const Square& D) const {
    for (const Entry& b : of(row)) {
      const Eigen::Matrix<double, rows, 6> DG = D * b.G;
      for (const Entry& a : of(row)) {
        matrix.block<6, 6>(a.in_x, b.in_x).noalias() += a.G.transpose() * DG;
      }
    }
  }

 private:
  struct Entry {
    Eigen::Index in_x;
    Eigen::Matrix<double, rows, 6> G;
  };

  [[nodiscard]] std::span<const Entry> of(std::size_t row) const {
    return {entries_.data() + first_[row], entries_.data() + first_[row + 1]};
  }
  static std::size_t block(const Entry& entry) { return static_cast<std::size_t>(entry.in_x / 6); }
  template <class Use>
  void for_each_pair(std::size_t row, const Use& use) const {
    const auto entries = of(row);
    for (std::size_t b = 0; b < entries.size(); ++b) {
      for (std::size_t a = 0; a <= b; ++a) {
        use(entries[a], entries[b]);
      }
    }
  }

  std::vector<Entry> entries_;
  std::vector<std::size_t> first_ = {0};  // First entry of each row in entries_, and the end.
  std::vector<BlockPattern::Place> places_;
  std::vector<std::size_t> first_place_;
};

}  // namespace firstcontact::detail
