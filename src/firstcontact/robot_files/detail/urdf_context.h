/// @file
/// The context that the readers of a URDF's elements share.

#pragma once

#include <filesystem>
#include <functional>

#include <firstcontact/motion/pose.h>
#include <firstcontact/robot_files/detail/urdf_names.h>
#include <firstcontact/robot_files/read_urdf.h>
#include <firstcontact/text/reading_log.h>
#include <firstcontact/text/xml_names.h>
#include <firstcontact/text/xml_reader.h>

namespace firstcontact::detail {

/// One document, its names and its log. All members outlive it.
struct UrdfContext {
  const XmlReader& xml;
  const XmlNameCheck& names;
  ReadingLog& log;
  const std::filesystem::path& source;
  const UrdfOptions& options;

  /// Calls `read`, and logs its error, so that the elements after it are read.
  void attempt(const std::function<void()>& read) const;

  /// The <origin> of an element; the identity where there is none.
  ///
  /// @throws ParseError
  [[nodiscard]] Pose origin(const XmlElement& element) const;

  /// Passes over a pose where urdfdom reads none.
  ///
  /// It warns where the pose is the identity, and refuses it where the author may have meant
  /// something.
  void pass_over_pose(const XmlElement& element, const char* what, const Pose& pose) const;
};

/// The pose of an <origin>.
///
/// @throws ParseError
[[nodiscard]] Pose pose_of(const XmlElement& origin, const XmlReader& xml);

}  // namespace firstcontact::detail
