#include <firstcontact/robot_check/detail/tree_poses.h>

#include <algorithm>
#include <array>
#include <cassert>

#include <Eigen/Geometry>

#include <firstcontact/robot/detail/chain_bounds.h>
#include <firstcontact/robot/detail/chain_walk.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

constexpr double kUp = 1.0 + 0x1p-40;

/// Passes a joint, as ChainWalk adds it to its pose.
FramePlace pass(const FramePlace& parent, const JointState& joint) {
  const Vector3d step = joint.p_PQ.value();
  FramePlace child;
  child.p = parent.p + parent.R * (step + joint.p_QL);
  child.R = parent.R * joint.R_PL;
  child.rotation_error = parent.rotation_error + kRotationStep + joint.angle_error;
  const double far = rough_size(step);
  const double lever = rough_size(joint.p_QL);
  child.position_error = (parent.position_error + joint.position_error + 0x1p-90 * far +
                          parent.rotation_error * far + child.rotation_error * lever) *
                         ChainWalk::kSecondOrder;
  child.length = parent.length + far + lever;
  child.rounding = parent.rounding + 2.0 * kChainRounding * child.length;
  return child;
}

}  // namespace

TreePoses::TreePoses(std::span<const Node> nodes, const TimeGrid& grid,
                     std::pmr::memory_resource& memory)
    : grid_(grid), joints_(&memory), levers_(&memory), places_(&memory) {
  first_.fill(kNone);
  joints_.reserve(nodes.size());
  for (const Node& node : nodes) {
    assert(node.parent == kWorld || node.parent < joints_.size());
    const bool rests =
        node.path->rest() != nullptr && (node.parent == kWorld || joints_[node.parent].rests);
    joints_.push_back({node, rests});
  }
}

TreePoses::TreePoses(const JointPath& path, const TimeGrid& grid)
    : TreePoses(std::array{Node{kWorld, &path}}, grid) {}

const FramePlace& TreePoses::place(std::size_t node, int k) {
  const std::uint32_t& first = first_[static_cast<std::size_t>(k)];
  if (first == kNone) {
    place_all(k);
  }
  return places_[first + node];
}

void TreePoses::place_all(int k) {
  const FramePlace world;
  const double t = grid_.at(k);
  const std::size_t first = places_.size();
  first_[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(first);
  places_.reserve(std::max(kFewTimes * joints_.size(), first + joints_.size()));
  if (k == TimeGrid::kMiddle) {
    levers_.reserve(joints_.size());
  }
  for (const auto& [joint, rests] : joints_) {
    const FramePlace& parent = joint.parent == kWorld ? world : places_[first + joint.parent];
    const JointState state = joint.path->state(t);
    if (k == TimeGrid::kMiddle) {
      add_lever(parent, state, *joint.path);
    }
    places_.push_back(pass(parent, state));
  }
}

void TreePoses::add_lever(const FramePlace& parent, const JointState& state,
                          const JointPath& path) {
  const Vector3d step = state.p_PQ.value();
  levers_.push_back({parent.p + parent.R * step, parent.R * state.axis, step.norm(),
                     state.p_QL.norm(), path.bounds(grid_.piece.begin, grid_.piece.end)});
}

CoordinateSegment::Bounds TreePoses::bounds(std::size_t node, const Vector3d& p_LC, double reach,
                                            std::size_t frame) {
  const double middle = grid_.at(TimeGrid::kMiddle);
  const double T = std::max(grid_.piece.end - middle, middle - grid_.piece.begin) * kUp;
  const FramePlace& L = place(node, TimeGrid::kMiddle);
  const Vector3d centre = L.p + L.R * p_LC;
  const double offset = p_LC.norm();
  ChainBounds bounds(offset + reach, reach, T);
  for (std::size_t at = node; at != frame; at = joints_[at].node.parent) {
    const Lever& lever = levers_[at];
    if (joints_[at].node.path->rest() != nullptr) {
      bounds.pass_rest(lever.step + lever.lever);
      continue;
    }
    const Vector3d arm = centre - lever.p_WQ;
    const double error = 2.0 * (L.position_error + L.rounding) +
                         (L.rotation_error + 8.0 * kChainRounding) * (arm.norm() + offset);
    bounds.pass(lever.bounds, arm.cross(lever.axis).norm() + error, lever.step, lever.lever);
  }
  return bounds.bounds();
}

}  // namespace firstcontact::detail
