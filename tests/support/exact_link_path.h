/// @file
/// Exact pose of a robot's link, its velocity, and a bound of its acceleration: in 256 bits, from
/// the numbers of a RobotInput.

#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "support/robot_input.h"
#include "support/wide.h"

namespace firstcontact::oracle {

/// Coefficients of powers of (t - t_begin).
struct ExactPolynomial {
  double t_begin = 0.0;
  std::vector<Wide> coefficients;

  [[nodiscard]] Wide value(const Wide& t) const;
  [[nodiscard]] Wide rate(const Wide& t) const;
};

/// Pose of the link at one time, p_FP = origin + columns p_LP, and the rates of change.
struct ExactLinkState {
  Vector3<Wide> origin, velocity;
  Matrix3<Wide> R, spin;

  [[nodiscard]] Vector3<Wide> place(const Vector3<double>& p_LP) const {
    return origin + R * exact(p_LP);
  }
  [[nodiscard]] Vector3<Wide> rate(const Vector3<double>& p_LP) const {
    return velocity + spin * exact(p_LP);
  }
};

/// The chain from a frame F to a link over one smooth piece of time.
class ExactLinkPath {
 public:
  [[nodiscard]] ExactLinkState state(const Wide& t) const;

  /// [m per step^2]  Upper bound of the acceleration of points of the link within `radius` of its
  /// origin, at times of the piece from t_from to t_to.
  [[nodiscard]] double acceleration_bound(double radius, double t_from, double t_to) const;

 private:
  friend class ExactLinkPathBuilder;
  struct Slide {
    Vector3<Wide> direction;
    ExactPolynomial coordinate;
    double length = 1.0;  // Upper bound of |direction|.
  };
  /// p_out = position + R (base + slides + Rot(axis, angle) (lever + start p_in)).
  struct Step {
    Vector3<Wide> position;
    Matrix3<Wide> R;
    Vector3<Wide> base;
    std::vector<Slide> slides;
    Vector3<Wide> axis;  // Unit.
    ExactPolynomial angle;
    Vector3<Wide> lever;
    Matrix3<Wide> start;
    bool starts_turned = false;  // Else `start` is the identity.
    double step_length = 0.0;    // Upper bounds of |position| + |base|, and of |lever|.
    double lever_length = 0.0;
  };

  std::vector<Step> steps_;
};

/// Returns the times at which the motion of a link may change its formula: 0, ..., 1.
std::vector<double> break_times(const RobotCase& c);

/// Returns the paths of A and B over the piece of time that starts at a break.
///
/// Their frame is that of the last common ancestor, or the world.
std::array<ExactLinkPath, 2> exact_link_paths(const RobotCase& c, double t_begin);

}  // namespace firstcontact::oracle
