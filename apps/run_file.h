/// @file
/// The file to which a simulation appends.

#pragma once

#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <firstcontact/record/run.h>

namespace firstcontact::app {

/// The treatment of a run in the file where another one is to begin.
enum class HeldRun {
  kept,       ///< The new run is refused.
  resumable,  ///< The new run is refused, and --resume is offered where the two are one run.
  replaced,   ///< The old run is lost.
};

/// A file with a header and whole steps, at every moment except while a line is written.
///
/// A line that was cut off there is left out when the run is resumed.
class RunFile {
 public:
  /// Begins a new run.
  ///
  /// @throws std::runtime_error, one line that names the file, where it cannot be written, or where
  ///         it holds anything and is not to be replaced
  static RunFile begin(const std::string& path, const RunHeader& header, HeldRun on_held);

  /// Goes on with the run in the file, or begins one where there is no file.
  ///
  /// @param each    called with every existing step
  /// @throws std::invalid_argument if the file holds another run than one with this header
  /// @throws ParseError if it holds no run
  static RunFile resume(const std::string& path, const RunHeader& header,
                        const std::function<void(const RunStep&)>& each);

  /// The last step of a run that is resumed, if it has any.
  [[nodiscard]] const std::optional<RunStep>& last() const { return last_; }

  /// Appends a step; it is in the file when this returns.
  void write(const RunStep& step);

 private:
  RunFile(std::string path, const char* mode);
  RunFile(const std::string& path, const RunHeader& header);
  void write(const std::string& line);

  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::optional<RunStep> last_;
};

}  // namespace firstcontact::app
