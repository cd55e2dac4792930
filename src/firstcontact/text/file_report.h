/// @file
/// The report on a file that was read: what was taken, what was left out and why.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace firstcontact {

/// The strictness of readers.
struct ReadingOptions {
  /// Makes a warning of an unknown name that could hold or place geometry; by default it is an
  /// error.
  bool lenient = false;
};

/// The number of things of one kind in a file.
struct FileContent {
  std::string what;  ///< The kind in the plural: "triangles".
  std::size_t count = 0;
};

/// Something that the reader passed over, and why it can make no contact.
struct LeftOut {
  std::string name;    ///< The name in the file: "<material>", "KHR_lights_punctual".
  std::string reason;  ///< "looks", "animation", "settings of a simulator"
  std::size_t count = 0;
};

/// The account of one file. It lists everything that could make a contact.
struct FileReport {
  std::string path;                   ///< As it was named.
  std::string format;                 ///< "glTF", "STL", "URDF"
  std::vector<FileContent> contents;  ///< The things that were taken, in a fixed order.
  std::string unit;               ///< The unit of lengths: "1 m"; empty where the format has none.
  std::vector<LeftOut> left_out;  ///< By name and reason, in order of appearance.
  std::vector<std::string> warnings;   ///< One line each, with path and place.
  std::vector<std::string> also_read;  ///< Paths of files that belong to it, as opened.
};

}  // namespace firstcontact
