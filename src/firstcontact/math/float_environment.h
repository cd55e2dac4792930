/// @file
/// The floating-point environment that the proofs assume, kept for a scope.

#pragma once

#include <cfenv>
#include <cstdint>

#include <firstcontact/math/export.h>

namespace firstcontact {

#if defined(__x86_64__)
namespace detail {

/// Control registers of the SSE and the x87 unit.
struct FloatControl {
  std::uint32_t sse = 0;
  std::uint16_t x87 = 0;
};

}  // namespace detail
#endif

/// For its scope: round to nearest, gradual underflow (no flush to zero, no denormals as zero),
/// full x87 precision, all exceptions masked. Whatever the host had set comes back at the end.
///
/// The environment belongs to the calling thread: every worker thread makes its own guard. The
/// host's sticky exception flags come back as they were, so nothing that the library raises can
/// leak; with the x87 unit, which only `long double` uses, flags are left alone. Costs some
/// nanoseconds. Compilers may move arithmetic past the register writes, so guard a function and
/// compute in the functions that it calls.
class FIRSTCONTACT_API FloatEnvironmentGuard {
 public:
  FloatEnvironmentGuard() noexcept;
  ~FloatEnvironmentGuard();
  FloatEnvironmentGuard(const FloatEnvironmentGuard&) = delete;
  FloatEnvironmentGuard& operator=(const FloatEnvironmentGuard&) = delete;

 private:
#if defined(__x86_64__)
  detail::FloatControl host_;
#else
  std::fenv_t host_;
#endif
};

}  // namespace firstcontact
