/// @file
/// The data that do not change while a simulation runs, and those with which a step begins.

#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/query/detail/surface_neighbours.h>
#include <firstcontact/simulation_model/detail/contact_distances.h>
#include <firstcontact/simulation_model/detail/round_circles.h>
#include <firstcontact/simulation_model/detail/sim_body.h>
#include <firstcontact/simulation_model/detail/sim_robot.h>
#include <firstcontact/simulation_model/detail/sim_tie.h>

namespace firstcontact {
struct LinksAsBodies;
struct LoadedScene;
}  // namespace firstcontact

namespace firstcontact::detail {

struct SimulationModel {
  /// @param loaded  the scene of which `linked` was made
  SimulationModel(const LoadedScene& loaded, const LinksAsBodies& linked);

  std::vector<SimBody> bodies;
  std::vector<SimRobot> robots;
  PairLaws laws;
  bool has_pairs;  ///< Whether there is any pair to keep apart.
  ContactDistances distances;
  std::vector<std::shared_ptr<const SurfaceNeighbours>> neighbours;  ///< One for each body.
  std::vector<std::shared_ptr<const RoundCircles>> round_circles;    ///< One for each body.
  Eigen::Vector3d gravity;                                           ///< [m/s^2]
  ImpactLaw impacts;
  std::size_t events;  ///< Most events in a step.
  std::vector<SimTie> ties;
  std::vector<std::vector<std::size_t>> ties_of;  ///< For each body; empty without any ties.
};

/// [m]  The greatest sag of a polygon that counts as a circle in the contacts of two bodies.
[[nodiscard]] double most_sag_of(const SimulationModel& model, const BodyPair& bodies);

/// [m]  The distance of two bodies beyond which not even circles are within the band.
[[nodiscard]] double near_of(const SimulationModel& model, const BodyPair& bodies);

/// [m]  The reach of the smaller of two bodies.
[[nodiscard]] double smaller_reach(const SimulationModel& model, const BodyPair& bodies);

}  // namespace firstcontact::detail
