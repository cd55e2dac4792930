/// @file
/// Passages whose clearance is known by construction, and twins that nothing gets through.

#pragma once

#include <span>
#include <string>
#include <string_view>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/edges/edge_checker.h>

namespace firstcontact::test {

/// A body that has to get through a passage.
///
/// The body is as wide as `width`, the passage by `clearance` wider. Above 0 there is a way, by
/// construction. Below 0 there is none; the proof is one for all families. The body holds a ball of
/// diameter `width` around each point of its core. On every way a point of the core crosses some
/// section of the passage, whose free part lies between two faces that are width + clearance apart.
/// The ball does not fit between these.
struct NarrowPassage {
  PlanScene scene;
  Configuration start;
  Configuration goal;
  double width = 0.0;      ///< [m]
  double clearance = 0.0;  ///< [m]
};

/// The families:
/// - window: a bar through a window that it fits lengthwise;
/// - peg: a square peg through a square hole almost as deep as it is long;
/// - tunnel: a cube through a tunnel with two corners;
/// - trap: a bar out of a box, by a tube that leads inwards;
/// - dovetail: a wedge-shaped slide out of its channel;
/// - bayonet: a plate through two slots that are turned against each other: slide, turn, slide;
/// - links: a closed link off an open one, by its gap;
/// - maze: a cube through a maze between two lids.
[[nodiscard]] std::span<const char* const> narrow_families();

/// @param family     one of narrow_families()
/// @param clearance  [m]  below 0 for a twin without a way; not 0, and of at most 0.1 m
[[nodiscard]] NarrowPassage narrow_passage(std::string_view family, double clearance);

}  // namespace firstcontact::test
