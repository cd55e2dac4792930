#include "device_recordings.h"

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <firstcontact/haptic_devices/recording.h>

namespace firstcontact::app {
namespace {

[[noreturn]] void fail_to_write(const std::string& path) {
  throw std::runtime_error(path + ": cannot write this file: " + std::strerror(errno));
}

/// Whether a device reads the same at two ticks, but for the time.
bool is_same(const DeviceState& a, const DeviceState& b) {
  return a.sequence == b.sequence && a.status == b.status && a.buttons == b.buttons &&
         a.X_DH.position == b.X_DH.position &&
         a.X_DH.rotation.coeffs() == b.X_DH.rotation.coeffs() && a.linear_rate == b.linear_rate &&
         a.angular_rate == b.angular_rate && a.grips == b.grips;
}

void require_empty(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_regular_file(path, error) &&
      std::filesystem::file_size(path, error) > 0) {
    throw std::runtime_error(path +
                             ": holds something already; replace it with --force, or give another "
                             "file for --record");
  }
}

}  // namespace

void DeviceRecordings::One::write(const std::string& text) const {
  if (std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() ||
      std::fflush(file.get()) != 0) {
    fail_to_write(path);
  }
}

void DeviceRecordings::One::add(const DeviceState& state, std::int64_t now_ns) {
  // A device that was opened again may count from the start; a recording counts on.
  if (!last) {
    sequence = state.sequence;
  } else if (state.sequence < last->sequence) {
    ++sequence;
  } else {
    sequence += state.sequence - last->sequence;
  }
  last = state;
  time_ns = now_ns;
  DeviceState row = state;
  row.sequence = sequence;
  row.time_ns = now_ns;
  write(recording_line(row, kind, grips));
}

void DeviceRecordings::begin(std::span<const std::string> files, std::span<Device* const> devices,
                             bool replaces) {
  for (const std::string& file : files) {
    if (!replaces) {
      require_empty(file);
    }
  }
  for (std::size_t k = 0; k < files.size(); ++k) {
    const DeviceCapabilities& capabilities = devices[k]->capabilities();
    One one{.path = files[k],
            .file = {std::fopen(files[k].c_str(), "wb"), {}},
            .kind = capabilities.kind,
            .grips = capabilities.grips};
    if (!one.file) {
      fail_to_write(one.path);
    }
    one.write(recording_head(capabilities));
    all_.push_back(std::move(one));
  }
}

void DeviceRecordings::add(const ForceTick& tick) {
  now_ns_ = tick.time_ns;
  for (std::size_t k = 0; k < all_.size(); ++k) {
    const DeviceState& state = tick.tools[k].device;
    if (!all_[k].last || !is_same(state, *all_[k].last)) {
      all_[k].add(state, tick.time_ns);
    }
  }
}

bool DeviceRecordings::end() {
  bool has_ticks = true;
  for (One& one : all_) {
    if (!one.last) {
      has_ticks = false;
      std::filesystem::remove(one.path);
    } else if (one.time_ns < now_ns_) {
      one.add(DeviceState(*one.last), now_ns_);
    }
  }
  return has_ticks;
}

}  // namespace firstcontact::app
