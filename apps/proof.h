/// @file
/// The arguments of `firstcontact verify` for every kind of file.

#pragma once

#include <string>

#include <firstcontact/verification/proof_verdict.h>

#include "exit_status.h"

namespace firstcontact::app {

struct ProofArguments {
  std::string file;   ///< File to be proven.
  std::string scene;  ///< Scene that the file has to be of; may be empty.
  bool json = false;
  bool lenient = false;
  int threads = 0;
};

[[nodiscard]] ExitStatus status_of(ProofVerdict verdict);

}  // namespace firstcontact::app
