#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include <firstcontact/geometry/mesh_defects.h>
#include <firstcontact/geometry/weld.h>
#include <firstcontact/model_files/detail/parse_dae.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/reading_log.h>

#include "fuzz/fuzz_reader.h"
#include "fuzz/small_stack.h"
#include "fuzz/xml_mutator.h"

namespace {

using firstcontact::test::require;

const firstcontact::test::XmlWords& dae_words() {
  static const firstcontact::test::XmlWords words{
      .names = {"COLLADA",
                "asset",
                "unit",
                "up_axis",
                "library_geometries",
                "geometry",
                "mesh",
                "source",
                "input",
                "float_array",
                "accessor",
                "param",
                "vertices",
                "triangles",
                "polylist",
                "polygons",
                "tristrips",
                "trifans",
                "lines",
                "convex_mesh",
                "p",
                "ph",
                "h",
                "vcount",
                "library_controllers",
                "controller",
                "skin",
                "morph",
                "targets",
                "bind_shape_matrix",
                "joints",
                "v",
                "scene",
                "node",
                "library_visual_scenes",
                "matrix",
                "translate",
                "rotate",
                "scale",
                "skew",
                "lookat",
                "extra",
                "technique",
                "id",
                "instance_visual_scene",
                "sid",
                "count",
                "stride",
                "offset",
                "instance_geometry",
                "semantic",
                "set",
                "meter",
                "url",
                "instance_node",
                "library_nodes",
                "Name_array",
                "method",
                "skeleton",
                "instance_controller"},
      .values = {"#a",       "#b",          "#a-positions", "#missing", "VERTEX",
                 "POSITION", "NORMAL",      "JOINT",        "WEIGHT",   "MORPH_TARGET",
                 "Z_UP",     "X_UP",        "NORMALIZED",   "RELATIVE", "INV_BIND_MATRIX",
                 "0 1 2",    "0 0 1 1 2 2", "3 4",          "1 0 0 90", "#scene"}};
  return words;
}

/// Any bytes give a body of finite coordinates, or a ParseError of one line. Lenient or not.
void fuzz_dae(std::string_view bytes, bool lenient) {
  try {
    firstcontact::detail::ReadingLog log("fuzz.dae", "DAE", {.lenient = lenient});
    firstcontact::Mesh mesh = firstcontact::detail::parse_dae(bytes, log);
    require(!mesh.triangles.empty());
    firstcontact::weld(mesh);
    require(firstcontact::inspect(mesh).nonfinite_vertices == 0);
    require(!log.finish().unit.empty());
  } catch (const firstcontact::ParseError& error) {
    require(std::strchr(error.what(), '\n') == nullptr);
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t greatest);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t greatest, unsigned seed) {
  return firstcontact::test::mutate_xml(data, size, greatest, seed, dae_words(), LLVMFuzzerMutate);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz_dae({reinterpret_cast<const char*>(data), size}, size % 2 == 0);
  return 0;
}
