/// @file
/// Plans of god-objects: Gauss' projection of the displacement to their targets on the contacts.

#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/haptics/contact_loop.h>
#include <firstcontact/haptics/contact_set.h>
#include <firstcontact/haptics/detail/contact_coordinates.h>

namespace firstcontact::detail {

/// The displacement of a body: its pivot moves by a translation, and the body turns about the
/// pivot.
struct Displacement {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();      ///< [m]
  Eigen::Vector3d rotation_vector = Eigen::Vector3d::Zero();  ///< [rad]

  /// [m]  The displacement of the point at an arm [m] from the pivot, to first order.
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

  /// The same fraction of each.
  [[nodiscard]] ToolDisplacements part(double part) const;
};

/// Computes the product of two displacements in the metric of the springs [m^2].
[[nodiscard]] double product_of(const ToolDisplacements& a, const ToolDisplacements& b,
                                const ToolFrames& frames, std::size_t tools);

/// A touch as a projection takes it.
struct PlannedTouch {
  const HapticContact* contact = nullptr;
  /// [m]  Distance to the gap at which the pair rests; negative where it is too near.
  double way = 0.0;
  /// [m]  Displacement of the environment there, less that of a link that the coordinates do not
  /// have.
  Eigen::Vector3d surface = Eigen::Vector3d::Zero();
  double friction = 0.0;  ///< [-]  Friction in this plan.
};

/// A plan of all tools.
struct GodObjectPlan {
  ToolDisplacements displacements = {};
  double residual = 0.0;      ///< [m]
  bool is_pressed = false;    ///< Whether contacts change it.
  bool is_shortened = false;  ///< Whether it goes only a fraction of the way...
  double part = 1.0;          ///< [-]  ...this one, where the fraction was chosen.
  double damping = 1.0;       ///< [-]  The fraction of the displacements that is made.
};

/// Projects the displacements towards the targets on the contacts, with friction.
///
/// Touches that are too near are pushed to their rest gap. Where that contradicts others, they are
/// only kept from coming nearer. The small projection of the force loop solves the plan
/// (ConeProjection), else project_on_contacts().
///
/// @param residual  [m]  to be reached; > 0
/// @param is_quick  whether little time is left, so that project_on_contacts() only sweeps
[[nodiscard]] GodObjectPlan plan_god_objects(const ToolDisplacements& wanted,
                                             const ToolFrames& frames, std::size_t tools,
                                             const std::vector<PlannedTouch>& touches,
                                             double residual, bool is_quick = false);

/// [m]  Computes the displacement of the tool at a touch relative to the other surface, to first
/// order.
[[nodiscard]] Eigen::Vector3d displacement_at(const PlannedTouch& touch,
                                              const ToolDisplacements& ways,
                                              const ToolFrames& frames);

/// Whether a plan keeps its touches apart, to first order. No touch comes nearer by more than its
/// `way`, or at all where it has none left. False where a moving environment leaves a tool no room.
///
/// @param slack  [m]  for touches with a gap above five times this. For nearer ones it is almost 0,
///         as it would add up
[[nodiscard]] bool keeps_apart(const GodObjectPlan& plan, const ToolFrames& frames,
                               const std::vector<PlannedTouch>& touches, double slack);

/// Computes the rotation vector [rad] of the shortest turn from one orientation to another.
[[nodiscard]] Eigen::Vector3d turn_between(const Eigen::Quaterniond& from,
                                           const Eigen::Quaterniond& to) noexcept;

}  // namespace firstcontact::detail
