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
/// @param scene    Has the duration and how files are read.
/// @param digests  Takes the digest of what was read.
/// @param loaded   Takes the account of a file.
/// @throws ParseError if a file cannot be used, or has another number of vertices than move
DeformingBody load_body(const Body& body, const Scene& scene, ShapeCache& cache,
                        std::string& digests, LoadedScene& loaded);

}  // namespace firstcontact::detail
