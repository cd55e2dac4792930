/// @file
/// The second proof of the results in a file, and its answer as text for a terminal.

#pragma once

#include <stop_token>
#include <string>

#include "exit_status.h"
#include "proof.h"

namespace firstcontact::app {

class Progress;

/// Proves each result of a file again, and prints the findings. The status is the worst.
///
/// @param text  text of the file: one result, or one on each line
/// @throws ParseError where it holds something else, or a file has changed
[[nodiscard]] ExitStatus prove_results(const ProofArguments& arguments, const std::string& text,
                                       Progress& progress, const std::stop_token& stop);

}  // namespace firstcontact::app
