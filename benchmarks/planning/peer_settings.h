/// @file
/// The arguments of benchmarks beside planners of OMPL.

#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

#include "benchmarks/planning/thin_plates.h"

namespace firstcontact::benchmarks {

struct PeerSettings {
  std::uint64_t seeds = 1;
  int every = 1;
  double time = 0.0;  ///< [s]  Most for one search.
  ThinPlates plates;
  std::string output;  ///< File of the results; empty for none.
};

/// Reads arguments into settings.
///
/// @param more  takes an option's name and value, and returns whether it knows the name
/// @throws std::invalid_argument  for an unknown option or a value that is no number
inline void read_arguments(
    int count, char** arguments, PeerSettings& settings,
    const std::function<bool(const std::string&, const std::string&)>& more = {}) {
  for (int k = 1; k < count; ++k) {
    const std::string name = arguments[k];
    const bool is_option = name.starts_with("--") && k + 1 < count;
    const std::string value = is_option ? arguments[++k] : "";
    if (name == "--seeds") {
      settings.seeds = std::stoull(value);
    } else if (name == "--every") {
      settings.every = std::max(1, std::stoi(value));
    } else if (name == "--time") {
      settings.time = std::stod(value);
    } else if (name == "--plates") {
      settings.plates.count = std::stoi(value);
    } else if (name == "--thickness") {
      settings.plates.thickness = std::stod(value);
    } else if (!name.starts_with("--")) {
      settings.output = name;
    } else if (!more || !more(name, value)) {
      throw std::invalid_argument("unknown option " + name);
    }
  }
}

}  // namespace firstcontact::benchmarks
