/// @file
/// A file of results that survives the end of its writer at any moment.

#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace firstcontact::app {

/// A file that grows by whole lines.
///
/// After the end of a killed writer it holds all lines but the last ones, and perhaps a part of
/// one. The next writer cuts that part off and goes on. Beside it, FILE.batch states the origin of
/// the results. So the next writer can decide whether it would write the same.
class ResultsFile {
 public:
  /// Opens the file; no other process can until it is closed.
  ///
  /// @param origin  the origin of the results: a few lines of text
  /// @param resume  whether to go on with the existing lines, which must have the same origin;
  ///                otherwise the file must be empty or missing
  /// @throws std::runtime_error, one line that names the file
  ResultsFile(std::filesystem::path path, const std::string& origin, bool resume);

  /// Visits the lines of earlier writers.
  void for_each_kept(
      const std::function<void(std::size_t number, const std::string&)>& visit) const;

  /// Writes a line at the end.
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
