/// @file
/// The meaning of the extensions of glTF for this reader, by their names.

#pragma once

#include <string_view>

namespace firstcontact::detail {

/// The effect that an extension may have on a body.
enum class GltfMeaning {
  understood,  ///< It is read.
  harmless,    ///< It can make no contact and move none: it is left out.
  compressed,  ///< It holds geometry in a form that is not read; the plain form may stand beside
               ///< it.
  geometry,    ///< It holds, places or hides geometry, and is not read.
  unknown,     ///< Its meaning is not known.
};

/// The meaning of an extension, and its topic.
struct GltfExtension {
  GltfMeaning meaning = GltfMeaning::unknown;
  std::string_view reason;  ///< Its topic: "looks", "shapes of a simulator".
};

/// Finds the meaning of an extension.
[[nodiscard]] GltfExtension gltf_extension(std::string_view name);

}  // namespace firstcontact::detail
