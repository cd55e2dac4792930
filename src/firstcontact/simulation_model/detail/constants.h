/// @file
/// The numbers that a simulation's behaviour depends on, each with its unit and its consequence.
/// Bounds of rounding stand where they are derived.

#pragma once

#include <cstddef>

namespace firstcontact::detail {

// What a scene leaves open.

/// [kg/m^3]  Density of free bodies without mass and density: that of water.
inline constexpr double kDefaultDensity = 1000.0;
/// [-]  The contact distance, by the radius of the smallest free body. Smaller: bodies rest nearer
/// to each other, and steps take longer.
inline constexpr double kContactDistanceOfRadius = 1e-3;
/// [-]  The same by the smallest link, where no other body is free. A contact distance is missing
/// to where a joint is told to be.
inline constexpr double kContactDistanceOfLinks = 5e-4;

/// [-]  A contact distance of more than this part of that radius, or of less than that, is warned
/// of: bodies rest visibly apart, or steps take long.
inline constexpr double kLargeDistanceOfRadius = 0.1;
inline constexpr double kSmallDistanceOfRadius = 1e-7;
/// [-]  The least contact distance, by the largest coordinate: 4096 roundings. With fewer, time is
/// lost at every contact, and runs are not proven.
inline constexpr double kLeastDistanceOfExtent = 0x1p-40;

// Distances between bodies, by the contact distance (ContactDistances).

/// [-]  A contact is found at 1 to 1 + this. Smaller: first contacts take more steps.
inline constexpr double kToleranceOfDistance = 0.25;
/// [-]  Impacts act on pairs within it; bodies rest between 1 and this.
inline constexpr double kTouchingOfDistance = 1.5;
/// [-]  Constraints act on pairs within it. Larger: problems have more contacts.
inline constexpr double kBandOfDistance = 2.0;
/// [-]  Pairs below it are pushed apart. Nearer to 1: more plans push.
inline constexpr double kPushedOfDistance = 0.9;
/// [-]  Bodies come to rest so many tolerances beyond 1, before a contact would be found: the way
/// there is straight and that of a point is not.
inline constexpr double kRestOfTolerance = 1.5;
/// [-]  Gaps that differ by less are equal, or what the solver leaves would be a velocity.
inline constexpr double kSameGap = 0.05;
/// [-]  A pair that is nearer than 1 is held to this share of its gap...
inline constexpr double kHeldShare = 0.5;
/// [-]  ... and one nearer than this is jammed, and held to that share: what cannot yield, as a
/// body that is crushed, would halve its way to nothing.
inline constexpr double kJammedOfDistance = 1e-3;
inline constexpr double kHeldShareOfJammed = 0.99;

// Touches of a pair, by the reach of the smaller body.

/// [-]  Touches nearer to each other than this, with normals of this cosine, are one.
inline constexpr double kSamePlace = 1e-3;
inline constexpr double kSameNormal = 1.0 - 1e-5;
/// [-]  A touch takes the impulse of one of the step before that is nearer than this.
inline constexpr double kCloseBy = 0.01;
/// [-]  A regular polygon is a circle if its edges are no farther inside of it, by its radius: one
/// of 64 corners. Larger: what is meant to have corners rolls. Smaller: meshes of round parts bump
/// over their edges.
inline constexpr double kSagOfRadius = 1.21e-3;
/// [-]  Nor may they be, by the reach of the smaller of two bodies that touch: the rim of a large
/// floor is a polygon to a small box.
inline constexpr double kMostSagOfReach = 0.02;
/// [-]  Edges of a circle within this cosine of its nearest point are that point.
inline constexpr double kNearLine = 0.94;
/// [contacts]  A pair with more of them keeps the nearest one of each neighbourhood...
inline constexpr std::size_t kVeryManyContacts = 500;
/// [-]  ... which is about as wide as this.
inline constexpr double kNeighbourhood = 0.1;
/// [contacts]  A pair with more of them has only those recorded that press, as a nut on its thread
/// with thousands.
inline constexpr std::ptrdiff_t kManyRecordedOfPair = 100;

/// [-]  Edges cross where the sine between them is greater: their normal is that of both. Smaller:
/// the normal of nearly parallel edges turns wildly.
inline constexpr double kCrossingEdges = 0.1;

// Seams between bodies.

/// [-]  A body beside an edge leaves it a normal if the allowed part of the one found is longer.
inline constexpr double kLeastLevel = 0.5;
/// [-]  Normals that differ by less are not changed.
inline constexpr double kTiltOfSeam = 1e-6;
/// [-]  The sine between a normal and a face below which it is that of the face.
inline constexpr double kTiltOfFace = 1e-4;
/// [-]  Along a changed normal there must be this part of the contact distance, or the body beside
/// is a step.
inline constexpr double kLeastGapOfSeam = 0.25;

// Impacts.

/// [steps]  Impacts slower than what gravity adds in so many steps do not bounce: bodies come to
/// rest.
inline constexpr double kStepsWithoutBounce = 2.0;
/// [answers]  So many a pair may have, in the mean, in a sequence of impacts.
inline constexpr std::size_t kAnswersOfPair = 100;
/// [-]  Pairs that close more slowly than this part of the fastest impact end the sequence.
inline constexpr double kSlowOfFirst = 1e-6;
/// [-]  A contact ahead is slight if the bodies approach by less than this over the plan, by the
/// radius of the smaller one, and would not bounce. It becomes a constraint. Larger: fewer impacts,
/// and more motion that is not straight.
inline constexpr double kSlightApproach = 0.4;
/// [impacts]  After so many in a row that let no more time pass than a stall, an island is jammed:
/// the rest of the step is lost.
inline constexpr std::size_t kMostStalls = 10;
/// [-]  A pair nearer than this part of the contact distance is squeezed...
inline constexpr double kSqueezedOfDistance = 1e-2;
/// [impacts]  ...and after so many in a step that leave one squeezed the rest of the step is lost.
inline constexpr std::size_t kMostSqueezed = 20;
/// [impacts]  The same of impacts that ended a plan whose velocities broke its own constraints.
inline constexpr std::size_t kMostCrushed = 8;
/// [impacts]  The same of a script that stood still in the step before, and tries to go on.
/// Larger: what stays jammed takes longer.
inline constexpr std::size_t kMostCrushedAgain = 1;
/// [impacts]  Nor has such a script more of them in a step.
inline constexpr std::size_t kMostEventsAgain = 20;
/// [-]  Contacts slip with this part of their friction where scripts leave no solution with all of
/// it...
inline constexpr double kSlippery = 0.3;
/// [solutions]  ...in so many of a step. Larger: a jam takes longer.
inline constexpr std::size_t kMostSlips = 8;
/// [-]  A step is lost if it lasted less than this, by what is lost of it.
inline constexpr double kLostOfStep = 1e-2;
/// [-]  A stall, by the step.
inline constexpr double kStallOfStep = 1e-9;

// Plans of an island.

/// [plans]  So often slight contacts of the motion ahead become constraints before bodies are moved
/// until the first of them.
inline constexpr int kRoundsOfSlight = 12;
/// [-]  A plan that was stopped is followed by one of at least this part of its span.
inline constexpr double kLeastShareOfPlan = 0.1;
/// [-]  Links that turn fast, bodies that tumble and ellipsoids that roll over a flat side make
/// plans shorter, down to this part of the step.
inline constexpr double kLeastShareOfFast = 0.01;
/// [rad]  A body that tumbles is no farther than this from where it would be halfway through a
/// plan, as it turns at a constant rate then: an impact in between finds it there, with another
/// inertia.
inline constexpr double kMostAstray = 0.01;
/// [rad]  Links turn no farther in a plan: mass matrices are those of its end.
inline constexpr double kMostTurnOfLinks = 0.1;
/// [rounds]  Islands that meet are joined so many times one by one. Then those whose ways cross
/// are, too: of bricks that fall together and come to rest row by row each row would meet the next
/// one.
inline constexpr int kExactRoundsOfIslands = 2;
/// [-]  A predicted contact replaces one of the same features that is as near as this, by the reach
/// of the smaller body, with normals of this cosine.
inline constexpr double kReplacedWithin = 0.1;
inline constexpr double kReplacedNormal = 1.0 - 1e-3;
/// [-]  Where plans are made again, bodies have so much room, of their reach and of their way,
/// before all pairs are looked for anew.
inline constexpr double kRoomOfReach = 0.03;
inline constexpr double kRoomOfWay = 0.1;
/// [-]  Where no plane keeps two hulls apart for a whole plan, planes for parts of it often do: it
/// is halved so many times. A first contact takes as long as thirty planes.
inline constexpr int kSplitsOfPlan = 3;

/// [-]  In a plan that the mean of velocities leads, pairs may come nearer by this part of the
/// contact distance than constraints ask. Smaller: velocities at the end lead more plans, which
/// are of first order.
inline constexpr double kSlackOfMean = 0.02;

/// [-]  Where the way of a plan is solved by itself, pairs may come nearer by this part of the
/// contact distance, or what so many sweeps leave: where that is too near, the proof finds it.
inline constexpr double kToleranceOfWay = 2e-3;
inline constexpr int kSweepsOfWay = 50;
/// [-]  A contact that rolls slips by less, by the change of its velocity that its curve makes in
/// half of a plan: the plan before led it nearly to that. Smaller: what rolls seems to slide and to
/// stop.
inline constexpr double kSlipOfChange = 0.05;
/// [-]  A contact that presses and has drifted beyond where bodies rest may come back by this part
/// of the way in a plan. Larger: the mean of the velocities leads too far in the next one.
inline constexpr double kBackToRest = 0.5;
/// [-]  A contact follows its circle in a plan if the normal turns against its axis by less than
/// this, by the sine between both. Larger: the lowest point of a nearly flat disc runs too far.
inline constexpr double kTurnOfCurve = 0.2;
/// [rad]  A contact follows a corner on its circle about the centre of mass, too, where the body
/// turns by more in a plan. Smaller: it costs time where bodies hardly move.
inline constexpr double kTurnOnCorner = 0.01;
/// [-]  Plans are so short, of the time in which contacts on rims turn by that, as far as a tenth
/// of a step. Larger: a coin gains energy as it settles.
inline constexpr double kRollOfPlan = 0.4;
/// [-]  And so short that the arm of a contact on an ellipsoid changes by no more, by its length:
/// down to a tenth of a step, of fewer than kSeveralBodies to a hundredth.
/// Larger: flat or long ellipsoids gain energy.
inline constexpr double kArmOfPlan = 0.05;
/// [-]  And so short that the way of the ellipsoid's centre bends by no more, by the contact
/// distance. Larger: within a plan its triangles come nearer than both ends have them.
inline constexpr double kSagittaOfPlan = 0.5;
/// [-]  So often is a plan solved with contacts where its solution before leads them.
inline constexpr int kPassesOfCurves = 2;
/// [rad]  Bodies that turn by more in a plan spin: gyroscopic moments act on what contacts change.
/// Beyond the second it does not matter any more.
inline constexpr double kSpin = 1e-3;
inline constexpr double kMostSpin = 100.0;
/// [rad]  Where links of a robot in contact turn by more in a plan, its flight predicts its motors
/// and what it touches.
inline constexpr double kSwing = 1e-4;
/// [rad]  Bodies that touch turn no farther in a plan, where gyroscopic moments act on them.
inline constexpr double kMostTurnInContact = 0.5;
/// [-]  So often does a polygon that stands out lift the contact of its circle in a plan, before
/// it becomes a contact of its own.
inline constexpr int kMostLifts = 8;

// Pushing apart what is too near.

/// [-]  Plans shorter than this part of a step push nothing apart. Smaller: a displacement in so
/// little time is a speed at which doubles cannot prove it free.
inline constexpr double kLeastSpanOfPush = 1e-6;
/// [-]  A plan makes up for this part of what is missing to the contact distance...
inline constexpr double kPush = 0.5;
/// [-]  ... to this part of that distance; so much of it may be left by sweeps, of at most so many.
inline constexpr double kPushTolerance = 1e-2;
inline constexpr double kPushEnough = 0.3;
inline constexpr int kPushSweeps = 50;
/// [-]  So often contacts around what is too near are solved, in the mean of all, before all are
/// swept.
inline constexpr int kPushSweepsAround = 4;

// Joints.

/// [rad or m]  A coordinate this near to its limit, or beyond it, is stopped there.
inline constexpr double kAtLimit = 1e-9;
/// [rad or m]  A plan may lead so far beyond a limit. What pushes a link against its limit and
/// yields as little has no solution together with it, and then neither law is kept.
inline constexpr double kMostBeyondLimit = 1e-3;

/// [-]  A plan leaves links on the chords of their ways. They need at least this part of a step to
/// get back to their joints. Smaller: contacts answer that way with velocities.
inline constexpr double kSpanOfDrift = 0.1;

/// [rad]  Springs that swing on by more in a span are damped.
inline constexpr double kGreatestPhase = 1.0;

/// [-]  Motors may place a robot that touches something so far from where its velocities lead, by
/// the contact distance. Beyond it velocities at the end of a plan lead the robot.
inline constexpr double kUnseenPlacement = 0.5;
/// [-]  The same of motors along rows of positions, whose rates jump: what such a robot carries
/// knows its velocities alone, and slips by as much in each plan.
inline constexpr double kUnseenJump = 1e-3;

// Ties.

/// [-]  A cable within this part of the contact distance of its length is taut.
inline constexpr double kTautOfDistance = 0.25;
/// [-]  Joints of ties are together to this part of the contact distance at the end of a plan.
inline constexpr double kApartOfDistance = 1e-5;
/// [rounds]  Displacements without velocity bring joints of ties together in so many rounds.
inline constexpr int kRoundsOfSettling = 4;
/// [rounds]  Forces of ties act in the flights of a plan. So often flights are made again, at most,
/// until [-] what changes is this part of the greatest impulse of a tie.
inline constexpr int kMostRoundsOfTies = 8;
inline constexpr double kChangeOfTies = 1e-9;
/// [-]  Forces that still change by more after these rounds are not predicted at all.
inline constexpr double kNearChangeOfTies = 1e-3;
/// [rounds]  Where changes are mixed, flights are made again so often, until [-] this is left.
inline constexpr int kMostMixedRoundsOfTies = 24;
inline constexpr double kMixedChangeOfTies = 1e-6;
/// [-]  A displacement that closes a gap is at most so many times as long as the gap.
inline constexpr double kFarthestOfGap = 20.0;
/// [impacts]  After so many in a step, cables are taut at the end of a plan in place of within it.
inline constexpr std::size_t kMostTautEvents = 20;
/// [rad]  Bodies with ties turn no farther in a plan.
inline constexpr double kMostTurnOfTied = 0.25;
/// [rad]  No plan that turns a body with ties farther can be meant.
inline constexpr double kWildTurnOfTied = 1e6;
/// [-]  Joints that are apart already get no farther apart in a plan than by this factor.
inline constexpr double kTearing = 2.0;
/// [-]  In a step the energy of bodies that joints alone hold changes by no more of the kinetic
/// one. Where it would, plans become shorter.
inline constexpr double kEnergyOfTied = 1e-3;
/// [-]  Where forces of ties are not found, plans become shorter, down to this part of the step.
inline constexpr double kLeastShareOfTied = 1.0 / 16.0;
/// [-]  Islands with ties sleep at this part of the speed of others: a soft spring is slow where it
/// turns back.
inline constexpr double kRestOfTied = 0.1;

// How exactly contact problems are solved, by what gravity adds in a step.

/// [-]  The residual of problems of few contacts.
inline constexpr double kExactTolerance = 3e-7;
/// [m/s]  No problem is solved more exactly than this.
inline constexpr double kLeastTolerance = 1e-9;
/// [-]  The residual of heaps, and of problems with very many contacts.
inline constexpr double kHeapTolerance = 1e-3;
/// [contacts, bodies]  An island with as many of both is a heap. One body on another may have as
/// many contacts.
inline constexpr std::size_t kHeapContacts = 120;
inline constexpr std::size_t kHeapBodies = 20;
/// [-]  A heap whose points all are slower than this part of what gravity adds in a step stands: it
/// is solved as exactly as few bodies, however large it is, or it would creep.
inline constexpr double kStandsOfGravity = 0.3;
/// [contacts]  A problem with so many is solved as a heap's, whatever its bodies.
inline constexpr std::size_t kManyContactsOfIsland = 1000;
/// [-]  So much sweeps of a heap may leave, after at most so many: where that brings bodies too
/// near, the next plan holds them.
inline constexpr double kHeapEnough = 0.3;
inline constexpr int kHeapSweeps = 600;
/// [bodies]  An island of so many, without robots, may leave [-] this part of the residual of its
/// guesses, where that is beyond the last of these: that is a hit, as weight alone asks for what
/// gravity adds.
inline constexpr std::size_t kSeveralBodies = 6;
inline constexpr double kPartOfHits = 1e-3;
inline constexpr double kHitOfGravity = 2.0;
/// [rounds]  Of the interior point, at most.
inline constexpr int kRoundsOfMany = 2;
/// [-]  In a plan that is like another but for some contacts, a change beyond this goes on to
/// others; and so often each of all is solved, in the mean at most.
inline constexpr double kAroundTolerance = 3e-2;
inline constexpr int kAroundSweeps = 2;
/// [-]  A residual beyond this means that a problem has no solution, or none that was found: its
/// answer is shortened, so that it adds no energy.
inline constexpr double kUnsolved = 1e-2;
/// [-]  The same by the velocities, where there is no gravity: well above rounding.
inline constexpr double kUnsolvedOfSpeed = 1e-9;

/// [-]  Motors without bound yield by this part of what impulses do to their coordinates, where a
/// problem has no solution without that. Smaller: they press harder on what stops them.
inline constexpr double kYield = 1e-3;

// Sleep.

/// [-]  The points of bodies at rest seem no faster than the lesser of these: of the exact
/// tolerance, and of what gravity adds in a step. What gathers speed more slowly sleeps, too.
inline constexpr double kRestOfExactTolerance = 100.0;
inline constexpr double kRestOfGravity = 3e-5;

}  // namespace firstcontact::detail
