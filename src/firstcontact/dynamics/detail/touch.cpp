#include <firstcontact/dynamics/detail/touch.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <unordered_map>
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

/// More contacts than these are very many: of those beside each other, nearer than about this part
/// of the smaller body, the nearest counts.
constexpr std::size_t kMany = 500;
constexpr double kBeside = 0.1;

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

/// Which of some contacts count where there are very many: of those beside each other that face
/// alike the nearest, of bulging ones. The motion of a rigid body hardly differs between them, and
/// where it does the next first contact tells.
class NearestOfMany {
 public:
  /// @param apart  [m]
  explicit NearestOfMany(double apart) : apart_(apart) {}

  template <class IsOutermost>
  void add(const Contact& contact, const IsOutermost& is_outermost) {
    const Vector3d& n = *contact.n_AB_W;
    Cell key{0, 0, 0, (n.x() > 0.0 ? 1 : 0) + (n.y() > 0.0 ? 2 : 0) + (n.z() > 0.0 ? 4 : 0)};
    for (int k = 0; k < 3; ++k) {
      const double counted = std::floor(contact.p_WA[k] / apart_);
      key[static_cast<std::size_t>(k)] =
          static_cast<std::int64_t>(std::fmin(std::fmax(counted, -kFarthest), kFarthest));
    }
    const auto [found, is_new] = nearest_.try_emplace(key, nullptr);
    const Contact*& nearest = found->second;
    if ((nearest == nullptr || contact.distance < nearest->distance) && is_outermost(contact)) {
      nearest = &contact;
    }
  }

  /// In the order of the list that they are from.
  [[nodiscard]] std::vector<const Contact*> take() const {
    std::vector<const Contact*> all;
    for (const auto& [cell, nearest] : nearest_) {
      if (nearest != nullptr) {
        all.push_back(nearest);
      }
    }
    std::ranges::sort(all);
    return all;
  }

 private:
  static constexpr double kFarthest = 0x1p52;  // Cells beyond are one.

  /// Where, and the octant of the normal.
  using Cell = std::array<std::int64_t, 4>;
  struct Hash {
    std::size_t operator()(const Cell& cell) const {
      std::uint64_t hash = 0;
      for (const std::int64_t k : cell) {
        hash = (hash ^ static_cast<std::uint64_t>(k)) * 0x9e3779b97f4a7c15U;
        hash ^= hash >> 32;
      }
      return static_cast<std::size_t>(hash);
    }
  };

  double apart_;
  std::unordered_map<Cell, const Contact*, Hash> nearest_;
};

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

std::vector<Touch> touches_among_many(const World& world, const BodyPair& bodies,
                                      const std::array<Pose, 2>& poses, double margin,
                                      const std::vector<Contact>& contacts) {
  NearestOfMany nearest(kBeside * smaller_reach(world, bodies));
  for (const Contact& contact : contacts) {
    if (contact.n_AB_W) {
      nearest.add(contact,
                  [&](const Contact& of) { return is_outermost(world, bodies, poses, of); });
    }
  }
  std::vector<Touch> touches;
  for (const Contact* contact : nearest.take()) {
    touches.push_back(make_touch(bodies, margin, *contact));
  }
  return touches;
}

}  // namespace

bool same_features(const Touch& x, const Touch& y) {
  return x.feature_A.type == y.feature_A.type && x.feature_A.index == y.feature_A.index &&
         x.feature_B.type == y.feature_B.type && x.feature_B.index == y.feature_B.index;
}

std::vector<Touch> touches_among(const World& world, const BodyPair& bodies,
                                 const std::array<Pose, 2>& poses, double margin,
                                 const std::vector<Contact>& contacts) {
  if (contacts.size() > kMany) {
    std::vector<Touch> few = touches_among_many(world, bodies, poses, margin, contacts);
    if (!few.empty()) {
      return few;
    }
  }
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
                 margin + world.distances.band, workspace, contacts,
                 kBeside * smaller_reach(world, bodies));
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
