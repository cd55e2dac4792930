/// @file
/// Samples the gap on all processors.

#pragma once

#include <span>
#include <stop_token>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/scene/sample_gap.h>

namespace firstcontact {

struct LoadedScene;

/// Samples the gap as sample_gap() does.
///
/// Distances are the same for every number of processors, proven bounds up to their last digits. A
/// stop leaves samples out.
[[nodiscard]] FIRSTCONTACT_API std::vector<GapSample> sample_in_parallel(
    const LoadedScene& loaded, std::span<const double> times, const std::stop_token& stop = {});

}  // namespace firstcontact
