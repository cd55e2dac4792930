/// @file
/// Reads the objects of a planning scene.

#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/foreign_scenes/planning_scene.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/read_path.h>
#include <firstcontact/trajectory_files/detail/ros_message.h>

namespace firstcontact::detail {

/// Adds objects that rest, and objects that links hold, to a planning scene.
class PlanningObjects {
 public:
  /// Prepares the reading.
  ///
  /// @param source  meshes are relative to its folder
  /// @param frame   of the robot's root link: it is the planning frame
  /// @param read    outlives this
  PlanningObjects(const std::filesystem::path& source, std::string_view frame,
                  const JsonReader& read);

  /// Reads fixed_frame_transforms: frames that objects may be in.
  void add_frames(const JsonValue& transforms);
  /// Whether the frame "world" is not the planning frame.
  [[nodiscard]] bool moves_world() const;

  /// Adds the bodies of a moveit_msgs/CollisionObject.
  void add_object(const JsonValue& value, PlanningScene& scene);

  /// Adds the bodies of a moveit_msgs/AttachedCollisionObject.
  void add_attached(const JsonValue& value, PlanningScene& scene);

  /// The objects and frames with a pose whose quaternion is zero.
  [[nodiscard]] const std::vector<std::string>& with_zero_quaternions() const { return zeros_; }

 private:
  std::string new_id(const JsonValue& object);
  [[nodiscard]] Pose frame_of(const JsonValue& message) const;
  Pose pose_of(const JsonValue& message, const std::string& of);
  std::vector<Body> parts_of(const JsonValue& object, const std::string& id, const Pose& frame);
  void add_parts(const JsonValue& object, std::string_view shapes_key, std::string_view poses_key,
                 const Pose& X_WO, std::vector<Body>& parts, const std::string& id);
  void refuse_others(const JsonValue& object) const;

  SceneFolders folders_;
  const JsonReader& read_;
  std::string planning_frame_;
  std::map<std::string, Pose, std::less<>> frames_;
  std::set<std::string> ids_;
  std::vector<std::string> zeros_;
};

}  // namespace firstcontact::detail
