// Where the bytes of glTF come from: GLB chunks, data URIs, files beside the document.

#include <clocale>
#include <cstdint>
#include <locale>
#include <random>
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
using test::plain_gltf;

class GltfContainer : public GltfTest {};

TEST_F(GltfContainer, TakesDataUrisOfEachForm) {
  const GltfWriter gltf = plain_gltf();
  for (const char* const head :
       {"data:;base64,", "data:application/gltf-buffer;base64,", "DATA:text/plain;x=y;BASE64,"}) {
    EXPECT_TRUE(has_corners(read("a.gltf", gltf.with_data_uri(head)).mesh, float_corners()))
        << head;
  }
  std::string percent = "data:,";
  std::string escaped = "data:;base64,";
  const auto hex = [](char c) {
    const std::string digits = "0123456789aBcDeF";
    const auto byte = static_cast<unsigned char>(c);
    return std::string("%") + digits[byte / 16] + digits[byte % 16];
  };
  for (const char c : gltf.buffer) {
    percent += hex(c);
  }
  for (const char c : test::as_base64(gltf.buffer)) {
    escaped += c == '+' || c == '/' || c == '=' ? hex(c) : std::string(1, c);
  }
  for (const std::string& uri : {percent, escaped}) {
    EXPECT_TRUE(
        has_corners(read("a.gltf", gltf.json("\"uri\":\"" + uri + "\",")).mesh, float_corners()));
  }
}

TEST_F(GltfContainer, TakesBase64WithoutPadding) {
  for (std::size_t extra = 0; extra < 3; ++extra) {
    GltfWriter gltf = plain_gltf();
    gltf.buffer += std::string(extra, 'x');
    std::string text = test::as_base64(gltf.buffer);
    text.resize(std::min(text.find('='), text.size()));
    EXPECT_TRUE(has_corners(
        read("a.gltf", gltf.json(R"("uri":"data:;base64,)" + text + "\",")).mesh, float_corners()));
  }
}

TEST_F(GltfContainer, RefusesBrokenDataUris) {
  const GltfWriter gltf = plain_gltf();
  for (const char* const uri :
       {"data:;base64,AAAA*AAA", "data:;base64,A", "data:;base64", "data:", "data:;base64,AA==AAAA",
        "data:,%4", "data:,%zz", "data:;base64,===="}) {
    EXPECT_TRUE(
        is_refused("a.gltf", gltf.json("\"uri\":\"" + std::string(uri) + "\","), "data URI"))
        << uri;
  }
  EXPECT_TRUE(is_refused("a.gltf", gltf.json(R"("uri":"data:;base64,AAAA",)"), "byteLength"));
}

// Writers encode the space in a name; the file beside the document has the space itself.
TEST_F(GltfContainer, DecodesTheNamesOfFiles) {
  const GltfWriter gltf = plain_gltf();
  write("my mesh%.bin", gltf.buffer);
  for (const char* const uri : {"my%20mesh%25.bin", "my mesh%25.bin", "./%6dy%20mesh%25.bin"}) {
    const auto reading = read("a.gltf", gltf.json("\"uri\":\"" + std::string(uri) + "\","));
    EXPECT_TRUE(has_corners(reading.mesh, float_corners())) << uri;
    ASSERT_EQ(reading.report.also_read.size(), 1u);
    EXPECT_TRUE(std::filesystem::equivalent(reading.report.also_read[0], folder_ / "my mesh%.bin"));
    EXPECT_TRUE(reading.report.warnings.empty());
  }
}

TEST_F(GltfContainer, WarnsWhereOnlyTheFileOfTheUndecodedNameIsThere) {
  const GltfWriter gltf = plain_gltf();
  write("my%20mesh.bin", gltf.buffer);
  const auto reading = read("a.gltf", gltf.json(R"("uri":"my%20mesh.bin",)"));
  EXPECT_TRUE(has_corners(reading.mesh, float_corners()));
  EXPECT_EQ(reading.report.warnings.size(), 1u);
}

TEST_F(GltfContainer, RefusesFilesFromElsewhere) {
  const GltfWriter gltf = plain_gltf();
  for (const char* const uri : {"http://example.org/body.bin", "file:///body.bin", "/body.bin",
                                "//example.org/body.bin", "C:/body.bin"}) {
    EXPECT_TRUE(
        is_refused("a.gltf", gltf.json("\"uri\":\"" + std::string(uri) + "\","), "relative to"))
        << uri;
  }
  EXPECT_TRUE(is_refused("a.gltf", gltf.json(R"("uri":"bad%2.bin",)"), "two hexadecimal digits"));
  EXPECT_TRUE(is_refused("a.gltf", gltf.json(R"("uri":"bad%00.bin",)"), "two hexadecimal digits"));
  EXPECT_TRUE(is_refused("a.gltf", gltf.json(R"("uri":"missing.bin",)"), "missing.bin"));
  EXPECT_TRUE(is_refused("a.gltf", gltf.json(R"("uri":"",)"), "a URI"));
  EXPECT_TRUE(is_refused("a.gltf", gltf.json(""), "expected a URI"));
}

TEST_F(GltfContainer, NeedsNoFileThatOnlyLooksNeed) {
  GltfWriter gltf = plain_gltf();
  std::string json = gltf.json("");
  const std::string end = "}],\"bufferViews\"";
  json.replace(json.find(end), 2, R"(},{"uri":"texture.bin","byteLength":4}])");
  EXPECT_TRUE(
      has_corners(read("a.glb", GltfWriter::glb_of(json, gltf.buffer)).mesh, float_corners()));
}

TEST_F(GltfContainer, SkipsChunksOfOtherTypes) {
  const std::string other = GltfWriter::chunk("WXYZ", "something", ' ');
  const auto reading = read("a.glb", plain_gltf().glb(other));
  EXPECT_TRUE(has_corners(reading.mesh, float_corners()));
  ASSERT_EQ(reading.report.left_out.size(), 1u);
  EXPECT_EQ(reading.report.left_out[0].name, "chunk \"WXYZ\"");
}

TEST_F(GltfContainer, RefusesAGlbThatIsNotOne) {
  const GltfWriter gltf = plain_gltf();
  const std::string good = gltf.glb();
  const auto with = [&](std::size_t place, const std::string& bytes) {
    return std::string(good).replace(place, bytes.size(), bytes);
  };
  EXPECT_TRUE(is_refused("a.glb", with(4, "\1"), "version 1"));
  EXPECT_TRUE(is_refused("a.glb", with(12, "\xff\xff"), "a chunk"));
  EXPECT_TRUE(is_refused("a.glb", with(16, "BINO"), "a chunk of JSON first"));
  EXPECT_TRUE(is_refused("a.glb", with(8, std::string(4, '\0')), "at least 12"));
  const std::string binary = GltfWriter::chunk(std::string("BIN\0", 4), "more", '\0');
  EXPECT_TRUE(is_refused("a.glb", gltf.glb(binary), "one chunk of each type"));
  EXPECT_TRUE(is_refused("a.glb", GltfWriter::glb_of(gltf.json(""), "short"), "byteLength"));
  EXPECT_TRUE(is_refused("a.glb", "", "the header 'glTF'"));
  EXPECT_TRUE(is_refused("a.glb", "solid part", "the header 'glTF'"));
  const auto reading = read("a.glb", good + "more");
  EXPECT_TRUE(has_corners(reading.mesh, float_corners()));
  EXPECT_EQ(reading.report.warnings.size(), 1u);
}

TEST_F(GltfContainer, DoesNotHeedTheLocale) {
  struct CommaDecimal : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
  };
  GltfWriter gltf = plain_gltf();
  gltf.nodes = {R"({"mesh":0,"scale":[0.5,0.5,0.5]})"};
  const std::locale before = std::locale::global(std::locale(std::locale(), new CommaDecimal));
  std::setlocale(LC_ALL, "de_DE.UTF-8");  // Where it is installed.
  const Mesh mesh = read_glb(gltf);
  std::setlocale(LC_ALL, "C");
  std::locale::global(before);
  EXPECT_TRUE(has_corners(mesh, test::mapped(float_corners(), [](const Eigen::Vector3d& p) {
                            return Eigen::Vector3d(0.5 * p);
                          })));
}

TEST_F(GltfContainer, IsRefusedHoweverCutOff) {
  const std::string glb = plain_gltf().glb();
  for (std::size_t size = 0; size < glb.size(); ++size) {
    EXPECT_NE(error_of("a.glb", glb.substr(0, size)), "") << size;
  }
  const std::string text = plain_gltf().with_data_uri();
  for (std::size_t size = 0; size < text.size(); ++size) {
    EXPECT_NE(error_of("a.gltf", text.substr(0, size)), "") << size;
  }
  const std::string beside = plain_gltf().json(R"("uri":"body.bin",)");
  const std::string buffer = plain_gltf().buffer;
  for (std::size_t size = 0; size < buffer.size(); ++size) {
    write("body.bin", buffer.substr(0, size));
    EXPECT_NE(error_of("a.gltf", beside), "") << size;
  }
}

TEST_F(GltfContainer, IsAMeshOrOneLineWithAnyByteChanged) {
  const std::string whole = plain_gltf().glb();
  std::mt19937 random(1);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    SCOPED_TRACE(i);
    std::string bytes = whole;
    bytes[i] = static_cast<char>(random());
    static_cast<void>(error_of("a.glb", bytes));
  }
}

}  // namespace
}  // namespace firstcontact
