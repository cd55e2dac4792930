/// @file
/// The numbers that choose the solver of a contact problem, each with its unit and its consequence.
/// The numbers of a solver's steps stand beside the solver.

#pragma once

#include <cstddef>

namespace firstcontact::detail {

// Which solver.

/// [velocities]  Size of the largest problem with factorisations. Larger ones are only swept, as
/// the work of factorisations grows faster than the number of velocities. Such sweeps may stop far
/// from an answer, but take less memory.
inline constexpr std::size_t kMostForAugmentedLagrangian = 6000;
/// [sweeps]  Sweeps after which the augmented Lagrangian takes over, unless sweeps may leave a
/// residual.
inline constexpr int kSweepsBeforeAugmentedLagrangian = 100;
/// [sweeps]  Sweeps before the augmented Lagrangian where contacts are many for each body.
inline constexpr int kSweepsOfRedundant = 30;
/// [sweeps]  Sweeps that follow, [-] to this fraction of the tolerance. The residual of one step
/// would otherwise add up from step to step.
inline constexpr int kExtraSweeps = 30;
inline constexpr double kExtraTolerance = 0.1;
/// [contacts]  Contacts for each body, that is for six velocities, from which the augmented
/// Lagrangian takes less time. A contact costs as much in a sweep as in an assembly, and sweeps are
/// needed more often.
inline constexpr std::size_t kManyContactsOfBody = 12;
/// [contacts]  Number from which an interior point comes first: multipliers would take ten times as
/// long.
inline constexpr std::size_t kManyForInteriorPoint = 120;
/// [contacts]  Number from which it comes first where contacts are many for each body. Multipliers
/// have few equations then.
inline constexpr std::size_t kManyRedundant = 300;

/// [-]  Ratio of masses from which multipliers stop short even of few contacts, and an interior
/// point goes on.
inline constexpr double kUnequalMasses = 1e4;

/// [velocities]  Size of the largest problem whose rigid ties are decoupled. Combinations of ties
/// act on all of their bodies, so the work grows with the cube.
inline constexpr std::size_t kMostForDecoupling = 120;
/// [-]  Ties are decoupled at once where one has less than this of its response across the others.
/// Larger: more problems lose the sparsity of their ties.
inline constexpr double kNearlyImplied = 1e-6;

// The active set.

/// [rounds]  Rounds after which the current set gives the answer.
inline constexpr int kMostRoundsOfDeciding = 30;
/// [-]  The set may have one of this many contacts at most; else it is not small.
inline constexpr std::size_t kPartOfAll = 4;

// Even shares.

/// [contacts]  Most contacts of a problem whose impulses are shared evenly.
inline constexpr std::size_t kMostToShare = 12;
/// [shares]  Most shares: a contact that slides has one, a contact that sticks three. The work
/// grows with the cube of the number.
inline constexpr int kMostShares = 12;
/// [-]  Rounds in which directions of friction and shares settle go on while each leaves at most
/// this part of the residual before it.
inline constexpr double kGainOfSharing = 0.2;
/// [steps]  Most steps of an active set in a round, for each contact.
inline constexpr std::size_t kStepsOfSharing = 3;
/// [-]  A contact slides or opens if it is faster than so many tolerances.
inline constexpr double kMovesOfTolerance = 10.0;
/// [-]  Responses below this part of the greatest leave a choice of impulses.
inline constexpr double kLeastPivotOfSharing = 1e-9;
/// [-]  Shares below this part of the greatest are 0.
inline constexpr double kZeroShare = 1e-12;
/// [-]  Even shares are no longer than so many times the impulses that the solver found.
inline constexpr double kMostLengthOfSharing = 1.5;

// Contacts in batches.

/// [contacts]  Fewer contacts are swept one by one.
inline constexpr std::size_t kFewContacts = 16;
/// [contacts]  Number from which batches in double precision give up the order of contacts. Along
/// the order an answer travels through a stack in one sweep, and double precision is for answers of
/// many digits.
inline constexpr std::size_t kVeryManyInOrder = 500;
/// [-]  Fraction of the lanes that are filled. Below it the order is given up to fill more, where
/// that is permitted.
inline constexpr double kGoodFill = 0.6;
/// [contacts]  Mean number in a batch below which one by one is faster.
inline constexpr double kLeastInBatch = 2.5;
/// [contacts]  Number of contacts of a pair that are solved in turn before other pairs.
inline constexpr std::size_t kMostOfPair = 4;

}  // namespace firstcontact::detail
