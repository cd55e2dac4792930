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

/// The colours of each link's visuals, in order, by the link's name: red, green and blue in [0, 1].
using UrdfColors = std::map<std::string, std::vector<std::optional<Eigen::Vector3d>>>;

/// Parses the colours of a URDF; any faulty colour is left out, as colours decide nothing.
[[nodiscard]] UrdfColors parse_urdf_colors(std::string_view text);

/// Reads the colours as parse_urdf_colors() does; none for a file that cannot be read.
[[nodiscard]] UrdfColors read_urdf_colors(const std::filesystem::path& path);

}  // namespace firstcontact::detail
