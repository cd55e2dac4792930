#include <firstcontact/robot/detail/chain_walk.h>

#include <algorithm>
#include <cassert>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// The step to a joint's pivot. F does not turn, so before the first joint large numbers cancel
/// before they are rounded.
Vector3d step_to(const JointState& joint, bool is_first, const DoubleDoubleVector3& p_FO) {
  return (is_first ? joint.p_PQ - p_FO : joint.p_PQ).value();
}

PassedJoint pass(const JointState& joint, bool is_first, const DoubleDoubleVector3& p_FO,
                 ChainWalk& walk) {
  const Vector3d step = step_to(joint, is_first, p_FO);
  walk.position_error +=
      joint.position_error +
      0x1p-90 * (rough_size(joint.p_PQ.value()) + (is_first ? rough_size(p_FO.value()) : 0.0));
  walk.move(walk.R * step);
  if (joint.slides) {
    walk.slide(joint);
  }
  const Vector3d axis = walk.R * joint.axis;
  const Vector3d lever = walk.R * joint.p_QL;  // In the parent's axes: before the turn.
  PassedJoint passed{walk.p, axis, step.norm(), lever.norm(), walk.p + lever};
  walk.turn(joint, axis);
  walk.move(lever);
  ++walk.joints;
  return passed;
}

/// Passes a joint that rests: one step, and the axes after it.
PassedJoint pass_rest(const JointState& joint, bool is_first, const DoubleDoubleVector3& p_FO,
                      ChainWalk& walk) {
  const Vector3d step = step_to(joint, is_first, p_FO) + joint.p_QL;
  walk.position_error +=
      joint.position_error +
      0x1p-90 * (rough_size(joint.p_PQ.value()) + (is_first ? rough_size(p_FO.value()) : 0.0));
  walk.move(walk.R * step);
  walk.R = (walk.R * joint.R_PL).eval();
  walk.rotation_error += kRotationStep + joint.angle_error;
  ++walk.joints;
  return {walk.p, Vector3d::Zero(), step.norm(), 0.0, walk.p};
}

PassedJoint pass(const JointPath& joint, double t, bool is_first, const DoubleDoubleVector3& p_FO,
                 ChainWalk& walk) {
  const JointState* rest = joint.rest();
  return rest != nullptr ? pass_rest(*rest, is_first, p_FO, walk)
                         : pass(joint.state(t), is_first, p_FO, walk);
}

ChainWalk start_at(const DoubleDoubleVector3& p_FO, bool has_joints) {
  ChainWalk walk;
  if (!has_joints) {
    walk.move(-p_FO.value());
  }
  return walk;
}

bool equal(const DoubleDoubleVector3& a, const DoubleDoubleVector3& b) {
  return std::equal(
      a.c.begin(), a.c.end(), b.c.begin(),
      [](const DoubleDouble& x, const DoubleDouble& y) { return x.hi == y.hi && x.lo == y.lo; });
}

}  // namespace

ChainWalk walk_along(Joints joints, double t, const DoubleDoubleVector3& p_FO) {
  ChainWalk walk = start_at(p_FO, !joints.empty());
  for (const std::shared_ptr<const JointPath>& joint : joints) {
    pass(*joint, t, walk.joints == 0, p_FO, walk);
  }
  return walk;
}

ChainMemory::Instant& ChainMemory::instant(double t, const DoubleDoubleVector3& p_FO) {
  for (Instant& known : instants_) {
    if (known.t == t && equal(known.p_FO, p_FO)) {
      return known;
    }
  }
  Instant& fresh = instants_[next_instant_];
  next_instant_ = (next_instant_ + 1) % kInstants;
  fresh.t = t;
  fresh.p_FO = p_FO;
  fresh.nodes.resize(std::max<std::size_t>(fresh.nodes.size(), 1));
  fresh.nodes[0].first_child = 0;
  fresh.used = 1;
  return fresh;
}

std::size_t ChainMemory::Instant::add_child(std::size_t parent) {
  if (used == nodes.size()) {
    nodes.resize(2 * used + 14);
  }
  Node& node = nodes[used];
  node.parent = parent;
  node.first_child = 0;
  node.next_sibling = nodes[parent].first_child;
  node.t_from = node.t_to = std::numeric_limits<double>::quiet_NaN();
  return nodes[parent].first_child = used++;
}

ChainMemory::Walked ChainMemory::walk(Joints joints, double t, const DoubleDoubleVector3& p_FO) {
  Instant& now = instant(t, p_FO);
  std::vector<Node>& nodes = now.nodes;
  nodes[0].walk = start_at(p_FO, !joints.empty());
  std::size_t at = 0;
  for (const std::shared_ptr<const JointPath>& joint : joints) {
    std::size_t child = nodes[at].first_child;
    while (child != 0 && nodes[child].joint != joint->id()) {
      child = nodes[child].next_sibling;
    }
    if (child == 0) {
      child = now.add_child(at);
      Node& node = nodes[child];
      node.joint = joint->id();
      node.walk = nodes[at].walk;
      node.passed = pass(*joint, t, at == 0, p_FO, node.walk);
    }
    at = child;
  }
  return {nodes, at};
}

const JointBounds& ChainMemory::bounds(const Node& node, const JointPath& joint, double t_from,
                                       double t_to) {
  assert(node.joint == joint.id());
  if (!(node.t_from == t_from && node.t_to == t_to)) {
    node.bounds = joint.bounds(t_from, t_to);
    node.t_from = t_from;
    node.t_to = t_to;
  }
  return node.bounds;
}

}  // namespace firstcontact::detail
