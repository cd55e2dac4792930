#include <firstcontact/record/detail/scene_digest.h>

#include <variant>

#include <firstcontact/text/json_tree.h>
#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/sha256.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {

std::string digest_of_scene(std::string_view scene) {
  return sha256(write_json(parse_json(scene, "scene", 1)));
}

std::string digest_of_scene_in(std::string_view line) {
  const JsonValue header = parse_json(line, "header", 1);
  return sha256(write_json(*find(std::get<JsonObject>(header.value), "scene")));
}

}  // namespace firstcontact::detail
