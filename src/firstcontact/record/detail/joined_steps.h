/// @file
/// Two parts of a step as one.

#pragma once

#include <firstcontact/record/run_step.h>

namespace firstcontact::detail {

/// Joins the records of a part of a step and of the part after it, under the number of the first.
///
/// The joint step has the pieces, impacts and events of both, and the states and contacts at the
/// end of the second. Impulses of contacts are summed up; those of pairs that parted become
/// impacts. Forces of motors and ties are means over both.
[[nodiscard]] RunStep joined(RunStep first, RunStep second);

}  // namespace firstcontact::detail
