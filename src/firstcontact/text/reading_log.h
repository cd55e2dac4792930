/// @file
/// The notes of a reader: contents, names left out, warnings and errors.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/text/file_report.h>
#include <firstcontact/text/parse_error.h>

namespace firstcontact::detail {

/// The notes on one file. Equal notes are counted, not repeated.
class FIRSTCONTACT_API ReadingLog {
 public:
  /// @param path    names the file in errors
  /// @param format  "glTF"
  ReadingLog(std::string path, std::string format, const ReadingOptions& options = {});

  [[nodiscard]] const std::string& path() const { return report_.path; }
  [[nodiscard]] bool lenient() const { return options_.lenient; }

  /// Sets a count of the contents; counts of one name add up.
  void add_content(std::string_view what, std::size_t count);

  void set_unit(std::string unit) { report_.unit = std::move(unit); }

  /// Notes a further file that was read for this one; digests take it in.
  void add_file(std::string path) { report_.also_read.push_back(std::move(path)); }

  /// Notes something that can make no contact.
  void leave_out(std::string_view name, std::string_view reason, std::size_t count = 1);

  /// Notes a warning for the user.
  ///
  /// Warnings of one cause are counted: the first of them is shown, with the number of the others.
  ///
  /// @param cause  their common cause; empty for a warning of its own
  void warn(const ParseError& warning, std::string_view cause = {});

  /// Adds an error that does not stop the reader: finish() reports all of them at once.
  void add_error(const ParseError& error);

  /// Adds an error for an unknown name that could hold or place geometry.
  ///
  /// Where the options are lenient it is a warning.
  ///
  /// @param cause  as for warn()
  void refuse(const ParseError& error, std::string_view cause = {});

  [[nodiscard]] bool has_errors() const { return !errors_.empty(); }
  [[nodiscard]] std::size_t error_count() const { return errors_.size(); }

  /// Throws all errors as one.
  ///
  /// @throws ParseError  one line with all errors, if there are any
  void throw_errors() const;

  /// Returns the report on the file.
  ///
  /// @throws ParseError  as throw_errors
  [[nodiscard]] FileReport finish();

 private:
  struct Warning {
    std::string text;
    std::string cause;
    std::size_t count = 0;
  };

  ReadingOptions options_;
  FileReport report_;
  std::vector<Warning> warnings_;
  std::vector<ParseError> errors_;
};

}  // namespace firstcontact::detail
