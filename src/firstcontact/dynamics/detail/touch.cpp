#include <firstcontact/dynamics/detail/touch.h>

#include <algorithm>
#include <limits>

#include <firstcontact/query/close_features.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// Touches nearer to each other than this part of the smaller body are one.
constexpr double kSamePlace = 1e-6;
constexpr double kSameNormal = 1.0 - 1e-9;  // [-]  Cosine.

bool is_outermost(const World& world, const BodyPair& bodies, const std::array<Pose, 2>& poses,
                  const Contact& contact) {
  const Vector3d& n_W = *contact.n_AB_W;
  return world.neighbours[bodies[0]]->is_outermost(
             contact.feature_A, poses[0].rotation.normalized().conjugate() * n_W) &&
         world.neighbours[bodies[1]]->is_outermost(
             contact.feature_B, poses[1].rotation.normalized().conjugate() * -n_W);
}

Touch make_touch(const BodyPair& bodies, double margin, const Contact& contact) {
  return {.bodies = bodies,
          .feature_A = contact.feature_A,
          .feature_B = contact.feature_B,
          .point = 0.5 * (contact.p_WA + contact.p_WB),
          .normal = *contact.n_AB_W,
          .gap = contact.distance - margin};
}

/// Features that meet in one place, as the corner of one face and an edge of it, say the same.
void keep_once(double size, std::vector<Touch>& touches) {
  std::vector<Touch> kept;
  for (const Touch& touch : touches) {
    const bool is_new = std::ranges::none_of(kept, [&](const Touch& other) {
      return (touch.point - other.point).norm() <= kSamePlace * size &&
             touch.normal.dot(other.normal) >= kSameNormal;
    });
    if (is_new) {
      kept.push_back(touch);
    }
  }
  touches = std::move(kept);
}

}  // namespace

std::vector<Touch> touches_among(const World& world, const BodyPair& bodies,
                                 const std::array<Pose, 2>& poses, double margin,
                                 const std::vector<Contact>& contacts) {
  std::vector<Touch> outermost;
  std::vector<Touch> all;
  for (const Contact& contact : contacts) {
    if (!contact.n_AB_W) {
      continue;
    }
    all.push_back(make_touch(bodies, margin, contact));
    if (is_outermost(world, bodies, poses, contact)) {
      outermost.push_back(all.back());
    }
  }
  std::vector<Touch>& touches = outermost.empty() ? all : outermost;
  keep_once(std::min(world.bodies[bodies[0]].reach, world.bodies[bodies[1]].reach), touches);
  return touches;
}

Manifold find_manifold(const World& world, const BodyPair& bodies, const std::array<Pose, 2>& poses,
                       double margin, Workspace& workspace) {
  Manifold manifold{.bodies = bodies, .gap = std::numeric_limits<double>::infinity()};
  const Motion A = Motion::fixed(poses[0]);
  const Motion B = Motion::fixed(poses[1]);
  std::vector<Contact> contacts;
  close_features({world.bodies[bodies[0]].shape, A}, {world.bodies[bodies[1]].shape, B}, 0.0,
                 margin + world.distances.band, workspace, contacts);
  for (const Contact& contact : contacts) {
    manifold.gap = std::min(manifold.gap, contact.distance - margin);
  }
  manifold.touches = touches_among(world, bodies, poses, margin, contacts);
  return manifold;
}

}  // namespace firstcontact::detail
