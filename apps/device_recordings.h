/// @file
/// Recordings of the devices of a session, written while it runs.

#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <firstcontact/haptic_devices/device.h>
#include <firstcontact/haptics/force_loop.h>

#include "atomic_file.h"

namespace firstcontact::app {

/// Writes what the force loop read of each device, so that `--device` can play it again.
class DeviceRecordings {
 public:
  /// Begins the files.
  ///
  /// @param files  a name for each device, or none at all
  void begin(std::span<const std::string> files, std::span<Device* const> devices);

  /// Adds the samples of a tick that are new.
  void add(const ForceTick& tick);

  void commit();

 private:
  struct One {
    One(const std::string& name, const DeviceCapabilities& capabilities)
        : file(name), kind(capabilities.kind), grips(capabilities.grips) {}

    AtomicFile file;
    DeviceKind kind;
    int grips;
    std::optional<DeviceState> last;  // The sample that was written last.
  };
  std::vector<std::unique_ptr<One>> all_;
};

}  // namespace firstcontact::app
