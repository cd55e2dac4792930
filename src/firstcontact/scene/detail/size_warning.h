/// @file
/// Sizes so large or so small that their unit is likely to be a wrong one.

#pragma once

namespace firstcontact {
struct LoadedScene;
}

namespace firstcontact::detail {

/// Warns of sizes, compared with each other, once for each body, link or scene.
/// - Meshes of 1,000 m and more across, and links of more than 100 m.
/// - Meshes of files of 100 m and more, where they are 100 times as large as the next smaller body
///   or robot, or where everything is as large.
/// - Scenes in which nothing is as large as the tolerance.
///
/// Shapes whose size stands in the scene may have any size, and so may clouds and height maps.
void warn_of_sizes(LoadedScene& loaded);

}  // namespace firstcontact::detail
