/// @file
/// The second proof of a run, and its answer as text for a terminal.

#pragma once

#include <istream>
#include <stop_token>

#include "exit_status.h"
#include "proof.h"

namespace firstcontact::app {

class Progress;

/// Proves a run again, and prints the findings.
///
/// @param stream  at the begin of the file
/// @throws ParseError where it holds something else, contradicts itself, or a file has changed
[[nodiscard]] ExitStatus prove_run(const ProofArguments& arguments, std::istream& stream,
                                   Progress& progress, const std::stop_token& stop);

}  // namespace firstcontact::app
