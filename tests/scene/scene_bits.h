/// @file
/// All content of a scene, comparable bit for bit.

#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <firstcontact/scene/scene.h>

namespace firstcontact::test {

/// Bits of a scene's numbers, and its words.
///
/// The digest of its text and the content of robots' files are left out.
class SceneBits {
 public:
  explicit SceneBits(const Scene& scene) {
    add(scene.id);
    for (const Body& body : scene.bodies) {
      add(body.name);
      std::visit([this](const auto& source) { add(source); }, body.shape.source);
      add(static_cast<double>(body.shape.source.index()));
      add(body.shape.radius);
      add(static_cast<double>(body.shape.filling));
      add(body.shape.enclosure_error);
      add(static_cast<double>(body.motion.index()));
      std::visit([this](const auto& motion) { add(motion); }, body.motion);
      add(body.free);
      add(body.surface);
    }
    for (const SceneRobot& robot : scene.robots) {
      add(robot);
    }
    for (const BodyPair& pair : scene.ignored_pairs) {
      add(pair);
    }
    for (const PairMargin& pair : scene.pair_margins) {
      add(pair.bodies);
      add(pair.margin);
    }
    for (const BodyGroup& group : scene.groups) {
      add(group.name);
      for (const std::size_t body : group.bodies) {
        add(static_cast<double>(body));
      }
    }
    for (const GroupPair& pair : scene.ignored_groups) {
      add(pair);
    }
    for (const GroupMargin& pair : scene.group_margins) {
      add(pair.groups);
      add(pair.margin);
    }
    add(scene.options);
    add(scene.duration);
    add(scene.simulation);
  }

  friend bool operator==(const SceneBits&, const SceneBits&) = default;

 private:
  void add(double number) { bits_.push_back(std::bit_cast<std::uint64_t>(number)); }
  void add(const std::string& word) { words_.push_back(word); }
  void add(const BodyPair& pair) {
    add(static_cast<double>(pair[0]));
    add(static_cast<double>(pair[1]));
  }
  void add(const Eigen::Vector3d& v) {
    for (const double x : v) {
      add(x);
    }
  }
  void add(const Pose& pose) {
    add(pose.position);
    for (const double x : pose.rotation.coeffs()) {
      add(x);
    }
  }
  void add(Between between) { add(between == Between::screw ? 1.0 : 0.0); }

  void add(const MeshFile& file) {
    add(file.path.string());
    add(file.scale);
  }
  void add(const Mesh& mesh) {
    for (const Eigen::Vector3d& vertex : mesh.vertices) {
      add(vertex);
    }
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t corner : triangle) {
        add(static_cast<double>(corner));
      }
    }
  }

  void add(const Shape& shape) { add(shape.mesh()); }
  void add(const SphereShape& sphere) { add(sphere.radius); }
  void add(const CapsuleShape& capsule) {
    add(capsule.radius);
    add(capsule.length);
  }
  void add(const BoxShape& box) { add(box.size); }
  void add(const CylinderShape& cylinder) {
    add(cylinder.radius);
    add(cylinder.length);
    add(cylinder.enclosure_error.value_or(-1.0));
  }
  void add(const ConeShape& cone) {
    add(cone.radius);
    add(cone.length);
    add(cone.enclosure_error.value_or(-1.0));
  }
  void add(const EllipsoidShape& ellipsoid) {
    add(ellipsoid.radii);
    add(ellipsoid.enclosure_error.value_or(-1.0));
  }

  void add(const std::vector<Eigen::Vector3d>& points) {
    for (const Eigen::Vector3d& point : points) {
      add(point);
    }
  }
  void add(const ConvexHullShape& hull) {
    std::visit([this](const auto& of) { add(of); }, hull.of);
  }
  void add(const PointFile& file) {
    add(file.path.string());
    add(file.scale);
  }
  void add(const PointCloud& cloud) { add(cloud.points); }
  void add(const HeightFile& file) {
    add(file.path.string());
    add(file.cell.x());
    add(file.cell.y());
  }
  void add(const HeightMap& map) {
    add(map.cell.x());
    add(map.cell.y());
    add(static_cast<double>(map.columns));
    for (const double height : map.heights) {
      add(height);
    }
  }

  void add(const FixedMotion& motion) { add(motion.pose); }
  void add(const ConstantVelocityMotion& motion) {
    add(motion.from);
    add(motion.translation);
    add(motion.rotation_vector);
  }
  void add(const ScrewMotion& motion) {
    add(motion.from);
    add(motion.axis_point);
    add(motion.axis_direction);
    add(motion.angle);
    add(motion.translation);
  }
  void add(const TwoPoseMotion& motion) {
    add(motion.from);
    add(motion.to);
    add(motion.between);
  }
  void add(const WaypointMotion& motion) {
    for (const double time : motion.times) {
      add(time);
    }
    for (const Pose& pose : motion.poses) {
      add(pose);
    }
    add(motion.between);
  }
  void add(const VertexMotion& motion) {
    for (const Eigen::Vector3d& vertex : motion.to) {
      add(vertex);
    }
  }

  template <class T>
  void add(const std::optional<T>& value) {
    add(value ? 1.0 : 0.0);
    if (value) {
      add(*value);
    }
  }
  void add(const Eigen::Matrix3d& matrix) {
    for (const double x : matrix.reshaped()) {
      add(x);
    }
  }
  void add(const std::array<bool, 3>& locks) {
    for (const bool lock : locks) {
      add(lock ? 1.0 : 0.0);
    }
  }
  void add(const FreeBody& free) {
    add(free.density);
    add(free.mass);
    add(free.centre_of_mass);
    add(free.inertia);
    add(free.linear_velocity);
    add(free.angular_velocity);
    add(free.locked_translation);
    add(free.locked_rotation);
    for (const TimedForce& force : free.forces) {
      add(force.from);
      add(force.to);
      add(force.force);
      add(force.torque);
    }
  }
  void add(const Surface& surface) {
    add(surface.friction);
    add(surface.restitution);
    add(surface.velocity);
  }
  void add(const JointMotor& motor) {
    add(static_cast<double>(motor.kind));
    for (const TimedNumber& target : motor.target) {
      add(target.time);
      add(target.number);
    }
    add(motor.stiffness);
    add(motor.damping);
    add(motor.effort);
  }
  void add(const RobotDynamics& dynamics) {
    add(dynamics.has_free_base ? 1.0 : 0.0);
    add(dynamics.linear_velocity);
    add(dynamics.angular_velocity);
    for (const auto& [coordinate, velocity] : dynamics.velocities) {
      add(coordinate);
      add(velocity);
    }
    for (const auto& [joint, motor] : dynamics.motors) {
      add(static_cast<double>(joint));
      add(motor);
    }
    add(dynamics.density);
    add(dynamics.surface);
  }
  void add(const Simulation& simulation) {
    add(simulation.duration);
    add(simulation.step);
    add(simulation.gravity);
    add(simulation.friction);
    add(simulation.restitution);
    add(static_cast<double>(simulation.impacts));
    add(static_cast<double>(simulation.jams));
    add(simulation.contact_distance);
    add(static_cast<double>(simulation.events));
    for (const PairSurface& pair : simulation.pairs) {
      add(pair.bodies);
      add(pair.surface);
    }
    for (const Tie& tie : simulation.ties) {
      add(static_cast<double>(tie.type));
      for (std::size_t s = 0; s < 2; ++s) {
        add(tie.bodies[s] ? static_cast<double>(*tie.bodies[s]) : -1.0);
        add(tie.points[s]);
      }
      add(tie.length);
      add(tie.stiffness);
      add(tie.damping);
      add(tie.axis);
    }
  }

  void add(const Trajectory& trajectory) {
    if (trajectory.joint_names.empty()) {
      return;  // Its points move nothing.
    }
    for (const std::string& joint : trajectory.joint_names) {
      add(joint);
    }
    add(static_cast<double>(trajectory.turning));
    for (const TrajectoryPoint& point : trajectory.points) {
      add(point.time);
      for (const auto& numbers : {point.positions, point.velocities, point.accelerations}) {
        add(static_cast<double>(numbers.size()));
        for (const double number : numbers) {
          add(number);
        }
      }
    }
  }
  void add(const SceneAttachment& attached) {
    add(static_cast<double>(attached.body));
    add(static_cast<double>(attached.link));
    add(attached.from_time);
    add(attached.to_time);
    for (const std::size_t link : attached.touch_links) {
      add(static_cast<double>(link));
    }
    add(attached.pose);
  }
  void add(const SceneRobot& robot) {
    add(robot.name);
    add(robot.file.urdf.string());
    add(robot.srdf.string());
    for (const std::filesystem::path& root : robot.file.package_roots) {
      add(root.string());
    }
    add(static_cast<double>(robot.file.surface));
    add(static_cast<double>(robot.base.index()));
    std::visit([this](const auto& motion) { add(motion); }, robot.base);
    add(robot.trajectory);
    for (const auto& [coordinate, position] : robot.state) {
      add(coordinate);
      add(position);
    }
    for (const SceneAttachment& attached : robot.attached) {
      add(attached);
    }
    for (const auto& [link, padding] : robot.padding) {
      add(static_cast<double>(link));
      add(padding);
    }
    for (const auto& [joint, error] : robot.tracking_error) {
      add(static_cast<double>(joint));
      add(error.angle);
      add(error.distance);
    }
    add(robot.dynamics);
  }

  void add(const SceneOptions& options) {
    add(options.tolerance);
    add(options.margin);
    add(static_cast<double>(options.contacts.kind));
    add(static_cast<double>(options.contacts.most));
    add(static_cast<double>(options.start_contacts));
    add(options.contact_band);
    add(options.deadline.value_or(-1.0));
    add(options.lenient ? 1.0 : 0.0);
  }

  std::vector<std::uint64_t> bits_;
  std::vector<std::string> words_;
};

}  // namespace firstcontact::test
