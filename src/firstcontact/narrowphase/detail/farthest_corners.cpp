#include <firstcontact/narrowphase/detail/farthest_corners.h>

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

HWY_INLINE Vector along(const Eigen::Vector3d& n, const Vector& x, const Vector& y,
                        const Vector& z) {
  const Lanes d;
  return hn::MulAdd(hn::Set(d, n.z()), z,
                    hn::MulAdd(hn::Set(d, n.y()), y, hn::Mul(hn::Set(d, n.x()), x)));
}

HWY_INLINE void keep_greater(const Vector& value, const Vector& row, Vector& most, Vector& where) {
  const auto more = hn::Gt(value, most);
  most = hn::IfThenElse(more, value, most);
  where = hn::IfThenElse(more, row, where);
}

HWY_INLINE Eigen::Index first_of_greatest(const Vector& most, const Vector& where) {
  const Lanes d;
  HWY_ALIGN double values[8];
  HWY_ALIGN double rows[8];
  hn::Store(most, d, values);
  hn::Store(where, d, rows);
  std::size_t best = 0;
  for (std::size_t lane = 1; lane < hn::Lanes(d); ++lane) {
    const bool ahead =
        values[lane] > values[best] || (values[lane] == values[best] && rows[lane] < rows[best]);
    best = ahead ? lane : best;
  }
  return static_cast<Eigen::Index>(rows[best]);
}

/// Calls use(row, x, y, z) for all corners; some of the last ones come twice.
template <class Use>
HWY_INLINE void for_each(const PointRows& corners, const Use& use) {
  const Lanes d;
  const auto lanes = static_cast<Eigen::Index>(hn::Lanes(d));
  const Eigen::Index count = corners.rows();
  const double* x = corners.data();
  const double* y = x + count;
  const double* z = y + count;
  const auto take = [&](Eigen::Index row) HWY_ATTR {
    use(hn::Iota(d, static_cast<double>(row)), hn::LoadU(d, x + row), hn::LoadU(d, y + row),
        hn::LoadU(d, z + row));
  };
  Eigen::Index row = 0;
  for (; row + lanes <= count; row += lanes) {
    take(row);
  }
  if (row < count) {
    take(count - lanes);
  }
}

std::ptrdiff_t LeastRows() { return static_cast<std::ptrdiff_t>(hn::Lanes(Lanes())); }

void FarthestAlongOne(const PointRows& corners, const Eigen::Vector3d* n, Eigen::Index* rows) {
  const Lanes d;
  Vector most = hn::Set(d, -std::numeric_limits<double>::infinity());
  Vector where = hn::Zero(d);
  for_each(corners, [&](const Vector& row, const Vector& x, const Vector& y, const Vector& z)
                        HWY_ATTR { keep_greater(along(n[0], x, y, z), row, most, where); });
  rows[0] = first_of_greatest(most, where);
}

void FarthestAlongThree(const PointRows& corners, const Eigen::Vector3d* n, Eigen::Index* rows) {
  const Lanes d;
  Vector most_0 = hn::Set(d, -std::numeric_limits<double>::infinity());
  Vector most_1 = most_0;
  Vector most_2 = most_0;
  Vector where_0 = hn::Zero(d);
  Vector where_1 = where_0;
  Vector where_2 = where_0;
  for_each(corners,
           [&](const Vector& row, const Vector& x, const Vector& y, const Vector& z) HWY_ATTR {
             keep_greater(along(n[0], x, y, z), row, most_0, where_0);
             keep_greater(along(n[1], x, y, z), row, most_1, where_1);
             keep_greater(along(n[2], x, y, z), row, most_2, where_2);
           });
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
