#include <firstcontact/robot_files/link_shape.h>
#include <firstcontact/robot_files/motion_capture.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

namespace firstcontact {
namespace {

LinkGeometry bone_geometry(const Eigen::Vector3d& end, const FigureOptions& options) {
  const double length = end.norm();
  const double radius =
      std::clamp(options.slenderness * length, options.least_radius, options.greatest_radius);
  LinkGeometry geometry;
  if (length > 0.0) {
    geometry.X_LG = {0.5 * end, Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), end)};
    geometry.source = CapsuleGeometry{radius, length};
  } else {
    geometry.source = SphereGeometry{radius};
  }
  geometry.shape = make_shape(geometry.source);
  return geometry;
}

Link bone_link(const Bone& bone, const FigureOptions& options) {
  Link link{bone.name, {}, {}};
  for (const Eigen::Vector3d& end : bone.ends) {
    link.collision.push_back(bone_geometry(end, options));
  }
  if (bone.ends.empty()) {
    link.collision.push_back(bone_geometry(Eigen::Vector3d::Zero(), options));
  }
  link.visual = link.collision;
  return link;
}

void require_range(const FigureOptions& options) {
  const bool holds = options.slenderness >= 0.0 && options.least_radius > 0.0 &&
                     options.greatest_radius >= options.least_radius;
  if (!holds) {
    throw std::invalid_argument(
        "FigureOptions: expected slenderness >= 0 and 0 < least_radius <= greatest_radius");
  }
}

Motion through(const std::vector<double>& times, const std::vector<Pose>& poses) {
  return Motion::waypoints(times, poses, Between::constant_velocity);
}

void require_frames(const RobotModel& figure, const MotionCapture& capture, std::size_t first,
                    std::size_t last) {
  if (first >= last || last >= capture.frames.size()) {
    throw std::invalid_argument("capture_motion: no frames " + std::to_string(first) + " to " +
                                std::to_string(last) + " of " +
                                std::to_string(capture.frames.size()));
  }
  bool fits = figure.links().size() == capture.bones.size();
  for (std::size_t k = first; k <= last; ++k) {
    fits = fits && capture.frames[k].rotations.size() == capture.bones.size();
  }
  if (!fits) {
    throw std::invalid_argument("capture_motion: the figure is of other bones than the frames");
  }
}

}  // namespace

RobotModel make_figure(const MotionCapture& capture, const FigureOptions& options) {
  require_range(options);
  RobotDescription figure{.name = capture.name, .links = {}, .joints = {}};
  for (std::size_t b = 0; b < capture.bones.size(); ++b) {
    const Bone& bone = capture.bones[b];
    figure.links.push_back(bone_link(bone, options));
    if (b == 0) {
      continue;
    }
    if (bone.parent >= b) {
      throw std::invalid_argument("make_figure: bone '" + bone.name +
                                  "' hangs on none of those before it");
    }
    Joint joint{.name = bone.name,
                .type = bone.turns ? JointType::ball : JointType::fixed,
                .parent = capture.bones[bone.parent].name,
                .child = bone.name};
    joint.X_PJ = bone.X_PB;
    figure.joints.push_back(std::move(joint));
  }
  return RobotModel(std::move(figure));
}

RobotMotion capture_motion(const RobotModel& figure, const MotionCapture& capture,
                           std::size_t first, std::size_t last, const Pose& X_WC) {
  require_frames(figure, capture, first, last);
  std::vector<double> times;
  for (std::size_t k = first; k <= last; ++k) {
    times.push_back(static_cast<double>(k - first) / static_cast<double>(last - first));
  }
  const auto poses = [&](const auto& pose_of) {
    std::vector<Pose> all;
    for (std::size_t k = first; k <= last; ++k) {
      all.push_back(pose_of(capture.frames[k]));
    }
    return all;
  };
  const Eigen::Quaterniond R_WC = X_WC.rotation.normalized();
  const Motion base =
      through(times, poses([&](const CaptureFrame& frame) {
                return Pose{X_WC.position + R_WC * frame.root_position, R_WC * frame.rotations[0]};
              }));
  std::map<std::string, JointMotion> joints;
  for (std::size_t b = 1; b < capture.bones.size(); ++b) {
    if (capture.bones[b].turns) {
      joints.emplace(capture.bones[b].name,
                     through(times, poses([&](const CaptureFrame& frame) {
                               return Pose{Eigen::Vector3d::Zero(), frame.rotations[b]};
                             })));
    }
  }
  return RobotMotion(figure, std::move(joints), base);
}

}  // namespace firstcontact
