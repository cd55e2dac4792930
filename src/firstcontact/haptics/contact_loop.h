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

/// A piece of a cycle at constant rates: the pivot of a body moves on a line, the body turns about
/// it (Motion::constant_rates).
///
/// The pivot of a tool is its centre, that of a link or another body its origin.
struct HapticPiece {
  double to = 0.0;                                        ///< [s]  Its end, since the cycle began.
  Pose X_WB;                                              ///< Where it begins.
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< [m]  Of the pivot.
  Eigen::Vector3d rotation_vector = Eigen::Vector3d::Zero();  ///< [rad]  World axes.
};

/// How a tool, a link of it or a body with a course moved in a cycle. Members are the tools, then
/// the bodies, then the links that have a shape.
struct HapticMemberMotion {
  std::size_t member = 0;
  std::vector<HapticPiece> pieces = {};  ///< They end with the cycle.
  Pose X_WB = {};                        ///< At its end.
};

/// A contact of a tool at the end of a cycle, with its features: of the member, then of the tool.
struct HapticTouch {
  HapticContact contact;
  Feature feature_of_other;
  Feature feature_of_tool;
  std::array<std::size_t, 2> members = {};  ///< The other one, then the tool or its link.
};

/// The account of a cycle of the contact loop.
struct HapticCycle {
  std::uint64_t index = 0;  ///< From 1.
  double asked = 0.0;       ///< [s]
  double lasted = 0.0;  ///< [s]  For courses; less than asked where they had to wait for a tool.
  /// [m]  Proven: no tool came closer to anything in this cycle. Infinite where nothing is near.
  double clearance = 0.0;
  std::size_t rounds = 0;     ///< Projections.
  bool is_converged = false;  ///< No more was to be gained than ContactLoopOptions::least_gain.
  bool is_late = false;       ///< The deadline ended it.
  double residual = 0.0;      ///< [m]  The greatest of the projections.
  std::size_t contacts = 0;   ///< At its end.
  std::vector<HapticMemberMotion> members = {};
  std::vector<double> joints = {};        ///< [rad or m]  Of all tools, at its end.
  std::vector<HapticTouch> touches = {};  ///< At its end; those that the contact set lists.
};

/// Where devices want the tools.
struct HapticTargets {
  std::span<const Pose> poses;     ///< X_WB of each tool, finite.
  std::span<const double> joints;  ///< [rad or m]  Of all tools, finite; empty: as they are.
};

struct ContactLoopOptions {
  std::size_t rounds = 10;  ///< > 0  Projections in a cycle, at most.
  /// [-]  >= 0  A further round is not made where it gains less than this part of the springs'
  /// stretch. It would change forces by about as much; the next cycle begins with it.
  double least_gain = 2e-3;
  double angle = 0.0175;  ///< [rad]  > 0  Contacts that allow the same within it are left out.
  std::size_t most_contacts = 32;  ///< 1 to kMostHapticContacts: that a contact set lists.
};

/// Moves god-objects towards their targets, cycle by cycle.
///
/// In a cycle a god-object goes where its spring pulls it as far as contacts allow (Gauss'
/// principle without inertia, with Coulomb friction), until the first contact of its in-between
/// motion, and on from there. Each motion is proven apart from everything at a distance that is
/// kept. Where bodies with a course would squeeze a tool they wait, and only it moves until the
/// cycle ends (HapticCycle::lasted).
///
/// The coordinates of a tool with joints are its pose and those of its joints, each with its own
/// spring. Its links are members of their own. Each moves at constant rates, so a joint opens while
/// it turns, and is closed at the end of the piece. A piece is so short that it opens by less than
/// a contact distance. Proofs and records are of the links as they move.
///
/// Source: M. Ortega, S. Redon, S. Coquillart, "A six degree-of-freedom god-object method for
/// haptic display of rigid bodies with surface properties", IEEE Transactions on Visualization and
/// Computer Graphics 13 (2007). Here friction is a part of the projection, and the metric is that
/// of the spring, so that its force is the sum of the contact forces.
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
  [[nodiscard]] double time() const;              ///< [s]  For which the surroundings moved.
  [[nodiscard]] const Pose& pose(std::size_t member) const;
  [[nodiscard]] std::span<const double> joints() const;  ///< [rad or m]  Of all tools.

  /// Runs a cycle. The result holds until the next one.
  ///
  /// @param targets   of each tool; joints stop at their limits
  /// @param dt        [s]  > 0; the surroundings move for so long
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
