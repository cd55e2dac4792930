#include <firstcontact/robot_check/touching_links.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

#include <firstcontact/query/distance.h>

namespace firstcontact {
namespace {

/// A collision geometry at its place at rest, in the frame of the root link.
struct Placed {
  Shape shape;
  Motion X_RG;
};

std::vector<Placed> place(const RobotMotion& motion, std::size_t link) {
  const RobotModel& model = motion.model();
  const LinkMotion X_RL = motion.link(model.root(), link);
  std::vector<Placed> placed;
  for (const LinkGeometry& geometry : model.links()[link].collision) {
    if (!geometry.shape) {
      throw std::invalid_argument("touching_links: link '" + model.links()[link].name +
                                  "' has a collision geometry without its shape; load it");
    }
    const LinkPose pose = X_RL.then(precise(geometry.X_LG)).at(0.0).pose(0.0);
    placed.push_back({*geometry.shape, Motion::fixed({pose.p_OL, Eigen::Quaterniond(pose.R_FL)})});
  }
  return placed;
}

bool touch(const std::vector<Placed>& A, const std::vector<Placed>& B, double margin,
           Workspace& workspace) {
  const auto touches = [&](const Placed& a, const Placed& b) {
    return distance({a.shape, a.X_RG}, {b.shape, b.X_RG}, 0.0, workspace).distance <= margin;
  };
  return std::any_of(A.begin(), A.end(), [&](const Placed& a) {
    return std::any_of(B.begin(), B.end(), [&](const Placed& b) { return touches(a, b); });
  });
}

}  // namespace

RobotMotion at_rest(const RobotModel& model) {
  std::map<std::string, JointMotion> joints;
  for (const Joint& joint : model.joints()) {
    if (joint.type == JointType::fixed || joint.mimic) {
      continue;
    }
    const CoordinatePath zero = CoordinatePath::constant(0.0);
    if (joint.type == JointType::planar) {
      joints.emplace(joint.name, PlanarPath{zero, zero, zero});
    } else if (coordinate_count(joint.type) == 0) {
      joints.emplace(joint.name, Motion::fixed());
    } else {
      const double upper = joint.limits.upper.value_or(0.0);
      const double lower = joint.limits.lower.value_or(0.0);
      joints.emplace(joint.name, CoordinatePath::constant(std::max(lower, std::min(0.0, upper))));
    }
  }
  return {model, joints};
}

std::vector<LinkPairIndex> touching_links(const RobotMotion& motion, double margin) {
  if (!(margin >= 0.0 && std::isfinite(margin))) {
    throw std::invalid_argument("touching_links: the margin must be finite and >= 0");
  }
  const std::size_t count = motion.model().links().size();
  std::vector<std::vector<Placed>> placed;
  for (std::size_t link = 0; link < count; ++link) {
    placed.push_back(place(motion, link));
  }
  std::vector<LinkPairIndex> pairs;
  Workspace workspace;
  for (std::size_t link = 0; link < count; ++link) {
    for (std::size_t other = link + 1; other < count; ++other) {
      if (touch(placed[link], placed[other], margin, workspace)) {
        pairs.push_back({link, other});
      }
    }
  }
  return pairs;
}

}  // namespace firstcontact
