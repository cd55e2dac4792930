#include "freed_memory.h"

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace firstcontact::app {

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kKept = 256 << 20;    // [bytes]
  constexpr int kLargest = 32 << 20;  // [bytes]  The greatest threshold that glibc takes.
  mallopt(M_TRIM_THRESHOLD, kKept);
  mallopt(M_MMAP_THRESHOLD, kLargest);
#endif
}

}  // namespace firstcontact::app
