/// @file
/// The gap of a scene as a curve for a plot.

#pragma once

#include <stop_token>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/scene/sample_gap.h>

namespace firstcontact {

struct LoadedScene;
struct SceneResult;

/// [-]  The time that a plot shows in detail: the contact, or else the closest approach.
[[nodiscard]] FIRSTCONTACT_API double time_of_interest(const SceneResult& result);

/// Samples over the whole step, few where the curve is straight and many where it bends.
///
/// @param focus  [-]  a time that is among the samples, such as that of a contact
/// @param stop   ends the sampling early, with fewer samples
[[nodiscard]] FIRSTCONTACT_API std::vector<GapSample> gap_curve(const LoadedScene& loaded,
                                                                double focus,
                                                                const std::stop_token& stop = {});

}  // namespace firstcontact
