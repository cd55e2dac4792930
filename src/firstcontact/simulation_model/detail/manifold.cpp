#include <firstcontact/simulation_model/detail/manifold.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <unordered_map>
#include <utility>

#include <Eigen/Geometry>

#include <firstcontact/geometry/detail/spatial_hash.h>
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
      : A_(*model.neighbours[bodies[0]]),
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

 private:
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
          .shape = &body.shape, .neighbours = model.neighbours[pair[s]].get(), .pose = poses[s]};
      placed[s] = {.shape = &body.shape,
                   .circles = model.round_circles[pair[s]].get(),
                   .ellipsoid = body.ellipsoid ? &*body.ellipsoid : nullptr,
                   .pose = poses[s]};
    }
  }

  [[nodiscard]] ManifoldPoint make(Contact contact) const {
    lay_on_face(surfaces, contact);
    std::array<RoundFeature, 2> round = make_ellipsoidal(placed, most_sag, contact);
    if (!round[0].is_curved() && !round[1].is_curved()) {
      round = make_round(placed, most_sag, contact);
    }
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

/// Drops corners of an ellipsoid's triangles beside a plane that the ellipsoid touches.
///
/// They are inside of the ellipsoid, and another corner of the triangles is nearer.
///
/// @param same  [m]  planes that are less apart are one
void drop_inner_corners(const TouchMaker& maker, double same, std::vector<ManifoldPoint>& touches) {
  for (std::size_t s = 0; s < 2; ++s) {
    if (maker.placed[s].ellipsoid == nullptr) {
      continue;
    }
    const auto point_of_other = [&](const ManifoldPoint& touch) -> Vector3d {
      return touch.point + (s == 0 ? 0.5 : -0.5) * touch.gap * touch.normal;
    };
    const auto is_inner = [&](const ManifoldPoint& touch, const ManifoldPoint& of_ellipsoid) {
      const Vector3d apart = point_of_other(touch) - point_of_other(of_ellipsoid);
      return of_ellipsoid.round[s].ellipsoid != nullptr &&
             touch.normal.dot(of_ellipsoid.normal) >= kSameNormal &&
             std::abs(of_ellipsoid.normal.dot(apart)) <= same;
    };
    const std::vector<ManifoldPoint> all = touches;
    std::erase_if(touches, [&](const ManifoldPoint& touch) {
      return touch.round[s].ellipsoid == nullptr &&
             std::ranges::any_of(all, [&](const auto& other) { return is_inner(touch, other); });
    });
  }
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
    drop_inner_corners(maker, kSameGap * model.distances.least, touches);
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

Manifold ManifoldFinder::find(const BodyPair& bodies, const PlacedShape& A, const PlacedShape& B,
                              double margin) {
  Manifold manifold{.bodies = bodies, .gap = std::numeric_limits<double>::infinity()};
  close_features(A, B, margin + near_of(model_, bodies), workspace_, contacts_,
                 kNeighbourhood * smaller_reach(model_, bodies));
  for (const Contact& contact : contacts_) {
    manifold.gap = std::min(manifold.gap, contact.distance - margin);
  }
  manifold.touches = touches_among(model_, bodies, {A.pose(), B.pose()}, margin, contacts_);
  std::erase_if(manifold.touches,
                [&](const ManifoldPoint& touch) { return touch.gap > model_.distances.band; });
  if (manifold.touches.empty() && manifold.gap > model_.distances.band) {
    manifold.gap = std::numeric_limits<double>::infinity();
  }
  return manifold;
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
