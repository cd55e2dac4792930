/// @file
/// Reads SRDF: the groups, states, end effectors and disabled pairs of a robot.

#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/robot/robot_model.h>
#include <firstcontact/text/file_report.h>

namespace firstcontact {

/// A named part of the robot. Indices rise, and each is there once.
struct RobotGroup {
  std::string name;
  std::vector<std::size_t> links;
  std::vector<std::size_t> joints;
};

/// A named configuration of a group.
struct GroupState {
  struct JointValue {
    std::size_t joint = 0;
    /// [rad or m]  As many numbers as the joint has coordinates. A floating joint has seven: its
    /// position, then the quaternion x, y, z, w, as MoveIt orders them.
    std::vector<double> coordinates;
  };
  std::string name;
  std::string group;
  std::vector<JointValue> values;
};

/// A group that serves as a tool, on a link of another.
struct EndEffector {
  std::string name;
  std::string group;
  std::size_t parent_link = 0;
};

/// The contents of an SRDF file.
struct RobotSemantics {
  std::string robot;
  std::vector<DisabledPair> disabled;  ///< In order of the indices, each pair once.
  std::vector<RobotGroup> groups;
  std::vector<GroupState> states;
  std::vector<EndEffector> end_effectors;

  /// The report on the file.
  ///
  /// Files that variants of a robot share hold elements that name links or joints which this robot
  /// does not have, or has fixed. One warning counts them for each kind of element. They have no
  /// effect: none can hide a contact.
  FileReport report;
  std::vector<std::string> warnings;  ///< The warnings of the report.

  /// Whether the pair is in `disabled`.
  [[nodiscard]] FIRSTCONTACT_API bool is_disabled(std::size_t link, std::size_t other) const;
};

/// Reads an SRDF file for a robot.
///
/// A group holds its links with their parent joints, its joints with their child links, its chains
/// with both ends, and what its subgroups hold. `disable_default_collisions` disables a link
/// against all others, which `enable_collisions` takes back. Virtual and passive joints, sphere
/// approximations and elements of other tools are left out by name. A name near a known one is an
/// error, as in read_robot().
///
/// @throws ParseError  one line with path, place, element and what was expected, for all errors
[[nodiscard]] FIRSTCONTACT_API RobotSemantics read_srdf(const std::filesystem::path& path,
                                                        const RobotModel& robot,
                                                        const ReadingOptions& options = {});

/// Parses the text of an SRDF file, as read_srdf() reads it.
///
/// @param source  names the text in errors
[[nodiscard]] FIRSTCONTACT_API RobotSemantics parse_srdf(std::string_view text,
                                                         const std::string& source,
                                                         const RobotModel& robot,
                                                         const ReadingOptions& options = {});

}  // namespace firstcontact
