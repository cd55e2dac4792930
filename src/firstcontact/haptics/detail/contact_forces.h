/// @file
/// The forces that the contacts of a set cause on tools and their joints.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <firstcontact/haptics/contact_set.h>
#include <firstcontact/haptics/detail/cone_projection.h>
#include <firstcontact/haptics/detail/contact_coordinates.h>
#include <firstcontact/haptics/detail/tool_links.h>
#include <firstcontact/haptics/force_loop.h>
#include <firstcontact/haptics/haptic_scene.h>

namespace firstcontact::detail {

/// The forces of a tick, in the coordinates of the metric.
struct ContactForce {
  Coordinates force = {};  ///< [m]  Exactly 0 for tools and joints on which no contact presses.
  int pressing = 0;        ///< Number of contacts that press, limits of joints included.
  int pivots = 0;
  std::array<bool, kMostTools> is_solved = {true, true};  ///< For each tool.
};

/// Projects the way to the devices on the contacts of a set.
///
/// Tools that do not touch each other are projected each for itself: so what one feels does not
/// depend on the contacts of the other. After the construction nothing is allocated.
class ContactForces {
 public:
  /// Prepares the projections.
  ///
  /// @param links  of the tools; outlives this
  ContactForces(const std::vector<HapticTool>& tools, const ToolLinks& links,
                const ForceLoopOptions& options);

  /// Takes the contacts of a new set.
  void take(const HapticContactSet& set) noexcept;

  /// Computes the forces.
  ///
  /// @param wanted   [m]  from the set's poses and joints to the targets
  /// @param seconds  for which surfaces have moved on since the places in the set
  [[nodiscard]] ContactForce project(const HapticContactSet& set, const Coordinates& wanted,
                                     double seconds) noexcept;

  [[nodiscard]] const ToolFrames& frames() const noexcept { return frames_; }

 private:
  /// The contacts of tools that touch each other, or of one tool.
  struct Island {
    ConeProjection cone;
    std::array<std::size_t, kMostHapticContacts> contacts = {};
    std::size_t count = 0;
  };

  void add_contacts(const HapticContactSet& set) noexcept;
  [[nodiscard]] double tolerance_for(const Coordinates& wanted) const noexcept;
  void add_limits() noexcept;
  [[nodiscard]] std::size_t island_of(std::size_t tool) const noexcept {
    return are_coupled_ ? 0 : tool;
  }
  [[nodiscard]] std::size_t tool_of(std::size_t coordinate) const noexcept;
  [[nodiscard]] double felt_after(const HapticContact& contact, double seconds) const noexcept {
    return seconds + look_aheads_[static_cast<std::size_t>(contact.tool)];
  }
  void shift_surfaces(const HapticContactSet& set, double seconds, Island& island) const noexcept;
  void add_island(const HapticContactSet& set, const Coordinates& wanted, double seconds,
                  std::size_t number, ContactForce& forces) noexcept;
  [[nodiscard]] bool presses_on(const Island& island, std::size_t coordinate,
                                const Coordinates& wanted) const noexcept;
  void keep_last(const HapticContactSet& set, const Coordinates& wanted, double seconds,
                 std::size_t number, Coordinates& force) const noexcept;
  void cut_to_springs(const HapticContactSet& set, const Coordinates& wanted, double seconds,
                      std::size_t number, Coordinates& force) const noexcept;

  const ToolLinks* links_;
  std::size_t tools_;
  double tolerance_;         // [m]
  double widest_gap_ = 0.0;  // [m]  Of the set.
  int pivots_;
  ToolFrames frames_;
  std::array<double, kMostTools> look_aheads_ = {};  // [s]  Damping by stiffness.
  std::vector<Island> islands_;                      // One for each tool; the first one for both.
  bool are_coupled_ = false;
  // [m]  The forces that were solved last, of tools that have touched ever since.
  Coordinates solved_ = {};
  std::array<bool, kMostTools> has_solved_ = {};
};

}  // namespace firstcontact::detail
