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

/// [tools]  The most tools of a session.
inline constexpr std::size_t kMostTools = 2;

/// [contacts]  The most contacts of a published set.
inline constexpr std::size_t kMostHapticContacts = 128;

/// [joints]  The most joints that move, of all tools of a session together.
inline constexpr std::size_t kMostHapticJoints = 24;

/// [links]  The most links of all tools of a session together.
inline constexpr std::size_t kMostHapticLinks = 64;

/// The axis of the joint that moves a link.
struct HapticAxis {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();       ///< [m]  World, on the axis.
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< [-]  Unit, world.
};

/// A place where a tool touches its environment, the other tool or itself.
struct HapticContact {
  std::int32_t tool = 0;    ///< The tool to which the normal points.
  std::int32_t other = -1;  ///< The other tool, or the same; -1 for the environment.
  std::int32_t body = -1;   ///< The number of the body in the environment; -1 for a tool.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    ///< [m]  World, between the surfaces.
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< [-]  Unit, world.
  double gap = 0.0;                                   ///< [m]  Distance of the surfaces; > 0.
  double way = 0.0;  ///< [m]  Distance by which the tool may come nearer along the normal; >= 0.
  double friction = 0.0;  ///< [-]  Coulomb's coefficient; >= 0.
  /// [m/s]  Velocity of the point of the environment; 0 for the other tool.
  Eigen::Vector3d surface_velocity = Eigen::Vector3d::Zero();
  /// Whether the tool slid on a body with a course when the cycle ended, rather than being carried
  /// along by it. False for other contacts.
  bool slides = false;
  std::int32_t link = -1;  ///< The link, among the links of all tools; -1: the body of the tool.
  std::int32_t other_link = -1;  ///< The link of the other tool, likewise.
};

/// The set that the contact loop publishes: the poses of the god-objects and the contacts that hold
/// them.
///
/// The size is fixed, so a copy allocates nothing.
struct HapticContactSet {
  std::uint64_t sequence = 0;  ///< Number of the set; 0 where nothing is published yet.
  std::int64_t stamp_ns = 0;   ///< [ns]  Time at which the device poses of this cycle were read.
  /// [ns]  Time after the stamp at which the surfaces are where the set has them.
  std::int64_t lasted_ns = 0;
  std::uint32_t tools = 0;
  std::uint32_t count = 0;       ///< Number of contacts that are listed.
  std::uint32_t full_count = 0;  ///< Number of contacts for which these stand.
  /// [rad]  Angle by which a motion that the listed contacts permit may violate any other contact,
  /// at most. 0 where all are listed.
  double angle = 0.0;
  bool is_unproven = false;                ///< As HapticCycle::is_unproven.
  std::array<Pose, kMostTools> X_WB = {};  ///< Poses of the god-objects.
  /// [m]  Centres of the god-objects.
  std::array<Eigen::Vector3d, kMostTools> p_WC = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  std::array<HapticContact, kMostHapticContacts> contacts = {};
  std::uint32_t joint_count = 0;  ///< Number of joints of all tools, in their order.
  std::uint32_t link_count = 0;
  std::array<double, kMostHapticJoints> joints = {};   ///< [rad or m]  Joints of the god-objects.
  std::array<HapticAxis, kMostHapticLinks> axes = {};  ///< Axes of the links' joints.
  std::uint64_t checksum = 0;                          ///< The checksum_of() the rest.
};

/// Computes a checksum of all but its own field. It almost certainly changes where a set is torn.
[[nodiscard]] FIRSTCONTACT_API std::uint64_t checksum_of(const HapticContactSet& set) noexcept;

}  // namespace firstcontact
