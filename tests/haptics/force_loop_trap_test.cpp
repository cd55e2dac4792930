// The force loop allocates nothing, takes no lock and makes no system call. The traps are those of
// the whole program, so it is a program of its own.

#include <dlfcn.h>
#include <pthread.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <new>

#include <linux/seccomp.h>

#include <gtest/gtest.h>

#include <firstcontact/haptic_devices/mail_slot.h>
#include <firstcontact/haptic_sessions/detail/target_lead.h>
#include <firstcontact/haptic_sessions/detail/tick_ring.h>
#include <firstcontact/haptics/contact_loop.h>
#include <firstcontact/haptics/force_loop.h>

#include "haptics/grip_scenes.h"
#include "haptics/haptic_scenes.h"

// Sanitizers have their own functions; the names behind them are those of glibc.
#if !FIRSTCONTACT_SANITIZED && defined(__GLIBC__)
#define FIRSTCONTACT_TRAPS_MALLOC 1
#else
#define FIRSTCONTACT_TRAPS_MALLOC 0
#endif

namespace {

std::atomic<long> allocations{0};
std::atomic<long> locks{0};

}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) {
    return memory;
  }
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t& /*unused*/) noexcept {
  ++allocations;
  return std::malloc(size);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  const auto unit = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(unit, (size + unit - 1) / unit * unit)) {
    return memory;
  }
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment,
                   const std::nothrow_t& /*unused*/) noexcept {
  ++allocations;
  const auto unit = static_cast<std::size_t>(alignment);
  return std::aligned_alloc(unit, (size + unit - 1) / unit * unit);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

#if !FIRSTCONTACT_SANITIZED    // Sanitizers have their own.
#if FIRSTCONTACT_TRAPS_MALLOC  // Eigen and libraries of C allocate by these.
// NOLINTBEGIN(bugprone-reserved-identifier): names under which glibc has its own.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) noexcept {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) noexcept {
  ++allocations;
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  ++allocations;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  ++allocations;
  *memory = __libc_memalign(alignment, size);
  return *memory != nullptr ? 0 : ENOMEM;
}
}
// NOLINTEND(bugprone-reserved-identifier)
#endif

extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  using Lock = int (*)(pthread_mutex_t*);
  static const auto lock = reinterpret_cast<Lock>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  ++locks;
  return lock(mutex);
}
#endif

namespace firstcontact {
namespace {

/// A cube pressed on a floor with friction, and ticks of it by new sets of contacts.
class PressedCube {
 public:
  explicit PressedCube(double friction = 0.4)
      : contacts_(cube_on_floor(friction)), forces_(contacts_.scene(), {{}}), lead_({}) {
    Pose below = contacts_.pose(0);
    below.position.z() = 0.0;
    for (int k = 0; k < 5; ++k) {
      (void)contacts_.advance(std::array{below}, 1e-3, 0);
    }
    set_ = contacts_.contact_set();
  }

  /// Makes ticks as the thread of a session on the wall does: from the set to the next cycle's
  /// target, and to the caller's ring.
  ///
  /// @returns  the ticks at which something pressed
  int ticks(int count) {
    int pressed = 0;
    DeviceState device;
    device.status = DeviceStatus::live;
    for (int k = 0; k < count; ++k) {
      now_ += 250'000;
      device.X_DH.position = {1e-3 * std::sin(0.01 * k), 0.0, -0.012 + 4e-3 * std::sin(0.003 * k)};
      device.time_ns = now_;
      ++device.sequence;
      set_.sequence += 1;
      set_.stamp_ns = now_;
      slot_.put(set_);
      const HapticContactSet& newest = slot_.newest();
      const ForceTick& tick = forces_.tick(now_, newest, std::array{device});
      pressed += tick.pressing > 0 ? 1 : 0;
      lead_.watch(now_, tick.tools[0]);
      const double seconds = detail::is_rubbing(newest, 0) ? 0.0 : 1e-3;
      led_ += lead_.target_in(seconds).position != tick.tools[0].target.position ? 1 : 0;
      ring_.push(tick);  // Drops ticks once it is full, as where the caller is slow.
    }
    return pressed;
  }

  /// The ticks at which the target was extrapolated.
  [[nodiscard]] int led() const { return led_; }
  /// The ticks that the ring dropped.
  [[nodiscard]] std::uint64_t dropped() const { return ring_.dropped(); }

 private:
  ContactLoop contacts_;
  ForceLoop forces_;
  detail::TargetLead lead_;
  detail::TickRing<ForceTick> ring_{256};
  HapticContactSet set_;
  MailSlot<HapticContactSet> slot_;
  int led_ = 0;
  std::int64_t now_ = 0;
};

/// Jaws that hold a cube, and ticks of it.
class HoldingJaws {
 public:
  HoldingJaws() : contacts_(scene()), forces_(contacts_.scene(), {one_grip(kJawWay)}) {
    for (int k = 0; k < 5; ++k) {
      (void)contacts_.advance({.poses = std::array{Pose{}}, .joints = std::array{0.03, 0.03}}, 1e-3,
                              0);
    }
    set_ = contacts_.contact_set();
  }

  /// @returns  the ticks at which the hand felt its grip
  int ticks(int count) {
    int felt = 0;
    DeviceState device;
    device.status = DeviceStatus::live;
    for (int k = 0; k < count; ++k) {
      now_ += 250'000;
      device.grips[0] = 0.7 + 0.2 * std::sin(0.01 * k);
      set_.sequence += 1;
      set_.stamp_ns = now_;
      const ForceTick& tick = forces_.tick(now_, set_, std::array{device});
      felt += tick.tools[0].command.grips[0] < 0.0 ? 1 : 0;
    }
    return felt;
  }

 private:
  static HapticScene scene() {
    HapticScene made;
    made.tools.push_back(jaws(0.5));
    made.bodies.push_back(body_at("cube", make_box({0.03, 0.03, 0.03}), {0.0, 0.0, -0.05}, 0.5));
    return made;
  }

  ContactLoop contacts_;
  ForceLoop forces_;
  HapticContactSet set_;
  std::int64_t now_ = 0;
};

TEST(ForceLoop, AllocatesNothingForFingers) {
  HoldingJaws jaws_on_cube;
  const long before = allocations;
  const int felt = jaws_on_cube.ticks(2000);
  EXPECT_EQ(allocations, before);
  EXPECT_GT(felt, 500);
}

TEST(ForceLoop, AllocatesNothing) {
  const long before_all = allocations;
  PressedCube cube;
  EXPECT_GT(allocations, before_all);  // The counter counts.
  const long before = allocations;
  const int pressed = cube.ticks(2000);
  EXPECT_EQ(allocations, before);
  EXPECT_GT(pressed, 1000);
}

TEST(ForceLoop, AllocatesNothingForTheLeadAndTheRing) {
  PressedCube cube(0.0);  // A tool with friction has no lead.
  const long before = allocations;
  (void)cube.ticks(2000);
  EXPECT_EQ(allocations, before);
  EXPECT_GT(cube.led(), 1000);
  EXPECT_GT(cube.dropped(), 1000U);
}

// The counter counts each way to memory.
TEST(AllocationTrap, CountsEveryKindOfAllocation) {
  struct alignas(64) Wide {
    double number = 0.0;
  };
  const auto counts = [](auto allocate, auto release) {
    const long before = allocations;
    void* volatile memory = allocate();  // Volatile, or the compiler leaves the pair out.
    const long counted = allocations - before;
    release(memory);
    return counted > 0;
  };
  EXPECT_TRUE(counts([] { return new double(); },
                     [](void* memory) { delete static_cast<double*>(memory); }));
  EXPECT_TRUE(
      counts([] { return new Wide(); }, [](void* memory) { delete static_cast<Wide*>(memory); }));
#if FIRSTCONTACT_TRAPS_MALLOC
  EXPECT_TRUE(counts([] { return std::malloc(8); }, [](void* memory) { std::free(memory); }));
  EXPECT_TRUE(counts([] { return std::calloc(2, 8); }, [](void* memory) { std::free(memory); }));
  EXPECT_TRUE(
      counts([] { return std::realloc(nullptr, 8); }, [](void* memory) { std::free(memory); }));
  EXPECT_TRUE(
      counts([] { return std::aligned_alloc(64, 64); }, [](void* memory) { std::free(memory); }));
#endif
}

#if !FIRSTCONTACT_SANITIZED
TEST(ForceLoop, TakesNoLock) {
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  const long before_all = locks;
  pthread_mutex_lock(&mutex);
  pthread_mutex_unlock(&mutex);
  EXPECT_GT(locks, before_all);  // The counter counts.
  PressedCube cube;
  const long before = locks;
  (void)cube.ticks(500);
  EXPECT_EQ(locks, before);
}

/// Runs `work` in a process of its own that is killed by any system call but exit.
template <class Work>
bool survives_without_system_calls(Work work) {
  const pid_t child = fork();
  if (child == 0) {
    if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_STRICT) != 0) {
      _exit(3);
    }
    work();
    syscall(SYS_exit, 0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 3) {
    return false;  // The kernel has no such trap; see the test.
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

TEST(ForceLoop, MakesNoSystemCall) {
  PressedCube cube;
  (void)cube.ticks(10);
  EXPECT_TRUE(survives_without_system_calls([&] { (void)cube.ticks(500); }));
  EXPECT_FALSE(survives_without_system_calls([] { (void)getppid(); }));  // The trap traps.
}
#endif

}  // namespace
}  // namespace firstcontact
