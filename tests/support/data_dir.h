/// @file
/// Folder of the test data that is too large for the repository.

#pragma once

#include <cstdlib>
#include <filesystem>

namespace firstcontact::test {

/// Returns FIRSTCONTACT_DATA_DIR, or else ../shared/data beside the source tree; empty where
/// neither exists.
///
/// A test without its data is skipped: `GTEST_SKIP() << "needs FIRSTCONTACT_DATA_DIR"`.
inline std::filesystem::path data_dir() {
  const char* set = std::getenv("FIRSTCONTACT_DATA_DIR");
  const std::filesystem::path path =
      set != nullptr ? std::filesystem::path(set)
                     : std::filesystem::path(FIRSTCONTACT_SOURCE_DIR) / "../shared/data";
  return std::filesystem::is_directory(path) ? path : std::filesystem::path();
}

}  // namespace firstcontact::test
