#include <firstcontact/haptics/detail/last_round.h>

#include <algorithm>

#include <Eigen/Geometry>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// Computes the place of a point of a member after the member moved.
Vector3d carried(const Vector3d& point, const Pose& from, const Pose& to) {
  const Vector3d p_B = from.rotation.normalized().conjugate() * (point - from.position);
  return to.position + to.rotation.normalized() * p_B;
}

bool are_alike(const HapticTouch& a, const HapticTouch& b) {
  const auto same = [](const Feature& x, const Feature& y) {
    return x.type == y.type && x.index == y.index;
  };
  return a.members == b.members && same(a.feature_of_other, b.feature_of_other) &&
         same(a.feature_of_tool, b.feature_of_tool);
}

}  // namespace

void LastRound::keep(const std::vector<Pose>& poses, const std::vector<HapticTouch>& touches,
                     const ToolDisplacements& way) {
  poses_ = poses;
  touches_ = touches;
  way_ = way;
}

bool LastRound::is_left_by(const ToolDisplacements& way, const ToolFrames& frames,
                           std::size_t tools) const {
  return !poses_.empty() && product_of(way, way_, frames, tools) < 0.0;
}

std::vector<HapticTouch> LastRound::touches_left(const std::vector<Pose>& poses,
                                                 const std::vector<HapticTouch>& touching) const {
  std::vector<HapticTouch> left;
  for (HapticTouch touch : touches_) {
    if (std::ranges::any_of(touching, [&](const auto& now) { return are_alike(now, touch); })) {
      continue;
    }
    HapticContact& contact = touch.contact;
    const Vector3d half = 0.5 * contact.gap * contact.normal;
    const auto [other, tool] = touch.members;
    const Vector3d of_tool = carried(contact.point + half, poses_[tool], poses[tool]);
    Vector3d of_other = contact.point - half;
    if (contact.other >= 0) {
      of_other = carried(of_other, poses_[other], poses[other]);
    }
    contact.gap = contact.normal.dot(of_tool - of_other);
    contact.point = of_tool - 0.5 * contact.gap * contact.normal;
    if (contact.gap > 0.0) {
      left.push_back(touch);
    }
  }
  return left;
}

}  // namespace firstcontact::detail
