/// @file
/// The same work for many indices, on several threads.

#pragma once

#include <cstddef>
#include <functional>

#include <firstcontact/math/export.h>

namespace firstcontact {

/// Calls use(k) once for each k below count, in any order, on several threads.
///
/// Calls have the floating-point environment that queries need. The function returns when all calls
/// have returned; an exception of one ends the rest.
///
/// @param threads  at most; 0 for one on each core
FIRSTCONTACT_API void parallel_for(int threads, std::size_t count,
                                   const std::function<void(std::size_t)>& use);

}  // namespace firstcontact
