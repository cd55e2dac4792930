#include <firstcontact/simulation_model/detail/manifold.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <tuple>
#include <unordered_map>
#include <utility>

#include <Eigen/Geometry>

#include <firstcontact/geometry/detail/spatial_hash.h>
#include <firstcontact/moving_pairs/detail/moving_pair.h>
#include <firstcontact/query/close_features.h>
#include <firstcontact/query/detail/facing_cell.h>
#include <firstcontact/query/detail/surface_neighbours.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/ellipsoid_contact.h>
#include <firstcontact/simulation_model/detail/flat_contact.h>
#include <firstcontact/simulation_model/detail/round_contact.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// Usual number of manifold points of a pair; there may be more.
constexpr std::size_t kUsualTouches = 4;

auto features_of(const ManifoldPoint& touch) {
  return std::tuple(touch.feature_A.type, touch.surface[0], touch.feature_B.type, touch.surface[1]);
}

/// Finds the successors of earlier points among the manifold points of a pair.
class Successors {
 public:
  /// @param close_by  [m]  greatest distance of a successor with other features
  Successors(double close_by, std::vector<ManifoldPoint>& touches)
      : touches_(touches), close_by_(close_by), by_place_(close_by) {
    for (std::size_t k = 0; k < touches.size(); ++k) {
      by_place_.add(touches[k].point, k);
    }
    if (touches.size() > kFew) {
      for (std::size_t k = 0; k < touches.size(); ++k) {
        by_features_.push_back(k);
      }
      std::ranges::stable_sort(by_features_, {},
                               [&](std::size_t k) { return features_of(touches[k]); });
    }
  }

  /// The successor of a point; null where there is none.
  ManifoldPoint* of(const ManifoldPoint& before) {
    if (ManifoldPoint* same = of_same_features(before)) {
      return same;
    }
    ManifoldPoint* nearest = nullptr;
    double least = close_by_;
    by_place_.for_each_near(before.point, [&](std::size_t k) {
      const double distance = (touches_[k].point - before.point).norm();
      if (distance < least ||
          (distance == least && (nearest == nullptr || &touches_[k] < nearest))) {
        least = distance;
        nearest = &touches_[k];
      }
    });
    return nearest != nullptr ? nearest : on_curve(before);
  }

 private:
  /// The nearest point on a curve that faces alike: a rolling body touches elsewhere after each
  /// step.
  ManifoldPoint* on_curve(const ManifoldPoint& before) {
    ManifoldPoint* nearest = nullptr;
    for (ManifoldPoint& touch : touches_) {
      const bool is_on_curve = touch.round[0].is_curved() || touch.round[1].is_curved();
      if (is_on_curve && touch.normal.dot(before.normal) >= kNearLine &&
          (nearest == nullptr ||
           (touch.point - before.point).norm() < (nearest->point - before.point).norm())) {
        nearest = &touch;
      }
    }
    return nearest;
  }

  /// Up to this number all points are compared.
  static constexpr std::size_t kFew = 24;

  /// The first point of the same features.
  ManifoldPoint* of_same_features(const ManifoldPoint& before) {
    if (touches_.size() <= kFew) {
      const auto same = std::ranges::find_if(
          touches_, [&](const ManifoldPoint& touch) { return same_features(touch, before); });
      return same != touches_.end() ? &*same : nullptr;
    }
    const auto same =
        std::ranges::lower_bound(by_features_, features_of(before), {},
                                 [&](std::size_t k) { return features_of(touches_[k]); });
    return same != by_features_.end() && same_features(touches_[*same], before) ? &touches_[*same]
                                                                                : nullptr;
  }

  std::vector<ManifoldPoint>& touches_;
  double close_by_;
  std::vector<std::size_t> by_features_;  // Only where there are many.
  SpatialHash by_place_;
};

/// Two bodies, with a test whether their features bulge towards each other.
class FacingBodies {
 public:
  FacingBodies(const SimulationModel& model, const BodyPair& bodies,
               const std::array<Pose, 2>& poses)
      : shapes_{&model.bodies[bodies[0]].shape, &model.bodies[bodies[1]].shape},
        A_(*model.neighbours[bodies[0]]),
        B_(*model.neighbours[bodies[1]]),
        R_AW_(poses[0].rotation.normalized().conjugate()),
        R_BW_(poses[1].rotation.normalized().conjugate()) {}

  /// Whether the bodies bulge towards each other at a contact.
  ///
  /// It is false where a flat face of one body is over a flat face or a straight edge of the other.
  /// There the gap is least at the corners of the overlap: at a corner of one body, or where two
  /// edges cross. Corners alone so carry the load, however the faces are cut into triangles.
  [[nodiscard]] bool are_outermost(const Contact& contact) const {
    const Vector3d& n_W = *contact.n_AB_W;
    const Extent of_A = A_.extent(contact.feature_A);
    const Extent of_B = B_.extent(contact.feature_B);
    if (of_A != Extent::corner && of_B != Extent::corner &&
        (of_A == Extent::plane || of_B == Extent::plane)) {
      return false;
    }
    return A_.is_outermost(contact.feature_A, R_AW_ * n_W) &&
           B_.is_outermost(contact.feature_B, R_BW_ * -n_W);
  }

  /// Whether one body bulges at a point of convex sets. A set always does; the triangles of a body
  /// beside it may have a nearer neighbour.
  [[nodiscard]] bool is_outermost(std::size_t side, const ManifoldPoint& touch) const {
    if (is_asked_as_convex(*shapes_[side], *shapes_[1 - side])) {
      return true;
    }
    return side == 0 ? A_.is_outermost(touch.feature_A, R_AW_ * touch.normal)
                     : B_.is_outermost(touch.feature_B, R_BW_ * -touch.normal);
  }

 private:
  std::array<const Shape*, 2> shapes_;
  const SurfaceNeighbours& A_;
  const SurfaceNeighbours& B_;
  Eigen::Quaterniond R_AW_;
  Eigen::Quaterniond R_BW_;
};

/// Makes manifold points of a pair's contacts.
struct TouchMaker {
  TouchMaker(const SimulationModel& model, const BodyPair& pair, const std::array<Pose, 2>& poses,
             double its_margin)
      : bodies(pair), margin(its_margin), most_sag(most_sag_of(model, pair)) {
    for (std::size_t s = 0; s < 2; ++s) {
      const SimBody& body = model.bodies[pair[s]];
      surfaces[s] = {
          .shape = &body.surface, .neighbours = model.neighbours[pair[s]].get(), .pose = poses[s]};
      placed[s] = {.shape = &body.surface,
                   .is_curved = body.shape.is_curved(),
                   .circles = model.round_circles[pair[s]].get(),
                   .ellipsoid = body.ellipsoid ? &*body.ellipsoid : nullptr,
                   .pose = poses[s]};
    }
  }

  [[nodiscard]] ManifoldPoint make(Contact contact) const {
    lay_on_face(surfaces, contact);
    const std::array<RoundFeature, 2> round = make_round(placed, most_sag, contact);
    return point_of(contact, round);
  }

  /// Makes a point of a contact of the exact search.
  [[nodiscard]] ManifoldPoint make_of_sets(Contact contact) const {
    const bool has_ellipsoid = placed[0].ellipsoid != nullptr || placed[1].ellipsoid != nullptr;
    const auto round =
        has_ellipsoid ? make_ellipsoidal(placed, contact) : std::array<RoundFeature, 2>{};
    return point_of(contact, round);
  }

  [[nodiscard]] ManifoldPoint point_of(const Contact& contact,
                                       const std::array<RoundFeature, 2>& round) const {
    return {.bodies = bodies,
            .feature_A = contact.feature_A,
            .feature_B = contact.feature_B,
            .surface = {surfaces[0].neighbours->surface_index(contact.feature_A),
                        surfaces[1].neighbours->surface_index(contact.feature_B)},
            .point = 0.5 * (contact.p_WA + contact.p_WB),
            .normal = *contact.n_AB_W,
            .gap = contact.distance - margin,
            .round = round,
            .corner = {is_corner(0, contact.feature_A, contact.feature_B),
                       is_corner(1, contact.feature_B, contact.feature_A)}};
  }

  [[nodiscard]] bool is_corner(std::size_t side, const Feature& its, const Feature& other) const {
    return its.type == FeatureType::vertex && other.type == FeatureType::face &&
           placed[side].ellipsoid == nullptr &&
           placed[side].circles->at(*placed[side].shape, its).circle == nullptr;
  }

  BodyPair bodies;
  double margin;    // [m]
  double most_sag;  // [m]
  std::array<PlacedSurface, 2> surfaces;
  std::array<PlacedRound, 2> placed;
};

/// Chooses among very many contacts: of those beside each other that face alike the nearest bulging
/// one.
///
/// The motion of a rigid body is nearly the same at all of them. Where it is not, the next first
/// contact finds it.
class NearestOfMany {
 public:
  /// @param apart  [m]  width of a neighbourhood
  explicit NearestOfMany(double apart) : apart_(apart) {}

  void add(const Contact& contact, const FacingBodies& facing) {
    const FacingCell cell = facing_cell(contact.p_WA, *contact.n_AB_W, apart_);
    const Contact*& nearest = nearest_.try_emplace(cell, nullptr).first->second;
    if ((nearest == nullptr || contact.distance < nearest->distance) &&
        facing.are_outermost(contact)) {
      nearest = &contact;
    }
  }

  /// The chosen contacts, in the order of their list.
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
  double apart_;
  std::unordered_map<FacingCell, const Contact*, CellHash> nearest_;
};

/// Adds a point to the kept ones, unless a nearer one stands for it.
///
/// Features that meet in one place, as the corner of one face and an edge of it, constrain alike:
/// the nearest is kept.
///
/// @param size  [m]  of the smaller body
void keep_once(const ManifoldPoint& touch, double size, SpatialHash& by_place,
               std::vector<ManifoldPoint>& kept) {
  std::size_t same = kept.size();
  by_place.for_each_near(touch.point, [&](std::size_t k) {
    if ((touch.point - kept[k].point).norm() <= kSamePlace * size &&
        touch.normal.dot(kept[k].normal) >= kSameNormal) {
      same = std::min(same, k);
    }
  });
  if (same == kept.size()) {
    kept.push_back(touch);
  } else if (touch.gap < kept[same].gap) {
    kept[same] = touch;
  } else {
    return;
  }
  by_place.add(touch.point, same);
}

/// The manifold points among very many contacts.
///
/// @param beside  [m]  width of a neighbourhood
std::vector<ManifoldPoint> touches_among_many(const FacingBodies& facing, const TouchMaker& maker,
                                              const std::vector<Contact>& contacts, double beside) {
  NearestOfMany nearest(beside);
  for (const Contact& contact : contacts) {
    if (contact.n_AB_W) {
      nearest.add(contact, facing);
    }
  }
  std::vector<ManifoldPoint> touches;
  for (const Contact* contact : nearest.take()) {
    touches.push_back(maker.make(*contact));
  }
  return touches;
}

}  // namespace

bool same_features(const ManifoldPoint& x, const ManifoldPoint& y) {
  return features_of(x) == features_of(y);
}

bool share_curve(const ManifoldPoint& x, const ManifoldPoint& y) {
  const auto is_shared = [&](std::size_t side) {
    return x.round[side].is_curved() && x.round[side] == y.round[side];
  };
  return is_shared(0) || is_shared(1);
}

std::vector<ManifoldPoint> touches_among(const SimulationModel& model, const BodyPair& bodies,
                                         const std::array<Pose, 2>& poses, double margin,
                                         const std::vector<Contact>& contacts) {
  const FacingBodies facing(model, bodies, poses);
  const TouchMaker maker(model, bodies, poses, margin);
  if (contacts.size() > kVeryManyContacts) {
    std::vector<ManifoldPoint> few =
        touches_among_many(facing, maker, contacts, kNeighbourhood * smaller_reach(model, bodies));
    if (!few.empty()) {
      return few;
    }
  }
  std::vector<const Contact*> outermost;
  outermost.reserve(contacts.size());
  for (const Contact& contact : contacts) {
    if (contact.n_AB_W && facing.are_outermost(contact)) {
      outermost.push_back(&contact);
    }
  }
  const double size = smaller_reach(model, bodies);
  SpatialHash by_place(kSamePlace * size);
  std::vector<ManifoldPoint> touches;
  if (!outermost.empty()) {
    touches.reserve(std::min(outermost.size(), kUsualTouches));
    for (const Contact* contact : outermost) {
      keep_once(maker.make(*contact), size, by_place, touches);
    }
    return touches;
  }
  for (const Contact& contact : contacts) {
    if (contact.n_AB_W) {
      keep_once(maker.make(contact), size, by_place, touches);
    }
  }
  return touches;
}

double least_gap(const Manifold& manifold) {
  double least = std::numeric_limits<double>::infinity();
  for (const ManifoldPoint& touch : manifold.touches) {
    least = std::min(least, touch.gap);
  }
  return least;
}

bool are_curved(const SimulationModel& model, const BodyPair& bodies) {
  return model.bodies[bodies[0]].shape.is_curved() || model.bodies[bodies[1]].shape.is_curved();
}

Manifold ManifoldFinder::find(const BodyPair& bodies, const PlacedShape& A, const PlacedShape& B,
                              double margin) {
  Manifold manifold{.bodies = bodies, .gap = std::numeric_limits<double>::infinity()};
  if (!model_.bodies[bodies[0]].ellipsoid && !model_.bodies[bodies[1]].ellipsoid) {
    find_among_triangles(A, B, margin, manifold);
  }
  if (are_curved(model_, bodies)) {
    add_of_sets({A.pose(), B.pose()}, margin, manifold);
  }
  std::erase_if(manifold.touches,
                [&](const ManifoldPoint& touch) { return touch.gap > model_.distances.band; });
  if (manifold.touches.empty() && manifold.gap > model_.distances.band) {
    manifold.gap = std::numeric_limits<double>::infinity();
  }
  return manifold;
}

void ManifoldFinder::find_among_triangles(const PlacedShape& A, const PlacedShape& B, double margin,
                                          Manifold& manifold) {
  const BodyPair& bodies = manifold.bodies;
  close_features(A, B, margin + near_of(model_, bodies), workspace_, contacts_,
                 kNeighbourhood * smaller_reach(model_, bodies));
  for (const Contact& contact : contacts_) {
    manifold.gap = std::min(manifold.gap, contact.distance - margin);
  }
  manifold.touches = touches_among(model_, bodies, {A.pose(), B.pose()}, margin, contacts_);
}

/// Adds the points of convex sets: all of an ellipsoid, which has no others, and else those that
/// are nearer than all that the triangles have. The gap is that of the sets. Points of triangles
/// that are nearer than it are none of the bodies.
void ManifoldFinder::add_of_sets(const std::array<Pose, 2>& poses, double margin,
                                 Manifold& manifold) {
  const BodyPair& bodies = manifold.bodies;
  const TouchMaker maker(model_, bodies, poses, margin);
  const FacingBodies facing(model_, bodies, poses);
  const ContactDistances& distances = model_.distances;
  close_points_of_sets({model_.bodies[bodies[0]].shape, poses[0]},
                       {model_.bodies[bodies[1]].shape, poses[1]}, margin + distances.band,
                       workspace_, contacts_);
  manifold.gap = std::numeric_limits<double>::infinity();
  for (const Contact& contact : contacts_) {
    manifold.gap = std::min(manifold.gap, contact.distance - margin);
  }
  const double same = kSameGap * distances.least;
  const double least = std::min(manifold.gap, distances.band) - same;
  std::erase_if(manifold.touches, [&](const ManifoldPoint& touch) { return touch.gap < least; });
  const double nearer = least_gap(manifold) - same;
  const double size = smaller_reach(model_, bodies);
  SpatialHash by_place(kSamePlace * size);
  std::vector<ManifoldPoint> added;
  for (const Contact& contact : contacts_) {
    if (!contact.n_AB_W || !(contact.distance - margin < nearer)) {
      continue;
    }
    const ManifoldPoint touch = maker.make_of_sets(contact);
    if (facing.is_outermost(0, touch) && facing.is_outermost(1, touch)) {
      keep_once(touch, size, by_place, added);
    }
  }
  std::ranges::copy(added, std::back_inserter(manifold.touches));
}

bool comes_before(const ManifoldPoint& x, const ManifoldPoint& y) {
  return std::pair(x.bodies, features_of(x)) < std::pair(y.bodies, features_of(y));
}

void carry_impulses(const std::vector<ManifoldPoint>& before, double size, Manifold& manifold) {
  const auto bodies_of = [](const ManifoldPoint& touch) { return touch.bodies; };
  auto touch = std::ranges::lower_bound(before, manifold.bodies, {}, bodies_of);
  if (touch == before.end() || touch->bodies != manifold.bodies) {
    return;
  }
  Successors successors(kCloseBy * size, manifold.touches);
  for (; touch != before.end() && touch->bodies == manifold.bodies; ++touch) {
    if (ManifoldPoint* next = successors.of(*touch)) {
      next->impulse += touch->impulse;
    }
  }
}

}  // namespace firstcontact::detail
