/// @file
/// URDF text of massive links and joints, and a double pendulum of them beside its closed
/// equations.

#pragma once

#include <array>
#include <cmath>
#include <string>

#include <Eigen/Core>

#include "simulation/simulated_run.h"

namespace firstcontact::test {

/// A link with moments of inertia (x, y, z) about its centre, and perhaps a box there; `more` is
/// what it has beside.
inline std::string massive(const std::string& name, double mass, const std::string& centre,
                           const std::array<double, 3>& moments, const std::string& box_size = "",
                           const std::string& more = "") {
  const std::string origin = R"(<origin xyz=")" + centre + R"("/>)";
  return "<link name=\"" + name + "\"><inertial>" + origin + "<mass value=\"" + number_text(mass) +
         "\"/><inertia ixx=\"" + number_text(moments[0]) + "\" iyy=\"" + number_text(moments[1]) +
         "\" izz=\"" + number_text(moments[2]) + "\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>" +
         (box_size.empty() ? ""
                           : "<collision>" + origin + "<geometry><box size=\"" + box_size +
                                 "\"/></geometry></collision>") +
         more + "</link>";
}

inline std::string connected(const std::string& name, const std::string& type,
                             const std::string& parent, const std::string& child,
                             const std::string& axis, const std::string& origin,
                             const std::string& more = "") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent +
         "\"/><child link=\"" + child + "\"/><axis xyz=\"" + axis + "\"/><origin xyz=\"" + origin +
         "\"/>" + more + "</joint>";
}

inline constexpr double kPull = 9.81;   // [m/s^2]
inline constexpr double kLength = 0.5;  // [m]  From hinge to hinge.
inline constexpr double kM1 = 1.0;      // [kg]
inline constexpr double kM2 = 0.7;
inline constexpr double kC1 = 0.25;  // [m]  From the hinge to the centre.
inline constexpr double kC2 = 0.2;
inline constexpr double kI1 = 0.02;  // [kg m^2]
inline constexpr double kI2 = 0.01;

/// @param first,second  elements of the joints besides their origins
/// @param end           elements of the second link besides its mass
inline std::string double_pendulum(const std::string& first, const std::string& second,
                                   const std::string& end = "") {
  return "<link name=\"base\"/>" + massive("a", kM1, "0 0 -0.25", {kI1, kI1, kI1}) +
         massive("b", kM2, "0 0 -0.2", {kI2, kI2, kI2}, "", end) +
         connected("j1", "continuous", "base", "a", "0 1 0", "0 0 0", first) +
         connected("j2", "continuous", "a", "b", "0 1 0", "0 0 -0.5", second);
}

struct Swing {
  Eigen::Vector2d q = Eigen::Vector2d::Zero();  ///< [rad]
  Eigen::Vector2d v = Eigen::Vector2d::Zero();  ///< [rad/s]
};

inline Eigen::Matrix2d pendulum_mass(double q2) {
  const double c = kM2 * kLength * kC2 * std::cos(q2);
  const double m22 = kI2 + kM2 * kC2 * kC2;
  Eigen::Matrix2d M;
  M << kI1 + kM1 * kC1 * kC1 + kM2 * kLength * kLength + m22 + 2.0 * c, m22 + c, m22 + c, m22;
  return M;
}

/// Computes the forces that keep the rates of a double pendulum.
inline Eigen::Vector2d pendulum_bias(const Swing& s) {
  const double k = kM2 * kLength * kC2 * std::sin(s.q[1]);
  const double second = kM2 * kPull * kC2 * std::sin(s.q[0] + s.q[1]);
  return {-k * s.v[1] * (2.0 * s.v[0] + s.v[1]) +
              (kM1 * kC1 + kM2 * kLength) * kPull * std::sin(s.q[0]) + second,
          k * s.v[0] * s.v[0] + second};
}

}  // namespace firstcontact::test
