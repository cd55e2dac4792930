/// @file
/// Limits the stack of a fuzz target to 1 MiB, so that recursion by the input's depth fails there.
///
/// Include it in the one source file of a target; libFuzzer calls the function at the start.

#pragma once

#include <sys/resource.h>

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  // The kernel applies the limit whenever the main thread's stack grows, and inputs run on that
  // stack.
  constexpr rlim_t kStack = rlim_t{1} << 20;
  rlimit limit{};
  if (getrlimit(RLIMIT_STACK, &limit) != 0) {
    return 1;
  }
  limit.rlim_cur = kStack;
  return setrlimit(RLIMIT_STACK, &limit) == 0 ? 0 : 1;
}
