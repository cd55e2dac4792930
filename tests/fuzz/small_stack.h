/// @file
/// Runs a reader on a small stack, so that recursion without a limit is found.

#pragma once

#include <pthread.h>

#include <cstddef>
#include <cstdlib>

namespace firstcontact::test {

inline constexpr std::size_t kSmallStack = std::size_t{1} << 20;  ///< [byte]

/// Calls `run` in a thread with a stack of 1 MiB.
template <class Run>
void on_small_stack(Run run) {
  pthread_attr_t attributes;
  pthread_t thread;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kSmallStack);
  const auto call = [](void* argument) -> void* {
    (*static_cast<Run*>(argument))();
    return nullptr;
  };
  if (pthread_create(&thread, &attributes, call, &run) != 0) {
    std::abort();
  }
  pthread_join(thread, nullptr);
  pthread_attr_destroy(&attributes);
}

}  // namespace firstcontact::test
