/// @file
/// The data that do not change while a simulation runs, and those with which a step begins.

#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/motion/motion.h>
#include <firstcontact/simulation/detail/sim_body.h>
#include <firstcontact/simulation/detail/sim_robot.h>
#include <firstcontact/simulation/detail/surface_neighbours.h>

namespace firstcontact::detail {

/// Distances that keep bodies apart, beyond what the scene's margins ask of a pair.
///
/// A pair may not come closer than `least`: first_contact is asked with that margin. Bodies rest
/// between it and `touching`. A pair that is nearer already, as turning may bring it, is held to
/// half of what it has left, and pushed back.
struct ContactDistances {
  explicit ContactDistances(double contact_distance)
      : least(contact_distance),
        tolerance(0.25 * contact_distance),
        touching(1.5 * contact_distance),
        band(2.0 * contact_distance),
        pushed(0.9 * contact_distance) {}

  /// [m]  The way by which a pair may still come nearer before it rests.
  ///
  /// It ends a little before a contact would be found, for the way there is straight and that of a
  /// point is not. Where a pair is about to rest it does, or every rounding of a gap would be a
  /// velocity.
  [[nodiscard]] double way_to_rest(double gap) const {
    return gap > touching ? gap - (least + 1.5 * tolerance) : 0.0;
  }

  double least;      ///< [m]
  double tolerance;  ///< [m]  A contact is found at least .. least + tolerance.
  double touching;   ///< [m]  Impacts act on pairs within it.
  double band;       ///< [m]  Constraints act on pairs within it.
  double pushed;     ///< [m]  Pairs below it are pushed apart.
};

/// How a pair is asked for first contact, which was this far apart at the start.
///
/// @param gap  [m]  least, infinite where it is beyond the band
struct HeldDistance {
  double margin = 0.0;     ///< [m]  Of the question.
  double tolerance = 0.0;  ///< [m]
};
[[nodiscard]] HeldDistance held_distance(const ContactDistances& distances, double pair_margin,
                                         double gap);

struct World {
  /// @param loaded  the scene of which `linked` was made
  World(const LoadedScene& loaded, const LinksAsBodies& linked);

  std::vector<SimBody> bodies;
  std::vector<SimRobot> robots;
  PairLaws laws;
  ContactDistances distances;
  std::vector<std::shared_ptr<const SurfaceNeighbours>> neighbours;  ///< Of each body.
  Eigen::Vector3d gravity;                                           ///< [m/s^2]
  std::size_t events;                                                ///< In a step, at most.
};

/// [m]  Of two bodies, how far the smaller one reaches.
[[nodiscard]] double smaller_reach(const World& world, const BodyPair& bodies);

/// How a body is displaced over some time, from a pose.
struct Move {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();      ///< [m]  Of C.
  Eigen::Vector3d rotation_vector = Eigen::Vector3d::Zero();  ///< [rad]

  [[nodiscard]] Move part(double share) const {
    return {share * translation, share * rotation_vector};
  }
};

/// The motion over t in [0, 1] that makes the move.
[[nodiscard]] Motion motion_of(const SimBody& body, const Pose& X_WB, const Move& move);

/// A box around the thickened surface over the whole move.
[[nodiscard]] Eigen::AlignedBox3d swept_box(const SimBody& body, const Pose& X_WB,
                                            const Move& move);

/// The state with which a step of a simulation begins, for every body.
struct StepStart {
  double time = 0.0;                    ///< [s]  Since the simulation began.
  double h = 0.0;                       ///< [s]  How long the step is to last.
  std::vector<RigidState> states = {};  ///< Velocities of free bodies.
  std::vector<Move> scripted = {};      ///< Over the step; zero but for scripted bodies.
  std::vector<MechanismState> robots = {};
  std::vector<bool> rests = {};  ///< Of every body: found at rest in the step before.
};

/// Where a scripted or fixed body is, a share of the step after its begin.
[[nodiscard]] Pose scripted_pose(const World& world, const StepStart& start, std::size_t body,
                                 double share);

}  // namespace firstcontact::detail
