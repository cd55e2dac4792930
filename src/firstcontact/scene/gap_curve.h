/// @file
/// The gap of a scene as a curve for a plot.

#pragma once

#include <stop_token>
#include <vector>

#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/sample_gap.h>

namespace firstcontact::app {

/// Samples over the whole step, few where the curve is straight and many where it bends.
///
/// @param focus  [-]  a time that is among them, such as that of a contact
[[nodiscard]] std::vector<GapSample> gap_curve(const LoadedScene& loaded, double focus,
                                               const std::stop_token& stop);

}  // namespace firstcontact::app
