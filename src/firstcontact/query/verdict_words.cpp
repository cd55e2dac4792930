#include <firstcontact/query/first_contact.h>

namespace firstcontact {

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::free:
      return "free";
    case Verdict::contact:
      return "contact";
    case Verdict::contact_at_start:
      return "contact_at_start";
    case Verdict::undecided:
      break;
  }
  return "undecided";
}

const char* to_string(UndecidedReason reason) {
  switch (reason) {
    case UndecidedReason::none:
      break;
    case UndecidedReason::work:
      return "work";
    case UndecidedReason::deadline:
      return "deadline";
    case UndecidedReason::memory:
      return "memory";
    case UndecidedReason::precision:
      return "precision";
    case UndecidedReason::cancelled:
      return "cancelled";
  }
  return "none";
}

}  // namespace firstcontact
