/// @file
/// Recordings of the devices of a session, written while it runs.

#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <firstcontact/haptic_devices/device.h>
#include <firstcontact/haptics/force_loop.h>

namespace firstcontact::app {

/// Writes what the force loop read of each device, so that `--device` plays it again.
///
/// A row has the time of the tick that read it, so that a session in virtual time is the same
/// again, and several devices stay in step. Each new sample and status has a row, and so have the
/// first and the last tick. A file holds whole rows at every moment.
class DeviceRecordings {
 public:
  /// Begins the files. One that holds something is refused, unless `replaces`.
  ///
  /// @param files  a name for each device, or none at all
  /// @throws std::runtime_error  names the file, which is refused or cannot be written
  void begin(std::span<const std::string> files, std::span<Device* const> devices, bool replaces);

  /// Adds what is new in a tick.
  void add(const ForceTick& tick);

  /// Adds the last tick.
  ///
  /// @returns whether there was a tick. Without one the files are removed: they would not play.
  bool end();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  struct One {
    std::string path;
    std::unique_ptr<std::FILE, Close> file;
    DeviceKind kind = DeviceKind::pose;
    int grips = 0;
    std::optional<DeviceState> last = {};  // As it was read last.
    std::uint64_t sequence = 0;            // As it was written last.
    std::int64_t time_ns = 0;              // As it was written last.

    void write(const std::string& text) const;
    void add(const DeviceState& state, std::int64_t now_ns);
  };
  std::vector<One> all_;
  std::int64_t now_ns_ = 0;  // Time of the last tick.
};

}  // namespace firstcontact::app
