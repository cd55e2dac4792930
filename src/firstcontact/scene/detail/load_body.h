/// @file
/// Makes a body of a scene ready for queries.

#pragma once

#include <string>

#include <firstcontact/geometry/deforming_body.h>

namespace firstcontact {
class ShapeCache;
struct Body;
struct LoadedScene;
struct Scene;
}  // namespace firstcontact

namespace firstcontact::detail {

/// Loads the shape of a body and normalises its motion; a body whose vertices move deforms.
///
/// @param scene    has the duration and the options of reading
/// @param digests  receives the digest of the file
/// @param loaded   receives the report on the file
/// @throws ParseError if a file cannot be used, or has another number of vertices than move
DeformingBody load_body(const Body& body, const Scene& scene, ShapeCache& cache,
                        std::string& digests, LoadedScene& loaded);

}  // namespace firstcontact::detail
