// Content that the reader of glTF refuses, leaves out or warns of: by name, in one line.

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "model_files/gltf_body.h"
#include "model_files/gltf_reading.h"
#include "support/gltf_writer.h"

namespace firstcontact {
namespace {

using test::float_corners;
using test::GltfTest;
using test::GltfWriter;
using test::has_corners;
using test::mesh_text;
using test::plain_gltf;
using test::primitive_text;

/// One change of a document's text, and the message that it causes.
struct Change {
  std::string from;
  std::string to;
  std::string says;
};

class GltfRefusal : public GltfTest {
 protected:
  /// The document with the first occurrence of a text replaced, as GLB.
  static std::string changed(const GltfWriter& gltf, const Change& change) {
    std::string json = gltf.json("");
    const std::size_t place = json.find(change.from);
    EXPECT_NE(place, std::string::npos) << change.from;
    json.replace(place, change.from.size(), change.to);
    return GltfWriter::glb_of(json, gltf.buffer);
  }
};

TEST_F(GltfRefusal, NamesIndicesOutOfRange) {
  for (const Change& change : std::vector<Change>{
           {R"("scene":0)", R"("scene":1)",
            "scene: expected an index of scenes, of which the file has 1"},
           {R"([{"nodes":[0]}])", R"([{"nodes":[1]}])",
            "scenes[0].nodes[0]: expected an index of nodes"},
           {R"({"mesh":0})", R"({"mesh":1})", "nodes[0].mesh: expected an index of meshes"},
           {R"({"mesh":0})", R"({"mesh":-1})", "nodes[0].mesh: expected an index of meshes"},
           {R"({"mesh":0})", R"({"mesh":0.5})", "nodes[0].mesh: expected an index of meshes"},
           {R"({"mesh":0})", R"({"mesh":"0"})", "nodes[0].mesh: expected an index of meshes"},
           {R"({"mesh":0})", R"({"mesh":0,"skin":0})", "nodes[0].skin: expected an index of skins"},
           {R"({"mesh":0})", R"({"mesh":0,"children":[9]})",
            "nodes[0].children[0]: expected an index"},
           {R"("POSITION":0)", R"("POSITION":2)", "POSITION: expected an index of accessors"},
           {R"("indices":1)", R"("indices":2)", "indices: expected an index of accessors"},
           {R"({"bufferView":0,)", R"({"bufferView":2,)", "expected an index of bufferViews"},
           {R"({"buffer":0,)", R"({"buffer":1,)", "expected an index of buffers"},
       }) {
    EXPECT_TRUE(is_refused("a.glb", changed(plain_gltf(), change), change.says)) << change.to;
  }
}

TEST_F(GltfRefusal, NamesWhatIsLongerThanItsBytes) {
  for (const Change& change : std::vector<Change>{
           {R"("count":8)", R"("count":9)", "accessors[0]: expected 9 elements"},
           {R"("count":8)", R"("count":9007199254740992)", "accessors[0]: expected 9007"},
           {R"("count":36)", R"("count":39)", "accessors[1]: expected 39 elements"},
           {R"("count":8)", R"("count":8,"byteOffset":4)", "accessors[0]: expected 8 elements"},
           {R"("count":8)", R"("count":8,"byteOffset":9007199254740992)",
            "accessors[0]: expected 8"},
           {R"("byteLength":96)", R"("byteLength":133)", "bufferViews[0]: expected a view inside"},
           {R"("byteOffset":0)", R"("byteOffset":37)", "bufferViews[0]: expected a view inside"},
           {R"("byteLength":96)", R"("byteLength":96,"byteStride":16)", "accessors[0]: expected 8"},
           {R"("byteLength":96)", R"("byteLength":96,"byteStride":8)", "byteStride of at least 12"},
           {R"("byteLength":96)", R"("byteLength":96,"byteStride":0)", "byteStride of at least 12"},
           {R"("byteLength":132)", R"("byteLength":133)", "buffers[0]: expected 133 bytes"},
       }) {
    EXPECT_TRUE(is_refused("a.glb", changed(plain_gltf(), change), change.says)) << change.to;
  }
}

TEST_F(GltfRefusal, NamesWrongTypes) {
  for (const Change& change : std::vector<Change>{
           {R"("count":8)", R"("count":-8)", "a whole number"},
           {R"("count":8)", R"("count":8.5)", "a whole number"},
           {R"("count":8)", R"("count":null)", "a whole number"},
           {R"("count":8,)", "", "\"count\""},
           {"5126", "5124", "componentType: expected 5120"},
           {"5126", "\"5126\"", "componentType: expected a number"},
           {"5121", "5126", "numbers of another type"},
           {"5121", "5120", "numbers of another type"},
           {"VEC3", "VEC2", "expected \"VEC3\""},
           {"\"SCALAR\"", "7", "expected a type"},
           {R"("nodes":[{"mesh":0}])", R"("nodes":{"mesh":0})", "expected an array"},
           {R"("nodes":[{"mesh":0}])", R"("nodes":[[0]])", "nodes[0]: expected an object"},
           {R"({"mesh":0})", R"({"mesh":0,"translation":[0,0]})", "three numbers"},
           {R"({"mesh":0})", R"({"mesh":0,"rotation":[0,0,0]})", "four numbers"},
           {R"({"mesh":0})", R"({"mesh":0,"rotation":[0,0,0,0]})", "a quaternion other than zero"},
           {R"({"mesh":0})", R"({"mesh":0,"rotation":[0,0,0,1e999]})", "fits a double"},
           {R"({"mesh":0})", R"({"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0]})",
            "16 numbers"},
           {R"({"mesh":0})", R"({"mesh":0,"matrix":[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]})", "affine"},
           {R"({"mesh":0})",
            R"({"mesh":0,"scale":[1,1,1],"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]})", "got both"},
           {R"("indices":1)", R"("indices":1,"mode":7)", "a mode from 0"},
           {R"("asset":{"version":"2.0"})", R"("asset":{"version":"1.0"})", "version 2.0"},
           {R"("asset":{"version":"2.0"})", R"("asset":{"version":"2.1","minVersion":"2.1"})",
            "version 2.0"},
           {R"("asset":{"version":"2.0"})", R"("asset":{})", "\"version\""},
           {R"("asset":{"version":"2.0"},)", "", "\"asset\""},
       }) {
    EXPECT_TRUE(is_refused("a.glb", changed(plain_gltf(), change), change.says)) << change.to;
  }
}

TEST_F(GltfRefusal, NamesNodesThatAreNoTree) {
  GltfWriter gltf = plain_gltf();
  gltf.nodes = {R"({"mesh":0})", R"({"children":[2]})", R"({"children":[1]})"};
  EXPECT_TRUE(
      is_refused(gltf, "nodes[1]: expected a tree of nodes, got a node that is inside of itself"));
  gltf.nodes = {R"({"children":[0]})"};
  EXPECT_TRUE(is_refused(gltf, "nodes[0]: expected a tree of nodes"));
  gltf.nodes = {R"({"children":[2,1]})", R"({"children":[2]})", R"({"mesh":0})"};
  EXPECT_TRUE(is_refused(gltf, "got node 2 below node 0 and node 1"));
  gltf.nodes = {R"({"mesh":0})", R"({"children":[0]})"};
  EXPECT_TRUE(is_refused(gltf, "scenes[0].nodes[0]: expected a root"));
  gltf.nodes = {R"({"mesh":0})"};
  gltf.scenes = R"("scenes":[{"nodes":[0,0]}],)";
  EXPECT_TRUE(is_refused(gltf, "each root once"));
}

TEST_F(GltfRefusal, NamesRingsOfTenThousandNodes) {
  GltfWriter gltf = plain_gltf();
  for (std::size_t i = 1; i < 10'000; ++i) {
    gltf.nodes.push_back(R"({"children":[)" + std::to_string(i < 9'999 ? i + 1 : 1) + "]}");
  }
  EXPECT_TRUE(is_refused(gltf, "inside of itself"));
}

TEST_F(GltfRefusal, IsOneLineForDeepText) {
  const std::string deep = std::string(10'000, '[') + std::string(10'000, ']');
  EXPECT_TRUE(is_refused("a.gltf", "{\"asset\":" + deep, "brackets inside each other"));
  GltfWriter gltf = plain_gltf();
  gltf.more = "\"extras\":" + deep + ",";
  EXPECT_TRUE(is_refused(gltf, "brackets inside each other"));
}

TEST_F(GltfRefusal, NamesPositionsThatAreNotFinite) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    GltfWriter gltf = plain_gltf();
    gltf.buffer.replace(4, 4, test::little_endian(bad));
    EXPECT_TRUE(is_refused(gltf, "meshes[0].primitives[0]: expected finite coordinates"));
  }
  GltfWriter gltf = plain_gltf();
  gltf.nodes = {R"({"children":[1],"scale":[1e200,1e200,1e200]})",
                R"({"mesh":0,"scale":[1e200,1e200,1e200]})"};
  EXPECT_TRUE(is_refused(gltf, "expected finite coordinates"));
}

TEST_F(GltfRefusal, NamesIndicesWithoutAVertexAndRestarts) {
  GltfWriter gltf = plain_gltf();
  const auto with = [&](std::size_t indices) {
    gltf.meshes = {mesh_text({primitive_text(0, indices)})};
    return gltf;
  };
  EXPECT_TRUE(is_refused(with(gltf.add_numbers(std::vector<std::uint8_t>{0, 1, 8}, "SCALAR")),
                         "indices of its 8 vertices, got 8"));
  EXPECT_TRUE(is_refused(with(gltf.add_numbers(std::vector<std::uint8_t>{0, 1, 255}, "SCALAR")),
                         "restarts"));
  EXPECT_TRUE(is_refused(with(gltf.add_numbers(std::vector<std::uint16_t>{0, 1, 65535}, "SCALAR")),
                         "restarts"));
  EXPECT_TRUE(is_refused(
      with(gltf.add_numbers(std::vector<std::uint32_t>{0, 1, 0xffffffff}, "SCALAR")), "restarts"));
  EXPECT_TRUE(is_refused(with(gltf.add_numbers(std::vector<std::uint8_t>{0, 1, 2, 3}, "SCALAR")),
                         "three corners for each triangle, got 4"));
  EXPECT_TRUE(is_refused(with(gltf.add_numbers(std::vector<std::uint8_t>{}, "SCALAR")),
                         "at least one triangle"));
}

TEST_F(GltfRefusal, NamesSparseRowsThatDoNotAscend) {
  for (const std::vector<std::uint8_t>& rows :
       std::vector<std::vector<std::uint8_t>>{{1, 1}, {2, 1}, {1, 8}}) {
    GltfWriter gltf = plain_gltf();
    const auto indices = std::to_string(gltf.add_view(std::string(rows.begin(), rows.end())));
    const auto values = std::to_string(gltf.add_view(std::string(24, '\0')));
    const auto accessor =
        gltf.add_accessor(R"("sparse":{"count":2,"indices":{"bufferView":)" + indices +
                              R"(,"componentType":5121},"values":{"bufferView":)" + values + "}},",
                          5126, 8, "VEC3");
    gltf.meshes = {mesh_text({primitive_text(accessor, 1)})};
    EXPECT_TRUE(is_refused(gltf, "expected ascending indices below 8"));
  }
}

TEST_F(GltfRefusal, TakesNoRoomForWhatNoByteBacks) {
  GltfWriter gltf = plain_gltf();
  gltf.add_accessor("", 5126, std::size_t{1} << 40, "VEC3");
  gltf.meshes = {R"({"primitives":[{"attributes":{"POSITION":2}}]})"};
  EXPECT_TRUE(is_refused(gltf, "expected a bufferView"));
  // 30 MB of nodes would place 10^7 bodies of 12 triangles.
  GltfWriter often = plain_gltf();
  const std::size_t instances = often.add_accessor("", 5126, 65536, "VEC3");
  std::vector<std::string> children;
  for (std::size_t i = 1; i < 400; ++i) {
    children.push_back(std::to_string(i));
    often.nodes.push_back(R"({"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":)"
                          R"({"TRANSLATION":)" +
                          std::to_string(instances) + "}}}}");
  }
  often.nodes[0] = "{\"children\":" + GltfWriter::list(children) + "}";
  EXPECT_TRUE(is_refused(often, "vertices and triangles once all nodes have placed their meshes"));
}

TEST_F(GltfRefusal, NamesExtensionsThatAreRequiredAndNotRead) {
  for (const char* const name : {"VENDOR_other_geometry", "KHR_physics_rigid_bodies", "CESIUM_RTC",
                                 "KHR_draco_mesh_compression", "EXT_meshopt_compression"}) {
    GltfWriter gltf = plain_gltf();
    gltf.more = R"("extensionsRequired":[")" + std::string(name) + "\"],";
    EXPECT_TRUE(is_refused(gltf, name));
  }
  GltfWriter gltf = plain_gltf();
  gltf.more = R"("extensionsRequired":["VENDOR_other_geometry"],)";
  const auto reading = read("a.glb", gltf.glb(), {.lenient = true});
  EXPECT_TRUE(has_corners(reading.mesh, float_corners()));
  ASSERT_EQ(reading.report.warnings.size(), 1u);
  EXPECT_NE(reading.report.warnings[0].find("VENDOR_other_geometry"), std::string::npos);
  gltf.more = R"("extensionsRequired":["KHR_draco_mesh_compression"],)";
  EXPECT_THROW(static_cast<void>(read("a.glb", gltf.glb(), {.lenient = true})), ParseError);
}

TEST_F(GltfRefusal, NamesUnknownExtensionsOfWhatHoldsGeometry) {
  const std::string extension = R"("extensions":{"VENDOR_shape":{}})";
  GltfWriter node = plain_gltf();
  node.nodes = {"{\"mesh\":0," + extension + "}"};
  EXPECT_TRUE(is_refused(node, "nodes[0]: the extension \"VENDOR_shape\""));
  EXPECT_EQ(read("a.glb", node.glb(), {.lenient = true}).report.warnings.size(), 1u);
  GltfWriter mesh = plain_gltf();
  mesh.meshes = {mesh_text({primitive_text(0, 1)}, "," + extension)};
  EXPECT_TRUE(is_refused(mesh, "meshes[0]: the extension \"VENDOR_shape\""));
  GltfWriter primitive = plain_gltf();
  primitive.meshes = {mesh_text({primitive_text(0, 1, "", "," + extension)})};
  EXPECT_TRUE(is_refused(primitive, "meshes[0].primitives[0]: the extension \"VENDOR_shape\""));
  // Elsewhere it is a warning.
  GltfWriter root = plain_gltf();
  root.more = R"("extensionsUsed":["VENDOR_shape"],)" + extension + ",";
  const auto reading = read("a.glb", root.glb());
  EXPECT_TRUE(has_corners(reading.mesh, float_corners()));
  EXPECT_EQ(reading.report.warnings.size(), 1u);
}

// As shares of the greatest integer they would all be vertex 0 or 1.
TEST_F(GltfRefusal, NamesNormalisedIndices) {
  for (const std::string flag : {"true", "false"}) {
    GltfWriter gltf;
    gltf.add_numbers(test::float_positions(), "VEC3");
    gltf.add_numbers(test::indices_of_triangles(), "SCALAR", "\"normalized\":" + flag + ",");
    gltf.meshes = {mesh_text({primitive_text(0, 1)})};
    gltf.nodes = {R"({"mesh":0})"};
    if (flag == "true") {
      EXPECT_TRUE(is_refused(gltf, "accessors[1].normalized: expected false here"));
    } else {
      EXPECT_TRUE(has_corners(read_glb(gltf), float_corners()));
    }
  }
}

TEST_F(GltfRefusal, NamesHiddenNodes) {
  GltfWriter gltf = plain_gltf();
  gltf.nodes = {R"({"mesh":0,"extensions":{"KHR_node_visibility":{"visible":false}}})"};
  EXPECT_TRUE(is_refused(gltf, "KHR_node_visibility"));
  gltf.nodes = {R"({"mesh":0,"extensions":{"KHR_node_visibility":{"visible":true}}})"};
  EXPECT_TRUE(has_corners(read_glb(gltf), float_corners()));
}

TEST_F(GltfRefusal, ReadsThePlainFormBesideACompressedOne) {
  GltfWriter gltf = plain_gltf();
  const std::string draco =
      R"(,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}})";
  gltf.more = R"("extensionsUsed":["KHR_draco_mesh_compression"],)";
  gltf.meshes = {mesh_text({primitive_text(0, 1, "", draco)})};
  EXPECT_TRUE(has_corners(read_glb(gltf), float_corners()));
  const std::size_t empty = gltf.add_accessor("", 5126, 8, "VEC3");
  gltf.meshes = {mesh_text({primitive_text(empty, 1, "", draco)})};
  EXPECT_TRUE(is_refused(gltf, "decompress the file first"));
}

TEST_F(GltfRefusal, NamesKeysThatAreNotKnown) {
  for (const Change& change : std::vector<Change>{
           {R"({"mesh":0})", R"({"mesh":0,"tranlation":[1,0,0]})", "did you mean \"translation\"?"},
           {R"({"mesh":0})", R"({"mesh":0,"something":1})", "nodes[0]: unknown key \"something\""},
           {R"("indices":1)", R"("indexes":1)", "did you mean \"indices\"?"},
           {R"("POSITION":0)", R"("POSITION":0,"JOINT_0":0)", "did you mean \"JOINTS_0\"?"},
           {R"("asset":)", R"("mesh":[],"asset":)", "did you mean \"meshes\"?"},
       }) {
    EXPECT_TRUE(is_refused("a.glb", changed(plain_gltf(), change), change.says)) << change.to;
  }
  const auto reading =
      read("a.glb", changed(plain_gltf(), {R"("asset":)", R"("producer":1,"asset":)", ""}));
  EXPECT_EQ(reading.report.warnings.size(), 1u);
}

TEST_F(GltfRefusal, LeavesOutByNameWhatCannotTouch) {
  GltfWriter gltf = plain_gltf();
  gltf.more =
      R"("extensionsUsed":["KHR_texture_transform","KHR_lights_punctual","KHR_materials_unlit"],)"
      R"("extensionsRequired":["KHR_texture_transform"],)"
      R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}},"extras":{"a":1},)"
      R"("materials":[{"extensions":{"KHR_materials_unlit":{}}},{}],"textures":[{}],"cameras":[{}],)"
      R"("animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}],)"
      R"("samplers":[{"input":0,"output":0}]}],)";
  gltf.meshes.push_back(gltf.meshes[0]);
  gltf.nodes = {R"({"mesh":0,"camera":0,"extensions":{"KHR_lights_punctual":{"light":0}}})"};
  const auto reading = read("a.glb", gltf.glb());
  EXPECT_TRUE(has_corners(reading.mesh, float_corners()));
  EXPECT_TRUE(reading.report.warnings.empty());
  EXPECT_EQ(reading.report.unit, "1 m");
  EXPECT_EQ(reading.report.format, "GLB");
  std::string names;
  for (const LeftOut& entry : reading.report.left_out) {
    EXPECT_FALSE(entry.reason.empty()) << entry.name;
    names += entry.name + " " + std::to_string(entry.count) + ", ";
  }
  EXPECT_EQ(names,
            "KHR_texture_transform 1, KHR_lights_punctual 1, KHR_materials_unlit 1, extras 1, "
            "animation 1, camera 1, material 2, texture 1, mesh 1, ");
}

}  // namespace
}  // namespace firstcontact
