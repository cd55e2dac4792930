/// @file
/// A Haply Inverse3 through the Inverse Service.

#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <Eigen/Core>

#include <firstcontact/haptic_devices/device.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// The generations of the service's messages.
enum class HaplyGeneration {
  automatic,   ///< By the first message: 3.5 names a session, earlier versions do not.
  before_3_5,  ///< Versions 3.1 to 3.4: a force has the key "values".
  since_3_5,   ///< Version 3.5: a force has the key "vector".
};

/// The options of a Haply Inverse3.
struct HaplyOptions {
  std::string host = "localhost";
  std::uint16_t port = 10001;
  std::string device_id;  ///< The Inverse3; empty for the first one.
  std::string grip_id;    ///< The grip that gives the orientation; empty for the first one.
  HaplyGeneration generation = HaplyGeneration::automatic;
  /// [N]  The greatest force that is sent. A cautious value of ours, not the maker's limit.
  double max_force = 2.0;
  /// [m]  Centre of the workspace in the frame of the service: the origin of D.
  Eigen::Vector3d centre = {0.0, -0.14, 0.17};
  double workspace_radius = 0.1;  ///< [m]   Radius of the workspace about the centre; > 0.
  double rate = 2000.0;           ///< [Hz]  Greatest rate of messages to the service; > 0.
  std::int64_t silent_after_ns = 50'000'000;  ///< [ns]  Time without a message until `silent`.
  /// [ns]  Time without a message until a new connection.
  std::int64_t lost_after_ns = 500'000'000;
  std::int64_t connect_ns = 2'000'000'000;  ///< [ns]  Limit for a connection and its first state.
  std::int64_t retry_ns = 250'000'000;  ///< [ns]  Pause between two tries to connect again; > 0.
};

/// A Haply Inverse3 with or without a Verse Grip, through the local Inverse Service.
///
/// The position is sensed and driven. The orientation is sensed if there is a grip, and never
/// driven. The frame of the service has the axes of D. The service answers each message with one
/// state. A thread sends the newest force at the given rate and takes the answers. At most two
/// messages are on the way. While no Inverse3 is there, the thread sends an empty message, which
/// keeps the connection.
///
/// The force is zero before the first command, and after each new connection until the next
/// command. It is zero again 100 ms after the last command. No library for WebSockets is needed.
/// Not tried on hardware.
class FIRSTCONTACT_API Haply : public Device {
 public:
  /// Connects to the service and waits for the first state of an Inverse3.
  ///
  /// @throws std::invalid_argument  if an option is outside its range
  /// @throws std::runtime_error     if no service or no device answers in time, with the mend
  explicit Haply(const HaplyOptions& options = {});
  ~Haply() override;

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
