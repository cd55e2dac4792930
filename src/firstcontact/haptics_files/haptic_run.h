/// @file
/// The motion of god-objects as the record of a run, which `verify` proves and the page plays.

#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <firstcontact/haptics/contact_loop.h>
#include <firstcontact/haptics/force_loop.h>
#include <firstcontact/haptics_files/haptic_setup.h>
#include <firstcontact/math/export.h>
#include <firstcontact/record/run.h>

namespace firstcontact {

namespace detail {
class ToolLinks;
}  // namespace detail

/// Writes cycles of a contact loop as steps of a run (docs/run_format.md).
///
/// A tool, and each link of it that moves, is a free body of 1 kg. The clearance, contacts and
/// poses are those of the cycle. A body with a course is `behind` by the time that it waited for
/// tools. Energies, momenta and impulses are 0: a god-object has none.
class FIRSTCONTACT_API HapticRun {
 public:
  /// Begins the record of a session.
  ///
  /// @param loaded  a scene that was prepared
  /// @param contact_distance  [m]  distance that the contact loop keeps
  HapticRun(const LoadedScene& loaded, const HapticSetup& setup, double contact_distance);

  [[nodiscard]] const RunHeader& header() const { return header_; }

  /// Converts the next cycle.
  ///
  /// @param devices  devices at the tick whose targets the cycle followed; may be empty
  [[nodiscard]] RunStep step(const HapticCycle& cycle, std::vector<RunDevice> devices = {});

  /// Converts the tools of a tick to devices of the step that begins there.
  ///
  /// The force is the one that was asked of the device, with components that it does not drive.
  [[nodiscard]] std::vector<RunDevice> devices(const ForceTick& tick) const;

 private:
  RunHeader header_;
  std::vector<std::size_t> bodies_;
  std::shared_ptr<const detail::ToolLinks> links_;
  std::vector<std::optional<std::size_t>> link_bodies_;  // Bodies of links that have a shape.
  std::size_t tools_ = 0;
  double time_ = 0.0;    // [s]
  double behind_ = 0.0;  // [s]  The time that all courses have waited for tools.
  std::size_t count_ = 0;
};

}  // namespace firstcontact
