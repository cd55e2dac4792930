#include <firstcontact/robot_files/detail/urdf_context.h>

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/motion/rotation_forms.h>
#include <firstcontact/text/parse_error.h>

namespace firstcontact::detail {
namespace {

Eigen::Quaterniond quaternion(const XmlElement& origin, const XmlReader& xml) {
  if (origin.Attribute("rpy") != nullptr) {
    xml.fail(origin, "expected one of 'rpy' and 'quat_xyzw', got both");
  }
  const std::vector<double> q = xml.numbers(origin, "quat_xyzw");
  if (q.size() != 4) {
    xml.fail(origin, "expected four numbers in 'quat_xyzw', got " + std::to_string(q.size()));
  }
  const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
  if (!(rotation.coeffs().stableNorm() > 0.0)) {
    xml.fail(origin, "expected 'quat_xyzw' not to be zero");
  }
  return Eigen::Quaterniond((rotation.coeffs() / rotation.coeffs().stableNorm()).eval());
}

}  // namespace

void UrdfContext::attempt(const std::function<void()>& read) const {
  try {
    read();
  } catch (const ParseError& error) {
    log.add_error(error);
  }
}

Pose UrdfContext::origin(const XmlElement& element) const {
  const XmlElement* origin = xml.child(element, "origin");
  if (origin == nullptr) {
    return {};
  }
  names.check(*origin, urdf_names().origin);
  return pose_of(*origin, xml);
}

void UrdfContext::pass_over_pose(const XmlElement& element, const char* what,
                                 const Pose& pose) const {
  const std::string name(what);
  if (pose.position.isZero(0.0) && pose.rotation.vec().isZero(0.0)) {
    log.warn(xml.error(element, name + " is not of URDF; it moves nothing, and is left out"),
             name + " that moves nothing");
  } else {
    log.refuse(xml.error(element, name + " is not of URDF, and other readers pass over it; put it "
                                         "where it is meant, or remove it"),
               name + " that moves something");
  }
}

Pose pose_of(const XmlElement& origin, const XmlReader& xml) {
  Pose pose;
  if (origin.Attribute("xyz") != nullptr) {
    pose.position = xml.vector3(origin, "xyz");
  }
  if (origin.Attribute("quat_xyzw") != nullptr) {
    pose.rotation = quaternion(origin, xml);
  } else if (origin.Attribute("rpy") != nullptr) {
    pose.rotation = rotation_from_rpy(xml.vector3(origin, "rpy"));
  }
  return pose;
}

}  // namespace firstcontact::detail
