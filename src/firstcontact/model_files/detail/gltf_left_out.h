/// @file
/// The parts of a glTF document beside geometry.

#pragma once

#include <vector>

#include <firstcontact/model_files/detail/gltf_document.h>

namespace firstcontact::detail {

/// Notes the left-out parts of a document: looks, cameras, animations, meshes that nothing places.
///
/// @param used  for each mesh, whether a node of the scene has it
void note_left_out(const GltfDocument& document, const std::vector<bool>& used);

}  // namespace firstcontact::detail
