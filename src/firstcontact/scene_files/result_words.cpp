#include <firstcontact/scene_files/write_result.h>

#include <cstddef>

#include <firstcontact/query/contact.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact {

const char* word(Verdict verdict) { return to_string(verdict); }

const char* word(UndecidedReason reason) { return to_string(reason); }

const char* word(FeatureType type) { return kFeatureTypeWords[static_cast<std::size_t>(type)]; }

}  // namespace firstcontact
