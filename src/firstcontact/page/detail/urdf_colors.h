/// @file
/// The colours that a URDF file gives to its links.

#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace firstcontact::detail {

/// Of each link by name, of each of its visuals in order: red, green and blue, each in [0, 1].
using UrdfColors = std::map<std::string, std::vector<std::optional<Eigen::Vector3d>>>;

/// Colours decide nothing: what is no colour is left out, whatever is wrong with it.
[[nodiscard]] UrdfColors parse_urdf_colors(std::string_view text);

/// As parse_urdf_colors(); of a file that cannot be read there are none.
[[nodiscard]] UrdfColors read_urdf_colors(const std::filesystem::path& path);

}  // namespace firstcontact::detail
