/// @file
/// The contacts of tools at one moment, as the contact loop hands them to the force loop.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact {

/// [tools]  A session has at most so many.
inline constexpr std::size_t kMostTools = 2;

/// [contacts]  A published set has at most so many.
inline constexpr std::size_t kMostHapticContacts = 128;

/// [joints]  The tools of a session have at most so many joints that move, all together.
inline constexpr std::size_t kMostHapticJoints = 24;

/// [links]  The tools of a session have at most so many links, all together.
inline constexpr std::size_t kMostHapticLinks = 64;

/// The axis of the joint that moves a link.
struct HapticAxis {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();       ///< [m]  World, on the axis.
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< [-]  Unit, world.
};

/// A place where a tool touches the surroundings, the other tool or itself.
struct HapticContact {
  std::int32_t tool = 0;    ///< The normal points to it.
  std::int32_t other = -1;  ///< The other tool, or the same; -1 for the surroundings.
  std::int32_t body = -1;   ///< The number among the surroundings; -1 for a tool.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    ///< [m]  World, between the surfaces.
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< [-]  Unit, world.
  double gap = 0.0;                                   ///< [m]  Between the surfaces; > 0.
  double way = 0.0;       ///< [m]  The tool may come so much nearer along the normal; >= 0.
  double friction = 0.0;  ///< [-]  Coulomb's coefficient; >= 0.
  /// [m/s]  Velocity of the point of the surroundings; 0 for the other tool.
  Eigen::Vector3d surface_velocity = Eigen::Vector3d::Zero();
  std::int32_t link = -1;        ///< Of the tool, among the links of all tools; -1: its body.
  std::int32_t other_link = -1;  ///< The same of the other tool.
};

/// The set that the contact loop publishes: where the god-objects are, and what holds them.
///
/// The size is fixed, so a copy allocates nothing.
struct HapticContactSet {
  std::uint64_t sequence = 0;  ///< Counts the sets; 0 where nothing is published yet.
  std::int64_t stamp_ns = 0;   ///< [ns]  When the device poses were read that led here.
  std::int64_t lasted_ns = 0;  ///< [ns]  Surfaces are where they are so long after the stamp.
  std::uint32_t tools = 0;
  std::uint32_t count = 0;       ///< Contacts that are listed.
  std::uint32_t full_count = 0;  ///< Contacts that these stand for.
  /// [rad]  The listed contacts allow no motion that leaves one of all by more than this angle; 0
  /// where all are listed.
  double angle = 0.0;
  std::array<Pose, kMostTools> X_WB = {};             ///< Of the god-objects.
  std::array<Eigen::Vector3d, kMostTools> p_WC = {};  ///< [m]  Their centres.
  std::array<HapticContact, kMostHapticContacts> contacts = {};
  std::uint32_t joint_count = 0;  ///< Of all tools, in their order.
  std::uint32_t link_count = 0;
  std::array<double, kMostHapticJoints> joints = {};   ///< [rad or m]  Of the god-objects.
  std::array<HapticAxis, kMostHapticLinks> axes = {};  ///< Of the links' joints.
  std::uint64_t checksum = 0;                          ///< checksum_of() the rest.
};

/// A number that almost certainly changes where a set is torn: of all but its own field.
[[nodiscard]] FIRSTCONTACT_API std::uint64_t checksum_of(const HapticContactSet& set) noexcept;

}  // namespace firstcontact
