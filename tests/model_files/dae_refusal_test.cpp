// Content that writers leave beside the geometry of COLLADA documents is ignored. Content that
// could hold or place geometry and is not understood is refused.

#include <clocale>
#include <locale>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "model_files/dae_reading.h"

namespace firstcontact {
namespace {

using test::DaeWriter;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

void expect_plain(const DaeWriter& dae) {
  test::expect_same_body(test::read_dae(dae).mesh, test::moved_body(0.1, test::same));
}

/// The body with further sources and primitives.
DaeWriter with(const std::string& sources, const std::string& primitives = "") {
  DaeWriter dae;
  dae.geometries = test::dae_geometry(
      "body",
      test::dae_source("body-p", test::dae_rows(test::reference_body(0.1).vertices), "XYZ") +
          sources,
      test::dae_primitive("body", test::DaePrimitive::triangles) + primitives);
  return dae;
}

TEST(DaeSources, ThatNoGeometryUsesMayHoldAnything) {
  for (const char* const numbers :
       {"NaN NaN NaN", "-1.#IND 1.#QNAN -1.#INF", "INF -INF 0", "", "what is this?", "1,5 2,5"}) {
    expect_plain(with("<source id='n'><float_array id='n-a' count='3'>" + std::string(numbers) +
                      "</float_array><technique_common><accessor source='#none' count='99'/>"
                      "</technique_common></source>"));
  }
}

TEST(DaePrimitives, ThatAreEmptyDoNoHarm) {
  for (const char* const empty :
       {"<polylist count='0'><input semantic='VERTEX' source='#body-v' "
        "offset='0'/><vcount></vcount>"
        "<p></p></polylist>",
        "<polylist material='none' count='0'/>", "<triangles count='0'><p/></triangles>",
        "<polygons count='0'/>", "<tristrips count='0'><p> </p></tristrips>",
        "<triangles count='0'><input semantic='VERTEX' source='#none' offset='0'/></triangles>"}) {
    expect_plain(with("", empty));
  }
}

TEST(DaeLines, AreLeftOutByName) {
  for (const char* const name : {"lines", "linestrips"}) {
    const DaeWriter dae =
        with("", "<" + std::string(name) + " count='77'><p>0 1 2</p></" + name + ">");
    expect_plain(dae);
    EXPECT_TRUE(test::leaves_out(test::read_dae(dae).report, "<" + std::string(name) + ">"));
  }
  const DaeWriter dae =
      with("",
           "<polylist count='2'><input semantic='VERTEX' source='#body-v' offset='0'/>"
           "<vcount>1 2</vcount><p>0 1 2</p></polylist>");
  expect_plain(dae);
  EXPECT_TRUE(test::leaves_out(test::read_dae(dae).report, "polygons of 2 corners"));
}

TEST(DaeLibraries, ThatMakeNoContactAreLeftOutByName) {
  for (const char* const name :
       {"animations", "animation_clips", "cameras", "effects", "force_fields", "images", "lights",
        "materials", "physics_materials", "physics_models", "physics_scenes", "articulated_systems",
        "joints", "kinematics_models", "kinematics_scenes", "formulas"}) {
    DaeWriter dae;
    dae.more = "<library_" + std::string(name) + "><x/></library_" + name + ">";
    expect_plain(dae);
    EXPECT_TRUE(test::leaves_out(test::read_dae(dae).report, "<library_" + std::string(name) + ">"))
        << name;
  }
}

TEST(DaeExtras, AreLeftOutByTheNamesOfTheirProfiles) {
  DaeWriter dae;
  dae.nodes =
      "<node layer='hidden'><extra><technique profile='MAX3D'><a/></technique></extra>"
      "<instance_camera url='#c'/><instance_light url='#l'/><instance_geometry url='#body'>"
      "<bind_material/></instance_geometry></node>";
  expect_plain(dae);
  const FileReport report = test::read_dae(dae).report;
  EXPECT_TRUE(test::leaves_out(report, "<extra> of 'MAX3D'"));
  EXPECT_TRUE(test::leaves_out(report, "<instance_light>"));
  EXPECT_TRUE(report.warnings.empty());
}

TEST(DaeGeometry, OutsideOfTheSceneDoesNoHarmAndIsLeftOutByName) {
  DaeWriter dae;
  dae.geometries += "<geometry id='s'><spline/></geometry><geometry id='e'/>" +
                    replaced(test::dae_body("b"), "count='12'", "count='99'");
  expect_plain(dae);
  EXPECT_TRUE(test::leaves_out(test::read_dae(dae).report, "<geometry>"));
}

TEST(DaeSources, TakeParametersInAnyOrderStrideAndOffset) {
  const std::string plain = test::dae_body("body");
  const auto rows = test::dae_rows(test::reference_body(0.1).vertices);
  const std::string array = test::dae_numbers(rows);
  const auto body = [&](const std::vector<double>& numbers, const std::string& accessor,
                        const std::string& parameters) {
    std::string text = replaced(plain, array, test::dae_numbers(numbers));
    text = replaced(text, "count='24'", "count='" + std::to_string(numbers.size()) + "'");
    text = replaced(text, "count='8' stride='3'", accessor);
    const std::size_t begin = text.find("<param");
    return text.replace(begin, text.find("</accessor>") - begin, parameters);
  };
  std::vector<double> turned;
  std::vector<double> wide = {77.0, 77.0};
  for (std::size_t i = 0; i < rows.size(); i += 3) {
    turned.insert(turned.end(), {rows[i + 2], rows[i], rows[i + 1]});
    wide.insert(wide.end(), {rows[i], 99.0, rows[i + 1], rows[i + 2], 98.0});
  }
  wide.pop_back();  // The last row need not be whole.
  DaeWriter dae;
  dae.geometries = body(turned, "count='8' stride='3'",
                        "<param name='Z' type='float'/><param name='X'/><param name='Y'/>");
  expect_plain(dae);
  dae.geometries = body(wide, "count='8' stride='5' offset='2'",
                        "<param name='X'/><param type='float'/><param name='Y'/><param name='Z'/>");
  expect_plain(dae);
  dae.geometries = body(rows, "count='8' stride='3'", "<param/><param/><param/>");
  expect_plain(dae);
  dae.geometries = body(rows, "count='8' stride='3'", "");
  expect_plain(dae);
  for (const char* const wrong :
       {"<param name='X'/><param name='Y'/>", "<param name='X'/><param name='Y'/><param name='Y'/>",
        "<param name='R'/><param name='G'/><param name='B'/>", "<param/><param/>"}) {
    dae.geometries = body(rows, "count='8' stride='3'", wrong);
    EXPECT_TRUE(test::is_refused(dae, "<accessor>")) << wrong;
  }
  for (const char* const wrong :
       {"count='8' stride='999999999'", "count='9' stride='3'", "count='8' stride='4'",
        "count='8' stride='3' offset='1'", "count='24' stride='1'", "count='24'", "stride='3'",
        "count='8' stride='-3'", "count='18446744073709551615' stride='3'", "count='8' stride='0'",
        "count='8' stride='18446744073709551615'"}) {
    dae.geometries = replaced(plain, "count='8' stride='3'", wrong);
    EXPECT_NE(test::error_of_dae(dae.text()), "") << wrong;
  }
}

TEST(DaeArrays, MayStandInAnotherSource) {
  DaeWriter dae;
  dae.geometries = replaced(dae.geometries, "<vertices",
                            "<source id='q'><technique_common><accessor source='#body-p-a' "
                            "count='8' stride='3'><param name='X'/><param name='Y'/>"
                            "<param name='Z'/></accessor></technique_common></source><vertices");
  dae.geometries = replaced(dae.geometries, "source='#body-p'/>", "source='#q'/>");
  expect_plain(dae);
}

TEST(DaeArrays, MayHoldCommentsBetweenNumbers) {
  DaeWriter dae;
  dae.geometries = replaced(dae.geometries, "<p>", "<p><!-- corners -->");
  dae.geometries = replaced(dae.geometries, "</float_array>", " <!-- the end --> </float_array>");
  expect_plain(dae);
}

TEST(DaeConvexMesh, OfPolygonsIsReadAndHullsAreRefused) {
  DaeWriter dae;
  dae.geometries =
      replaced(replaced(dae.geometries, "<mesh>", "<convex_mesh>"), "</mesh>", "</convex_mesh>");
  expect_plain(dae);
  DaeWriter hull;
  hull.geometries += "<geometry id='h'><convex_mesh convex_hull_of='#body'/></geometry>";
  hull.nodes = "<node><instance_geometry url='#h'/></node>";
  EXPECT_TRUE(test::is_refused(hull, "convex_hull_of"));
}

/// A change of the plain document, and what the error says.
struct Wrong {
  std::string from;
  std::string to;
  std::string says;
};

TEST(Dae, ThatIsWrongIsRefusedByOneLine) {
  const std::vector<Wrong> all = {
      {"version='1.4.1'", "version='1.3.1'", "version"},
      {"<library_geometries>", "<library_geometrie>", "XML"},
      {"<node id='n'>", "<node id='n'><instance_mesh url='#body'/>", "<instance_mesh>"},
      {"<mesh>", "<mesh><quads count='1'/>", "<quads>"},
      {"<geometry id='body'>", "<geometry id='body'><spline/>", "spline"},
      {"<geometry id='body'>", "<geometry id='body'><brep/>", "brep"},
      {"<mesh>", "<mesh/><mesh>", "second mesh"},
      {"url='#body'", "url='#nobody'", "'nobody'"},
      {"url='#body'", "url='other.dae#body'", "other documents"},
      {"url='#body'", "", "'url'"},
      {"<geometry id='body'>", "<geometry id='body'/><geometry id='body'>", "several"},
      {"<triangles count='12'>", "<triangles count='11'>", "count"},
      {"<triangles count='12'>", "<triangles>", "'count'"},
      {"<float_array id='body-p-a' count='24'>", "<float_array id='body-p-a' count='23'>", "count"},
      {"<float_array id='body-p-a' count='24'>",
       "<float_array id='body-p-a' count='99999999999999'>", "count"},
      {"<float_array id='body-p-a' count='24'>", "<float_array id='body-p-a' count='25'>x ", "'x'"},
      {"semantic='VERTEX'", "semantic='VERTICES'", "VERTEX"},
      {"semantic='VERTEX'", "semantic='POSITION'", "POSITION"},
      {"semantic='NORMAL'", "semantic='VERTEX'", ""},
      {"semantic='POSITION'", "semantic='NORMAL'", "POSITION"},
      {"source='#body-p'/>", "source='#none'/>", "'none'"},
      {"source='#body-v' offset='1'", "source='#body-v'", "offset"},
      {"source='#body-v' offset='1'", "source='#body-v' offset='0'", "below 8"},
      {"source='#body-v' offset='1'", "source='#body-v' offset='4294967295'", "offset"},
      {"source='#body-v' offset='1'", "source='#body-v' ofset='1'", "'ofset'"},
      {"<p>9 0 -1", "<p>9 8 -1", "below 8"},
      {"<p>9 0 -1", "<p>9 -1 -1", ">= 0"},
      {"<p>9 0 -1", "<p>9 0.5 -1", "index"},
      {"<p>9 0 -1", "<p>9 1e308 -1", "index"},
      {"<p>9 0 -1", "<p>9 4294967296 -1", "index"},
      {"<p>9 0 -1", "<p>9 0", ">= 0"},
      {"</p></triangles>", " 9</p></triangles>", "rest"},
      {"<scene>", "<scene><instance_scene url='#x'/>", "<instance_scene>"},
      {"<library_geometries>", "<library_shapes/><library_geometries>", "<library_shapes>"},
      {"Z_UP", "W_UP", "W_UP"},
  };
  for (const Wrong& wrong : all) {
    const std::string line = test::error_of_dae(replaced(DaeWriter{}.text(), wrong.from, wrong.to));
    EXPECT_NE(line, "") << wrong.to;
    EXPECT_NE(line.find(wrong.says), std::string::npos) << wrong.to << ": " << line;
  }
  EXPECT_NE(test::error_of_dae(""), "");
  EXPECT_NE(test::error_of_dae("<COLLADA version='1.4.1'/>"), "");
  EXPECT_NE(test::error_of_dae("<robot/>"), "");
}

TEST(DaePolylist, WhoseNumbersContradictIsRefused) {
  const auto list = [](const std::string& counts, const std::string& corners,
                       const std::string& count) {
    return with("", "<polylist count='" + count +
                        "'><input semantic='VERTEX' source='#body-v' offset='0'/><vcount>" +
                        counts + "</vcount><p>" + corners + "</p></polylist>");
  };
  EXPECT_EQ(test::error_of_dae(list("3 4", "0 1 2 3 4 5 6", "2").text()), "");
  EXPECT_NE(test::error_of_dae(list("3", "0 1 2 3 4 5 6", "2").text()), "");
  EXPECT_NE(test::error_of_dae(list("3 5", "0 1 2 3 4 5 6", "2").text()), "");
  EXPECT_NE(test::error_of_dae(list("3 4", "0 1 2 3 4 5 6", "3").text()), "");
  EXPECT_NE(test::error_of_dae(list("-3 10", "0 1 2 3 4 5 6", "2").text()), "");
  EXPECT_NE(test::error_of_dae(list("3 4", "", "2").text()), "");
  EXPECT_NE(test::error_of_dae(list("18446744073709551615 8", "0 1 2 3 4 5 6", "2").text()), "");
}

TEST(DaePositions, ThatAreUsedHaveToBeFinite) {
  for (const char* const word : {"NaN", "-1.#IND", "INF", "1e999"}) {
    DaeWriter dae;
    dae.geometries =
        replaced(dae.geometries, "count='24'>", "count='24'>" + std::string(word) + " <!--");
    dae.geometries = replaced(dae.geometries, "</float_array>", "--></float_array>");
    EXPECT_NE(test::error_of_dae(dae.text()), "") << word;
    const std::string first = test::dae_number(test::reference_body(0.1).vertices[0][0]);
    DaeWriter other;
    other.geometries =
        replaced(other.geometries, "count='24'>" + first, "count='24'>" + std::string(word));
    EXPECT_TRUE(test::is_refused(other, "finite")) << word;
  }
}

TEST(DaeLenient, WarnsOfWhatIsNotKnown) {
  DaeWriter dae;
  dae.nodes = "<node><instance_mesh url='#x'/><instance_geometry url='#body'/></node>";
  EXPECT_NE(test::error_of_dae(dae.text()), "");
  const auto reading = test::read_dae(dae, {.lenient = true});
  ASSERT_EQ(reading.report.warnings.size(), 1u);
  EXPECT_NE(reading.report.warnings[0].find("<instance_mesh>"), std::string::npos);
}

TEST(Dae, TellsAllUnknownNamesAtOnce) {
  DaeWriter dae;
  dae.nodes = "<node><one/><instance_geometry url='#body'/><two/></node>";
  EXPECT_TRUE(test::is_refused(dae, "<one>"));
  EXPECT_TRUE(test::is_refused(dae, "<two>"));
}

TEST(Dae, DoesNotHeedTheLocale) {
  struct CommaDecimal : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
  };
  const std::locale before = std::locale::global(std::locale(std::locale(), new CommaDecimal));
  std::setlocale(LC_ALL, "de_DE.UTF-8");  // Where it is installed.
  expect_plain(DaeWriter{});
  std::setlocale(LC_ALL, "C");
  std::locale::global(before);
}

TEST(Dae, IsABodyOrOneLineHoweverCutOff) {
  const std::string whole = DaeWriter{}.text();
  int read_anyhow = 0;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    SCOPED_TRACE(size);
    read_anyhow += test::error_of_dae(whole.substr(0, size)).empty() ? 1 : 0;
  }
  EXPECT_LE(read_anyhow, 1);  // Without its last line break.
}

TEST(Dae, IsABodyOrOneLineWithAnyByteChanged) {
  const std::string whole = DaeWriter{}.text();
  std::mt19937 random(1);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    SCOPED_TRACE(i);
    std::string bytes = whole;
    bytes[i] = static_cast<char>(random());
    test::error_of_dae(bytes);
  }
}

}  // namespace
}  // namespace firstcontact
