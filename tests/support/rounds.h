/// @file
/// Number of cases of a test.

#pragma once

namespace firstcontact::test {

/// Returns the number of cases that a test tries; fewer where sanitizers make it slow.
///
/// A sanitizer checks how each case is computed. The optimised run tries all cases.
constexpr int rounds(int optimised, int sanitized) {
  return FIRSTCONTACT_SANITIZED ? sanitized : optimised;
}

}  // namespace firstcontact::test
