#include <firstcontact/narrowphase/detail/farthest_corners.h>

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "firstcontact/narrowphase/detail/farthest_corners.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace firstcontact::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<double, 8>;
using Vector = hn::Vec<Lanes>;

/// Eight corners, or as many as a vector holds, from a row on.
struct Place {
  const double* x;
  const double* y;
  const double* z;
  double row;

  Place(const PointRows& corners, Eigen::Index first)
      : x(corners.data() + first),
        y(x + corners.rows()),
        z(y + corners.rows()),
        row(static_cast<double>(first)) {}
};

/// Keeps those that are farther along n than all before, lane by lane.
HWY_INLINE void keep_farther(const Place& at, const Eigen::Vector3d& n, Vector& most,
                             Vector& where) {
  const Lanes d;
  const Vector value = hn::MulAdd(hn::Set(d, n.z()), hn::LoadU(d, at.z),
                                  hn::MulAdd(hn::Set(d, n.y()), hn::LoadU(d, at.y),
                                             hn::Mul(hn::Set(d, n.x()), hn::LoadU(d, at.x))));
  const auto more = hn::Gt(value, most);
  most = hn::IfThenElse(more, value, most);
  where = hn::IfThenElse(more, hn::Iota(d, at.row), where);
}

HWY_INLINE Eigen::Index first_of_greatest(const Vector& most, const Vector& where) {
  const Lanes d;
  const auto is_greatest = hn::Eq(most, hn::MaxOfLanes(d, most));
  const Vector no_row = hn::Set(d, std::numeric_limits<double>::infinity());
  const Vector rows = hn::IfThenElse(is_greatest, where, no_row);
  return static_cast<Eigen::Index>(hn::GetLane(hn::MinOfLanes(d, rows)));
}

std::ptrdiff_t LeastRows() { return static_cast<std::ptrdiff_t>(hn::Lanes(Lanes())); }

/// Both halves of the corners take turns, as each comparison waits for the one before it.
void FarthestAlongOne(const PointRows& corners, const Eigen::Vector3d* n, Eigen::Index* rows) {
  const Lanes d;
  const auto lanes = static_cast<Eigen::Index>(hn::Lanes(d));
  const Eigen::Index last = corners.rows() - lanes;
  const Eigen::Index half = corners.rows() / (2 * lanes) * lanes;
  Vector most = hn::Set(d, -std::numeric_limits<double>::infinity());
  Vector where = hn::Zero(d);
  Vector most_later = most;
  Vector where_later = where;
  for (Eigen::Index row = 0; row < half; row += lanes) {
    keep_farther({corners, row}, n[0], most, where);
    keep_farther({corners, half + row}, n[0], most_later, where_later);
  }
  for (Eigen::Index row = 2 * half; row < corners.rows(); row += lanes) {
    keep_farther({corners, std::min(row, last)}, n[0], most_later, where_later);
  }
  const auto more = hn::Gt(most_later, most);
  rows[0] = first_of_greatest(hn::IfThenElse(more, most_later, most),
                              hn::IfThenElse(more, where_later, where));
}

void FarthestAlongThree(const PointRows& corners, const Eigen::Vector3d* n, Eigen::Index* rows) {
  const Lanes d;
  const auto lanes = static_cast<Eigen::Index>(hn::Lanes(d));
  const Eigen::Index last = corners.rows() - lanes;
  Vector most_0 = hn::Set(d, -std::numeric_limits<double>::infinity());
  Vector most_1 = most_0;
  Vector most_2 = most_0;
  Vector where_0 = hn::Zero(d);
  Vector where_1 = where_0;
  Vector where_2 = where_0;
  for (Eigen::Index row = 0; row < corners.rows(); row += lanes) {
    const Place at(corners, std::min(row, last));
    keep_farther(at, n[0], most_0, where_0);
    keep_farther(at, n[1], most_1, where_1);
    keep_farther(at, n[2], most_2, where_2);
  }
  rows[0] = first_of_greatest(most_0, where_0);
  rows[1] = first_of_greatest(most_1, where_1);
  rows[2] = first_of_greatest(most_2, where_2);
}

}  // namespace firstcontact::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace firstcontact::detail {
namespace {

HWY_EXPORT(LeastRows);
HWY_EXPORT(FarthestAlongOne);
HWY_EXPORT(FarthestAlongThree);

/// The farthest of fewer corners than the vector kernels need.
Eigen::Index farthest_of_few(const PointRows& corners, const Eigen::Vector3d& n) {
  Eigen::Index best = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (Eigen::Index row = 0; row < corners.rows(); ++row) {
    const double value = corners.row(row).dot(n);
    if (value > most) {
      most = value;
      best = row;
    }
  }
  return best;
}

}  // namespace

std::array<Eigen::Index, kDirections> farthest_corners(
    const PointRows& corners, std::span<const Eigen::Vector3d> directions) {
  static const std::ptrdiff_t least_rows = HWY_DYNAMIC_DISPATCH(LeastRows)();
  std::array<Eigen::Index, kDirections> rows{};
  if (corners.rows() < least_rows) {
    for (std::size_t k = 0; k < directions.size(); ++k) {
      rows[k] = farthest_of_few(corners, directions[k]);
    }
  } else if (directions.size() == 1) {
    HWY_DYNAMIC_DISPATCH(FarthestAlongOne)(corners, directions.data(), rows.data());
  } else {
    HWY_DYNAMIC_DISPATCH(FarthestAlongThree)(corners, directions.data(), rows.data());
  }
  return rows;
}

}  // namespace firstcontact::detail
#endif
