/// @file
/// The protocol of spacenavd on its local socket.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <firstcontact/haptic_devices/device.h>

namespace firstcontact::detail {

/// The kinds of events that the daemon reports.
enum class SpacenavEventType {
  motion,          ///< The deflection of the cap is new.
  press,           ///< A button goes down.
  release,         ///< A button comes up.
  device_added,    ///< A device was plugged in.
  device_removed,  ///< A device was taken away.
  protocol,        ///< The daemon has agreed to version `value` of the protocol.
  other,           ///< Settings and the like, which no driver needs.
};

/// An event of the daemon.
struct SpacenavEvent {
  SpacenavEventType type = SpacenavEventType::other;
  /// Counts along x (right), y (up), z (away), then about them, as the daemon has them.
  std::array<std::int32_t, 6> axes{};
  std::int32_t value = 0;  ///< Number of the button; version of the protocol.
};

/// Cuts the bytes of the daemon into events.
///
/// A record is eight integers of 32 bits in the order of the machine: the type, then its data. The
/// answer to the request for a protocol is one such integer alone. An invalid record is counted and
/// left out; the next one begins 32 bytes later.
///
/// Source: the sources of libspnav 1.0 (BSD 3-clause) describe the protocol; nothing is copied.
class SpacenavDecoder {
 public:
  void add(std::string_view bytes) { bytes_.append(bytes); }

  /// Reads the next event; nothing until there are more bytes.
  [[nodiscard]] std::optional<SpacenavEvent> next();

  [[nodiscard]] std::uint64_t malformed() const { return malformed_; }

  /// Whether a record has begun that has not ended.
  [[nodiscard]] bool inside_record() const { return at_ < bytes_.size(); }

 private:
  [[nodiscard]] std::int32_t integer(std::size_t index) const;
  [[nodiscard]] std::optional<SpacenavEvent> event_of_record() const;

  std::string bytes_;
  std::size_t at_ = 0;
  std::uint64_t malformed_ = 0;
  bool agreed_ = false;  // Whether a protocol is agreed.
};

/// Makes the request for version 1 of the protocol, in which the daemon reports removed devices.
[[nodiscard]] std::string spacenav_protocol_request();

/// Makes the answer to a daemon that took the request for one of a sensitivity, as those of version
/// 0 do: 1.
[[nodiscard]] std::string spacenav_sensitivity_one();

}  // namespace firstcontact::detail
