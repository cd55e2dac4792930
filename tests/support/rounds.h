/// @file
/// How much a test asks.

#pragma once

namespace firstcontact::test {

/// How many cases a test tries: fewer where sanitizers, which look at how each is answered, make it
/// slow. The optimised run tries them all.
constexpr int rounds(int optimised, int sanitized) {
  return FIRSTCONTACT_SANITIZED ? sanitized : optimised;
}

}  // namespace firstcontact::test
