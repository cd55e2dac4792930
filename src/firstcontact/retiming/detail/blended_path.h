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

/// The stretch p(S) of a path between two waypoints at which the robot rests.
///
/// p is twice continuously differentiable. Derivation: on edge e from a to b, dp / dS = c (b - a).
/// A blend of shares `before` and `after` has a length of 2 before / c of the edge before it. The
/// edge behind it has the factor c after / before, so that the first derivatives meet. The second
/// derivatives are 0 there.
class BlendedPath {
 public:
  /// One edge's straight part, or one blend.
  struct Piece {
    std::size_t edge = 0;  ///< Index of the edge; of a blend, of the edge before it.
    double begin = 0.0;    ///< Value of S at the begin.
    double end = 0.0;
    double x_begin = 0.0;  ///< [-]  Place on the edge where a straight piece begins.
    double factor = 1.0;   ///< Derivative dx / dS on the edge.
    bool is_blend = false;
    double before = 0.0;
    double after = 0.0;
  };

  /// @param first, last  waypoints at which the robot rests, with blends at all waypoints between
  ///                     them
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
