/// @file
/// Warnings of what looks wrong where a scene begins.

#pragma once

#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>

namespace firstcontact::detail {

/// Warns of tested bodies and links that begin inside of a closed mesh that is a surface, as only
/// its triangles can touch.
///
/// @param cache  of the scene's shapes; remembers which of them are closed
void warn_of_begins_inside(LoadedScene& loaded, ShapeCache& cache);

}  // namespace firstcontact::detail
