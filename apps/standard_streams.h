/// @file
/// The standard streams, which may be closed, or full as a disk is.

#pragma once

#include <string>
#include <string_view>

namespace firstcontact::app {

/// Occupies the numbers of closed standard streams; to be called before any file is opened.
///
/// A file would get the number of a closed stream, and output for the stream would go into the
/// file. After this call such a write fails.
void occupy_closed_streams();

/// Writes to standard error. Throws nothing: if no one can read it, the exit status reports the
/// error.
void say_on_stderr(std::string_view text);

/// Writes out the buffered part of the answer.
///
/// @throws std::runtime_error where any of it could not be written
void flush_stdout();

/// Makes a limit on the size of files an error of the write, as a full disk is.
///
/// Otherwise the limit would end the process.
void refuse_long_files_by_error();

/// The name of standard input on a command line.
inline constexpr std::string_view kStdin = "-";

/// The name of standard input in errors.
inline constexpr std::string_view kStdinName = "standard input";

/// Reads all of standard input.
///
/// @throws std::runtime_error where it cannot be read
std::string read_stdin();

}  // namespace firstcontact::app
