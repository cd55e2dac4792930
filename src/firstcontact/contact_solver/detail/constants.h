/// @file
/// The numbers by which a contact problem gets its solver, each with its unit and its consequence.
/// The steps of a solver stand beside it.

#pragma once

#include <cstddef>

namespace firstcontact::detail {

// Which solver.

/// [velocities]  Larger problems are only swept: factorisations grow with more than the number of
/// velocities. Sweeps of such problems may stop far from an answer, but take less memory.
inline constexpr std::size_t kMostForAugmentedLagrangian = 6000;
/// [sweeps]  After so many the augmented Lagrangian takes over, unless sweeps may leave
/// something...
inline constexpr int kSweepsBeforeAugmentedLagrangian = 100;
/// [sweeps]  ... and in so many where contacts are many for each body.
inline constexpr int kSweepsOfRedundant = 30;
/// [sweeps]  Then there are so many more, [-] to this part of the tolerance: what is left would add
/// up from step to step.
inline constexpr int kExtraSweeps = 30;
inline constexpr double kExtraTolerance = 0.1;
/// [contacts]  For each body, that is for six velocities, from where on the augmented Lagrangian is
/// cheaper: a sweep costs as many contacts as an assembly, and takes more of them.
inline constexpr std::size_t kManyContactsOfBody = 12;
/// [contacts]  From so many on an interior point comes first: multipliers would take ten times as
/// long.
inline constexpr std::size_t kManyForInteriorPoint = 120;
/// [contacts]  The same where there are many for each body, and few equations for multipliers.
inline constexpr std::size_t kManyRedundant = 300;

/// [-]  Where masses differ by this factor, multipliers stop short of few contacts, too, and an
/// interior point goes on.
inline constexpr double kUnequalMasses = 1e4;

// The active set.

/// [rounds]  After so many, what was found is the answer.
inline constexpr int kMostRoundsOfDeciding = 30;
/// [-]  One contact of so many may be in the set, or it is no small one.
inline constexpr std::size_t kPartOfAll = 4;

// Contacts side by side.

/// [contacts]  Fewer are swept one by one.
inline constexpr std::size_t kFewContacts = 16;
/// [contacts]  In double precision, which is for answers of many digits, the order of contacts is
/// given up only for more of them: along it an answer travels through a stack in one sweep.
inline constexpr std::size_t kVeryManyInOrder = 500;
/// [-]  Of the lanes that are filled. Below it the order is given up for more of them, where that
/// is allowed.
inline constexpr double kGoodFill = 0.6;
/// [contacts]  With fewer in a batch, in the mean, one by one is faster.
inline constexpr double kLeastInBatch = 2.5;
/// [contacts]  So many of a pair in turn are solved before other pairs.
inline constexpr std::size_t kMostOfPair = 4;

}  // namespace firstcontact::detail
