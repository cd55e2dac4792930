#include <firstcontact/haptics/detail/haptic_scene_check.h>

#include <limits>
#include <stdexcept>
#include <string>

#include <firstcontact/haptics/contact_set.h>

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

void check_haptic_scene(const HapticScene& scene) {
  require_haptic(!scene.tools.empty() && scene.tools.size() <= kMostTools,
                 "a haptic scene has 1 or 2 tools, not " + std::to_string(scene.tools.size()));
  require_haptic(scene.duration > 0.0 && scene.duration < std::numeric_limits<double>::infinity(),
                 "the duration of a haptic scene must be > 0 s");
  require_haptic(!scene.contact_distance ||
                     (*scene.contact_distance > 0.0 &&
                      *scene.contact_distance < std::numeric_limits<double>::infinity()),
                 "the contact distance must be > 0 m");
  for (const HapticTool& tool : scene.tools) {
    const std::string name = "tool \"" + tool.name + "\": ";
    require_haptic(is_finite_pose(tool.X_WB) && tool.p_BC.allFinite(),
                   name + "its pose is not finite");
    require_haptic(tool.friction >= 0.0 && tool.friction < std::numeric_limits<double>::infinity(),
                   name + "friction must be >= 0");
    require_haptic(tool.coupling.stiffness > 0.0 &&
                       tool.coupling.stiffness < std::numeric_limits<double>::infinity() &&
                       tool.coupling.angular_stiffness > 0.0 &&
                       tool.coupling.angular_stiffness < std::numeric_limits<double>::infinity(),
                   name + "stiffnesses must be > 0");
    require_haptic(tool.shape.vertices_to().empty(), name + "its shape deforms");
  }
  for (const HapticBody& body : scene.bodies) {
    const std::string name = "body \"" + body.name + "\": ";
    require_haptic(is_finite_pose(body.X_WB), name + "its pose is not finite");
    require_haptic(body.friction >= 0.0 && body.friction < std::numeric_limits<double>::infinity(),
                   name + "friction must be >= 0");
    require_haptic(body.shape.vertices_to().empty(), name + "its shape deforms");
  }
}

}  // namespace firstcontact::detail
