/// @file
/// Keeps the outputs of a command apart from its inputs, and from each other.

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <firstcontact/scene/scene.h>

namespace firstcontact::app {

/// A file that a command is to write.
struct OutputFile {
  std::string option;  ///< Option that names it: "--html".
  std::string path;    ///< Empty where the option was not given.
};

/// Refuses an output with the name `-`: it would not go to the standard output.
///
/// @throws std::invalid_argument that names the option
void require_named(const std::vector<OutputFile>& outputs);

/// Refuses two outputs in one file, as one answer would replace the other.
///
/// @throws std::invalid_argument where two outputs are one file
void require_different(const std::vector<OutputFile>& outputs);

/// Requires that the outputs can be written, before the work whose answer they are for.
///
/// @throws std::runtime_error, one line that names the file, where its folder is missing, or the
///         file cannot be written
void require_writable(const std::vector<OutputFile>& outputs);

/// Refuses an output in the file of an input, as the answer would replace the question.
///
/// @throws std::runtime_error where an output is one of the inputs: unlike a bad scene of many,
///         this ends them all
void require_no_input(const std::vector<OutputFile>& outputs,
                      const std::vector<std::filesystem::path>& inputs);

/// The files that a scene names or was made of, without its own file.
[[nodiscard]] std::vector<std::filesystem::path> files_of(const Scene& scene);

}  // namespace firstcontact::app
