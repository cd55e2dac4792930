/// @file
/// Tops with balls as tips, compared with Lagrange's equations.

#pragma once

#include <array>
#include <cmath>
#include <string>

#include <Eigen/Core>

#include "simulation/simulated_run.h"

namespace firstcontact::test {

inline constexpr double kMassOfTop = 0.3;  // [kg]
inline constexpr double kArm = 0.1;        // [m]  From the centre of the tip to the centre of mass.

struct Top {
  std::array<double, 3> moments{5e-4, 5e-4, 6e-4};  // [kg m^2]  The last moment is that about the
                                                    // axis.
  double spin = 60.0;                               // [rad/s]
  double lean = 0.3;                                // [rad]  About y.
  double friction = 0.0;
};

/// Writes the body of a top on a floor: a ball of 2 cm with the centre of mass above it.
inline std::string top_body(const Top& top, double contact_distance) {
  return R"({"name": "top", "shape": {"sphere": {"radius": 0.02}}, "pose": {"position": )" +
         numbers({0.0, 0.0, 0.02 + contact_distance}) + R"(, "rpy": )" +
         numbers({0.0, top.lean, 0.0}) + R"(}, "dynamics": {"mass": )" +
         std::to_string(kMassOfTop) + R"(, "centre_of_mass": [0, 0, 0.1], "inertia": [)" +
         numbers({top.moments[0], 0.0, 0.0}) + ", " + numbers({0.0, top.moments[1], 0.0}) + ", " +
         numbers({0.0, 0.0, top.moments[2]}) + R"(], "angular_velocity": )" +
         numbers({top.spin * std::sin(top.lean), 0.0, top.spin * std::cos(top.lean)}) + "}}";
}

/// The axis of a symmetric top whose tip slides without friction: its centre of mass goes up and
/// down alone. Lagrange's equations for the angles of Euler, by the rule of Runge and Kutta.
///
/// @param stiffness  [N/m]  of a spring without length, from the centre of mass straight up.
/// @param anchor     [m]    Height of its upper end.
inline Eigen::Vector3d right_axis(const Top& top, double time, double stiffness = 0.0,
                                  double anchor = 0.0) {
  using Eigen::Vector3d;
  const double across = top.moments[0];
  const double about_axis = top.moments[2] * top.spin;
  const double about_z = about_axis * std::cos(top.lean);
  const auto rates = [&](const Vector3d& at) -> Vector3d {  // Lean, its rate, angle about z.
    const double s = std::sin(at[0]);
    const double c = std::cos(at[0]);
    const double w = at[1];
    const double round = (about_z - about_axis * c) / (across * s * s);
    const double spins = across * round * round * c - about_axis * round;
    const double falls = kMassOfTop * (9.81 * kArm - kArm * kArm * w * w * c);
    const double pulled = stiffness * kArm * (anchor - 0.02 - kArm * c);
    const double push = (spins + falls - pulled) * s;
    return {w, push / (across + kMassOfTop * kArm * kArm * s * s), round};
  };
  constexpr int kParts = 20000;
  const double h = time / kParts;
  Vector3d at(top.lean, 0.0, 0.0);
  for (int k = 0; k < kParts; ++k) {
    const Vector3d a = rates(at);
    const Vector3d b = rates(at + 0.5 * h * a);
    const Vector3d c = rates(at + 0.5 * h * b);
    const Vector3d d = rates(at + h * c);
    at += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
  }
  return {std::sin(at[0]) * std::cos(at[2]), std::sin(at[0]) * std::sin(at[2]), std::cos(at[0])};
}

}  // namespace firstcontact::test
