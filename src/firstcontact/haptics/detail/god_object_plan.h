/// @file
/// Where contacts let god-objects go: Gauss' projection of the way to their targets.

#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/haptics/contact_loop.h>
#include <firstcontact/haptics/contact_set.h>
#include <firstcontact/haptics/detail/contact_coordinates.h>

namespace firstcontact::detail {

/// The displacement of a body: its pivot moves by a translation, and it turns about it.
struct Displacement {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();      ///< [m]
  Eigen::Vector3d rotation_vector = Eigen::Vector3d::Zero();  ///< [rad]

  /// [m]  The way of the point at an arm [m] from the pivot, to first order.
  [[nodiscard]] Eigen::Vector3d at(const Eigen::Vector3d& arm) const {
    return translation + rotation_vector.cross(arm);
  }
};

/// The displacements of all tools and of their joints.
struct ToolDisplacements {
  std::array<Displacement, kMostTools> tools = {};
  std::array<double, kMostHapticJoints> joints = {};  ///< [rad or m]

  [[nodiscard]] Displacement& operator[](std::size_t tool) { return tools[tool]; }
  [[nodiscard]] const Displacement& operator[](std::size_t tool) const { return tools[tool]; }

  /// The same part of each.
  [[nodiscard]] ToolDisplacements part(double part) const;
};

/// The product of two displacements in the metric of the springs [m^2].
[[nodiscard]] double product_of(const ToolDisplacements& a, const ToolDisplacements& b,
                                const ToolFrames& frames, std::size_t tools);

/// A touch as a projection needs it.
struct PlannedTouch {
  const HapticContact* contact = nullptr;
  double way = 0.0;  ///< [m]  To where the pair rests; negative where it is too near.
  /// [m]  How far the surroundings go there, less the way of a link that coordinates do not have.
  Eigen::Vector3d surface = Eigen::Vector3d::Zero();
};

struct GodObjectPlan {
  ToolDisplacements displacements = {};
  double residual = 0.0;      ///< [m]
  bool is_pressed = false;    ///< Contacts change it.
  bool is_shortened = false;  ///< It leads only a part of the way...
  double part = 1.0;          ///< [-]  ...this one, where that was chosen.
};

/// Projects the displacements towards the targets on the contacts, with friction.
///
/// Touches that are too near are pushed to where they rest; where that contradicts others, they
/// are only kept from coming nearer. The small projection of the force loop solves it
/// (ConeProjection), else project_on_contacts().
///
/// @param residual  [m]  to be reached; > 0
[[nodiscard]] GodObjectPlan plan_god_objects(const ToolDisplacements& wanted,
                                             const ToolFrames& frames, std::size_t tools,
                                             const std::vector<PlannedTouch>& touches,
                                             double residual);

/// Whether a plan keeps its touches apart, to first order: none comes nearer than its way, or than
/// it is where it has none left. Not where surroundings that move leave a tool no room.
///
/// @param slack  [m]  none of touches that are nearer than five times as much: it would add up
[[nodiscard]] bool keeps_apart(const GodObjectPlan& plan, const ToolFrames& frames,
                               const std::vector<PlannedTouch>& touches, double slack);

/// The rotation vector [rad] of the shortest turn from one orientation to another.
[[nodiscard]] Eigen::Vector3d turn_between(const Eigen::Quaterniond& from,
                                           const Eigen::Quaterniond& to) noexcept;

}  // namespace firstcontact::detail
