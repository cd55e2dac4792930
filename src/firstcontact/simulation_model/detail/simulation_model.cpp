#include <firstcontact/simulation_model/detail/simulation_model.h>

#include <algorithm>
#include <limits>
#include <unordered_map>
#include <utility>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/scene/links_as_bodies.h>
#include <firstcontact/scene/loaded_scene.h>

namespace firstcontact::detail {
namespace {

std::vector<std::shared_ptr<const SurfaceNeighbours>> neighbours_of(
    const std::vector<SimBody>& bodies, double slack) {
  // Bodies that share their shape share its neighbours.
  std::unordered_map<const Hierarchy*, std::shared_ptr<const SurfaceNeighbours>> known;
  std::vector<std::shared_ptr<const SurfaceNeighbours>> all;
  for (const SimBody& body : bodies) {
    auto& entry = known[&body.surface.hierarchy()];
    if (!entry) {
      entry = std::make_shared<const SurfaceNeighbours>(body.surface, slack);
    }
    all.push_back(entry);
  }
  return all;
}

/// The circles of the bodies. Facets that stand out by less than the tolerance of contacts make no
/// polygon, and those of a curved shape never do.
std::vector<std::shared_ptr<const RoundCircles>> round_circles_of(
    const std::vector<SimBody>& bodies, double sag) {
  std::unordered_map<const Hierarchy*, std::shared_ptr<const RoundCircles>> known;
  std::vector<std::shared_ptr<const RoundCircles>> all;
  for (const SimBody& body : bodies) {
    auto& entry = known[&body.surface.hierarchy()];
    if (!entry && body.ellipsoid) {
      entry = std::make_shared<const RoundCircles>();
    } else if (!entry) {
      const double most = body.shape.is_curved() ? std::numeric_limits<double>::infinity() : sag;
      entry = std::make_shared<const RoundCircles>(body.surface, most);
    }
    all.push_back(entry);
  }
  return all;
}

std::vector<std::vector<std::size_t>> ties_of_bodies(const std::vector<SimTie>& ties,
                                                     std::size_t bodies) {
  std::vector<std::vector<std::size_t>> of(ties.empty() ? 0 : bodies);
  for (std::size_t k = 0; k < ties.size(); ++k) {
    for (const TieEnd& end : ties[k].ends) {
      if (end.body) {
        of[*end.body].push_back(k);
      }
    }
  }
  return of;
}

/// [m]  The greatest sag of the circles of a body that count beside a limit for polygons.
double sag_of(const SimulationModel& model, std::size_t body, double most) {
  const double sag = model.round_circles[body]->sag();
  return model.bodies[body].shape.is_curved() ? sag : std::min(sag, most);
}

}  // namespace

SimulationModel::SimulationModel(const LoadedScene& loaded, const LinksAsBodies& linked)
    : bodies(make_sim_bodies(loaded.scene, linked)),
      robots(make_sim_robots(loaded, linked)),
      laws(linked.loaded),
      has_pairs(linked.loaded.pair_counts.tested > 0),
      distances(contact_distance_of(*loaded.scene.simulation, bodies)),
      neighbours(neighbours_of(bodies, distances.band)),
      round_circles(round_circles_of(bodies, distances.tolerance)),
      gravity(loaded.scene.simulation->gravity),
      impacts(loaded.scene.simulation->impacts),
      events(loaded.scene.simulation->events),
      ties(make_sim_ties(linked.loaded, bodies, distances.least)),
      ties_of(ties_of_bodies(ties, bodies.size())) {
  double reach = 0.0;
  for (const SimBody& body : bodies) {
    reach = std::max(reach, body.kind == BodyKind::free ? body.reach : 0.0);
  }
  double sag = 0.0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    sag = std::max(sag, sag_of(*this, b, kMostSagOfReach * reach + distances.tolerance));
  }
  distances.near += 2.0 * sag;
}

double most_sag_of(const SimulationModel& model, const BodyPair& bodies) {
  return kMostSagOfReach * smaller_reach(model, bodies) + model.distances.tolerance;
}

double near_of(const SimulationModel& model, const BodyPair& bodies) {
  const double most = most_sag_of(model, bodies);
  double near = model.distances.band;
  for (const std::size_t body : bodies) {
    near += sag_of(model, body, most);
  }
  return near;
}

double smaller_reach(const SimulationModel& model, const BodyPair& bodies) {
  return std::min(model.bodies[bodies[0]].reach, model.bodies[bodies[1]].reach);
}

}  // namespace firstcontact::detail
