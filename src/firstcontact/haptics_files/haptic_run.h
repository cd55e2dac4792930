/// @file
/// The motion of god-objects as the record of a run, which `verify` proves and the page plays.

#pragma once

#include <firstcontact/haptics/contact_loop.h>
#include <firstcontact/haptics_files/haptic_setup.h>
#include <firstcontact/math/export.h>
#include <firstcontact/record/run.h>

namespace firstcontact {

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
  [[nodiscard]] RunStep step(const HapticCycle& cycle);

 private:
  RunHeader header_;
  std::vector<std::size_t> bodies_;
  double time_ = 0.0;    // [s]
  double behind_ = 0.0;  // [s]  The time that all courses have waited for tools.
  std::size_t count_ = 0;
};

}  // namespace firstcontact
