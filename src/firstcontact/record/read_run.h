/// @file
/// Reads a run back, step after step.

#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <optional>
#include <string>

#include <firstcontact/math/export.h>
#include <firstcontact/record/run.h>

namespace firstcontact {

/// Reads the lines of a run in order; holds one of them at a time.
///
/// The reader is strict, as for scenes: a key that is missing, unknown or of the wrong type is an
/// error. So are a body that the scene does not have, a step out of order, and pieces that do not
/// end with their step. Doubles are those that were written, bit for bit.
class FIRSTCONTACT_API RunReader {
 public:
  /// Reads the header. Paths in its scene are as they were opened by the simulation.
  ///
  /// @param run      outlives the reader
  /// @param path     name of the file, for errors: "path:line: what was expected"
  /// @param options  for the files of its scene
  /// @throws ParseError if there is no header
  RunReader(std::istream& run, std::string path, const ReadingOptions& options = {});

  /// Passes over the header of a run, where it is known. The files that it names are not opened.
  ///
  /// @param header  of the run, see is_header_line_of()
  /// @throws ParseError if there is no header
  RunReader(std::istream& run, std::string path, RunHeader header);

  [[nodiscard]] const RunHeader& header() const { return header_; }

  /// Reads the next step; none at the end of the run.
  ///
  /// @throws ParseError if a line is no step, or the stream cannot be read
  [[nodiscard]] std::optional<RunStep> next();

  /// Whether the run ends in the middle of a line, as a killed simulation leaves it.
  ///
  /// It is known when next() has returned none.
  [[nodiscard]] bool is_cut_off() const { return cut_off_; }

  /// [byte]  The end of the last whole line that was read.
  ///
  /// A run that was cut off can go on when its file is cut to this size.
  [[nodiscard]] std::uint64_t size() const { return size_; }

 private:
  std::string header_line();
  std::optional<std::string> next_line();

  std::istream& stream_;
  std::string path_;
  std::size_t line_ = 0;
  std::size_t steps_ = 0;
  std::uint64_t size_ = 0;
  bool cut_off_ = false;
  RunHeader header_;
};

}  // namespace firstcontact
