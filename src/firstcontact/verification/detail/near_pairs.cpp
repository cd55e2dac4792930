#include <firstcontact/verification/detail/near_pairs.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>

namespace firstcontact::detail {
namespace {

/// [-]  Covers the roundings of a position.
constexpr double kRounding = 0x1p-40;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A box around the body at its pose, or around all of its rotations.
Eigen::AlignedBox3d box_at(const RunMember& member, const BodyInstant& now, bool turns) {
  const BoxNode& root = member.tree.nodes[0];
  const Eigen::Vector3d centre =
      turns ? now.pivot : Eigen::Vector3d(now.pivot + now.R * root.centre);
  const Eigen::Vector3d extent = turns ? Eigen::Vector3d::Constant(root.reach)
                                       : Eigen::Vector3d(now.R.cwiseAbs() * root.extent);
  const double slack = member.shape.radius() + now.pivot_error + now.turn_error * root.reach +
                       kRounding * (now.pivot.norm() + root.reach);
  const Eigen::Vector3d half = extent + Eigen::Vector3d::Constant(slack);
  return {Eigen::Vector3d(centre - half), Eigen::Vector3d(centre + half)};
}

}  // namespace

Eigen::AlignedBox3d swept_box(const RunMember& member, const FollowedBody& body) {
  Eigen::AlignedBox3d box;
  for (const PieceMotion& piece : body.pieces) {
    for (const double time : {piece.from(), piece.to()}) {
      const BodyInstant now = piece.instant(time, Eigen::Vector3d::Zero());
      box.extend(box_at(member, now, !now.spin.isZero(0.0)));
    }
  }
  const Eigen::Vector3d jump = Eigen::Vector3d::Constant(body.jump);
  const Eigen::AlignedBox3d all(Eigen::Vector3d(box.min() - jump),
                                Eigen::Vector3d(box.max() + jump));
  // A body whose numbers overflow may be anywhere.
  const Eigen::Vector3d infinite = Eigen::Vector3d::Constant(kInfinity);
  const bool finite = all.min().allFinite() && all.max().allFinite();
  return finite ? all : Eigen::AlignedBox3d(Eigen::Vector3d(-infinite), infinite);
}

std::vector<BodyPair> near_pairs(const std::vector<Eigen::AlignedBox3d>& boxes, double reach) {
  std::vector<std::size_t> order(boxes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return boxes[a].min().x() < boxes[b].min().x(); });
  const auto apart = [&](std::size_t a, std::size_t b, int axis) {
    return boxes[b].min()[axis] - boxes[a].max()[axis] > reach;
  };
  std::vector<BodyPair> pairs;
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = i + 1; j < order.size() && !apart(order[i], order[j], 0); ++j) {
      const auto [a, b] = std::minmax(order[i], order[j]);
      if (!apart(a, b, 1) && !apart(b, a, 1) && !apart(a, b, 2) && !apart(b, a, 2)) {
        pairs.push_back({a, b});
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace firstcontact::detail
