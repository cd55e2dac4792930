/// @file
/// First contact of two triangles whose corners move on lines, in double-double.
///
/// It decides where doubles cannot.

#pragma once

#include <array>
#include <cstddef>

#include <firstcontact/math/double_double.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// A point at (1 - t) from + t to.
struct PreciseLinearPoint {
  DoubleDoubleVector3 from;  ///< [m]
  DoubleDoubleVector3 to;    ///< [m]
};

/// A triangle; an edge or a point where only the first corners count.
struct PreciseLinearFeature {
  std::array<PreciseLinearPoint, 3> corners;
  std::size_t count = 3;  ///< 1 to 3.
};

struct PreciseLinearOptions {
  double threshold = 0.0;        ///< [m]  Closer than this is contact; >= 0.
  double tolerance = 0.0;        ///< [m]  A contact is no farther than threshold + tolerance; > 0.
  double least_tolerance = 0.0;  ///< [m]  Resolution of doubles: taken where double-doubles stall.
  double position_error = 0.0;   ///< [m]  Error of the position of any corner.
  double t_begin = 0.0;          ///< [-]  Proven: no contact before.
};

enum class PreciseLinearVerdict { free, contact, unresolved };

struct PreciseLinearContact {
  PreciseLinearVerdict verdict = PreciseLinearVerdict::unresolved;
  double t = 0.0;  ///< [-]  Proven: no contact before; 1 when free.
  /// [m]  The tolerance that holds: at t the features are within threshold + this.
  ///
  /// It is larger than the one asked for where the next double after t would be too late, or
  /// double-doubles cannot resolve it either.
  double tolerance_used = 0.0;
  int steps = 0;
};

/// Whether double-doubles hold the numbers of features of this size.
///
/// Products then neither overflow nor lose bits at the small end.
[[nodiscard]] FIRSTCONTACT_API bool suits_double_doubles(double size);

/// Finds the first time at which two features come within the threshold.
///
/// The steps are those of linear_vertex_face_contact(), with positions, directions and products in
/// double-double. So is the time: neighbouring doubles of t are 2^-53 of the step apart, in which
/// features move 100 times as far as 1e-18 of their size.
///
/// Derivation of the errors, u = 2^-53: additions err by 3 u^2 and products by 5 u^2
/// (math/double_double.h). A difference of positions at t is a sum of at most six terms with a
/// product each, of the size `reach`. It is within 64 u^2 of reach. A product with a unit vector
/// adds 16 u^2 of it, the vector's own length 32 u^2. So 2^-96 = 1024 u^2 of reach covers each gap
/// and each rate eight times. It also covers the error of the sum of times, 3 u^2 of the rate.
/// Differences of coordinates err by 3 u^2 of these. The error of positions holds at all times and
/// is counted to the threshold.
[[nodiscard]] FIRSTCONTACT_API PreciseLinearContact
precise_linear_contact(const PreciseLinearFeature& A, const PreciseLinearFeature& B,
                       const PreciseLinearOptions& options);

}  // namespace firstcontact
