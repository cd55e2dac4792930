#include <firstcontact/parallel/parallel_for.h>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/parallel/detail/workers.h>

namespace firstcontact {

void parallel_for(int threads, std::size_t count, const std::function<void(std::size_t)>& use) {
  if (threads != 1 && count > 1) {
    detail::Workers(threads).for_each(count, 1, use);
    return;
  }
  const FloatEnvironmentGuard guard;
  for (std::size_t k = 0; k < count; ++k) {
    use(k);
  }
}

}  // namespace firstcontact
