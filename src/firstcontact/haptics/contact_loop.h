/// @file
/// The contact loop: god-objects follow their devices and pass through nothing.

#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/haptics/contact_set.h>
#include <firstcontact/haptics/haptic_scene.h>
#include <firstcontact/math/export.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/query/contact.h>

namespace firstcontact {

/// A piece of a cycle at constant rates: the pivot of a body moves on a line, and the body turns
/// about the pivot (Motion::constant_rates).
///
/// The pivot of a tool is its centre; the pivot of a link or another body is its origin.
struct HapticPiece {
  double to = 0.0;  ///< [s]  End of the piece, since the cycle began.
  Pose X_WB;        ///< Pose at the begin of the piece.
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();      ///< [m]  Displacement of the pivot.
  Eigen::Vector3d rotation_vector = Eigen::Vector3d::Zero();  ///< [rad]  World axes.
};

/// The motion of a tool, one of its links or a body with a course in a cycle.
///
/// Members are the tools, then the bodies, then the links that have a shape.
struct HapticMemberMotion {
  std::size_t member = 0;
  std::vector<HapticPiece> pieces = {};  ///< The pieces, up to the end of the cycle.
  Pose X_WB = {};                        ///< Pose at the end of the cycle.
};

/// A contact of a tool at the end of a cycle, with the features of both members.
struct HapticTouch {
  HapticContact contact;
  Feature feature_of_other;
  Feature feature_of_tool;
  std::array<std::size_t, 2> members = {};  ///< The other member, then the tool or its link.
};

/// The account of a cycle of the contact loop.
struct HapticCycle {
  std::uint64_t index = 0;  ///< Number of the cycle, from 1.
  double asked = 0.0;       ///< [s]  Time that was requested.
  /// [s]  Time by which courses moved on; less than `asked` where they waited for a tool.
  double lasted = 0.0;
  /// [m]  Proven: the least distance of a tool in this cycle is at least this. Infinite where
  /// nothing is near.
  double clearance = 0.0;
  std::size_t rounds = 0;  ///< Number of projections.
  /// Whether a further round would gain less than ContactLoopOptions::least_gain.
  bool is_converged = false;
  bool is_late = false;  ///< Whether the deadline ended the cycle or one of its proofs.
  /// Whether the tools stayed where they were because no part of their motion could be proven.
  bool is_unproven = false;
  double residual = 0.0;     ///< [m]  Greatest residual of the projections.
  std::size_t contacts = 0;  ///< Number of contacts at the end of the cycle.
  double angle = 0.0;        ///< [rad]  HapticContactSet::angle of its contact set.
  /// [s]  Processor time of its thread; none in virtual time, where it is not measured.
  std::optional<double> processor_time = {};
  std::vector<HapticMemberMotion> members = {};
  std::vector<double> joints = {};  ///< [rad or m]  Joints of all tools, at the end of the cycle.
  /// The contacts of the contact set, at the end of the cycle.
  std::vector<HapticTouch> touches = {};
};

/// The poses and joints that the devices want.
struct HapticTargets {
  std::span<const Pose> poses;     ///< X_WB of each tool, finite.
  std::span<const double> joints;  ///< [rad or m]  Joints of all tools, finite; empty: as they are.
};

/// The options of a contact loop.
struct ContactLoopOptions {
  std::size_t rounds = 10;  ///< Most projections in a cycle; > 0.
  /// [-]  Least gain of a further round, as a fraction of the springs' stretch; >= 0. A round that
  /// gains less would change forces by about that fraction; the next cycle begins with it.
  double least_gain = 2e-3;
  /// [rad]  Contacts that permit the same motions within this angle are left out; > 0.
  double angle = 0.0175;
  std::size_t most_contacts = 32;  ///< Most contacts of a contact set; 1 to kMostHapticContacts.
};

/// Moves god-objects towards their targets, cycle by cycle.
///
/// In a cycle a god-object goes where its spring pulls it, as far as contacts permit. This is
/// Gauss' principle without inertia, with Coulomb friction. It goes on until the first contact of
/// its in-between motion, and on from there. Each motion is proven to keep a distance from
/// everything. Where bodies with a course would squeeze a tool, the courses wait. Then only the
/// tool moves until the cycle ends (HapticCycle::lasted).
///
/// The coordinates of a tool with joints are its pose and those of its joints, each with its own
/// spring. Its links are members of their own. Each link moves at constant rates, so a joint opens
/// while it turns, and is closed at the end of the piece. A piece is so short that the joint opens
/// by less than a contact distance. Proofs and records are about the links as they move.
///
/// Source: M. Ortega, S. Redon, S. Coquillart, "A six degree-of-freedom god-object method for
/// haptic display of rigid bodies with surface properties", IEEE Transactions on Visualization and
/// Computer Graphics 13 (2007). Here friction is a part of the projection. The metric is that of
/// the spring, so that its force is the sum of the contact forces.
///
/// The same on every run where no deadline is given.
class FIRSTCONTACT_API ContactLoop {
 public:
  using Deadline = std::chrono::steady_clock::time_point;

  /// @throws std::invalid_argument  no tool or too many; a number out of range; a tool that starts
  ///         in another body, or nearer to one than a tenth of the contact distance (names both); a
  ///         deforming shape
  explicit ContactLoop(HapticScene scene, const ContactLoopOptions& options = {});
  ~ContactLoop();
  ContactLoop(ContactLoop&&) noexcept;
  ContactLoop& operator=(ContactLoop&&) noexcept;

  [[nodiscard]] const HapticScene& scene() const;
  [[nodiscard]] double contact_distance() const;  ///< [m]
  [[nodiscard]] double time() const;              ///< [s]  Time for which the environment moved.
  [[nodiscard]] const Pose& pose(std::size_t member) const;
  [[nodiscard]] std::span<const double> joints() const;  ///< [rad or m]  Joints of all tools.

  /// Runs a cycle. The result holds until the next one.
  ///
  /// @param targets   of each tool; joints stop at their limits. A tool goes at most 2^40 contact
  ///                  distances from the world's origin: farther off nothing could be proven
  /// @param dt        [s]  > 0; the environment moves for this time
  /// @param stamp_ns  [ns]  goes into the contact set of this cycle
  /// @param deadline  no round begins after it; a search that runs then stops with what is proven
  /// @throws std::invalid_argument if an argument is outside its range
  const HapticCycle& advance(const HapticTargets& targets, double dt, std::int64_t stamp_ns,
                             const std::optional<Deadline>& deadline = {});
  const HapticCycle& advance(std::span<const Pose> targets, double dt, std::int64_t stamp_ns,
                             const std::optional<Deadline>& deadline = {}) {
    return advance(HapticTargets{.poses = targets, .joints = {}}, dt, stamp_ns, deadline);
  }

  /// The contacts at the end of the last cycle, or at the start.
  [[nodiscard]] const HapticContactSet& contact_set() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace firstcontact
