#include <firstcontact/query/detail/close_pairs_by_front.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/query/detail/close_pairs.h>
#include <firstcontact/query/detail/nearest_pairs.h>
#include <firstcontact/query/detail/screw_sliding_cover.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// [groups]  Where a new front opens this many, screw sliding finds the pairs of screw surfaces.
constexpr std::uint64_t kManyOpened = 10'000;
constexpr std::uint64_t kAll = std::numeric_limits<std::uint64_t>::max();
/// [pairs of triangles]  More than these are very many.
constexpr std::size_t kVeryMany = 1000;

/// An instant, and the distance that is asked for.
struct Instant {
  const MovingPair& pair;
  const RelativeState& state;
  double reach;  // [m]  Reach for features, the error of gaps included.
  BoxesAtInstant boxes;

  Instant(const ContactFrame& frame, const RelativeState& at, double band)
      : pair(frame.pair), state(at), reach(band + frame.pair.gap_error(at)), boxes(pair, at) {}
};

/// Opens the near boxes, group after group.
class FrontOpener {
 public:
  FrontOpener(const Instant& instant, BoxFront& front, std::vector<FrontTriangles>& triangles)
      : instant_(instant),
        front_(front),
        motion_(front.place(), instant.pair, instant.state, 0.0),
        triangles_(triangles) {
    triangles_.clear();
  }

  /// [m]  The most by which the distance of triangles may have fallen since the front began.
  [[nodiscard]] double moved(const FrontTriangles& at) const {
    return motion_.of(front_.ball(at.group));
  }

  /// @returns the number of groups that were bounded; above `most` if that ended the search
  std::uint64_t open(std::uint64_t most) {
    std::uint64_t opened = 0;
    std::size_t k = next_due(0);
    while (k < front_.size() && opened <= most) {
      const std::size_t other = next_due(k + 1);
      if (other < front_.size()) {
        open_both(k, other);
        opened += 2;
        k = next_due(other + 1);
      } else {
        open_one(k);
        opened += 1;
        k = next_due(k + 1);
      }
    }
    return opened;
  }

 private:
  std::size_t next_due(std::size_t k) const {
    const double most = instant_.reach + motion_.most();
    while (k < front_.size() && (front_.least(k) > most ||
                                 front_.least(k) > instant_.reach + motion_.of(front_.ball(k)))) {
      ++k;
    }
    return k;
  }

  void open_one(std::size_t k) {
    BoxBounds bounds;
    instant_.boxes.bound(front_.group(k).node_a, front_.group(k).node_b, bounds);
    take(k, bounds);
  }

  void open_both(std::size_t k, std::size_t other) {
    BoxBounds bounds;
    BoxBounds other_bounds;
    instant_.boxes.bound(front_.group(k).node_a, front_.group(k).node_b, bounds,
                         front_.group(other).node_a, front_.group(other).node_b, other_bounds);
    take(k, bounds);
    take(other, other_bounds);
  }

  void take(std::size_t k, const BoxBounds& bounds) {
    const double moved = motion_.of(front_.ball(k));
    const unsigned due = front_.lanes_within(k, instant_.reach + moved);
    unsigned near = due & front_.raise(k, bounds, instant_.pair.unit(), moved, instant_.reach);
    for (; near != 0; near &= near - 1) {
      const int lane = std::countr_zero(near);
      const BoxFront::Group& group = front_.group(k);
      const BoxPair inside =
          open_lane(instant_.pair, group.node_a, group.node_b, lane,
                    (bounds.larger_a >> lane & 1u) != 0, (bounds.larger_b >> lane & 1u) != 0);
      if (inside.is_triangle_pair) {
        triangles_.push_back({.a = inside.triangle_A,
                              .b = inside.triangle_B,
                              .group = static_cast<std::uint32_t>(k),
                              .lane = lane});
      } else {
        front_.open(instant_.pair, k, lane, inside);
      }
    }
    front_.settle(k);
  }

  const Instant& instant_;
  BoxFront& front_;
  FrontMotion motion_;
  std::vector<FrontTriangles>& triangles_;
};

/// [m]  The gap of two triangles along a direction of any length; negative if they are not apart.
double gap_along(const Vector3d& n, const TrianglePair& pair) {
  const Vector3d a(n.dot(pair.A[0]), n.dot(pair.A[1]), n.dot(pair.A[2]));
  const Vector3d b(n.dot(pair.B[0]), n.dot(pair.B[1]), n.dot(pair.B[2]));
  const double length = n.norm();
  constexpr double kLeastLength = 1e-100;  // Shorter ones lose digits.
  return length > kLeastLength
             ? std::max(b.minCoeff() - a.maxCoeff(), a.minCoeff() - b.maxCoeff()) / length
             : -1.0;
}

/// [m]  The greatest gap along the normals of both and the line of their centres.
double gap_by_planes(const TrianglePair& pair) {
  const auto normal = [](const Triangle& T) -> Vector3d {
    return (T[1] - T[0]).cross(T[2] - T[0]);
  };
  const Vector3d between =
      (pair.B[0] + pair.B[1] + pair.B[2]) - (pair.A[0] + pair.A[1] + pair.A[2]);
  return std::max(
      {gap_along(normal(pair.A), pair), gap_along(normal(pair.B), pair), gap_along(between, pair)});
}

/// Two triangles: a lower bound of their distance, and their closest points if they are near.
struct Bounded {
  double gap;  // [m]
  std::optional<ClosestFeatures> closest;
};

/// Bounds the distance by the planes of the triangles where these separate them, else by closest
/// points.
Bounded bounded(const Instant& instant, const FrontTriangles& at) {
  const TrianglePair placed = instant.pair.place(instant.state, at.a, at.b);
  const double by_planes = gap_by_planes(placed);
  if (by_planes > instant.reach) {
    return {by_planes, std::nullopt};
  }
  // The distance is an upper bound, the gap along its direction a lower bound.
  const ClosestFeatures closest = triangle_distance(placed.A, placed.B);
  const double gap = std::max(by_planes, gap_along(closest.p_B - closest.p_A, placed));
  return {gap, closest.distance <= instant.reach ? std::optional(closest) : std::nullopt};
}

/// Raises the bounds of triangles, and lists those within the reach.
void find_near(const Instant& instant, const std::vector<FrontTriangles>& triangles,
               const FrontOpener& opener, BoxFront& front, std::vector<NearTriangles>& near) {
  near.clear();
  for (const FrontTriangles& at : triangles) {
    const Bounded found = bounded(instant, at);
    front.raise_lane(at.group, at.lane, found.gap - opener.moved(at));
    front.settle(at.group);
    if (found.closest) {
      near.push_back({{at.a, at.b}, *found.closest});
    }
  }
}

/// Lists the features of triangles that are near.
void list_features(const ContactFrame& frame, const Instant& instant, double band, bool are_chosen,
                   WorkspaceData& workspace) {
  const auto own_A = frame.A.own_features();
  const auto own_B = frame.B.own_features();
  workspace.close_pairs.clear();
  for (const NearTriangles& near : workspace.near_triangles) {
    const unsigned of_A = are_chosen ? 0x3fu : own_A[near.at.a];
    const unsigned of_B = are_chosen ? 0x3fu : own_B[near.at.b];
    if (of_A == 0 && of_B == 0) {
      continue;
    }
    const TrianglePair placed = frame.pair.place(instant.state, near.at.a, near.at.b);
    const FeaturePairs close = feature_pairs_within(placed.A, placed.B, band, of_A, of_B);
    for (std::size_t k = 0; k < close.count; ++k) {
      workspace.close_pairs.push_back(close_pair(frame, near.at.a, near.at.b, close.pairs[k]));
    }
  }
}

}  // namespace

bool find_close_by_front(const ContactFrame& frame, const RelativeState& state, double band,
                         BoxFront& front, WorkspaceData& workspace) {
  if (front.is_empty() && !front.is_due_again()) {
    return false;
  }
  const bool begins = front.is_empty() || front.is_spent();
  if (begins) {
    front.begin(frame.pair, state);
  } else {
    front.rebase(frame.pair, state);
  }
  const Instant instant(frame, state, band);
  std::vector<FrontTriangles>& triangles = workspace.front_triangles;
  FrontOpener opener(instant, front, triangles);
  const bool may_slide =
      begins && ScrewSlidingCover::of(frame.pair, frame.A, frame.B, frame.t).has_value();
  const std::uint64_t opened = opener.open(may_slide ? kManyOpened : kAll);
  if (may_slide && opened > kManyOpened) {
    front.give_up();
    return false;
  }
  if (begins) {
    front.end_begin();
  }
  std::vector<NearTriangles>& near = workspace.near_triangles;
  find_near(instant, triangles, opener, front, near);
  const bool are_chosen = frame.beside > 0.0 && near.size() > kVeryMany;
  if (are_chosen) {
    keep_nearest(frame.beside, near);
  }
  list_features(frame, instant, band, are_chosen, workspace);
  return true;
}

}  // namespace firstcontact::detail
