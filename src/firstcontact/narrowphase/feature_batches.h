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
  FeatureLanes square;                ///< [m^2]  Square of the length.
  FeatureLanes inverse_square;        ///< [1/m^2]  0 for an edge without length.

  void add(const Eigen::Vector3d& begin, const Eigen::Vector3d& end) {
    from.add(begin);
    to.add(end);
  }
  [[nodiscard]] std::size_t count() const { return from.count; }
};

/// Computes the fields that depend on the ends of edges; to be called after the last was added.
FIRSTCONTACT_API void prepare(EdgeBatch& edges);

/// The distances of an edge of A from all edges of a batch B.
struct EdgeDistances {
  FeatureLanes s;            ///< [-]  Place of the closest point on A's edge, in [0, 1].
  FeatureLanes t;            ///< [-]  Place of the closest point on B's edge.
  FeatureLanes distance;     ///< [m]  Distance of these points; only for the lanes `within`.
  std::uint64_t within = 0;  ///< Bits of the lanes whose distance is at most the band.
};

/// Finds exactly what feature_pairs_within() finds for these edges, to the last bit.
///
/// @param band  [m]
/// @param size  [m]  no coordinate is greater
FIRSTCONTACT_API void edge_distances(const EdgeBatch& A, std::size_t edge, const EdgeBatch& B,
                                     double band, double size, EdgeDistances& distances);

/// Triangles side by side.
struct FaceBatch {
  static constexpr std::size_t kCapacity = 16;

  std::array<CornerBatch, 3> corner;
  std::array<FeatureLanes, 3> normal;                 ///< A normal of any length.
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

/// Computes the fields that depend on the corners of faces; to be called after the last was added.
FIRSTCONTACT_API void prepare(FaceBatch& faces);

/// The place of a corner over the faces of a batch.
struct CornerFeet {
  using Lanes = std::array<double, FaceBatch::kCapacity>;

  alignas(64) Lanes u;
  alignas(64) Lanes v;
  alignas(64) Lanes height;
  std::uint32_t above = 0;   ///< Bits of the lanes with a positive height.
  std::uint32_t within = 0;  ///< Bits of the lanes with feet inside the face, and at most the band
                             ///< away.

  [[nodiscard]] CornerFoot operator[](std::size_t face) const {
    return {u[face], v[face], height[face]};
  }
};

/// Finds for each of these corners exactly what feature_pairs_within() finds, to the last bit.
///
/// The lanes `within` are those that the function looks at. Some of them are beyond the band by
/// rounding.
///
/// @param band  [m]
/// @param size  [m]  no coordinate is greater
FIRSTCONTACT_API void corner_feet(const CornerBatch& corners, const FaceBatch& faces, double band,
                                  double size,
                                  std::array<CornerFeet, FeatureLanes::kCapacity>& feet);

}  // namespace firstcontact
