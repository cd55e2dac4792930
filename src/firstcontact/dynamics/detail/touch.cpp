#include <firstcontact/dynamics/detail/touch.h>

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include <firstcontact/dynamics/detail/place_grid.h>
#include <firstcontact/query/close_features.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// Touches nearer to each other than this part of the smaller body are one.
constexpr double kSamePlace = 1e-3;
constexpr double kSameNormal = 1.0 - 1e-5;  // [-]  Cosine.

/// A touch is taken for what touched before where it is nearer than this part of the smaller body.
constexpr double kCloseBy = 0.01;

auto features_of(const Touch& touch) {
  return std::tuple(touch.feature_A.type, touch.feature_A.index, touch.feature_B.type,
                    touch.feature_B.index);
}

/// Finds what touches in place of what touched before, among the touches of a pair.
class Successors {
 public:
  /// @param close_by  [m]  how far it may be where it has other features
  Successors(double close_by, std::vector<Touch>& touches)
      : touches_(touches), close_by_(close_by), by_place_(close_by) {
    for (std::size_t k = 0; k < touches.size(); ++k) {
      by_features_.push_back(k);
      by_place_.add(touches[k].point, k);
    }
    std::ranges::stable_sort(by_features_, {},
                             [&](std::size_t k) { return features_of(touches[k]); });
  }

  /// Null where there is none.
  Touch* of(const Touch& before) {
    const auto same =
        std::ranges::lower_bound(by_features_, features_of(before), {},
                                 [&](std::size_t k) { return features_of(touches_[k]); });
    if (same != by_features_.end() && same_features(touches_[*same], before)) {
      return &touches_[*same];
    }
    Touch* nearest = nullptr;
    double least = close_by_;
    by_place_.for_each_near(before.point, [&](std::size_t k) {
      const double distance = (touches_[k].point - before.point).norm();
      if (distance < least ||
          (distance == least && (nearest == nullptr || &touches_[k] < nearest))) {
        least = distance;
        nearest = &touches_[k];
      }
    });
    return nearest;
  }

 private:
  std::vector<Touch>& touches_;
  double close_by_;
  std::vector<std::size_t> by_features_;
  PlaceGrid by_place_;
};

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
  PlaceGrid by_place(kSamePlace * size);
  for (const Touch& touch : touches) {
    std::size_t same = kept.size();
    by_place.for_each_near(touch.point, [&](std::size_t k) {
      if ((touch.point - kept[k].point).norm() <= kSamePlace * size &&
          touch.normal.dot(kept[k].normal) >= kSameNormal) {
        same = std::min(same, k);
      }
    });
    if (same < kept.size() && !(touch.gap < kept[same].gap)) {
      continue;
    }
    if (same == kept.size()) {
      kept.push_back(touch);
    } else {
      kept[same] = touch;
    }
    by_place.add(touch.point, same);
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
  return std::pair(x.bodies, features_of(x)) < std::pair(y.bodies, features_of(y));
}

void carry_impulses(const std::vector<Touch>& before, double size, Manifold& manifold) {
  const auto bodies_of = [](const Touch& touch) { return touch.bodies; };
  auto touch = std::ranges::lower_bound(before, manifold.bodies, {}, bodies_of);
  if (touch == before.end() || touch->bodies != manifold.bodies) {
    return;
  }
  Successors successors(kCloseBy * size, manifold.touches);
  for (; touch != before.end() && touch->bodies == manifold.bodies; ++touch) {
    if (Touch* next = successors.of(*touch)) {
      next->impulse += touch->impulse;
    }
  }
}

}  // namespace firstcontact::detail
