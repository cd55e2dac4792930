#include <firstcontact/haptic_sessions/detail/real_time.h>

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

namespace firstcontact::detail {

bool take_real_time_priority(int priority) noexcept {
  sched_param wanted{};
  wanted.sched_priority = priority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted) == 0;
}

bool bind_to_processor(int number) noexcept {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  if (pthread_getaffinity_np(pthread_self(), sizeof allowed, &allowed) != 0) {
    return false;
  }
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(cpu, &allowed) && number-- == 0) {
      cpu_set_t one;
      CPU_ZERO(&one);
      CPU_SET(cpu, &one);
      return pthread_setaffinity_np(pthread_self(), sizeof one, &one) == 0;
    }
  }
  return false;
}

bool lock_memory() noexcept { return mlockall(MCL_CURRENT | MCL_FUTURE) == 0; }
void unlock_memory() noexcept { (void)munlockall(); }

}  // namespace firstcontact::detail
