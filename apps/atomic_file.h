/// @file
/// A file that appears whole or not at all.

#pragma once

#include <filesystem>
#include <string_view>

namespace firstcontact::app {

/// Writes a file that appears on commit, or not at all.
///
/// It writes to a temporary file beside the target. On commit that takes the target's name, and the
/// permissions of a file that it replaces. A target that is no plain file, such as a pipe or
/// /dev/null, is written directly. So is a descriptor of this process, such as /dev/stdout.
///
/// @throws std::runtime_error, one line that names the file, where it cannot be written
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& target);

  /// Removes the temporary file, unless it was committed.
  ~AtomicFile();

  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view text);
  void commit();

 private:
  void begin_temporary();
  void end_temporary() noexcept;
  [[noreturn]] void fail(const char* what) const;

  std::filesystem::path target_;
  std::filesystem::path temporary_;  // Empty where the target is written directly.
  int descriptor_ = -1;
};

/// Removes the temporary files of all files that are not committed, as the process ends at once.
void remove_temporaries() noexcept;

/// Writes one text to a file.
void write_file(const std::filesystem::path& target, std::string_view text);

}  // namespace firstcontact::app
