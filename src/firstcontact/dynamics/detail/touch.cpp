#include <firstcontact/dynamics/detail/touch.h>

#include <algorithm>
#include <limits>
#include <tuple>

#include <firstcontact/query/close_features.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// Touches nearer to each other than this part of the smaller body are one.
constexpr double kSamePlace = 1e-3;
constexpr double kSameNormal = 1.0 - 1e-5;  // [-]  Cosine.

/// A touch is taken for what touched before where it is nearer than this part of the smaller body.
constexpr double kCloseBy = 0.01;

/// Null where there is none.
Touch* successor(const Touch& before, double close_by, std::vector<Touch>& touches) {
  const auto same =
      std::ranges::find_if(touches, [&](const Touch& t) { return same_features(t, before); });
  if (same != touches.end()) {
    return &*same;
  }
  const auto distance = [&](const Touch& t) { return (t.point - before.point).norm(); };
  const auto nearest = std::ranges::min_element(touches, {}, distance);
  return nearest != touches.end() && distance(*nearest) <= close_by ? &*nearest : nullptr;
}

/// Whether the bodies bulge towards each other there. Not where edges cross within a flat face:
/// over it the gap is least at the ends of the other edge, or where that leaves the face.
bool is_outermost(const World& world, const BodyPair& bodies, const std::array<Pose, 2>& poses,
                  const Contact& contact) {
  const Vector3d& n_W = *contact.n_AB_W;
  const SurfaceNeighbours& A = *world.neighbours[bodies[0]];
  const SurfaceNeighbours& B = *world.neighbours[bodies[1]];
  const bool are_edges =
      contact.feature_A.type == FeatureType::edge && contact.feature_B.type == FeatureType::edge;
  if (are_edges && (A.is_flat_edge(contact.feature_A) || B.is_flat_edge(contact.feature_B))) {
    return false;
  }
  return A.is_outermost(contact.feature_A, poses[0].rotation.normalized().conjugate() * n_W) &&
         B.is_outermost(contact.feature_B, poses[1].rotation.normalized().conjugate() * -n_W);
}

Touch make_touch(const BodyPair& bodies, double margin, const Contact& contact) {
  return {.bodies = bodies,
          .feature_A = contact.feature_A,
          .feature_B = contact.feature_B,
          .point = 0.5 * (contact.p_WA + contact.p_WB),
          .normal = *contact.n_AB_W,
          .gap = contact.distance - margin};
}

/// Features that meet in one place, as the corner of one face and an edge of it, say the same: of
/// them the nearest.
void keep_once(double size, std::vector<Touch>& touches) {
  std::vector<Touch> kept;
  for (const Touch& touch : touches) {
    const auto same = std::ranges::find_if(kept, [&](const Touch& other) {
      return (touch.point - other.point).norm() <= kSamePlace * size &&
             touch.normal.dot(other.normal) >= kSameNormal;
    });
    if (same == kept.end()) {
      kept.push_back(touch);
    } else if (touch.gap < same->gap) {
      *same = touch;
    }
  }
  touches = std::move(kept);
}

}  // namespace

bool same_features(const Touch& x, const Touch& y) {
  return x.feature_A.type == y.feature_A.type && x.feature_A.index == y.feature_A.index &&
         x.feature_B.type == y.feature_B.type && x.feature_B.index == y.feature_B.index;
}

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
  keep_once(smaller_reach(world, bodies), touches);
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

bool comes_before(const Touch& x, const Touch& y) {
  const auto key = [](const Touch& touch) {
    return std::tuple(touch.bodies, touch.feature_A.type, touch.feature_A.index,
                      touch.feature_B.type, touch.feature_B.index);
  };
  return key(x) < key(y);
}

void carry_impulses(const std::vector<Touch>& before, double size, Manifold& manifold) {
  const double close_by = kCloseBy * size;
  const auto bodies_of = [](const Touch& touch) { return touch.bodies; };
  auto touch = std::ranges::lower_bound(before, manifold.bodies, {}, bodies_of);
  for (; touch != before.end() && touch->bodies == manifold.bodies; ++touch) {
    if (Touch* next = successor(*touch, close_by, manifold.touches)) {
      next->impulse += touch->impulse;
    }
  }
}

}  // namespace firstcontact::detail
