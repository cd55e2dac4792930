#include <firstcontact/haptics/detail/haptic_scene_check.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <firstcontact/haptics/contact_set.h>
#include <firstcontact/math/number_text.h>

namespace firstcontact::detail {

void require_haptic(bool holds, const std::string& what) {
  if (!holds) {
    throw std::invalid_argument(what);
  }
}

bool is_finite_pose(const Pose& pose) {
  return pose.position.allFinite() && pose.rotation.coeffs().allFinite() &&
         pose.rotation.coeffs().squaredNorm() > 0.0;
}

namespace {

void check_joints(const HapticTool& tool, const std::string& name) {
  for (const HapticJoint& joint : tool.joints) {
    const std::string of = name + "joint \"" + joint.name + "\": ";
    require_haptic(std::isfinite(joint.start), of + "its start is not finite");
    require_haptic(joint.lower <= joint.start && joint.start <= joint.upper,
                   of + "it starts at " + detail::shortest(joint.start) +
                       ", outside of its limits " + detail::shortest(joint.lower) + " to " +
                       detail::shortest(joint.upper));
    require_haptic(joint.stiffness > 0.0 && std::isfinite(joint.stiffness),
                   of + "its stiffness must be > 0");
  }
  std::vector<bool> moves(tool.joints.size(), false);
  for (std::size_t k = 0; k < tool.links.size(); ++k) {
    const HapticLink& link = tool.links[k];
    const std::string of = name + "link \"" + link.name + "\": ";
    require_haptic(!link.parent || *link.parent < k, of + "its parent does not stand before it");
    require_haptic(!link.joint || *link.joint < tool.joints.size(), of + "it has no such joint");
    require_haptic(is_finite_pose(link.X_PJ) && link.axis.allFinite() &&
                       link.axis.squaredNorm() > 0.0 && std::isfinite(link.turn) &&
                       std::isfinite(link.slide),
                   of + "its joint is not finite");
    require_haptic(link.friction >= 0.0 && std::isfinite(link.friction),
                   of + "friction must be >= 0");
    require_haptic(!link.shape || link.shape->vertices_to().empty(), of + "its shape deforms");
    if (link.joint) {
      moves[*link.joint] = moves[*link.joint] || link.turn != 0.0 || link.slide != 0.0;
    }
  }
  for (std::size_t k = 0; k < moves.size(); ++k) {
    require_haptic(moves[k], name + "joint \"" + tool.joints[k].name + "\" moves no link");
  }
}

}  // namespace

void check_haptic_scene(const HapticScene& scene) {
  require_haptic(!scene.tools.empty() && scene.tools.size() <= kMostTools,
                 "a haptic scene has 1 or 2 tools, not " + std::to_string(scene.tools.size()));
  require_haptic(scene.duration > 0.0 && scene.duration < std::numeric_limits<double>::infinity(),
                 "the duration of a haptic scene must be > 0 s");
  require_haptic(!scene.contact_distance ||
                     (*scene.contact_distance > 0.0 &&
                      *scene.contact_distance < std::numeric_limits<double>::infinity()),
                 "the contact distance must be > 0 m");
  std::size_t joints = 0;
  std::size_t links = 0;
  for (const HapticTool& tool : scene.tools) {
    const std::string name = "tool \"" + tool.name + "\": ";
    require_haptic(is_finite_pose(tool.X_WB) && tool.p_BC.allFinite(),
                   name + "its pose is not finite");
    require_haptic(tool.friction >= 0.0 && tool.friction < std::numeric_limits<double>::infinity(),
                   name + "friction must be >= 0");
    constexpr double kMostStiffness = 1e17;  // [N/m, N m/rad]  More feels rounded coordinates.
    require_haptic(tool.coupling.stiffness > 0.0 && tool.coupling.stiffness <= kMostStiffness &&
                       tool.coupling.angular_stiffness > 0.0 &&
                       tool.coupling.angular_stiffness <= kMostStiffness,
                   name + "stiffnesses must be > 0 and at most 1e17");
    require_haptic(tool.shape.vertices_to().empty(), name + "its shape deforms");
    check_joints(tool, name);
    joints += tool.joints.size();
    links += tool.links.size();
  }
  require_haptic(joints <= kMostHapticJoints, "the tools have " + std::to_string(joints) +
                                                  " joints; at most " +
                                                  std::to_string(kMostHapticJoints) + " may move");
  require_haptic(links <= kMostHapticLinks, "the tools have " + std::to_string(links) +
                                                " links; at most " +
                                                std::to_string(kMostHapticLinks) + " may move");
  for (const HapticBody& body : scene.bodies) {
    const std::string name = "body \"" + body.name + "\": ";
    require_haptic(is_finite_pose(body.X_WB), name + "its pose is not finite");
    require_haptic(body.friction >= 0.0 && body.friction < std::numeric_limits<double>::infinity(),
                   name + "friction must be >= 0");
    require_haptic(body.shape.vertices_to().empty(), name + "its shape deforms");
  }
}

}  // namespace firstcontact::detail
