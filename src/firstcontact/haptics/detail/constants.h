/// @file
/// The constants of the contact loop, each with its unit and its consequence.

#pragma once

#include <cstddef>

namespace firstcontact::detail {

/// [-]  The contact distance, by the reach of the smallest tool. With a smaller one surfaces are
/// felt nearer to their true place, and turning along a contact takes more rounds.
inline constexpr double kContactDistanceOfReach = 1e-4;
/// [-]  The least contact distance, by the largest coordinate: with less, rounding could not be
/// proven.
inline constexpr double kLeastContactDistanceOfExtent = 0x1p-40;

// Distances, by the contact distance.

/// [-]  A contact is found at a distance between 1 and 1 + this.
inline constexpr double kFoundWithin = 0.25;
/// [-]  The gap at which tools come to rest. It is beyond the gap at which a contact is found, so
/// that they can slide on.
inline constexpr double kRestGap = 1.375;
/// [-]  Contacts nearer than this count, and are felt.
inline constexpr double kContactBand = 2.0;
/// [-]  Gap below which a pair is held to a fraction of its gap...
inline constexpr double kFreeGap = 1.3;
inline constexpr double kShareOfGap = 0.75;
/// [-]  ...but not to less than this. A pair that is nearer already is held to the larger fraction,
/// so that a wedged tool does not halve its gap again and again.
inline constexpr double kLeastHeldGap = 0.5;
inline constexpr double kShareOfJammedGap = 0.9;
/// [-]  Gap below which a tool first parts from its touches, if it gains at least the second
/// number.
inline constexpr double kPartBelow = 0.4;
inline constexpr double kLeastParting = 0.1;
/// [-]  Gap below which a pair moves only where it ends no nearer. At a gap that rounding blurs
/// nothing could be proven, not even that the tool is pulled out.
inline constexpr double kFloorOfGap = 0.01;
/// [-]  The fraction of its gap by which such a pair may come nearer nevertheless.
inline constexpr double kSlackOfFloor = 1e-6;
/// [-]  The most by which a turn in a round brings points of a pressed tool nearer, in second
/// order. With more, more rounds end at a contact.
inline constexpr double kSinkOfTurn = 1.2;
/// [-]  The least fraction of a plan that is made where plans turn back again and again...
inline constexpr double kLeastPartOfPlan = 1.0 / 64.0;
/// [-]  ...and the growth of that fraction in a round in which the plan does not turn back.
inline constexpr double kGrowthOfPart = 1.5;
/// [-]  The most by which links of a tool depart in a piece from the places that joints give
/// them...
inline constexpr double kBendOfLinks = 0.25;
/// [rad]  ...and the most by which they turn in it, well below half a turn.
inline constexpr double kMostTurnOfPiece = 1.5;
/// [pieces]  The most pieces of a round.
inline constexpr double kMostPiecesOfLinks = 12.0;
/// [-]  The most by which a course departs from a straight line in a round.
inline constexpr double kBendOfCourse = 0.5;
/// [-]  The most by which bodies with courses may push a tool farther than it has room. Beyond it
/// there is no room.
inline constexpr double kSlackOfRoom = 0.1;
/// [-]  Then the courses go on for this fraction of the time, and are tried again...
inline constexpr double kShareWithoutRoom = 0.25;
/// [-]  ...down to this fraction of it. Below it they wait until the cycle ends.
inline constexpr double kLeastShareOfCourses = 0.02;
/// [-]  A tool that slides at least this far in a cycle, at the rate of its last round, slides on
/// the body; else the body carries it along. Residuals of a plan are smaller.
inline constexpr double kSlideOfCycle = 0.1;
/// [-]  The fraction of a round for a course that bends away from each of 10,000 straight lines.
inline constexpr double kShareOfWildCourse = 1e-4;
/// [-]  The least rest of a round, after the courses are over, that counts as time of its own.
inline constexpr double kLeastRestOfRound = 1e-6;
/// [node groups and steps]  The work of a proof of one pair in one round. Where it is spent, the
/// pair is proven up to there...
inline constexpr std::size_t kProofSteps = 20'000;
/// [node groups and steps]  ...but where it proves nothing, it is doubled up to this work...
inline constexpr std::size_t kMostProofSteps = 640'000;
/// [-]  ...for a part of the plan that is shorter by this factor...
inline constexpr double kShorterPart = 1.0 / 16.0;
/// [-]  ...down to this part.
inline constexpr double kShortestPart = 0x1p-16;
/// [-]  The most by which the time of a cycle is exceeded after cycles in which nothing could be
/// proven in time.
inline constexpr double kMostOvertime = 64.0;
/// [steps]  The work of a proof by the hulls of two convex members, before their triangles are
/// searched.
inline constexpr std::size_t kHullSteps = 1000;
/// [-]  The most by which a vertex of a convex member may lie outside of a triangle's plane.
inline constexpr double kSlackOfConvex = 0.01;
/// [-]  The least gain of a motion that is made, so that sticking tools do not creep.
inline constexpr double kLeastGain = 0.01;
/// [-]  Residual of the solver.
inline constexpr double kSolvedTo = 1e-3;
/// [-]  The most by which a neighbour beside a near feature may reach farther than the feature.
inline constexpr double kSlackOfNeighbours = 0.25;
/// [-]  The most by which a neighbour far from it may do so...
inline constexpr double kSlackOfFarNeighbours = 2.0;
/// [-]  ...that is, at least this fraction of a tool's reach away. A turn moves the load from one
/// end of a long edge to the other within a cycle, so both ends count.
inline constexpr double kFarNeighbour = 0.25;

// Many contacts.

/// [contacts]  Number of contacts of a pair from which only the nearest of each neighbourhood
/// count...
inline constexpr std::size_t kManyContacts = 300;
/// [-]  ...and the width of a neighbourhood, by the reach of the smaller body.
inline constexpr double kWidthOfNeighbourhood = 0.05;
/// [-]  Distance, by that reach, and cosine of the normals at which two contacts are one.
inline constexpr double kOnePlace = 1e-3;
inline constexpr double kOneNormal = 1.0 - 1e-5;
/// [contacts]  The most contacts of a projection; of more a reduced set is taken.
inline constexpr std::size_t kMostProjected = 64;

/// [-]  Bound of the difference between proven and recorded pieces, by their sizes: pieces are
/// rounded.
inline constexpr double kRoundingOfPieces = 0x1p-46;

}  // namespace firstcontact::detail
