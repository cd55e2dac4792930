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
#include <cmath>
#include <cstdlib>
#include <new>

#include <linux/seccomp.h>

#include <gtest/gtest.h>

#include <firstcontact/haptic_devices/mail_slot.h>
#include <firstcontact/haptics/contact_loop.h>
#include <firstcontact/haptics/force_loop.h>

#include "haptics/grip_scenes.h"
#include "haptics/haptic_scenes.h"

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
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

#if !FIRSTCONTACT_SANITIZED  // Sanitizers have their own.
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
  PressedCube() : contacts_(cube_on_floor(0.4)), forces_(contacts_.scene(), {{}}) {
    Pose below = contacts_.pose(0);
    below.position.z() = 0.0;
    for (int k = 0; k < 5; ++k) {
      (void)contacts_.advance(std::array{below}, 1e-3, 0);
    }
    set_ = contacts_.contact_set();
  }

  /// @returns  the ticks at which something pressed
  int ticks(int count) {
    int pressed = 0;
    DeviceState device;
    device.status = DeviceStatus::live;
    for (int k = 0; k < count; ++k) {
      now_ += 250'000;
      device.X_DH.position = {1e-3 * std::sin(0.01 * k), 0.0, -0.012 + 4e-3 * std::sin(0.003 * k)};
      set_.sequence += 1;
      set_.stamp_ns = now_;
      slot_.put(set_);
      pressed += forces_.tick(now_, slot_.newest(), std::array{device}).pressing > 0 ? 1 : 0;
    }
    return pressed;
  }

 private:
  ContactLoop contacts_;
  ForceLoop forces_;
  HapticContactSet set_;
  MailSlot<HapticContactSet> slot_;
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
