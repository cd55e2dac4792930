#include <firstcontact/scene_files/write_result.h>

namespace firstcontact {

const char* word(Verdict verdict) { return to_string(verdict); }

const char* word(UndecidedReason reason) { return to_string(reason); }

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
