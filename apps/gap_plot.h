/// @file
/// The gap of a scene over time as a picture (SVG).

#pragma once

#include <string>
#include <string_view>

#include "scene_answer.h"

namespace firstcontact::app {

/// Draws the curve of an answer, its samples, and the proven bounds.
///
/// @param title  title of the picture
[[nodiscard]] std::string gap_plot(std::string_view title, const SceneAnswer& answer);

}  // namespace firstcontact::app
