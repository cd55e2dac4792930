/// @file
/// The numbers that the contact loop depends on, each with its unit and its consequence.

#pragma once

#include <cstddef>

namespace firstcontact::detail {

/// [-]  The contact distance, by the reach of the smallest tool. Smaller: surfaces are felt nearer
/// to where they are, and turning along a contact takes more rounds.
inline constexpr double kContactDistanceOfReach = 1e-4;
/// [-]  The least contact distance, by the largest coordinate, or rounding could not be proven.
inline constexpr double kLeastContactDistanceOfExtent = 0x1p-40;

// Distances, by the contact distance.

/// [-]  A contact is found at 1 to 1 + this.
inline constexpr double kFoundWithin = 0.25;
/// [-]  Tools come to rest here: beyond where a contact is found, so that they can slide on.
inline constexpr double kRestGap = 1.375;
/// [-]  Contacts within it count, and are felt.
inline constexpr double kContactBand = 2.0;
/// [-]  A pair that is nearer than this is held to a share of its gap...
inline constexpr double kFreeGap = 1.3;
inline constexpr double kShareOfGap = 0.75;
/// [-]  ...but not below this, unless it is there already: then to the larger share, so that what
/// is wedged does not halve its way to nothing.
inline constexpr double kLeastHeldGap = 0.5;
inline constexpr double kShareOfJammedGap = 0.9;
/// [-]  A tool with a touch nearer than this first parts from its touches, if that takes it as far
/// as the second number.
inline constexpr double kPartBelow = 0.4;
inline constexpr double kLeastParting = 0.1;
/// [-]  A pair that is nearer than this moves only where it ends no nearer: at a gap that rounding
/// blurs nothing could be proven, not even that the tool is pulled out.
inline constexpr double kFloorOfGap = 0.01;
/// [-]  By this part of its gap it may come nearer nevertheless.
inline constexpr double kSlackOfFloor = 1e-6;
/// [-]  A tool that contacts press turns by no more in a round than brings its points this much
/// nearer, in second order. Larger: more rounds end at a contact.
inline constexpr double kSinkOfTurn = 1.2;
/// [-]  Links of a tool move in pieces in which they stay so near to where joints have them...
inline constexpr double kBendOfLinks = 0.25;
/// [rad]  ...and turn by no more, far less than half a turn.
inline constexpr double kMostTurnOfPiece = 1.5;
/// [pieces]  A round has at most so many.
inline constexpr double kMostPiecesOfLinks = 12.0;
/// [-]  A round ends before a course has bent away so far from a straight line.
inline constexpr double kBendOfCourse = 0.5;
/// [-]  Where bodies with courses bring a tool so much nearer than it may come, there is no room.
inline constexpr double kSlackOfRoom = 0.1;
/// [-]  Then they go on for this part of the time, and are tried again.
inline constexpr double kShareWithoutRoom = 0.25;
/// [-]  ...until less than this part of it: then they wait until the cycle ends.
inline constexpr double kLeastShareOfCourses = 0.02;
/// [-]  So does a part of a round in which a course bends away from any of 10,000 straight lines.
inline constexpr double kShareOfWildCourse = 1e-4;
/// [-]  Of a round: what is left of it after the courses are over counts from here on.
inline constexpr double kLeastRestOfRound = 1e-6;
/// [node groups and steps]  A proof of one pair in one round; what is spent is proven until there.
inline constexpr std::size_t kProofSteps = 20'000;
/// [-]  A motion that gains less than this is not made: what sticks does not creep.
inline constexpr double kLeastGain = 0.01;
/// [-]  Of the solver's residual.
inline constexpr double kSolvedTo = 1e-3;
/// [-]  A neighbour of a feature may reach so much farther than the feature that is near.
inline constexpr double kSlackOfNeighbours = 0.25;

// Many contacts.

/// [contacts]  Of a pair; of more only the nearest of each neighbourhood count...
inline constexpr std::size_t kManyContacts = 300;
/// [-]  ...which is about as wide as this, by the reach of the smaller body.
inline constexpr double kWidthOfNeighbourhood = 0.05;
/// [-]  Contacts nearer to each other than this, by that reach, with normals of this cosine, are
/// one.
inline constexpr double kOnePlace = 1e-3;
inline constexpr double kOneNormal = 1.0 - 1e-5;
/// [contacts]  A projection has at most so many; of more a reduced set.
inline constexpr std::size_t kMostProjected = 64;

/// [-]  Pieces are rounded: what was proven and what is recorded differ by less, of the sizes.
inline constexpr double kRoundingOfPieces = 0x1p-46;

}  // namespace firstcontact::detail
