#include <firstcontact/dynamics/detail/sweep_pairs.h>

#include <algorithm>
#include <numeric>

namespace firstcontact::detail {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

int widest_axis(const std::vector<AlignedBox3d>& boxes) {
  Vector3d sum = Vector3d::Zero();
  Vector3d squares = Vector3d::Zero();
  for (const AlignedBox3d& box : boxes) {
    const Vector3d centre = box.center();
    sum += centre;
    squares += centre.cwiseAbs2();
  }
  const Vector3d variance = squares - sum.cwiseAbs2() / static_cast<double>(boxes.size());
  Eigen::Index axis = 0;
  variance.maxCoeff(&axis);
  return static_cast<int>(axis);
}

}  // namespace

std::vector<std::array<std::size_t, 2>> overlapping_pairs(const std::vector<AlignedBox3d>& boxes) {
  std::vector<std::array<std::size_t, 2>> pairs;
  if (boxes.size() < 2) {
    return pairs;
  }
  const int axis = widest_axis(boxes);
  std::vector<std::size_t> order(boxes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t b) { return std::pair(boxes[b].min()[axis], b); });
  std::vector<std::size_t> active;
  for (const std::size_t b : order) {
    const double begin = boxes[b].min()[axis];
    std::erase_if(active, [&](std::size_t a) { return boxes[a].max()[axis] < begin; });
    for (const std::size_t a : active) {
      if (boxes[a].intersects(boxes[b])) {
        pairs.push_back({std::min(a, b), std::max(a, b)});
      }
    }
    active.push_back(b);
  }
  std::ranges::sort(pairs);
  return pairs;
}

}  // namespace firstcontact::detail
