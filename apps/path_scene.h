/// @file
/// The comparison of a planned path with the scene file that it is said to be of.

#pragma once

#include <string>
#include <vector>

#include <firstcontact/scene/planned_path.h>

#include "proof.h"

namespace firstcontact::app {

/// Requires that a path was planned in the scene file of `--scene` as it is now.
///
/// Compared are the movers, their start, the goals, contact pairs and the whole resolved scene.
/// Margin and tolerance may be options of the command that planned the path; a warning names a
/// difference. The error names the first key or file that differs.
///
/// @param text  of the path file
/// @returns     warnings
/// @throws ParseError
std::vector<std::string> require_scene_of_path(const ProofArguments& arguments,
                                               const std::string& text, const PlannedPath& path);

}  // namespace firstcontact::app
