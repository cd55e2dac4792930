/// @file
/// Two parts of a step as one.

#pragma once

#include <firstcontact/record/run_step.h>

namespace firstcontact::detail {

/// What was recorded of a part of a step and of the part after it, as one step of the first's
/// number.
///
/// Pieces, impacts and events of both; states and contacts at the end of the second. Impulses of
/// contacts are summed; those of pairs that parted are impacts. Forces of motors and ties are means
/// over both.
[[nodiscard]] RunStep joined(RunStep first, RunStep second);

}  // namespace firstcontact::detail
