/// @file
/// Names of joints and links of one or several movers of a scene.

#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace firstcontact {
struct Scene;
}

namespace firstcontact::detail {

/// What moves in a scene: robots, and at most one body.
struct MoverNumbers {
  std::span<const std::size_t> robots = {};
  std::optional<std::size_t> body = {};
};

/// The name of a joint or link, and its mover.
struct RobotName {
  std::size_t which = 0;  ///< Index among the given robots; their number for the body.
  std::string name;       ///< Name in that robot; of a body such as "trans_x".
};

/// Splits a name: that of a joint or link where one robot alone moves, else ROBOT/NAME or
/// BODY/NAME.
///
/// @param movers  indices in the scene; at least one robot
/// @throws std::invalid_argument  names a text that begins with none of the movers' names, or with
///         two
[[nodiscard]] RobotName split_mover_name(const Scene& scene, const MoverNumbers& movers,
                                         std::string_view name);

/// Splits a name where robots alone move.
[[nodiscard]] RobotName split_robot_name(const Scene& scene, std::span<const std::size_t> robots,
                                         std::string_view name);

/// The name of a joint or link of a mover, as split_mover_name() takes it.
///
/// @param which  index among the robots; their number for the body
[[nodiscard]] std::string joined_mover_name(const Scene& scene, const MoverNumbers& movers,
                                            std::size_t which, const std::string& name);

}  // namespace firstcontact::detail
