#include <firstcontact/query/parallel_for.h>

#include <firstcontact/query/detail/workers.h>

namespace firstcontact {

void parallel_for(int threads, std::size_t count, const std::function<void(std::size_t)>& use) {
  detail::Workers(threads).for_each(count, 1, use);
}

}  // namespace firstcontact
