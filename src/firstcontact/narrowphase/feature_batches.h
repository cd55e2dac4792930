/// @file
/// Distances of many features at once, on vector units: an edge from all edges of a batch, a corner
/// from all faces of one.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include <firstcontact/math/export.h>
#include <firstcontact/narrowphase/closest_features.h>
#include <firstcontact/narrowphase/triangle_distance.h>

namespace firstcontact {

/// A number of each feature of a batch.
struct FeatureLanes {
  static constexpr std::size_t kCapacity = 48;

  alignas(64) std::array<double, kCapacity> at;

  double& operator[](std::size_t lane) { return at[lane]; }
  double operator[](std::size_t lane) const { return at[lane]; }
};

/// Corners side by side. Lanes beyond them hold what the caller left there.
struct CornerBatch {
  std::array<FeatureLanes, 3> corner;  ///< [m]
  std::size_t count = 0;

  void add(const Eigen::Vector3d& p) {
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k][count] = p[static_cast<Eigen::Index>(k)];
    }
    ++count;
  }
  [[nodiscard]] Eigen::Vector3d operator[](std::size_t lane) const {
    return {corner[0][lane], corner[1][lane], corner[2][lane]};
  }
};

/// Edges side by side.
struct EdgeBatch {
  CornerBatch from;
  CornerBatch to;
  std::array<FeatureLanes, 3> along;  ///< [m]
  FeatureLanes square;                ///< [m^2]  Of the length.
  FeatureLanes inverse_square;        ///< [1/m^2]  0 of an edge without length.

  void add(const Eigen::Vector3d& begin, const Eigen::Vector3d& end) {
    from.add(begin);
    to.add(end);
  }
  [[nodiscard]] std::size_t count() const { return from.count; }
};

/// Finds what depends on the ends of edges. To be called after the last was added.
FIRSTCONTACT_API void prepare(EdgeBatch& edges);

/// An edge of A against all edges of a batch B.
struct EdgeDistances {
  FeatureLanes s;            ///< [-]  Where on A's edge the closest point is, in [0, 1].
  FeatureLanes t;            ///< [-]  Where on B's.
  FeatureLanes distance;     ///< [m]  Of these points; of lanes `within` alone.
  std::uint64_t within = 0;  ///< The lanes whose distance is at most the band.
};

/// Just what feature_pairs_within() finds of these edges, to the last bit.
///
/// @param band  [m]
/// @param size  [m]  no coordinate is greater
FIRSTCONTACT_API void edge_distances(const EdgeBatch& A, std::size_t edge, const EdgeBatch& B,
                                     double band, double size, EdgeDistances& distances);

/// Triangles side by side.
struct FaceBatch {
  static constexpr std::size_t kCapacity = 16;

  std::array<CornerBatch, 3> corner;
  std::array<FeatureLanes, 3> normal;                 ///< Of any length.
  std::array<std::array<FeatureLanes, 3>, 2> across;  ///< [1/m]  A point r from the first corner
                                                      ///< has its foot at u = r . across[0], v.

  void add(const Triangle& T) {
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k].add(T[k]);
    }
  }
  [[nodiscard]] std::size_t count() const { return corner[0].count; }
  [[nodiscard]] Triangle operator[](std::size_t lane) const {
    return {corner[0][lane], corner[1][lane], corner[2][lane]};
  }
};

/// Finds what depends on the corners of faces. To be called after the last was added.
FIRSTCONTACT_API void prepare(FaceBatch& faces);

/// Where a corner is over the faces of a batch.
struct CornerFeet {
  using Lanes = std::array<double, FaceBatch::kCapacity>;

  alignas(64) Lanes u;
  alignas(64) Lanes v;
  alignas(64) Lanes height;
  std::uint32_t above = 0;   ///< The lanes with a positive height.
  std::uint32_t within = 0;  ///< Those of feet inside the face, and at most the band away.

  [[nodiscard]] CornerFoot operator[](std::size_t face) const {
    return {u[face], v[face], height[face]};
  }
};

/// Finds for each of these corners just what feature_pairs_within() finds, to the last bit.
///
/// The lanes `within` are those that it looks at, some of them beyond the band by rounding.
///
/// @param band  [m]
/// @param size  [m]  no coordinate is greater
FIRSTCONTACT_API void corner_feet(const CornerBatch& corners, const FaceBatch& faces, double band,
                                  double size,
                                  std::array<CornerFeet, FeatureLanes::kCapacity>& feet);

}  // namespace firstcontact
