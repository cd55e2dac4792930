#include "robot_check/robot_library_case.h"

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "support/library_case.h"
#include "support/robot_contact_oracle.h"

namespace firstcontact::oracle {
namespace {

Eigen::Vector3d vector(const Vector3<double>& v) { return {v.x, v.y, v.z}; }

std::string joint_name(std::size_t joint) { return "j" + std::to_string(joint); }
std::string link_name(std::size_t link) { return "l" + std::to_string(link); }

JointType type_of(JointKind kind) {
  switch (kind) {
    case JointKind::fixed:
      return JointType::fixed;
    case JointKind::revolute:
      return JointType::revolute;
    case JointKind::continuous:
      return JointType::continuous;
    case JointKind::prismatic:
      return JointType::prismatic;
    case JointKind::screw:
      return JointType::screw;
    case JointKind::planar:
      return JointType::planar;
    case JointKind::floating:
      return JointType::floating;
    case JointKind::ball:
      return JointType::ball;
  }
  return JointType::fixed;
}

CoordinatePath to_path(const CoordinateInput& q) {
  const Turning turning = q.shortest ? Turning::shortest : Turning::as_given;
  switch (q.kind) {
    case CoordinateKind::linear:
      return CoordinatePath::linear(q.times, q.positions, turning);
    case CoordinateKind::cubic:
      return CoordinatePath::cubic(q.times, q.positions, q.velocities, turning);
    case CoordinateKind::quintic:
      return CoordinatePath::quintic(q.times, q.positions, q.velocities, q.accelerations, turning);
    case CoordinateKind::polynomial:
      break;
  }
  const std::vector<std::vector<double>> pieces = {q.coefficients};
  return CoordinatePath::polynomials(q.times, pieces);
}

JointMotion to_joint_motion(const JointInput& j) {
  if (j.kind == JointKind::planar) {
    return PlanarPath{to_path(j.coordinates[0]), to_path(j.coordinates[1]),
                      to_path(j.coordinates[2])};
  }
  if (j.kind == JointKind::floating || j.kind == JointKind::ball) {
    return to_motion(j.motion);
  }
  return to_path(j.coordinates[0]);
}

Joint to_joint(const JointInput& j, std::size_t index) {
  const Quaternion& q = j.X_PJ.rotation;
  Joint joint{.name = joint_name(index),
              .type = type_of(j.kind),
              .parent = link_name(j.parent),
              .child = link_name(index + 1)};
  joint.X_PJ = {vector(j.X_PJ.position), Eigen::Quaterniond(q.w, q.x, q.y, q.z)};
  joint.axis = vector(j.axis);
  joint.pitch = j.pitch;
  if (j.mimic) {
    joint.mimic = Mimic{joint_name(j.mimic->joint), j.mimic->multiplier, j.mimic->offset};
  }
  return joint;
}

RobotMotion to_robot_motion(const RobotInput& input) {
  RobotDescription robot{.name = "robot", .links = {{link_name(0), {}, {}}}, .joints = {}};
  std::map<std::string, JointMotion> motions;
  for (std::size_t k = 0; k < input.joints.size(); ++k) {
    const JointInput& j = input.joints[k];
    robot.links.push_back({link_name(k + 1), {}, {}});
    robot.joints.push_back(to_joint(j, k));
    if (!j.mimic && j.kind != JointKind::fixed) {
      motions.emplace(joint_name(k), to_joint_motion(j));
    }
  }
  return RobotMotion(RobotModel(std::move(robot)), motions, to_motion(input.base));
}

RelativeLinkMotion link_motions(const RobotCase& c) {
  const RobotMotion A = to_robot_motion(c.robots[c.A.robot]);
  if (c.A.robot == c.B.robot) {
    return A.relative(c.A.link, c.B.link);
  }
  return {A.link(c.A.link), to_robot_motion(c.robots[c.B.robot]).link(c.B.link)};
}

/// A shape and its motion in the frame that both share.
struct Moving {
  Shape shape;
  LinkMotion X_FS;
};

Moving moving(const MovingSoup& soup, const LinkMotion& X_FL) {
  if (soup.to.empty()) {
    return {to_shape(soup), X_FL};
  }
  DeformingBody body = to_body(soup);
  return {std::move(body.shape), LinkMotion(body.X_WS)};
}

}  // namespace

FirstContactResult ask_library(const RobotCase& c, bool swapped, Workspace& workspace) {
  const RelativeLinkMotion motions = link_motions(c);
  const Moving A = moving(c.A.soup, motions.A);
  const Moving B = moving(c.B.soup, motions.B);
  FirstContactOptions options;
  options.margin = c.margin;
  options.tolerance = c.tolerance;
  options.contacts = ContactState::none;
  const MovingLink first{A.shape, A.X_FS};
  const MovingLink second{B.shape, B.X_FS};
  return swapped ? first_contact(second, first, workspace, options)
                 : first_contact(first, second, workspace, options);
}

std::string complaint(const RobotCase& c, const FirstContactResult& answer, const Truth& truth) {
  if (std::string wrong = verdict_complaint(answer, truth); !wrong.empty()) {
    return wrong;
  }
  if (!(answer.tolerance_used <= c.tolerance)) {
    return describe("larger tolerance", answer, truth);
  }
  if (answer.verdict != Verdict::free &&
      !(RobotContactOracle(c).distance(answer.t).lower <= c.margin + answer.tolerance_used)) {
    return describe("false contact", answer, truth);
  }
  return {};
}

}  // namespace firstcontact::oracle
