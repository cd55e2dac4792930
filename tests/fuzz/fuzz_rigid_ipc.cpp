#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include <firstcontact/foreign_scenes/read_rigid_ipc.h>
#include <firstcontact/scene_files/write_scene.h>
#include <firstcontact/text/parse_error.h>

#include "fuzz/fuzz_reader.h"

namespace {

using firstcontact::test::require;

/// Any bytes give a scene that can be written, or a ParseError of one line. Its folder is the
/// corpus, so that the meshes that it names are found.
void fuzz_rigid_ipc(std::string_view text) {
  firstcontact::Scene scene;
  try {
    scene = firstcontact::parse_rigid_ipc(text, FIRSTCONTACT_FUZZ_CORPUS "/scene.json");
  } catch (const firstcontact::ParseError& error) {
    require(std::strchr(error.what(), '\n') == nullptr);
    return;
  }
  require(scene.simulation.has_value());
  require(!scene.bodies.empty());
  for (const firstcontact::Body& body : scene.bodies) {
    require(!body.free || !body.free->inertia || body.free->inertia->allFinite());
  }
  require(!firstcontact::write_scene(scene).empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz_rigid_ipc({reinterpret_cast<const char*>(data), size});
  return 0;
}
