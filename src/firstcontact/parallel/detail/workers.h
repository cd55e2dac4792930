/// @file
/// The threads of a query over many bodies.

#pragma once

#include <algorithm>
#include <cstddef>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <firstcontact/math/float_environment.h>

namespace firstcontact::detail {

class Workers {
 public:
  /// @param threads  at most; 0 for one on each core
  explicit Workers(int threads) : arena_(usable(threads)) {}

  /// Calls use(k) for each k below count; each thread takes at least `grain` of them.
  template <class Use>
  void for_each(std::size_t count, std::size_t grain, const Use& use) {
    arena_.execute([&] {
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                        [&](const tbb::blocked_range<std::size_t>& range) {
                          const FloatEnvironmentGuard guard;
                          for (std::size_t k = range.begin(); k < range.end(); ++k) {
                            use(k);
                          }
                        });
    });
  }

 private:
  /// The number of threads, at most what TBB may have; it complains about more.
  static int usable(int asked) {
    const auto most = static_cast<int>(
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
    return asked > 0 ? std::min(asked, most) : most;
  }

  tbb::task_arena arena_;
};

}  // namespace firstcontact::detail
