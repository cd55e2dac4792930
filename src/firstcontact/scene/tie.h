/// @file
/// Springs, cables and joints between two bodies of a simulation.

#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <Eigen/Core>

namespace firstcontact {

/// The law of a tie.
enum class TieType {
  spring,  ///< A spring and a damper along the line between two points.
  cable,   ///< Two points get no farther apart than a length; elastic where a stiffness is given.
  pin,     ///< A point of each body is the same: a ball joint.
  hinge,   ///< The same, and a line through it is the same.
  weld,    ///< The two bodies move as one.
};

/// The words of TieType in files and in Python, in this order.
inline constexpr std::array<const char*, 5> kTieTypeWords{"spring", "cable", "pin", "hinge",
                                                          "weld"};

/// Something that ties two bodies, or a body to the world.
///
/// Pairs that are tied touch like any other pair, unless they are ignored.
struct Tie {
  TieType type = TieType::spring;
  /// Bodies or links, numbered as members of the scene; none: the world. Not both the world.
  std::array<std::optional<std::size_t>, 2> bodies = {};
  /// [m]  A point of each body, in its frame; of the world, in the world's frame.
  ///
  /// A joint needs one point. For the other body it is then where that point is at the start. A
  /// weld without points has the origin of the second body.
  std::array<std::optional<Eigen::Vector3d>, 2> points = {};
  /// [m]  >= 0  The length at which a spring has no force, or the greatest length of a cable.
  ///
  /// By default it is the distance at the start.
  std::optional<double> length = {};
  std::optional<double> stiffness = {};             ///< [N/m]  > 0, of springs and elastic cables.
  double damping = 0.0;                             ///< [N s/m]  >= 0, likewise.
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< Axis of a hinge in the frame of the first
                                                    ///< body; not zero.
};

}  // namespace firstcontact
