/// @file
/// The bodies of an island within a step: their states and their touches.

#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <stop_token>
#include <unordered_map>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/geometry/detail/overlap_tree.h>
#include <firstcontact/query/workspace.h>
#include <firstcontact/simulation_model/detail/island_robots.h>
#include <firstcontact/simulation_model/detail/manifold.h>
#include <firstcontact/simulation_model/detail/move.h>
#include <firstcontact/simulation_model/detail/moving_contact.h>
#include <firstcontact/simulation_model/detail/obstacles.h>
#include <firstcontact/simulation_model/detail/response.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>
#include <firstcontact/simulation_model/detail/step_start.h>

namespace firstcontact::detail {

/// The data that the islands of a step share.
struct StepContext {
  const SimulationModel& model;
  const StepStart& start;
  const Obstacles& around;
  /// Touches of the step before, sorted; their impulses start the solver.
  const std::vector<ManifoldPoint>& guesses;
  const std::stop_token& stop;
};

/// An island now: plans, searches and impacts read it, and Island moves it.
struct IslandState {
  /// Makes the state at the begin of a step.
  ///
  /// @param bare_robots  robots of the island without geometry
  IslandState(const StepContext& step, std::vector<std::size_t> given_members,
              const std::vector<std::size_t>& bare_robots = {});

  [[nodiscard]] std::size_t size() const { return members.size(); }
  [[nodiscard]] const SimBody& member(std::size_t k) const { return model.bodies[members[k]]; }

  /// The present pose of a member, or of a body around the island.
  [[nodiscard]] const Pose& pose_of(std::size_t body);

  /// The members with their present motions, for a contact problem.
  [[nodiscard]] ProblemBodies problem_bodies() const;

  /// The present pose of a tied body; that of a link is given by its joints.
  [[nodiscard]] Pose tied_pose(std::size_t body);

  /// Adds the bodies of the pair that are around the island.
  void add_others(const BodyPair& pair, ProblemBodies& bodies);

  /// Makes the contact of a touch for the problem, with its impulse as guess, its friction and its
  /// belts.
  [[nodiscard]] ContactPoint contact(const ManifoldPoint& touch, const ProblemBodies& bodies,
                                     double least_normal_velocity);

  /// [m/s]  Computes the tangential velocity at which a contact of the pair sticks, as their belts
  /// run.
  ///
  /// @param frame  of the contact
  [[nodiscard]] Eigen::Vector2d belt_velocity(const BodyPair& pair, const Eigen::Matrix3d& frame);

  /// Whether a pair that closes at this speed [m/s] bounces.
  [[nodiscard]] bool bounces(const BodyPair& pair, double closing) const;

  /// Whether any pair is nearer than a distance.
  ///
  /// @param distance  [m]
  [[nodiscard]] bool is_nearer(double distance) const;

  /// Whether any pair is nearer than its rest gap.
  [[nodiscard]] bool is_too_near() const;

  /// Counts the present touches.
  [[nodiscard]] std::size_t touches() const;

  /// The curves, rotations and angular velocities of a touch's bodies, without the rest of a side.
  [[nodiscard]] std::array<ContactSide, 2> turning_sides(const ManifoldPoint& touch);

  /// Finds the manifolds after bodies were moved.
  ///
  /// @param before  sorted touches whose impulses go to those found
  void find_manifolds(const std::vector<ManifoldPoint>& before, Workspace& workspace);

  /// Calls use(pair, margin) for pairs of a member and any other body whose boxes are near each
  /// other.
  ///
  /// The other body is one of the island or around it. The boxes are as near as `reach` [m] beyond
  /// their margin.
  ///
  /// @param boxes  of each member, over its motion
  /// @param share  share of the step for which bodies around the island move
  template <class Use>
  void for_each_pair(const std::vector<Eigen::AlignedBox3d>& boxes, double reach, double share,
                     const Use& use);

  const SimulationModel& model;
  const StepStart& start;
  const Obstacles& around;
  std::vector<std::size_t> members;
  std::unordered_map<std::size_t, std::size_t> place;  ///< Index of each member.
  std::vector<RigidState> states;                      ///< State of each member.
  IslandRobots robots;
  std::map<BodyPair, Manifold> manifolds;
  double reached = 0.0;                                ///< [s]  Since the step began.
  std::unordered_map<std::size_t, Pose> poses_around;  ///< Poses now of bodies that were needed.
  std::vector<std::size_t> ties = {};  ///< Indices in the model of ties with a member.
  std::size_t taut = 0;                ///< Number of cables that became taut in the step.
  std::size_t slips = 0;  ///< Number of solutions in the step in which contacts slipped.
};

/// A box that is wider by `by` on all sides.
inline Eigen::AlignedBox3d widened(const Eigen::AlignedBox3d& box, double by) {
  const Eigen::Vector3d slack = Eigen::Vector3d::Constant(by);
  return {box.min() - slack, box.max() + slack};
}

template <class Use>
void IslandState::for_each_pair(const std::vector<Eigen::AlignedBox3d>& boxes, double reach,
                                double share, const Use& use) {
  using Eigen::AlignedBox3d;
  const double most = reach + model.laws.greatest_margin();
  const auto use_near = [&](std::size_t a, const AlignedBox3d& box_a, std::size_t b,
                            const AlignedBox3d& box_b) {
    const BodyPair pair{std::min(a, b), std::max(a, b)};
    const std::optional<double> margin = model.laws.margin(pair);
    if (margin && widened(box_a, reach).exteriorDistance(box_b) <= *margin) {
      use(pair, *margin);
    }
  };
  std::vector<AlignedBox3d> halfway;
  for (std::size_t k = 0; k < size(); ++k) {
    around.for_each_overlap(widened(boxes[k], most), [&](std::size_t b) {
      const Move move = start.scripted[b].part(share);
      use_near(members[k], boxes[k], b, swept_box(model.bodies[b], pose_of(b), move));
    });
    halfway.push_back(widened(boxes[k], 0.5 * most));
  }
  for (const auto& [i, k] : overlapping_pairs(halfway)) {
    use_near(members[i], boxes[i], members[k], boxes[k]);
  }
}

}  // namespace firstcontact::detail
