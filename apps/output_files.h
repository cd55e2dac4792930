/// @file
/// Keeps what a command writes off what it reads, and off its other answers.

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <firstcontact/scene/scene.h>

namespace firstcontact::app {

/// A file that a command is to write.
struct OutputFile {
  std::string option;  ///< That names it: "--html".
  std::string path;    ///< Empty where the option was not given.
};

/// Nobody wants one answer in the place of another.
///
/// @throws std::invalid_argument where two outputs are one file
void require_different(const std::vector<OutputFile>& outputs);

/// Nobody wants an answer in the place of the question.
///
/// @throws std::runtime_error where an output is one of the inputs: unlike a bad scene of many,
///         this ends them all
void require_no_input(const std::vector<OutputFile>& outputs,
                      const std::vector<std::filesystem::path>& inputs);

/// The files that a scene names or was put together of, without its own.
[[nodiscard]] std::vector<std::filesystem::path> files_of(const Scene& scene);

}  // namespace firstcontact::app
