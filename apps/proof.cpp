#include "proof.h"

namespace firstcontact::app {

ExitStatus status_of(ProofVerdict verdict) {
  switch (verdict) {
    case ProofVerdict::proven:
      return ExitStatus::free;
    case ProofVerdict::refuted:
      return ExitStatus::contact;
    case ProofVerdict::broken:
      return ExitStatus::bad_input;
    case ProofVerdict::not_proven:
      break;
  }
  return ExitStatus::undecided;
}

}  // namespace firstcontact::app
