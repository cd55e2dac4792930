#include <firstcontact/math/float_environment.h>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace firstcontact {

#if defined(__x86_64__)

namespace {

// Intel SDM volume 1, sections 8.1.5 and 10.2.3: all exceptions masked, round to nearest. For x87
// 64-bit precision; for SSE neither flush to zero nor denormals as zero.
constexpr std::uint32_t kSseControl = 0x1F80;
constexpr std::uint16_t kX87Control = 0x037F;

std::uint16_t x87_control() {
  std::uint16_t control = 0;
  __asm__ volatile("fnstcw %0" : "=m"(control));
  return control;
}

void set_x87_control(std::uint16_t control) { __asm__ volatile("fldcw %0" : : "m"(control)); }

}  // namespace

FloatEnvironmentGuard::FloatEnvironmentGuard() noexcept : host_{_mm_getcsr(), x87_control()} {
  if (host_.sse != kSseControl) {
    _mm_setcsr(kSseControl);
  }
  if (host_.x87 != kX87Control) {
    set_x87_control(kX87Control);
  }
}

FloatEnvironmentGuard::~FloatEnvironmentGuard() {
  _mm_setcsr(host_.sse);
  if (host_.x87 != kX87Control) {
    set_x87_control(host_.x87);
  }
}

#else

FloatEnvironmentGuard::FloatEnvironmentGuard() noexcept {
  std::fegetenv(&host_);
  std::fesetenv(FE_DFL_ENV);
}

FloatEnvironmentGuard::~FloatEnvironmentGuard() { std::fesetenv(&host_); }

#endif

}  // namespace firstcontact
