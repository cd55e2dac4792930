/// @file
/// Warnings of bodies that begin at an unlikely place.

#pragma once

namespace firstcontact {
class ShapeCache;
struct LoadedScene;
}  // namespace firstcontact

namespace firstcontact::detail {

/// Warns of tested bodies and links that begin inside of a closed mesh that is a surface.
///
/// Only the triangles of such a mesh can touch.
///
/// @param cache  cache of the scene's shapes; remembers which of them are closed
void warn_of_begins_inside(LoadedScene& loaded, ShapeCache& cache);

}  // namespace firstcontact::detail
