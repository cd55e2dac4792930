/// @file
/// The place of a value in a line of JSON, for errors.

#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace firstcontact::detail {

/// The place of a value below the root: ".bodies[2].pieces"; nothing if it is not there.
///
/// It is searched for only when there is an error to report.
[[nodiscard]] std::optional<std::string> place_of(const nlohmann::json& value,
                                                  const nlohmann::json& root, int depth = 0);

}  // namespace firstcontact::detail
