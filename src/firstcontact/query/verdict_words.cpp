#include <firstcontact/query/verdict_words.h>

#include <cstddef>

#include <firstcontact/query/outcome.h>

namespace firstcontact {

const char* to_string(Verdict verdict) { return kVerdictWords[static_cast<std::size_t>(verdict)]; }

const char* to_string(UndecidedReason reason) {
  return kUndecidedReasonWords[static_cast<std::size_t>(reason)];
}

}  // namespace firstcontact
