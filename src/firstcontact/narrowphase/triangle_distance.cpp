#include <firstcontact/narrowphase/triangle_distance.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include <firstcontact/narrowphase/detail/elementary_pairs.h>

namespace firstcontact {
namespace {

using detail::ElementaryPairs;
using Eigen::Vector3d;
using Type = TriangleFeature::Type;

constexpr int kStride = ElementaryPairs::kStride;

TriangleFeature edge_or_end(int edge, double s) {
  if (s == 0.0) {
    return {Type::vertex, edge};
  }
  return s == 1.0 ? TriangleFeature{Type::vertex, (edge + 1) % 3}
                  : TriangleFeature{Type::edge, edge};
}

Vector3d edge_vector(const Triangle& T, int edge) { return T[(edge + 1) % 3] - T[edge]; }

Vector3d point_on_edge(const Triangle& T, int edge, double s) {
  return s == 1.0 ? T[(edge + 1) % 3] : Vector3d(T[edge] + s * edge_vector(T, edge));
}

Vector3d point_on_face(const Triangle& T, double u, double v) {
  return T[0] + u * (T[1] - T[0]) + v * (T[2] - T[0]);
}

ClosestFeatures edge_edge(const Triangle& A, int i, const Triangle& B, int j,
                          const ElementaryPairs::Edges& edges) {
  const int at = kStride * i + j;
  const double s = edges.s[at];
  const double t = edges.t[at];
  const Vector3d p_A = point_on_edge(A, i, s);
  const Vector3d p_B = point_on_edge(B, j, t);
  return {(p_B - p_A).norm(), p_A, p_B, edge_or_end(i, s), edge_or_end(j, t)};
}

ClosestFeatures in_order(ClosestFeatures c, bool swapped) {
  if (swapped) {
    std::swap(c.p_A, c.p_B);
    std::swap(c.feature_A, c.feature_B);
  }
  return c;
}

/// Corner k of S over the face of T.
ClosestFeatures corner_face(const Triangle& S, int k, const Triangle& T,
                            const ElementaryPairs::Corners& corners, bool swapped) {
  const Vector3d foot = point_on_face(T, corners.u[k], corners.v[k]);
  return in_order({(foot - S[k]).norm(), S[k], foot, {Type::vertex, k}, {Type::face, 0}}, swapped);
}

/// [m]  At least the greatest coordinate.
double size(const Triangle& T) {
  return (T[0].cwiseAbs() + T[1].cwiseAbs() + T[2].cwiseAbs()).maxCoeff();
}

/// Where edge k of S, between two heights over T's plane, pierces T. Of a needle, rounding may have
/// put the point on T elsewhere: then they are as far apart as they are.
std::optional<ClosestFeatures> piercing(const Triangle& S, int k, const Triangle& T,
                                        const ElementaryPairs::Corners& corners, bool swapped) {
  constexpr double kRounding = 0x1p-40;  // Of the size, with room.
  const int end = (k + 1) % 3;
  const double above = corners.height[k];
  const double below = corners.height[end];
  if ((above > 0.0) == (below > 0.0) || above == below) {
    return std::nullopt;
  }
  const double part = above / (above - below);
  const double u = corners.u[k] + part * (corners.u[end] - corners.u[k]);
  const double v = corners.v[k] + part * (corners.v[end] - corners.v[k]);
  if (!(u > 0.0 && v > 0.0 && u + v < 1.0)) {
    return std::nullopt;
  }
  const Vector3d on_S = point_on_edge(S, k, part);
  const Vector3d on_T = point_on_face(T, u, v);
  const double apart = (on_T - on_S).norm();
  const bool pierces = apart <= kRounding * (size(S) + size(T));
  return in_order(
      {pierces ? 0.0 : apart, pierces ? on_T : on_S, on_T, edge_or_end(k, part), {Type::face, 0}},
      swapped);
}

/// But for piercings.
ClosestFeatures nearest(const Triangle& A, const Triangle& B, const ElementaryPairs& pairs) {
  const int row = pairs.nearest / kStride;
  const int k = std::min(pairs.nearest % kStride, 2);
  if (row < 3) {
    return edge_edge(A, row, B, k, pairs.edges);
  }
  return row == 3 ? corner_face(A, k, B, pairs.corners[0], false)
                  : corner_face(B, k, A, pairs.corners[1], true);
}

bool has_corner(unsigned features, int i) { return (features & 1u << i) != 0; }
bool has_edge(unsigned features, int i) { return (features & 8u << i) != 0; }

/// A number below kFeatures.
constexpr std::size_t kFeatures = 7;
std::size_t number_of(const TriangleFeature& feature) {
  return 3 * static_cast<std::size_t>(feature.type) + static_cast<std::size_t>(feature.index);
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
  std::array<std::uint8_t, kFeatures * kFeatures> place{};    // Plus 1; 0: not there yet.
  const double reach = band + 0x1p-46 * (size(A) + size(B));  // More than squares err.
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
        use(corner_face(S, k, T, corners, swapped));
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
  return within;
}

}  // namespace firstcontact
