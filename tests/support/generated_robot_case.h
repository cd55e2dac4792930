/// @file
/// Generated first-contact questions about links: each a pure function of its family and index.

#pragma once

#include <cstdint>
#include <string>

#include "support/robot_input.h"

namespace firstcontact::oracle {

/// Families of questions about links.
///
/// All families also vary size (0.01 to 100), number of joints (up to 12), orientation, margin,
/// radius and tolerance.
enum class RobotFamily {
  link_and_rest,     ///< A link on joints of all types against a mesh at rest.
  link_and_body,     ///< A link against a free body on a constant velocity, or through waypoints.
  own_links,         ///< Two links of one tree, on a base that rotates fast.
  two_robots,        ///< Links of two robots.
  high_polynomials,  ///< Coordinates on quintics, and polynomials of degree 5 to 7.
  mimics,            ///< Most joints mimic others.
  poses,             ///< Floating, ball and planar joints.
  many_turns,        ///< Joints that turn up to 30 times.
  far_away,          ///< The world's origin is 1e6 sizes away.
  grazing,           ///< A corner passes a face at the margin, up to 1e-2 to 1e-10 of the size.
  ends,              ///< A corner is as near to the margin at t = 0 or 1.
  link_and_cloth,    ///< A link against a mesh whose vertices each move on a line.
};

inline constexpr int kRobotFamilyCount = static_cast<int>(RobotFamily::link_and_cloth) + 1;

std::string name(RobotFamily family);

/// Generates a case; with every compiler it has the same bits.
///
/// It uses + - * / and square roots of doubles, and positions in 256 bits.
RobotCase generate(RobotFamily family, std::uint64_t index);

/// Computes a digest of all numbers of a case, which shows that a generator changed.
std::uint32_t digest(const RobotCase& c);

}  // namespace firstcontact::oracle
