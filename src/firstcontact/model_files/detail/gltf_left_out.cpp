#include <firstcontact/model_files/detail/gltf_left_out.h>

#include <array>
#include <string_view>
#include <variant>

namespace firstcontact::detail {
namespace {

struct Kind {
  std::string_view key;
  std::string_view name;
  std::string_view reason;
};

constexpr auto kKinds = std::to_array<Kind>({
    {"animations", "animation", "animation; the nodes' own pose is read"},
    {"cameras", "camera", "looks"},
    {"images", "image", "looks"},
    {"materials", "material", "looks"},
    {"samplers", "sampler", "looks"},
    {"textures", "texture", "looks"},
});

}  // namespace

void note_left_out(const GltfDocument& document, const std::vector<bool>& used) {
  for (const Kind& kind : kKinds) {
    const JsonValue* const value = find(document.root(), kind.key);
    const auto* const elements = value == nullptr ? nullptr : std::get_if<JsonArray>(&value->value);
    if (elements != nullptr && !elements->empty()) {
      document.log().leave_out(kind.name, kind.reason, elements->size());
    }
  }
  for (const bool is_used : used) {
    if (!is_used) {
      document.log().leave_out("mesh", "no node of the scene has it");
    }
  }
}

}  // namespace firstcontact::detail
