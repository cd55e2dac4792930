/// @file
/// Generated first-contact questions: each a pure function of its family and index.

#pragma once

#include <cstdint>
#include <string>

#include "support/moving_soup.h"

namespace firstcontact::oracle {

/// Families of questions.
///
/// The comments name the features of a family. All families also vary size (1e-6 to 1e6), distance
/// from the origin, orientation, margin, radius and tolerance.
enum class Family {
  plane_drop,        ///< A corner falls on a face: first contact in closed form.
  needle_swing,      ///< A needle turns into a wall: asin in closed form.
  random_slow,       ///< Random soups that turn by 0.01 to 1 rad.
  random_turning,    ///< Random soups that turn by up to ten turns.
  random_screws,     ///< Random soups on screws.
  random_waypoints,  ///< Random soups through up to five waypoints.
  tumbling_boxes,    ///< Closed boxes that meet while tumbling.
  tip_swing,         ///< A turning tip passes, or cuts, a wall by 1e-2 to 1e-10.
  rocking,           ///< A corner slides and rocks at a height of 1e-2 to 1e-10 over a face.
  passing_edges,     ///< Two edges pass each other at such a distance.
  bounce,            ///< A corner comes as near at a waypoint and leaves.
  peg_in_hole,       ///< A box slides through a square tube with such a clearance.
  sliding_faces,     ///< Faces in one plane, or at such a height, slide and turn into each other.
  planar,            ///< Both soups and their motions in one plane.
  parallel_edges,    ///< Parallel edges and faces that meet flatly.
  needles,           ///< Triangles of an aspect down to 1e-8.
  points,            ///< Triangles that are points and edges.
  start_contact,     ///< Soups that touch, or nearly touch, at t = 0.
  end_contact,       ///< Soups that touch, or nearly touch, at t = 1.
  bullets,           ///< Soups that overlap for less than 1e-4 of the step.
};

inline constexpr int kFamilyCount = static_cast<int>(Family::bullets) + 1;

std::string name(Family family);

struct GeneratedCase {
  MovingSoup A;
  MovingSoup B;
  double margin = 0.0;     ///< [m]
  double tolerance = 0.0;  ///< [m]
};

/// Generates a case; with every compiler it has the same bits.
///
/// It uses only + - * / and square roots of doubles.
GeneratedCase generate(Family family, std::uint64_t index);

/// Computes a digest of all numbers of a case, which shows that a generator changed.
std::uint32_t digest(const GeneratedCase& c);

}  // namespace firstcontact::oracle
