/// @file
/// What `firstcontact verify` asks of every kind of file.

#pragma once

#include <string>

#include <firstcontact/verification/proof_verdict.h>

#include "exit_status.h"

namespace firstcontact::app {

struct ProofArguments {
  std::string file;   ///< To be proven.
  std::string scene;  ///< That the file is to be of; may be empty.
  bool json = false;
  bool lenient = false;
  int threads = 0;
};

[[nodiscard]] ExitStatus status_of(ProofVerdict verdict);

}  // namespace firstcontact::app
