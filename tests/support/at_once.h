/// @file
/// Threads that work at the same time.

#pragma once

#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace firstcontact::test {

/// Calls work(thread) on several threads that begin together; returns when all are done.
template <class Work>
void at_once(std::size_t count, const Work& work) {
  std::atomic<std::size_t> ready = 0;
  std::vector<std::jthread> threads;
  for (std::size_t thread = 0; thread < count; ++thread) {
    threads.emplace_back([&, thread] {
      ++ready;
      while (ready < count) {
        std::this_thread::yield();
      }
      work(thread);
    });
  }
}

}  // namespace firstcontact::test
