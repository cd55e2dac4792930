/// @file
/// The threads on which islands advance.

#pragma once

#include <cstddef>

#include <tbb/enumerable_thread_specific.h>

#include <firstcontact/parallel/detail/workers.h>
#include <firstcontact/query/workspace.h>

namespace firstcontact::detail {

/// Threads, and a workspace of each that its queries share.
class IslandThreads {
 public:
  /// @param threads  at most; 0 for one on each core
  explicit IslandThreads(int threads) : threads_(threads), workers_(threads) {}

  /// Memory for the calling thread.
  [[nodiscard]] Workspace& workspace() { return workspaces_.local(); }

  /// Calls use(k, workspace) for each k below count. The result of `use` must not depend on the
  /// order.
  template <class Use>
  void for_each(std::size_t count, const Use& use) {
    if (count < 2 || threads_ == 1) {
      for (std::size_t k = 0; k < count; ++k) {
        use(k, workspace());
      }
      return;
    }
    workers_.for_each(count, 1, [&](std::size_t k) { use(k, workspace()); });
  }

 private:
  int threads_;
  Workers workers_;
  tbb::enumerable_thread_specific<Workspace> workspaces_;
};

}  // namespace firstcontact::detail
