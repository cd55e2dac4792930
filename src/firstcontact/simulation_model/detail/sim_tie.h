/// @file
/// A spring, a cable or a joint between two bodies of a simulation: its place and its law.

#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/motion/pose.h>
#include <firstcontact/scene/tie.h>
#include <firstcontact/simulation_model/detail/sim_body.h>

namespace firstcontact {
struct LoadedScene;
}

namespace firstcontact::detail {

/// An end of a tie: a frame T of a body, or of the world.
struct TieEnd {
  std::optional<std::size_t> body = {};
  Pose X_BT = {};  ///< The origin is the tied point; the z axis is that of a hinge.
};

struct SimTie {
  TieType type = TieType::spring;
  std::array<TieEnd, 2> ends = {};
  double length = 0.0;     ///< [m]  For springs and cables.
  double stiffness = 0.0;  ///< [N/m]  0: a cable that does not stretch, or a damper alone.
  double damping = 0.0;    ///< [N s/m]

  /// Whether it is a cable that does not stretch.
  [[nodiscard]] bool is_inextensible() const { return type == TieType::cable && stiffness == 0.0; }
  /// Whether it is a joint: it acts in both directions, and does not yield.
  [[nodiscard]] bool is_joint() const { return type != TieType::spring && type != TieType::cable; }
  /// Whether it is a spring of length 0, which pulls along three axes.
  [[nodiscard]] bool is_vector() const { return type == TieType::spring && length == 0.0; }
};

/// The ends of a tie at one instant.
struct TiePlace {
  std::array<Pose, 2> X_WT = {};

  /// [m]  From the first point to the second one.
  [[nodiscard]] Eigen::Vector3d between() const { return X_WT[1].position - X_WT[0].position; }
  [[nodiscard]] Eigen::Vector3d middle() const {
    return 0.5 * (X_WT[0].position + X_WT[1].position);
  }
};

/// The place of a tie.
///
/// @param pose_of  the pose of a body
[[nodiscard]] TiePlace place_of(const SimTie& tie, const std::function<Pose(std::size_t)>& pose_of);

/// One direction in which a tie acts.
///
/// Its velocity is that of the second point relative to the first one along `linear`, and that of
/// the second body relative to the first one about `angular`.
struct TieDirection {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();
};

/// The directions of a joint, or of a spring of length 0.
///
/// They are three axes of the world, then two across the axis of a hinge, or three of a weld.
[[nodiscard]] std::vector<TieDirection> directions_of(const SimTie& tie, const TiePlace& place);

/// [m or rad]  The displacement of the second body along each of directions_of().
[[nodiscard]] std::vector<double> displacements_of(const SimTie& tie, const TiePlace& place);

/// [J]  The elastic energy of a spring or a cable.
[[nodiscard]] double elastic_energy(const SimTie& tie, const TiePlace& place);

/// One coordinate of a spring over a span: its length, or its displacement along an axis.
struct SpringWay {
  double begin = 0.0;   ///< [m]  Extension at the begin of the span.
  double flight = 0.0;  ///< [m]  Extension to which velocities lead that the row does not change.
  double speed_at_begin = 0.0;   ///< [m/s]
  double speed_of_flight = 0.0;  ///< [m/s]  Velocity at the end of that flight.
  double inverse_mass = 0.0;     ///< [1/kg]  Effect of an impulse on the velocity at the end.
  bool is_led_by_end = false;    ///< Whether that velocity leads it, whatever the weights are.
};

/// The numbers of a row whose impulses r meet u + compliance r = target.
struct SpringRow {
  double target = 0.0;
  double compliance = 0.0;
  double weight = 0.5;  ///< [-]  Weight of the end of the span.
};

/// The row of a spring over a span.
///
/// It pulls with the weighted means of its extensions and of its velocities at both ends. Without a
/// damper the weights are equal: the trapezoidal rule, which keeps the energy. A damper has the
/// weight of fitted_weight(). Springs that swing by more than one radian of their phase in a span
/// are damped, as steps cannot follow them.
///
/// The velocity at the end leads bodies along the row with the same weight w. So the energy never
/// grows, up to rounding. Where no other force acts it changes over a displacement by
///   -damping way^2 / span - (w - 1/2) (r^2 inverse_mass + stiffness way^2).
///
/// @param span  [s]
[[nodiscard]] SpringRow spring_row(const SimTie& tie, const SpringWay& way, double span);

/// Describes a joint whose points are apart, or a cable that is longer than its length; else empty.
///
/// @param slack  [m]  distance or excess length that is allowed
[[nodiscard]] std::string wrong_ties(const std::vector<SimTie>& ties,
                                     const std::function<Pose(std::size_t)>& pose_of, double slack,
                                     const std::function<std::string(std::size_t)>& name_of);

/// Makes the ties of a scene.
///
/// @param linked  a scene in which each link is a body
/// @param slack   [m]  distance of a joint's points that is allowed at the start
/// @throws std::invalid_argument  names the tie, its bodies and the mend
[[nodiscard]] std::vector<SimTie> make_sim_ties(const LoadedScene& linked,
                                                const std::vector<SimBody>& bodies, double slack);

}  // namespace firstcontact::detail
