/// @file
/// Results that survive the end of their writer, at whatever moment it comes.

#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace firstcontact::app {

/// A file that grows by whole lines. Of a writer that was killed it holds all lines but the last
/// ones, and perhaps a part of one; the next writer cuts that off and goes on.
///
/// Beside it, FILE.batch says what the lines are the results of, so that the next writer can tell
/// whether it would write the same.
class ResultsFile {
 public:
  /// Opens the file; nobody else can until it is closed.
  ///
  /// @param origin  what the results are of: a few lines of text
  /// @param resume  go on with what is there, which must be of the same origin; otherwise the file
  ///                must be empty or missing
  /// @throws std::runtime_error, one line that names the file
  ResultsFile(std::filesystem::path path, const std::string& origin, bool resume);

  /// Visits the lines that were there already.
  void for_each_kept(
      const std::function<void(std::size_t number, const std::string&)>& visit) const;

  /// Writes a line, at the end.
  void append(std::string_view line);

 private:
  struct Descriptor {
    Descriptor() = default;
    ~Descriptor();
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    int value = -1;
  };

  void open();
  void write_origin(const std::string& origin) const;
  void require_origin(const std::string& origin) const;
  void cut_off_part_of_a_line() const;
  [[noreturn]] void fail(const std::string& what) const;
  [[noreturn]] void fail_errno(const char* what) const;

  std::filesystem::path path_;
  std::filesystem::path origin_path_;
  Descriptor descriptor_;
};

}  // namespace firstcontact::app
