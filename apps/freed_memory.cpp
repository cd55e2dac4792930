#include "freed_memory.h"

#include <array>
#include <cstddef>
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

void take_stack() {
  constexpr std::size_t kSize = std::size_t{512} << 10;  // [bytes]
  constexpr std::size_t kPage = 4096;                    // [bytes]  At most the size of pages.
  std::array<volatile char, kSize> stack;
  for (std::size_t k = 0; k < kSize; k += kPage) {
    stack[k] = 0;
  }
}

}  // namespace firstcontact::app
