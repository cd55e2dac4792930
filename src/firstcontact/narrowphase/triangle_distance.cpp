#include <firstcontact/narrowphase/triangle_distance.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include <firstcontact/geometry/needle.h>
#include <firstcontact/narrowphase/closest_features.h>
#include <firstcontact/narrowphase/detail/elementary_pairs.h>

namespace firstcontact {
namespace {

using detail::ElementaryPairs;
using Eigen::Vector3d;

constexpr int kStride = ElementaryPairs::kStride;

ClosestFeatures edge_edge(const Triangle& A, int i, const Triangle& B, int j,
                          const ElementaryPairs::Edges& edges) {
  const int at = kStride * i + j;
  const double s = edges.s[at];
  const double t = edges.t[at];
  const Vector3d p_A = point_on_edge(A[i], A[(i + 1) % 3], s);
  const Vector3d p_B = point_on_edge(B[j], B[(j + 1) % 3], t);
  return {(p_B - p_A).norm(), p_A, p_B, edge_or_end(i, s), edge_or_end(j, t)};
}

CornerFoot foot(const ElementaryPairs::Corners& corners, int k) {
  return {corners.u[k], corners.v[k], corners.height[k]};
}

std::optional<ClosestFeatures> piercing(const Triangle& S, int k, const Triangle& T,
                                        const ElementaryPairs::Corners& corners, bool swapped) {
  return edge_through_face(S, k, T, foot(corners, k), foot(corners, (k + 1) % 3), swapped);
}

/// The closest points, piercings left out.
ClosestFeatures nearest(const Triangle& A, const Triangle& B, const ElementaryPairs& pairs) {
  const int row = pairs.nearest / kStride;
  const int k = std::min(pairs.nearest % kStride, 2);
  if (row < 3) {
    return edge_edge(A, row, B, k, pairs.edges);
  }
  return row == 3 ? corner_over_face(A, k, B, foot(pairs.corners[0], k), false)
                  : corner_over_face(B, k, A, foot(pairs.corners[1], k), true);
}

bool has_corner(unsigned features, int i) { return (features & 1u << i) != 0; }
bool has_edge(unsigned features, int i) { return (features & 8u << i) != 0; }

/// The number of a feature, below kFeatures.
constexpr std::size_t kFeatures = 7;
std::size_t number_of(const TriangleFeature& feature) {
  return 3 * static_cast<std::size_t>(feature.type) + static_cast<std::size_t>(feature.index);
}

bool is_needle(const Triangle& T) { return firstcontact::is_needle(T[0], T[1], T[2]); }

/// The closest features of corner k of S and the edge of T from corner j.
///
/// @param swapped  S belongs to B
ClosestFeatures corner_beside_edge(const Triangle& S, int k, const Triangle& T, int j,
                                   bool swapped) {
  const Vector3d& from = T[j];
  const Vector3d& to = T[(j + 1) % 3];
  const Vector3d edge = to - from;
  const double square = edge.squaredNorm();
  const double s = square > 0.0 ? std::clamp(edge.dot(S[k] - from) / square, 0.0, 1.0) : 0.0;
  const Vector3d p = point_on_edge(from, to, s);
  return exchanged_if(
      swapped, {(p - S[k]).norm(), S[k], p, {TriangleFeature::Type::vertex, k}, edge_or_end(j, s)});
}

/// The corner at which the longest edge begins.
int begin_of_longest(const Triangle& T) {
  int longest = 0;
  for (int k = 1; k < 3; ++k) {
    if ((T[(k + 1) % 3] - T[k]).squaredNorm() > (T[(longest + 1) % 3] - T[longest]).squaredNorm()) {
      longest = k;
    }
  }
  return longest;
}

}  // namespace

ClosestFeatures triangle_distance(const Triangle& A, const Triangle& B) {
  ElementaryPairs pairs;
  find_elementary_pairs(A, B, pairs);
  ClosestFeatures best = nearest(A, B, pairs);
  const auto pierce = [&](const std::optional<ClosestFeatures>& through) {
    if (through && through->distance < best.distance) {
      best = *through;
    }
  };
  for (int k = 0; k < 3; ++k) {
    pierce(piercing(A, k, B, pairs.corners[0], false));
    pierce(piercing(B, k, A, pairs.corners[1], true));
  }
  return best;
}

FeaturePairs feature_pairs_within(const Triangle& A, const Triangle& B, double band,
                                  unsigned features_A, unsigned features_B) {
  FeaturePairs within;
  std::array<std::uint8_t, kFeatures * kFeatures> place{};  // Place plus 1; 0: not there yet.
  const double reach =
      // Beyond the error of squares.
      band + 0x1p-46 * (greatest_coordinate(A) + greatest_coordinate(B));
  const double reach2 = reach * reach;
  const auto use = [&](const ClosestFeatures& c) {
    if (!(c.distance <= band)) {
      return;
    }
    std::uint8_t& found = place[kFeatures * number_of(c.feature_A) + number_of(c.feature_B)];
    if (found == 0) {
      within.pairs[within.count++] = c;
      found = static_cast<std::uint8_t>(within.count);
    } else if (c.distance < within.pairs[found - 1].distance) {
      within.pairs[found - 1] = c;
    }
  };
  ElementaryPairs pairs;
  find_elementary_pairs(A, B, pairs);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (has_edge(features_A, i) && has_edge(features_B, j) &&
          pairs.edges.square[kStride * i + j] <= reach2) {
        use(edge_edge(A, i, B, j, pairs.edges));
      }
    }
  }
  const auto use_corners_and_edges = [&](const Triangle& S, unsigned features, const Triangle& T,
                                         const ElementaryPairs::Corners& corners, bool swapped) {
    for (int k = 0; k < 3; ++k) {
      const bool is_over_face = corners.square[k] < ElementaryPairs::kNone;
      if (has_corner(features, k) && is_over_face && corners.square[k] <= reach2) {
        use(corner_over_face(S, k, T, foot(corners, k), swapped));
      }
      if (has_edge(features, k)) {
        if (const auto through = piercing(S, k, T, corners, swapped)) {
          use(*through);
        }
      }
    }
  };
  use_corners_and_edges(A, features_A, B, pairs.corners[0], false);
  use_corners_and_edges(B, features_B, A, pairs.corners[1], true);
  const auto use_ends = [&](const Triangle& S, unsigned of_S, const Triangle& T, unsigned of_T,
                            bool swapped) {
    const int begin = begin_of_longest(S);
    for (const int k : {begin, (begin + 1) % 3}) {
      for (int j = 0; j < 3; ++j) {
        if (has_corner(of_S, k) && has_edge(of_T, j)) {
          use(corner_beside_edge(S, k, T, j, swapped));
        }
      }
    }
  };
  if (is_needle(A)) {
    use_ends(A, features_A, B, features_B, false);
  }
  if (is_needle(B)) {
    use_ends(B, features_B, A, features_A, true);
  }
  return within;
}

}  // namespace firstcontact
