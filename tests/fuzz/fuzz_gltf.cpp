#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/model_files/detail/parse_gltf.h>
#include <firstcontact/text/reading_log.h>

#include "fuzz/fuzz_reader.h"
#include "fuzz/glb_file.h"
#include "fuzz/mutate_json.h"
#include "fuzz/small_stack.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

using firstcontact::test::GlbFile;

const std::vector<std::string_view>& words() {
  static const std::vector<std::string_view> words = {"accessors",
                                                      "attributes",
                                                      "buffer",
                                                      "bufferView",
                                                      "bufferViews",
                                                      "buffers",
                                                      "byteLength",
                                                      "byteOffset",
                                                      "byteStride",
                                                      "children",
                                                      "componentType",
                                                      "count",
                                                      "extensions",
                                                      "extensionsRequired",
                                                      "extensionsUsed",
                                                      "EXT_mesh_gpu_instancing",
                                                      "indices",
                                                      "inverseBindMatrices",
                                                      "joints",
                                                      "JOINTS_0",
                                                      "JOINTS_1",
                                                      "KHR_draco_mesh_compression",
                                                      "KHR_mesh_quantization",
                                                      "KHR_node_visibility",
                                                      "matrix",
                                                      "mesh",
                                                      "meshes",
                                                      "mode",
                                                      "nodes",
                                                      "normalized",
                                                      "POSITION",
                                                      "primitives",
                                                      "rotation",
                                                      "ROTATION",
                                                      "scale",
                                                      "SCALE",
                                                      "scene",
                                                      "scenes",
                                                      "skin",
                                                      "skins",
                                                      "sparse",
                                                      "targets",
                                                      "translation",
                                                      "TRANSLATION",
                                                      "type",
                                                      "uri",
                                                      "values",
                                                      "weights",
                                                      "WEIGHTS_0",
                                                      "WEIGHTS_1",
                                                      "extras",
                                                      "name"};
  return words;
}

/// Reads strictly and leniently, with a report that can be finished or an error of one line.
void read(std::string_view bytes) {
  for (const bool lenient : {false, true}) {
    const auto parse = [&](std::string_view text, const char* source) {
      firstcontact::detail::ReadingLog log(source, "glTF", {.lenient = lenient});
      firstcontact::Mesh mesh =
          firstcontact::detail::parse_gltf(text, source, log, {.most_placed = 1u << 16});
      static_cast<void>(log.finish());
      return mesh;
    };
    firstcontact::test::fuzz_reader(parse, reinterpret_cast<const std::uint8_t*>(bytes.data()),
                                    bytes.size());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  read({reinterpret_cast<const char*>(data), size});
  return 0;
}

/// Three of four mutations are of the document or of the buffer, and leave the container whole.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  std::mt19937 random(seed);
  auto file = firstcontact::test::split({reinterpret_cast<const char*>(data), size});
  const unsigned kind = random() % 8;
  if (!file || kind < 2) {
    return LLVMFuzzerMutate(data, size, most);
  }
  if (kind < 4 && !file->binary.empty()) {
    auto* const bytes = reinterpret_cast<std::uint8_t*>(file->binary.data());
    file->binary.resize(LLVMFuzzerMutate(bytes, file->binary.size(), file->binary.size()));
  } else {
    for (unsigned i = 0; i <= random() % 3; ++i) {
      file->json = firstcontact::test::mutate_json(file->json, words(), random);
    }
  }
  const std::string bytes = firstcontact::test::joined(*file);
  if (bytes.size() > most) {
    return LLVMFuzzerMutate(data, size, most);
  }
  std::memcpy(data, bytes.data(), bytes.size());
  return bytes.size();
}
