/// @file
/// The second proof of a planned path, and its answer as text for a terminal.

#pragma once

#include <stop_token>
#include <string>

#include "exit_status.h"
#include "proof.h"

namespace firstcontact::app {

class Progress;

/// Proves a planned path again, and prints the findings.
///
/// @param text  text of the file
/// @throws ParseError where it holds something else, or a file has changed
[[nodiscard]] ExitStatus prove_path(const ProofArguments& arguments, const std::string& text,
                                    Progress& progress, const std::stop_token& stop);

}  // namespace firstcontact::app
