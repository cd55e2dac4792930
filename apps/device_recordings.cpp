#include "device_recordings.h"

#include <cstddef>

#include <firstcontact/haptic_devices/recording.h>

namespace firstcontact::app {
namespace {

/// Whether a recording gets a line for a state. A device that is silent, or over, is so by its age.
bool is_new(const DeviceState& state, const std::optional<DeviceState>& last) {
  const bool is_told = state.status == DeviceStatus::live || state.status == DeviceStatus::lost;
  if (!is_told || !last) {
    return is_told;
  }
  return (state.sequence > last->sequence || state.status != last->status) &&
         state.sequence >= last->sequence && state.time_ns >= last->time_ns;
}

}  // namespace

void DeviceRecordings::begin(std::span<const std::string> files, std::span<Device* const> devices) {
  for (std::size_t k = 0; k < files.size(); ++k) {
    const DeviceCapabilities& capabilities = devices[k]->capabilities();
    all_.push_back(std::make_unique<One>(files[k], capabilities));
    all_.back()->file.write(recording_head(capabilities));
  }
}

void DeviceRecordings::add(const ForceTick& tick) {
  for (std::size_t k = 0; k < all_.size(); ++k) {
    One& one = *all_[k];
    const DeviceState& state = tick.tools[k].device;
    if (is_new(state, one.last)) {
      one.file.write(recording_line(state, one.kind, one.grips));
      one.last = state;
    }
  }
}

void DeviceRecordings::commit() {
  for (const std::unique_ptr<One>& one : all_) {
    one->file.commit();
  }
}

}  // namespace firstcontact::app
