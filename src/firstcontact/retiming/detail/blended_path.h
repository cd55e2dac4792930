/// @file
/// The geometry of a path with blends, by one parameter over several edges.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/retiming/blend_motion.h>
#include <firstcontact/retiming/waypoint_path.h>

namespace firstcontact::detail {

/// A place on a path and its derivatives by the parameter S.
struct PathPlace {
  std::vector<double> p;    ///< [rad or m]
  std::vector<double> dp;   ///< [rad or m]  Per unit of S.
  std::vector<double> ddp;  ///< [rad or m]  Per unit of S^2.
};

/// The stretch of a path between two waypoints at which the robot rests, p(S), twice continuously
/// differentiable.
///
/// Derivation: on edge e from a to b, dp / dS = c (b - a). A blend of shares `before` and `after`
/// has a length of 2 before / c of the edge before it, and the edge behind it the factor
/// c after / before: so the first derivatives meet. The second ones are 0 there.
class BlendedPath {
 public:
  /// One edge's straight part, or one blend.
  struct Piece {
    std::size_t edge = 0;  ///< The one before a blend.
    double begin = 0.0;    ///< Of S.
    double end = 0.0;
    double x_begin = 0.0;  ///< [-]  On the edge, of a straight piece.
    double factor = 1.0;   ///< dx / dS on the edge.
    bool is_blend = false;
    double before = 0.0;
    double after = 0.0;
  };

  /// @param first, last  waypoints at which the robot rests; all blends between them are blends
  BlendedPath(const WaypointPath& path, const std::vector<Blend>& blends, std::size_t first,
              std::size_t last);

  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }
  [[nodiscard]] double length() const { return pieces_.back().end; }
  [[nodiscard]] PathPlace place(const Piece& piece, double S) const;
  [[nodiscard]] PathPlace place(double S) const;

 private:
  const WaypointPath& path_;
  std::vector<Piece> pieces_;
};

}  // namespace firstcontact::detail
