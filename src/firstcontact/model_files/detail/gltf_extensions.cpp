#include <firstcontact/model_files/detail/gltf_extensions.h>

#include <algorithm>
#include <array>

namespace firstcontact::detail {
namespace {

struct Known {
  std::string_view name;  ///< The beginning of the name, where it ends in '_'.
  GltfMeaning meaning;
  std::string_view reason;
};

constexpr auto kUnderstood = GltfMeaning::understood;
constexpr auto kHarmless = GltfMeaning::harmless;
constexpr auto kCompressed = GltfMeaning::compressed;
constexpr auto kGeometry = GltfMeaning::geometry;

/// The known extensions; the first that fits holds.
constexpr auto kKnown = std::to_array<Known>({
    {"KHR_mesh_quantization", kUnderstood, "integer coordinates"},
    {"EXT_mesh_gpu_instancing", kUnderstood, "instances"},
    {"KHR_node_visibility", kUnderstood, "looks"},
    {"KHR_draco_mesh_compression", kCompressed, "compressed geometry"},
    {"EXT_meshopt_compression", kCompressed, "compressed geometry"},
    {"KHR_meshopt_compression", kCompressed, "compressed geometry"},
    {"KHR_materials_displacement", kGeometry, "a surface that its material moves"},
    {"KHR_materials_", kHarmless, "looks"},
    {"EXT_materials_", kHarmless, "looks"},
    {"ADOBE_materials_", kHarmless, "looks"},
    {"KHR_texture_", kHarmless, "looks"},
    {"EXT_texture_", kHarmless, "looks"},
    {"MSFT_texture_", kHarmless, "looks"},
    {"MSFT_packing_", kHarmless, "looks"},
    {"KHR_techniques_webgl", kHarmless, "looks"},
    {"KHR_blend", kHarmless, "looks"},
    {"CESIUM_primitive_outline", kHarmless, "looks"},
    {"KHR_lights_", kHarmless, "lights"},
    {"EXT_lights_", kHarmless, "lights"},
    {"KHR_lights", kHarmless, "lights"},
    {"KHR_xmp", kHarmless, "notes about the file"},
    {"KHR_xmp_json_ld", kHarmless, "notes about the file"},
    {"AGI_stk_metadata", kHarmless, "notes about the file"},
    {"EXT_structural_metadata", kHarmless, "notes about features"},
    {"EXT_mesh_features", kHarmless, "notes about features"},
    {"EXT_instance_features", kHarmless, "notes about features"},
    {"EXT_feature_metadata", kHarmless, "notes about features"},
    {"FB_geometry_metadata", kHarmless, "notes about sizes"},
    {"KHR_animation_pointer", kHarmless, "animation"},
    {"KHR_audio", kHarmless, "sounds"},
    {"KHR_audio_", kHarmless, "sounds"},
    {"MSFT_audio_emitter", kHarmless, "sounds"},
    {"OMI_audio_emitter", kHarmless, "sounds"},
    {"KHR_node_selectability", kHarmless, "what a user may point at"},
    {"KHR_node_hoverability", kHarmless, "what a user may point at"},
    {"MSFT_lod", kHarmless, "coarser copies of what is there"},
    {"EXT_mesh_manifold", kHarmless, "the same triangles once more"},
    {"KHR_implicit_shapes", kGeometry, "shapes of a simulator"},
    {"KHR_collision_shapes", kGeometry, "shapes of a simulator"},
    {"KHR_rigid_bodies", kGeometry, "bodies of a simulator"},
    {"KHR_physics_", kGeometry, "bodies of a simulator"},
    {"MSFT_physics", kGeometry, "bodies of a simulator"},
    {"MSFT_rigid_bodies", kGeometry, "bodies of a simulator"},
    {"MSFT_collision_primitives", kGeometry, "shapes of a simulator"},
    {"OMI_physics_", kGeometry, "bodies of a simulator"},
    {"OMI_collider", kGeometry, "shapes of a simulator"},
    {"CESIUM_RTC", kGeometry, "an offset of all positions"},
    {"KHR_gaussian_splatting", kGeometry, "a cloud of splats"},
    {"AGI_articulations", kGeometry, "joints that place nodes"},
});

bool fits(std::string_view name, const Known& known) {
  return known.name.ends_with('_') ? name.starts_with(known.name) : name == known.name;
}

}  // namespace

GltfExtension gltf_extension(std::string_view name) {
  const auto* const found = std::find_if(kKnown.begin(), kKnown.end(),
                                         [&](const Known& known) { return fits(name, known); });
  return found == kKnown.end() ? GltfExtension{} : GltfExtension{found->meaning, found->reason};
}

}  // namespace firstcontact::detail
