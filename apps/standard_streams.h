/// @file
/// The standard streams, which may be closed, or full as a disk is.

#pragma once

#include <string>
#include <string_view>

namespace firstcontact::app {

/// Call before any file is opened: it would get the number of a stream that is closed, and what
/// is meant for the stream would go into the file. After this such a write fails.
void occupy_closed_streams();

/// Writes to standard error. Throws nothing: where nobody can be told, the exit status says it.
void say_on_stderr(std::string_view text);

/// Writes out what is buffered of the answer.
///
/// @throws std::runtime_error where any of it could not be written
void flush_stdout();

/// A limit on the size of files becomes an error of the write, as a full disk is, not the end of
/// the process.
void refuse_long_files_by_error();

/// What a command line calls standard input.
inline constexpr std::string_view kStdin = "-";

/// What errors call it.
inline constexpr std::string_view kStdinName = "standard input";

/// All that comes from standard input.
///
/// @throws std::runtime_error where it cannot be read
std::string read_stdin();

}  // namespace firstcontact::app
