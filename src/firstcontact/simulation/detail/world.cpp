#include <firstcontact/simulation/detail/world.h>

#include <algorithm>
#include <array>
#include <unordered_map>

namespace firstcontact::detail {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

/// Boxes are larger by this part of their size and place than they need be: rounding.
constexpr double kSlack = 1e-12;

/// Pairs nearer than this part of their distance of rest are hardly let nearer.
constexpr double kJammed = 1e-3;

std::vector<std::shared_ptr<const SurfaceNeighbours>> neighbours_of(
    const std::vector<SimBody>& bodies, double slack) {
  // Bodies that share their shape share what is known of it.
  std::unordered_map<const Hierarchy*, std::shared_ptr<const SurfaceNeighbours>> known;
  std::vector<std::shared_ptr<const SurfaceNeighbours>> all;
  for (const SimBody& body : bodies) {
    auto& entry = known[&body.shape.hierarchy()];
    if (!entry) {
      entry = std::make_shared<const SurfaceNeighbours>(body.shape, slack);
    }
    all.push_back(entry);
  }
  return all;
}

}  // namespace

World::World(const LoadedScene& loaded, const LinksAsBodies& linked)
    : bodies(make_sim_bodies(loaded.scene, linked)),
      robots(make_sim_robots(loaded, linked)),
      laws(linked.loaded),
      distances(contact_distance_of(*loaded.scene.simulation, bodies)),
      neighbours(neighbours_of(bodies, distances.band)),
      gravity(loaded.scene.simulation->gravity),
      events(loaded.scene.simulation->events) {}

HeldDistance held_distance(const ContactDistances& distances, double pair_margin, double gap) {
  if (gap > distances.least + distances.tolerance) {
    return {pair_margin + distances.least, distances.tolerance};
  }
  // What cannot yield, as a body that is crushed, would halve its way to nothing.
  const double share = gap > kJammed * distances.least ? 0.5 : 0.99;
  return {pair_margin + share * gap, 0.5 * (1.0 - share) * gap};
}

double smaller_reach(const World& world, const BodyPair& bodies) {
  return std::min(world.bodies[bodies[0]].reach, world.bodies[bodies[1]].reach);
}

Motion motion_of(const SimBody& body, const Pose& X_WB, const Move& move) {
  const std::array<ConstantRatePiece, 1> piece{
      {{1.0, X_WB, move.translation, move.rotation_vector}}};
  return Motion::constant_rates(piece, body.inertia.p_BC);
}

AlignedBox3d swept_box(const SimBody& body, const Pose& X_WB, const Move& move) {
  const Eigen::Matrix3d R = X_WB.rotation.normalized().toRotationMatrix();
  const Vector3d p_WC = X_WB.position + R * body.inertia.p_BC;
  const Vector3d centre = X_WB.position + R * body.box_B.center();
  const Vector3d half = R.cwiseAbs() * (0.5 * body.box_B.sizes());
  // A point at distance r from C gets no farther than the chord, nor than r from C itself.
  const double turned = body.reach * std::min(2.0, move.rotation_vector.norm());
  const Vector3d around = half.array() + turned;
  const AlignedBox3d box(centre - around, centre + around);
  const Vector3d reach = Vector3d::Constant(body.reach);
  AlignedBox3d swept = box.intersection(AlignedBox3d(p_WC - reach, p_WC + reach));
  swept.extend(AlignedBox3d(swept.min() + move.translation, swept.max() + move.translation));
  const Vector3d slack =
      kSlack * (swept.min().cwiseAbs().cwiseMax(swept.max().cwiseAbs()).array() + body.reach);
  return {swept.min() - slack, swept.max() + slack};
}

Pose scripted_pose(const World& world, const StepStart& start, std::size_t body, double share) {
  const SimBody& moved = world.bodies[body];
  const Pose& X_WB = start.states[body].X_WB;
  return moved.kind == BodyKind::scripted && share > 0.0
             ? motion_of(moved, X_WB, start.scripted[body]).pose(share)
             : X_WB;
}

}  // namespace firstcontact::detail
