/// @file
/// Two shapes on links at one time: where boxes and triangles are, and how long they stay apart.

#pragma once

#include <cstdint>

#include <Eigen/Core>

#include <firstcontact/articulated/link_path.h>
#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/narrowphase/triangle_distance.h>

namespace firstcontact::detail {

/// A box of a hierarchy: slot `slot` of node `node`.
struct LinkBox {
  std::uint32_t node = 0;
  int slot = 0;
};

/// How long two parts stay farther apart than a threshold, and by how much they are now.
struct Separation {
  double gap = 0.0;   ///< [m]  Less the threshold; the greatest over the directions tried.
  double time = 0.0;  ///< [-]  0 where no direction separates.
};

/// Two hierarchies whose centres are the origins of their links, at the time of two windows.
class LinkPair {
 public:
  LinkPair(const Hierarchy& A, const Hierarchy& B, const LinkWindow& at_A, const LinkWindow& at_B);

  /// [m]  How far any gap computed here may be from the exact one.
  [[nodiscard]] double gap_error() const { return gap_error_; }

  /// [-]  How long balls around both hierarchies stay farther apart, by their line of centres.
  [[nodiscard]] double balls_apart(double threshold) const;

  /// By the line of centres and the axes of both boxes.
  [[nodiscard]] Separation boxes(LinkBox a, LinkBox b, double threshold) const;

  /// Of two triangles, by index in their hierarchies; positions from the windows' origin.
  [[nodiscard]] ClosestFeatures distance(std::uint32_t a, std::uint32_t b) const;

  /// By the directions that the closest features define.
  [[nodiscard]] double triangles_apart(std::uint32_t a, std::uint32_t b,
                                       const ClosestFeatures& closest, double threshold) const;

  /// [m]
  [[nodiscard]] static double radius(const Hierarchy& hierarchy, LinkBox box);

 private:
  [[nodiscard]] Triangle place(const Hierarchy& hierarchy, const LinkPose& pose,
                               std::uint32_t triangle) const;
  [[nodiscard]] double time_apart(const Triangle& a, const Triangle& b, std::uint32_t index_a,
                                  std::uint32_t index_b, const Eigen::Vector3d& n,
                                  double threshold) const;

  const Hierarchy& A_;
  const Hierarchy& B_;
  const LinkWindow& at_A_;
  const LinkWindow& at_B_;
  double gap_error_;
};

}  // namespace firstcontact::detail
