/// @file
/// Values of a fixture of Rigid IPC.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/text/json_reader.h>

namespace firstcontact::detail {

/// The key that identifies a fixture.
inline constexpr std::string_view kRigidIpcProblem = "rigid_body_problem";

/// Whether a JSON document is a fixture of Rigid IPC.
[[nodiscard]] bool is_rigid_ipc(const JsonValue& root);

/// Reads the values of keys. Unknown keys are warnings, those that begin with '#' comments.
class RigidIpcKeys {
 public:
  /// @param read  outlives this
  explicit RigidIpcKeys(const JsonReader& read) : read_(read) {}

  [[nodiscard]] const JsonReader& read() const { return read_; }
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

  /// Reads an object. Warns of keys other than these.
  const JsonObject& object(const JsonValue& value, const std::vector<std::string_view>& known);

  [[nodiscard]] double positive_or(const JsonObject& object, std::string_view key,
                                   double otherwise) const;
  [[nodiscard]] Eigen::Vector3d vector_or_zero(const JsonObject& object,
                                               std::string_view key) const;

  /// Reads a vector in degrees as radians; a rate in degrees likewise.
  [[nodiscard]] Eigen::Vector3d degrees_or_zero(const JsonObject& object,
                                                std::string_view key) const;

 private:
  const JsonReader& read_;
  std::vector<std::string> warnings_;
};

}  // namespace firstcontact::detail
