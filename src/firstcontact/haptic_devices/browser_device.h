/// @file
/// A mouse on a page of a browser, as a haptic device.

#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include <firstcontact/haptic_devices/device.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// The options of a browser device.
struct BrowserDeviceOptions {
  std::uint16_t port = 0;  ///< The port on 127.0.0.1; 0 for a free one.
};

/// A handle that a page of a browser moves. It senses poses, and no force reaches the hand.
///
/// The device serves its page to this machine only: over HTTP at "/", and by a WebSocket at "/live"
/// of the same port. The page sends `{"position": [x, y, z], "rotation": [w, x, y, z]}`, the pose
/// of the handle in D [m]. A message with `"grip"` sets all grips to that value, any other sets
/// them to 0. The page receives the messages of `show`, at most 60 a second. The device refuses a
/// page that another site has opened, and a second page while the first one is there.
///
/// Before the first pose the status is `waiting`; without a page it is `lost`.
class FIRSTCONTACT_API BrowserDevice : public Device {
 public:
  /// Opens the port and listens; serves no page yet.
  ///
  /// @throws std::runtime_error  if the port is taken, with the mend
  explicit BrowserDevice(const BrowserDeviceOptions& options = {});
  ~BrowserDevice() override;

  /// The port on which the device listens.
  [[nodiscard]] std::uint16_t port() const noexcept;

  /// Serves a page from now on. Call it once.
  void serve(std::string page);

  /// Sends a text to the page. It replaces an earlier text that is not sent yet. For any thread;
  /// not for the force loop.
  void show(std::string_view message);

  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override;
  [[nodiscard]] DeviceState read(std::int64_t now_ns) noexcept override;
  void command(const ForceCommand& command, std::int64_t now_ns) noexcept override;
  [[nodiscard]] DeviceCounts counts() const override;
  [[nodiscard]] std::string problem() const override;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace firstcontact
