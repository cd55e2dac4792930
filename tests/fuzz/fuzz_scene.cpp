#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_scene.h>
#include <firstcontact/text/parse_error.h>

#include "fuzz/fuzz_reader.h"
#include "scene/scene_bits.h"

namespace {

using firstcontact::test::require;
using firstcontact::test::SceneBits;

/// Requires that a scene that was read is written and read back unchanged.
void require_round_trip(const firstcontact::Scene& scene) {
  try {
    const std::string written = firstcontact::write_scene(scene);
    require(SceneBits(firstcontact::parse_scene(written, "written")) == SceneBits(scene));
  } catch (const firstcontact::ParseError&) {
    require(false);
  }
}

/// Any bytes give a scene, or a ParseError of one line. Its folder is in the corpus, so that the
/// meshes that it names are found.
void fuzz_scene(std::string_view text) {
  firstcontact::Scene scene;
  try {
    scene = firstcontact::parse_scene(text, FIRSTCONTACT_FUZZ_CORPUS "/good/scene.json");
  } catch (const firstcontact::ParseError& error) {
    require(std::strchr(error.what(), '\n') == nullptr);
    return;
  }
  require(!scene.bodies.empty() || !scene.robots.empty());
  require_round_trip(scene);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz_scene({reinterpret_cast<const char*>(data), size});
  return 0;
}
