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

/// A guard of the floating-point environment for its scope.
///
/// In the scope the unit rounds to nearest, x87 precision is full and all exceptions are masked.
/// Underflow is gradual: no flush to zero, no denormals as zero. At the end the host's settings
/// come back.
///
/// The environment belongs to the calling thread: every worker thread makes its own guard. The
/// host's sticky exception flags come back as they were, so no exception of the library leaks. With
/// the x87 unit, which only `long double` uses, flags are left alone. The cost is some nanoseconds.
/// Compilers may move arithmetic past the register writes. So guard a function and compute in the
/// functions that it calls.
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
