/// @file
/// The constants of a simulation, each with its unit and its consequence.
///
/// Bounds of rounding stand where they are derived.

#pragma once

#include <cstddef>

namespace firstcontact::detail {

// Values that a scene leaves open.

/// [kg/m^3]  Density of free bodies without mass and density: that of water.
inline constexpr double kDefaultDensity = 1000.0;
/// [-]  The contact distance, by the radius of the smallest free body. Smaller: bodies rest nearer
/// to each other, and steps take longer.
inline constexpr double kContactDistanceOfRadius = 1e-3;
/// [-]  The contact distance by the radius of the smallest link, where no other body is free. A
/// joint stops short of its target by the contact distance.
inline constexpr double kContactDistanceOfLinks = 5e-4;

/// [-]  Limits of the contact distance, by the same radius, beyond which a warning follows: bodies
/// rest visibly apart, or steps take long.
inline constexpr double kLargeDistanceOfRadius = 0.1;
inline constexpr double kSmallDistanceOfRadius = 1e-7;
/// [-]  The least contact distance, by the largest coordinate: 4096 roundings. With fewer, time is
/// lost at every contact, and runs are not proven.
inline constexpr double kLeastDistanceOfExtent = 0x1p-40;

// Distances between bodies, by the contact distance (ContactDistances).

/// [-]  A contact is found at a distance between 1 and 1 + this. Smaller: first contacts take more
/// steps.
inline constexpr double kToleranceOfDistance = 0.25;
/// [-]  Impacts act on pairs within it; bodies rest between 1 and this.
inline constexpr double kTouchingOfDistance = 1.5;
/// [-]  Constraints act on pairs within it. Larger: problems have more contacts.
inline constexpr double kBandOfDistance = 2.0;
/// [-]  Pairs below it are pushed apart. Nearer to 1: more plans push.
inline constexpr double kPushedOfDistance = 0.9;
/// [-]  Bodies come to rest this many tolerances beyond 1, before a contact would be found. The
/// planned way there is straight, and the way of a point is not.
inline constexpr double kRestOfTolerance = 1.5;
/// [-]  Gaps that differ by less count as equal; otherwise the solver's residual would become a
/// velocity.
inline constexpr double kSameGap = 0.05;
/// [-]  A pair that is nearer than 1 is held to this share of its gap.
inline constexpr double kHeldShare = 0.5;
/// [-]  A pair nearer than this is jammed, and held to the second share. With the first one a body
/// that is crushed would halve its gap to nothing.
inline constexpr double kJammedOfDistance = 1e-3;
inline constexpr double kHeldShareOfJammed = 0.99;
/// [-]  Curved bodies that are nearer than this at the start count as bodies that meet.
inline constexpr double kNearOfMeeting = 1e-6;

// Manifold points of a pair, by the reach of the smaller body.

/// [-]  Manifold points nearer to each other than this, with normals of this cosine, are one.
inline constexpr double kSamePlace = 1e-3;
inline constexpr double kSameNormal = 1.0 - 1e-5;
/// [-]  A manifold point takes the impulse of one of the step before that is nearer than this.
inline constexpr double kCloseBy = 0.01;
/// [-]  A regular polygon is a circle if its edges are no farther inside of it, by its radius: one
/// of 64 corners. Larger: polygons that are meant to have corners roll. Smaller: meshes of round
/// parts bump over their edges.
inline constexpr double kSagOfRadius = 1.21e-3;
/// [-]  The same limit by the reach of the smaller of two touching bodies: the rim of a large floor
/// is a polygon to a small box.
inline constexpr double kMostSagOfReach = 0.02;
/// [-]  Edges of a circle within this cosine of its nearest point count as that point.
inline constexpr double kNearLine = 0.94;
/// [contacts]  A pair with more of them keeps the nearest one of each neighbourhood.
inline constexpr std::size_t kVeryManyContacts = 500;
/// [-]  Approximate width of a neighbourhood.
inline constexpr double kNeighbourhood = 0.1;
/// [contacts]  A pair with more of them records only those that press, as a nut with thousands on
/// its screw thread.
inline constexpr std::ptrdiff_t kManyRecordedOfPair = 100;

/// [-]  Edges cross where the sine between them is greater: their normal is that of both. Smaller:
/// the normal of nearly parallel edges turns wildly.
inline constexpr double kCrossingEdges = 0.1;

/// [-]  A contact is on the side of a cylinder where its normal is across the axis to this sine.
inline constexpr double kAcrossCylinder = 1e-3;

/// [-]  A contact slides throughout a plan where this fraction of its slip is left at the end.
/// Smaller: friction is turned against a slip that ends.
inline constexpr double kLeastOfSlip = 0.1;

// Seams between bodies.

/// [-]  A body beside an edge leaves it a normal if the allowed part of the found one is longer.
inline constexpr double kLeastLevel = 0.5;
/// [-]  Normals that differ by less are not changed.
inline constexpr double kTiltOfSeam = 1e-6;
/// [-]  A normal whose sine to the normal of a face is less is that of the face.
inline constexpr double kTiltOfFace = 1e-4;
/// [-]  The least gap along a changed normal, by the contact distance; with less the body beside is
/// a step.
inline constexpr double kLeastGapOfSeam = 0.25;

// Impacts.

/// [steps]  Impacts slower than the velocity that gravity adds in this many steps do not bounce, so
/// that bodies come to rest.
inline constexpr double kStepsWithoutBounce = 2.0;
/// [answers]  Most answers of a pair, in the mean, in a sequence of impacts.
inline constexpr std::size_t kAnswersOfPair = 100;
/// [-]  The sequence ends where all pairs close more slowly than this part of the fastest impact.
inline constexpr double kSlowOfFirst = 1e-6;
/// [-]  Pairs that close within this part of the fastest one answer with it. It is above what
/// rounding and tolerances leave of a symmetry. Smaller: the order in the scene decides.
inline constexpr double kEquallyFast = 1e-6;
/// [-]  A predicted contact is slight if the bodies approach by less than this over the plan and
/// would not bounce; by the radius of the smaller body. It becomes a constraint. Larger: fewer
/// impacts, and more motion that is not straight.
inline constexpr double kSlightApproach = 0.4;
/// [impacts]  After this many in a row with no more time between them than a stall, an island is
/// jammed: the rest of the step is lost.
inline constexpr std::size_t kMostStalls = 10;
/// [-]  A pair nearer than this part of the contact distance is squeezed.
inline constexpr double kSqueezedOfDistance = 1e-2;
/// [impacts]  After this many in a step that leave a pair squeezed the rest of the step is lost.
inline constexpr std::size_t kMostSqueezed = 20;
/// [impacts]  Likewise for impacts that ended a plan whose velocities broke its own constraints.
inline constexpr std::size_t kMostCrushed = 8;
/// [impacts]  Likewise for a script that stood still in the step before, and tries to go on.
/// Larger: a lasting jam takes longer.
inline constexpr std::size_t kMostCrushedAgain = 1;
/// [impacts]  Most impacts of such a script in a step.
inline constexpr std::size_t kMostEventsAgain = 20;
/// [-]  Contacts slip with this part of their friction where scripts leave no solution with all of
/// it.
inline constexpr double kSlippery = 0.3;
/// [solutions]  Most such solutions in a step. Larger: a jam takes longer.
inline constexpr std::size_t kMostSlips = 8;
/// [-]  A step is lost if it lasted less than this part of its lost time. Smaller: a jam takes
/// longer to be known.
inline constexpr double kLostOfStep = 0.1;
/// [-]  Least part of a step after which a script begins to wait.
inline constexpr double kLeastBeforeWait = 1e-2;
/// [-]  Duration of a stall, by the step.
inline constexpr double kStallOfStep = 1e-9;

// Plans of an island.

/// [plans]  Number of times that slight predicted contacts become constraints. After that bodies
/// move until the first of them.
inline constexpr int kRoundsOfSlight = 12;
/// [rad]  A plan that turns a body farther is wrong, as is one whose motion is not finite. Shorter
/// plans are tried; where none is right, the rest of the step is lost.
inline constexpr double kMostTurnOfPlan = 1e6;
/// [-]  A plan that was stopped is followed by one of at least this part of its span.
inline constexpr double kLeastShareOfPlan = 0.1;
/// [-]  The shortest plan, by the step, for links that turn fast, bodies that tumble, and
/// ellipsoids that roll over a flat side.
inline constexpr double kLeastShareOfFast = 0.01;
/// [rad]  Most by which a tumbling body may be off halfway through a plan, which has it turn at a
/// constant rate. An impact in between finds it there, with another inertia.
inline constexpr double kMostAstray = 0.01;
/// [rad]  Greatest turn of links in a plan: mass matrices are those of its end.
inline constexpr double kMostTurnOfLinks = 0.1;
/// [rounds]  Islands that meet are joined one by one this many times. Later, islands with crossing
/// ways are joined, too. Otherwise rows of bricks that fall together would meet one by one as they
/// come to rest.
inline constexpr int kExactRoundsOfIslands = 2;
/// [-]  A predicted contact replaces one of the same features within this distance, by the reach of
/// the smaller body, with normals of this cosine.
inline constexpr double kReplacedWithin = 0.1;
inline constexpr double kReplacedNormal = 1.0 - 1e-3;
/// [-]  Room of bodies in repeated plans, by their reach and by their way. Within it pairs are not
/// looked for anew.
inline constexpr double kRoomOfReach = 0.03;
inline constexpr double kRoomOfWay = 0.1;
/// [-]  Number of times that a plan is halved where no plane keeps two hulls apart for all of it.
/// Planes for parts of it often do. A first contact takes as long as thirty planes.
inline constexpr int kSplitsOfPlan = 3;

/// [-]  Most by which pairs may come nearer than their constraints, by the contact distance, in a
/// plan that follows the mean of velocities. Smaller: more plans follow the velocities at the end,
/// which are of first order.
inline constexpr double kSlackOfMean = 0.02;

/// [-]  Most by which pairs may come nearer where the displacements of a plan are solved
/// separately, by the contact distance; after this many sweeps the rest stays. The proof finds
/// pairs that are too near.
inline constexpr double kToleranceOfWay = 2e-3;
inline constexpr int kSweepsOfWay = 50;
/// [-]  A contact that rolls slips by less than this, by the change of its velocity that its curve
/// makes in half of a plan. The plan before led it nearly to that. Smaller: a rolling body seems to
/// slide and to stop.
inline constexpr double kSlipOfChange = 0.05;
/// [-]  A contact that rolls slips by less than this, by the speed at which it goes over both
/// surfaces. Smaller: rolling bodies seem to slide and to stop. Larger: a ball that begins to roll
/// slides for half a step more.
inline constexpr double kSlipOfRolling = 0.01;
/// [-]  Part of the way back in a plan for a contact that presses and has drifted beyond the
/// distance of rest. Larger: the mean of the velocities leads too far in the next plan.
inline constexpr double kBackToRest = 0.5;
/// [-]  A contact follows its circle in a plan if the normal turns against its axis by less than
/// this, by the sine between both. Larger: the lowest point of a nearly flat disc runs too far.
inline constexpr double kTurnOfCurve = 0.2;
/// [rad]  A contact also follows a corner on its circle about the centre of mass where the body
/// turns by more in a plan. Smaller: it costs time where bodies move little.
inline constexpr double kTurnOnCorner = 0.01;
/// [-]  Longest plan, by the time in which contacts on rims turn by that; not below a tenth of a
/// step. Larger: a coin gains energy as it settles.
inline constexpr double kRollOfPlan = 0.4;
/// [-]  Greatest change in a plan of the arm of a contact on an ellipsoid, by its length. Plans are
/// not below a tenth of a step, in islands of fewer than kSeveralBodies a hundredth. Larger: flat
/// or long ellipsoids gain energy.
inline constexpr double kArmOfPlan = 0.05;
/// [-]  Greatest bend in a plan of the way of an ellipsoid's centre, by the contact distance.
/// Larger: within a plan its triangles come nearer than at both ends.
inline constexpr double kSagittaOfPlan = 0.5;
/// [-]  Number of times that a plan is solved with contacts where its last solution leads them.
inline constexpr int kPassesOfCurves = 2;
/// [rad]  Bodies that turn by more in a plan spin: gyroscopic moments act on the changes by
/// contacts. Beyond the second angle they do not matter any more.
inline constexpr double kSpin = 1e-3;
inline constexpr double kMostSpin = 100.0;
/// [rad]  Where links of a robot in contact turn by more in a plan, its flight predicts its motors
/// and its contacts.
inline constexpr double kSwing = 1e-4;
/// [-]  Where links turn by less than this part of their turn in a flight, they are at rest.
inline constexpr double kRestOfSwing = 0.03;
/// [rad]  Greatest turn in a plan of touching bodies on which gyroscopic moments act.
inline constexpr double kMostTurnInContact = 0.5;
/// [-]  Number of times that a protruding polygon lifts the contact of its circle in a plan, before
/// it becomes a contact of its own.
inline constexpr int kMostLifts = 8;

// Pushing apart pairs that are too near.

/// [-]  Plans shorter than this part of a step push nothing apart. Smaller: a displacement in so
/// little time is so fast that doubles cannot prove it free.
inline constexpr double kLeastSpanOfPush = 1e-6;
/// [-]  Part of the missing distance that a plan makes up for.
inline constexpr double kPush = 0.5;
/// [-]  Tolerance of that, by the contact distance, and the part of it that sweeps may leave.
inline constexpr double kPushTolerance = 1e-2;
inline constexpr double kPushEnough = 0.3;
inline constexpr int kPushSweeps = 50;
/// [-]  Sweeps over the contacts around close pairs, in the mean of all contacts, before all
/// contacts are swept.
inline constexpr int kPushSweepsAround = 4;

// Joints.

/// [rad or m]  A coordinate this near to its limit, or beyond it, is stopped there.
inline constexpr double kAtLimit = 1e-9;
/// [rad or m]  Most by which a plan may lead beyond a limit. A motor that pushes a link against its
/// limit and yields as little has no solution together with it. Then neither law is kept.
inline constexpr double kMostBeyondLimit = 1e-3;

/// [-]  Least part of a step in which links get back to their joints from the chords of their ways.
/// Smaller: contacts answer that motion with velocities.
inline constexpr double kSpanOfDrift = 0.1;

/// [-]  Flights follow the dampers of joints if span damping / mass is no more than this. Larger:
/// flights take more parts.
inline constexpr double kFollowedDecay = 0.5;
/// [rad]  Springs that swing by more in a span are damped.
inline constexpr double kGreatestPhase = 1.0;

/// [-]  Most by which motors may place a touching robot off the place of its velocities, by the
/// contact distance. Beyond it the velocities at the end of a plan lead the robot.
inline constexpr double kUnseenPlacement = 0.5;
/// [-]  Likewise for motors along rows of positions, whose rates jump. A body that such a robot
/// carries knows the robot's velocities alone, and slips by as much in each plan.
inline constexpr double kUnseenJump = 1e-3;

// Ties.

/// [-]  A cable within this part of the contact distance of its length is taut.
inline constexpr double kTautOfDistance = 0.25;
/// [-]  Distance of the points of a tie's joint at the end of a plan, by the contact distance.
inline constexpr double kApartOfDistance = 1e-5;
/// [rounds]  Rounds of displacements without velocity that bring joints of ties together.
inline constexpr int kRoundsOfSettling = 4;
/// [rounds]  Most rounds of flights with the forces of ties. They end where the change [-] is this
/// part of the greatest impulse of a tie.
inline constexpr int kMostRoundsOfTies = 8;
inline constexpr double kChangeOfTies = 1e-9;
/// [-]  Forces that still change by more after these rounds are not predicted.
inline constexpr double kNearChangeOfTies = 1e-3;
/// [rounds]  Most rounds where changes are mixed, and the change [-] at which they end.
inline constexpr int kMostMixedRoundsOfTies = 24;
inline constexpr double kMixedChangeOfTies = 1e-6;
/// [-]  Greatest length of a displacement that closes a gap, by the gap.
inline constexpr double kFarthestOfGap = 20.0;
/// [impacts]  After this many in a step, cables are taut at the end of a plan instead of within it.
inline constexpr std::size_t kMostTautEvents = 20;
/// [rad]  Greatest turn of bodies with ties in a plan.
inline constexpr double kMostTurnOfTied = 0.25;
/// [rad]  Where a body turns by more in a plan, the energy at the end of the plan is looked at.
inline constexpr double kTurnOfEnergy = 0.05;
/// [-]  Greatest gain of energy in a step of bodies in contact that turn, by their kinetic energy.
/// Where it would be exceeded, plans become shorter.
inline constexpr double kEnergyOfTurning = 1e-4;
/// [-]  Greatest change in a step of the energy of bodies that joints alone hold, by their kinetic
/// energy. Where it would be exceeded, plans become shorter.
inline constexpr double kEnergyOfTied = 1e-3;
/// [-]  Where forces of ties are not found, plans become shorter, down to this part of the step.
inline constexpr double kLeastShareOfTied = 1.0 / 16.0;
/// [-]  Islands with ties sleep at this part of the speed of others, as a soft spring is slow where
/// it turns back.
inline constexpr double kRestOfTied = 0.1;

// Accuracy of contact problems, by the velocity that gravity adds in a step.

/// [-]  The residual of problems of few contacts.
inline constexpr double kExactTolerance = 3e-7;
/// [m/s]  No problem is solved more exactly than this.
inline constexpr double kLeastTolerance = 1e-9;
/// [-]  The residual of heaps, and of problems with very many contacts.
inline constexpr double kHeapTolerance = 1e-3;
/// [contacts, bodies]  An island with as many of both is a heap. A pair of bodies alone may have as
/// many contacts.
inline constexpr std::size_t kHeapContacts = 120;
inline constexpr std::size_t kHeapBodies = 20;
/// [-]  A heap stands if all of its points are slower than this part of the velocity that gravity
/// adds in a step. It is then solved as exactly as few bodies, however large it is, or it would
/// creep.
inline constexpr double kStandsOfGravity = 0.3;
/// [contacts]  A problem with so many is solved to a heap's residual, whatever its bodies, unless
/// they stand.
inline constexpr std::size_t kManyContactsOfIsland = 1000;
/// [-]  Residual that sweeps of a heap may leave, after at most so many sweeps. Where bodies then
/// come too near, the next plan holds them.
inline constexpr double kHeapEnough = 0.3;
inline constexpr int kHeapSweeps = 600;
/// [bodies]  An island of so many, without robots, may leave [-] this part of the residual of its
/// guesses, where that is beyond kHitOfGravity. Such a residual is that of an impact, as weight
/// alone needs only the velocity that gravity adds.
inline constexpr std::size_t kSeveralBodies = 6;
inline constexpr double kPartOfHits = 1e-3;
inline constexpr double kHitOfGravity = 2.0;
/// [rounds]  Most rounds of the interior point.
inline constexpr int kRoundsOfMany = 2;
/// [-]  In a plan that differs from another only in some contacts, a change beyond this goes on to
/// other contacts. The second number is the most solutions of a contact, in the mean.
inline constexpr double kAroundTolerance = 3e-2;
inline constexpr int kAroundSweeps = 2;
/// [-]  A residual beyond this means that a problem has no solution, or that none was found. Its
/// answer is shortened, so that it adds no energy.
inline constexpr double kUnsolved = 1e-2;
/// [-]  Likewise by the velocities, where there is no gravity: well above rounding.
inline constexpr double kUnsolvedOfSpeed = 1e-9;

/// [-]  Motors without bound also yield where bodies would be faster than before, and than these
/// motors want to move links, by this factor. Larger: a wedge that closes slowly shoots them out.
inline constexpr double kMostSqueeze = 10.0;
/// [-]  Motors without bound yield by this part of the effect of impulses on their coordinates,
/// where a problem has no solution otherwise. Smaller: they press harder on an obstacle.
inline constexpr double kYield = 1e-3;

// Sleep.

/// [-]  The points of bodies at rest are no faster than both of two limits. One is this factor of
/// the exact tolerance, the other this part of the velocity that gravity adds in a step. A body
/// that gains speed more slowly sleeps, too.
inline constexpr double kRestOfExactTolerance = 100.0;
inline constexpr double kRestOfGravity = 3e-5;

}  // namespace firstcontact::detail
