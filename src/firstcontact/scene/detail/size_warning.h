/// @file
/// Sizes so large or so small that their unit is likely to be a wrong one.

#pragma once

namespace firstcontact {
struct LoadedScene;
}

namespace firstcontact::detail {

/// Warns of sizes, judged beside each other, once for each body, link or scene.
/// - meshes of 1,000 m and more across, and links of more than 100 m;
/// - meshes of files of 100 m and more, where they are 100 times as large as the next smaller body
///   or robot, or where everything is as large;
/// - scenes in which nothing is as large as the tolerance.
///
/// Any size is meant in shapes whose size stands in the scene, in clouds and in height maps.
void warn_of_sizes(LoadedScene& loaded);

}  // namespace firstcontact::detail
