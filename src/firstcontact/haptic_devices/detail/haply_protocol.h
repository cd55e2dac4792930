/// @file
/// The messages of the Haply Inverse Service.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace firstcontact::detail {

/// The content of one message of the service.
struct HaplyMessage {
  std::optional<Eigen::Quaterniond> orientation;       ///< Orientation of the grip; of length 1.
  std::optional<Eigen::Vector3d> position;             ///< [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s]
  std::string device_id;                               ///< The Inverse3; empty if there is none.
  std::string model;          ///< `config.type` of the Inverse3, where the message has it.
  std::uint32_t buttons = 0;  ///< Buttons of the grip, in the order of their names.
  bool ready = true;          ///< Whether its `status` reports that it is ready.
  bool has_session = false;   ///< Whether it has a session, as messages of 3.5 have.
  /// The reason why the grip was left out; empty where nothing is wrong.
  std::string grip_problem;
};

/// The devices of a message that are read. Empty for the first one.
struct HaplyChoice {
  std::string device_id;
  std::string grip_id;
};

/// Parses a message. Unknown keys are left out.
///
/// Grips are searched for in all lists whose name ends in "verse_grip", wired ones first. So the
/// list of 3.5 with its own types is read as well.
///
/// @throws ParseError  where a value does not fit its key
[[nodiscard]] HaplyMessage parse_haply_message(std::string_view text, const HaplyChoice& choice);

/// Writes the message that commands a force [N], and so requests the next state.
///
/// @param vector_key  "vector" since 3.5, "values" before
/// @param profile     names the program, in the first message of a connection; else empty
[[nodiscard]] std::string haply_force(const std::string& device_id, const Eigen::Vector3d& force,
                                      const char* vector_key, const std::string& profile);

}  // namespace firstcontact::detail
