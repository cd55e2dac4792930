/// @file
/// Generated first-contact questions: each a pure function of its family and index.

#pragma once

#include <cstdint>
#include <string>

#include "support/moving_soup.h"

namespace firstcontact::oracle {

/// What the questions of a family have in common; the comments say what is varied besides size
/// (1e-6 to 1e6), distance from the origin, orientation, margin, radius and tolerance.
enum class Family {
  plane_drop,        ///< A corner falls on a face: first contact in closed form.
  needle_swing,      ///< A needle turns into a wall: asin in closed form.
  random_slow,       ///< Random soups that turn by 0.01 to 1 rad.
  random_turning,    ///< Random soups that turn by up to ten turns.
  random_screws,     ///< Random soups on screws.
  random_waypoints,  ///< Random soups through up to five waypoints.
  tumbling_boxes,    ///< Closed boxes that meet while tumbling.
  tip_swing,         ///< A turning tip passes, or cuts, a wall by 1e-2 to 1e-10.
  rocking,           ///< A corner slides and rocks at such a height over a face.
  passing_edges,     ///< Two edges pass each other at such a distance.
  bounce,            ///< A corner comes that near at a waypoint and leaves.
  peg_in_hole,       ///< A box slides through a square tube with such a clearance.
  sliding_faces,     ///< Faces in one plane, or at such a height, slide and turn into each other.
  planar,            ///< All of it in one plane.
  parallel_edges,    ///< Parallel edges and faces that meet flatly.
  needles,           ///< Triangles of an aspect down to 1e-8.
  points,            ///< Triangles that are points and edges.
  start_contact,     ///< Touching, or nearly, at t = 0.
  end_contact,       ///< Touching, or nearly, at t = 1.
  bullets,           ///< Overlap for less than 1e-4 of the step.
};

inline constexpr int kFamilyCount = static_cast<int>(Family::bullets) + 1;

std::string name(Family family);

struct GeneratedCase {
  MovingSoup A;
  MovingSoup B;
  double margin = 0.0;     ///< [m]
  double tolerance = 0.0;  ///< [m]
};

/// The same bits with every compiler: only + - * / and square roots of doubles.
GeneratedCase generate(Family family, std::uint64_t index);

/// A digest of all numbers of a case, to notice a generator that changed.
std::uint32_t digest(const GeneratedCase& c);

}  // namespace firstcontact::oracle
