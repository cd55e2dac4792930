#include <firstcontact/simulation_model/detail/sim_body.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <firstcontact/geometry/mass_properties.h>
#include <firstcontact/scene/body_motion.h>
#include <firstcontact/scene/links_as_bodies.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/inscribed_triangles.h>
#include <firstcontact/text/quantity.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

Inertia inertia_of(const FreeBody& free, const Shape& shape) {
  Inertia inertia;
  inertia.locked_translation = free.locked_translation;
  inertia.locked_rotation = free.locked_rotation;
  if (free.mass && free.centre_of_mass && free.inertia) {
    inertia.mass = *free.mass;
    inertia.p_BC = *free.centre_of_mass;
    inertia.about_C_B = *free.inertia;
    return inertia;
  }
  const MassProperties solid = mass_properties(shape);
  const double density =
      free.mass ? *free.mass / solid.volume : free.density.value_or(kDefaultDensity);
  inertia.mass = free.mass.value_or(density * solid.volume);
  inertia.p_BC = free.centre_of_mass.value_or(solid.p_BC);
  if (free.inertia) {
    inertia.about_C_B = *free.inertia;
    return inertia;
  }
  // A given centre of mass is trusted: the moments of the solid then count about it.
  inertia.about_C_B = density * solid.about_C;
  return inertia;
}

void find_reach(SimBody& body) {
  const Mesh& mesh = body.shape.mesh();
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) {
      body.box_B.extend(mesh.vertices[v]);
      body.reach = std::max(body.reach, (mesh.vertices[v] - body.inertia.p_BC).norm());
    }
  }
  body.reach += body.shape.radius();
  const Vector3d thickness = Vector3d::Constant(body.shape.radius());
  body.box_B = Eigen::AlignedBox3d(body.box_B.min() - thickness, body.box_B.max() + thickness);
}

/// The smallest free body, or where there are links only, the smallest of them; null without free
/// bodies.
const SimBody* smallest_free_body(const std::vector<SimBody>& bodies) {
  const SimBody* smallest = nullptr;
  for (const SimBody& body : bodies) {
    const bool is_smaller =
        smallest == nullptr || std::pair(body.link_body.has_value(), body.reach) <
                                   std::pair(smallest->link_body.has_value(), smallest->reach);
    if (body.kind == BodyKind::free && is_smaller) {
      smallest = &body;
    }
  }
  return smallest;
}

double default_contact_distance(const std::vector<SimBody>& bodies) {
  const SimBody* smallest = smallest_free_body(bodies);
  if (smallest == nullptr) {
    return kContactDistanceOfRadius;
  }
  return (smallest->link_body ? kContactDistanceOfLinks : kContactDistanceOfRadius) *
         smallest->reach;
}

/// The triangles with the features of shapes; bodies that share their shape share them.
class Surfaces {
 public:
  [[nodiscard]] const Shape& of(const Shape& shape) {
    const auto found = known_.find(&shape.hierarchy());
    return found != known_.end()
               ? found->second
               : known_.emplace(&shape.hierarchy(), inscribed_triangles(shape)).first->second;
  }

 private:
  std::unordered_map<const Hierarchy*, Shape> known_;
};

/// The number of a robot of the scene among those with dynamics.
std::size_t number_in_world(const Scene& scene, std::size_t robot) {
  return static_cast<std::size_t>(
      std::count_if(scene.robots.begin(), scene.robots.begin() + static_cast<std::ptrdiff_t>(robot),
                    [](const SceneRobot& other) { return other.dynamics.has_value(); }));
}

std::uint64_t key(const BodyPair& pair) {
  return (static_cast<std::uint64_t>(pair[0]) << 32) | pair[1];
}

}  // namespace

std::vector<SimBody> make_sim_bodies(const Scene& scene, const LinksAsBodies& linked) {
  const LoadedScene& loaded = linked.loaded;
  const std::size_t first_link_body = loaded.scene.bodies.size() - linked.geometries.size();
  std::vector<SimBody> bodies;
  Surfaces surfaces;
  for (std::size_t b = 0; b < loaded.scene.bodies.size(); ++b) {
    const Body& described = loaded.scene.bodies[b];
    const Shape& shape = loaded.bodies.shape(b);
    SimBody body{
        .shape = shape, .surface = surfaces.of(shape), .ellipsoid = round_ellipsoid_of(shape)};
    if (described.free && b >= first_link_body) {
      const LinkGeometryPose& geometry = linked.geometries[b - first_link_body];
      body.kind = BodyKind::free;
      body.link_body =
          LinkBody{number_in_world(scene, geometry.robot), geometry.link, geometry.X_LG};
      body.inertia.p_BC = described.free->centre_of_mass.value();
    } else if (described.free) {
      body.kind = BodyKind::free;
      body.forces = described.free->forces;
      try {
        body.inertia = inertia_of(*described.free, body.shape);
      } catch (const std::invalid_argument& error) {
        throw std::invalid_argument("body \"" + described.name + "\": " + error.what());
      }
    } else if (!std::holds_alternative<FixedMotion>(described.motion)) {
      body.kind = BodyKind::scripted;
    }
    find_reach(body);
    bodies.push_back(std::move(body));
  }
  return bodies;
}

bool moves_freely(const SimBody& body) {
  const auto is_set = [](bool lock) { return lock; };
  return body.kind == BodyKind::free && !body.link_body &&
         std::ranges::none_of(body.inertia.locked_translation, is_set) &&
         std::ranges::none_of(body.inertia.locked_rotation, is_set);
}

MeanForce mean_force(const SimBody& body, double from, double span) {
  MeanForce mean;
  for (const TimedForce& timed : body.forces) {
    const double acts = std::min(timed.to, from + span) - std::max(timed.from, from);
    const double share = std::max(0.0, acts) / span;
    mean.force += share * timed.force;
    mean.torque += share * timed.torque;
  }
  return mean;
}

double contact_distance_of(const Simulation& simulation, const std::vector<SimBody>& bodies) {
  if (simulation.contact_distance) {
    return *simulation.contact_distance;
  }
  return default_contact_distance(bodies);
}

std::vector<std::string> check_contact_distance(double contact_distance, const LoadedScene& linked,
                                                const std::vector<SimBody>& bodies) {
  double extent = 0.0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Pose X_WB = linked.bodies.motion(b).pose(0.0);
    const Vector3d p_WC = X_WB.position + X_WB.rotation * bodies[b].inertia.p_BC;
    extent = std::max(extent, p_WC.cwiseAbs().maxCoeff() + bodies[b].reach);
  }
  const std::string given =
      "simulation.contact_distance: " + detail::quantity(contact_distance, "m") + " is ";
  const double least = kLeastDistanceOfExtent * extent;
  if (contact_distance < least) {
    throw std::invalid_argument(given + "too small to be proven beside coordinates of " +
                                detail::quantity(extent, "m") + "; give at least " +
                                detail::quantity(1.005 * least, "m") +
                                ", or move the scene to the origin");
  }
  const SimBody* smallest = smallest_free_body(bodies);
  if (smallest == nullptr) {
    return {};
  }
  const double radius = smallest->reach;
  const std::string of_body =
      '"' + linked.scene.bodies[static_cast<std::size_t>(smallest - bodies.data())].name +
      "\", the smallest free body, has a radius of " + detail::quantity(radius, "m");
  const std::string mend =
      "; without this key it is " + detail::quantity(default_contact_distance(bodies), "m");
  if (contact_distance > radius) {
    throw std::invalid_argument(given + "larger than a body: " + of_body + mend);
  }
  if (contact_distance > kLargeDistanceOfRadius * radius) {
    return {given + "a large gap between bodies that touch: " + of_body + mend};
  }
  if (contact_distance < kSmallDistanceOfRadius * radius) {
    return {given + "so small that steps may take long: " + of_body + mend};
  }
  return {};
}

PairLaws::PairLaws(const LoadedScene& loaded) : rules_(&loaded.bodies.rules()) {
  const Simulation& simulation = *loaded.scene.simulation;
  const std::vector<double> margins = rules_->greatest_margins(loaded.scene.bodies.size());
  greatest_margin_ = margins.empty() ? 0.0 : std::ranges::max(margins);
  for (const Body& body : loaded.scene.bodies) {
    friction_.push_back(body.surface.friction.value_or(simulation.friction));
    restitution_.push_back(body.surface.restitution.value_or(simulation.restitution));
    belts_.push_back(body.surface.velocity.value_or(Vector3d::Zero()));
  }
  for (const PairSurface& pair : simulation.pairs) {
    pairs_[key({std::min(pair.bodies[0], pair.bodies[1]),
                std::max(pair.bodies[0], pair.bodies[1])})] = pair.surface;
  }
}

void PairLaws::set_surface(std::size_t body, const Surface& surface) {
  friction_[body] = surface.friction.value_or(friction_[body]);
  restitution_[body] = surface.restitution.value_or(restitution_[body]);
  belts_[body] = surface.velocity.value_or(belts_[body]);
}

void PairLaws::set_pair_surface(const BodyPair& pair, const Surface& surface) {
  Surface& own = pairs_[key({std::min(pair[0], pair[1]), std::max(pair[0], pair[1])})];
  own.friction = surface.friction ? surface.friction : own.friction;
  own.restitution = surface.restitution ? surface.restitution : own.restitution;
}

const Surface* PairLaws::of_pair(const BodyPair& pair) const {
  const auto found = pairs_.find(key(pair));
  return found == pairs_.end() ? nullptr : &found->second;
}

double PairLaws::friction(const BodyPair& pair) const {
  const Surface* own = of_pair(pair);
  return own != nullptr && own->friction ? *own->friction
                                         : std::sqrt(friction_[pair[0]] * friction_[pair[1]]);
}

double PairLaws::restitution(const BodyPair& pair) const {
  const Surface* own = of_pair(pair);
  return own != nullptr && own->restitution
             ? *own->restitution
             : std::max(restitution_[pair[0]], restitution_[pair[1]]);
}

}  // namespace firstcontact::detail
