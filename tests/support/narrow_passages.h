/// @file
/// Passages whose clearance is known by construction, and closed twins.

#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/edges/edge_checker.h>

namespace firstcontact::test {

/// A body that has to move through a passage.
///
/// The body is as wide as `width`, and the passage is wider by `clearance`. Above 0 a path exists,
/// by construction. Below 0 no path exists; one proof covers all families. The body holds a ball of
/// diameter `width` around each point of its core. On every path a point of the core crosses some
/// section of the passage, whose free part lies between two faces. Their distance is
/// width + clearance, which is less than the diameter of the ball.
struct NarrowPassage {
  PlanScene scene;
  Configuration start;
  Configuration goal;
  double width = 0.0;      ///< [m]
  double clearance = 0.0;  ///< [m]
  /// A path by construction. Where it is tight, half the clearance is on each side; between the
  /// openings of the tubes it is the whole. Empty where none is written down; in a twin it
  /// collides.
  std::vector<Configuration> way = {};
};

/// The families:
/// - window: a bar through a window that it fits lengthwise;
/// - peg: a square peg through a square hole almost as deep as it is long;
/// - tunnel: a cube through a tunnel with two corners;
/// - trap: a bar out of a box, by a tube that leads inwards;
/// - dovetail: a wedge-shaped slide out of its channel;
/// - bayonet: a plate through two slots that are turned against each other: slide, turn, slide;
/// - links: a closed link off an open one, by its gap;
/// - maze: a cube through a maze between two lids;
/// - tubes: two bent tubes that hang in each other, like those of the alpha puzzle, off each other:
///   both openings have to meet at right angles;
/// - key: a key of two bits through a lock of two plates: slide and turn, four times and three;
/// - screw: an eye off a coil of wire, by screwing it along the wire.
[[nodiscard]] std::span<const char* const> narrow_families();

/// @param family     one of narrow_families()
/// @param clearance  [m]  below 0 for a twin without a path; not 0, and at most 0.1 m
[[nodiscard]] NarrowPassage narrow_passage(std::string_view family, double clearance);

}  // namespace firstcontact::test
