#include <firstcontact/scene/write_result.h>

namespace firstcontact {

const char* word(Verdict verdict) {
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

const char* word(UndecidedReason reason) {
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

const char* word(FeatureType type) {
  switch (type) {
    case FeatureType::vertex:
      return "vertex";
    case FeatureType::edge:
      return "edge";
    case FeatureType::face:
      break;
  }
  return "face";
}

}  // namespace firstcontact
