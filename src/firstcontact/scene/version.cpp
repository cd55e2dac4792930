#include <firstcontact/scene/version.h>

namespace firstcontact {

const char* version() { return FIRSTCONTACT_VERSION; }

}  // namespace firstcontact
