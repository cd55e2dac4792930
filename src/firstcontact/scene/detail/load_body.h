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

/// Loads the shape of a body and normalises its motion; one whose vertices move deforms.
///
/// @param scene    has the duration and how files are read
/// @param digests  the digest of what was read is added to it
/// @param loaded   the account of a file is added to it
/// @throws ParseError if a file cannot be used, or has another number of vertices than move
DeformingBody load_body(const Body& body, const Scene& scene, ShapeCache& cache,
                        std::string& digests, LoadedScene& loaded);

}  // namespace firstcontact::detail
