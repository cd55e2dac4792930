// One body in every kind of primitive and every way to place it.

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "model_files/dae_reading.h"

namespace firstcontact {
namespace {

using test::DaePrimitive;
using test::DaeWriter;
using test::Point;

constexpr std::array<DaePrimitive, 5> kPrimitives = {
    DaePrimitive::triangles, DaePrimitive::polylist, DaePrimitive::polygons,
    DaePrimitive::tristrips, DaePrimitive::trifans};

/// Transforms of a node, what they do, and whether that is exact in double.
struct Placing {
  std::string text;
  std::function<Point(Point)> map;
  bool exact = true;
};

const std::vector<Placing>& placings() {
  static const double half = std::sqrt(0.5);
  static const std::vector<Placing> all = {
      {"", test::same},
      {"<translate>0.3 -7 1e-3</translate>",
       [](Point p) {
         return Point{p[0] + 0.3, p[1] - 7.0, p[2] + 1e-3};
       }},
      {"<scale>2 0.5 4</scale>",
       [](Point p) {
         return Point{2.0 * p[0], 0.5 * p[1], 4.0 * p[2]};
       }},
      {"<rotate>0 0 1 90</rotate>",
       [](Point p) {
         return Point{-p[1], p[0], p[2]};
       }},
      {"<rotate>0 3 0 -180</rotate>",
       [](Point p) {
         return Point{-p[0], p[1], -p[2]};
       }},
      {"<rotate>0 0 0 0</rotate>", test::same},
      {"<rotate>1 0 0 45</rotate>",
       [](Point p) {
         return Point{p[0], half * (p[1] - p[2]), half * (p[1] + p[2])};
       },
       false},
      {"<matrix>0 -1 0 5 1 0 0 6 0 0 1 7 0 0 0 1</matrix>",
       [](Point p) {
         return Point{-p[1] + 5.0, p[0] + 6.0, p[2] + 7.0};
       }},
      {"<translate>1 2 3</translate><rotate>1 0 0 90</rotate><scale>2 2 2</scale>",
       [](Point p) {
         return Point{2.0 * p[0] + 1.0, -2.0 * p[2] + 2.0, 2.0 * p[1] + 3.0};
       }},
      {"<lookat>1 2 3  1 2 -4  0 5 0</lookat>",
       [](Point p) {
         return Point{p[0] + 1.0, p[1] + 2.0, p[2] + 3.0};
       }},
      {"<lookat>0 0 0  9 0 0  1 0 2</lookat>",
       [](Point p) {
         return Point{-p[2], -p[0], p[1]};
       }},
      {"<skew>45 0 1 0 1 0 0</skew>",
       [](Point p) {
         return Point{p[0] + p[1], p[1], p[2]};
       }},
      {"<skew>-45 0 0 2 0 3 0</skew>",
       [](Point p) {
         return Point{p[0], p[1] - p[2], p[2]};
       }},
  };
  return all;
}

class DaePlacement : public testing::TestWithParam<std::tuple<DaePrimitive, std::size_t>> {};

// Decimal text is exact to double: a vertex that is not moved comes back to the last bit.
TEST_P(DaePlacement, OfEveryPrimitiveIsExact) {
  const auto& [primitive, index] = GetParam();
  const Placing& placing = placings()[index];
  DaeWriter dae;
  dae.geometries = test::dae_body("body", 0.1, primitive);
  dae.nodes = "<node>" + placing.text + "<instance_geometry url='#body'/></node>";
  test::expect_same_body(test::read_dae(dae).mesh, test::moved_body(0.1, placing.map),
                         placing.exact ? 0.0 : 4e-15);
}

INSTANTIATE_TEST_SUITE_P(All, DaePlacement,
                         testing::Combine(testing::ValuesIn(kPrimitives),
                                          testing::Range(std::size_t{0}, placings().size())));

TEST(DaeTriangles, KeepTheirOrderAndCorners) {
  const Mesh mesh = test::read_dae(DaeWriter{}).mesh;
  const Mesh expected = test::moved_body(0.1, test::same);
  ASSERT_EQ(mesh.triangles.size(), expected.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(mesh.vertices[mesh.triangles[i][k]], expected.vertices[expected.triangles[i][k]]);
    }
  }
}

// A plate of 4 by 4 with two holes, from above; its holes turn either way.
TEST(DaeHoles, AreLeftOpen) {
  for (const char* const scale : {"1 1 1", "-1 1 1"}) {
    DaeWriter dae;
    dae.geometries = test::dae_geometry(
        "body",
        test::dae_source("body-p", {0, 0, 0, 4, 0, 0, 4, 4, 0, 0, 4, 0, 1, 1, 0, 2, 1,
                                    0, 2, 2, 0, 1, 2, 0, 3, 3, 0, 3, 2, 0, 2, 3, 0},
                         "XYZ"),
        "<polygons count='2'><input semantic='VERTEX' source='#body-v' offset='0'/>"
        "<ph><p>0 1 2 3</p><h>4 5 6 7</h><h>8 9 10</h></ph><p>8 10 9</p></polygons>");
    dae.nodes =
        "<node><scale>" + std::string(scale) + "</scale><instance_geometry url='#body'/></node>";
    EXPECT_NEAR(test::volume_and_area(test::read_dae(dae).mesh)[1] / 2.0, 15.0, 1e-12);
  }
}

TEST(DaeHoles, OfPolygonsWithoutThreeCornersAreRefused) {
  DaeWriter dae;
  dae.geometries = test::dae_geometry(
      "body", test::dae_source("body-p", {0, 0, 0, 4, 0, 0, 4, 4, 0}, "XYZ"),
      "<polygons count='1'><input semantic='VERTEX' source='#body-v' offset='0'/>"
      "<ph><p>0 1</p><h>0 1 2</h></ph></polygons>");
  EXPECT_TRUE(test::is_refused(dae, "three corners"));
}

TEST(DaeReferences, MayHaveSpacesInPercent) {
  DaeWriter dae;
  dae.geometries = test::dae_body("my body");
  dae.nodes = "<node><instance_geometry url='#my%20body'/></node>";
  test::expect_same_body(test::read_dae(dae).mesh, test::moved_body(0.1, test::same));
}

TEST(DaeUnit, ScalesThePlacedBody) {
  for (const double unit : {1.0, 0.01, 0.0254, 1000.0, 0.5}) {
    SCOPED_TRACE(unit);
    DaeWriter dae;
    dae.asset = "<asset><unit meter='" + test::dae_number(unit) + "'/></asset>";
    dae.nodes = "<node><translate>8 0 0</translate><instance_geometry url='#body'/></node>";
    const auto expected = test::moved_body(0.1, [&](Point p) {
      return Point{unit * (p[0] + 8.0), unit * p[1], unit * p[2]};
    });
    test::expect_same_body(test::read_dae(dae).mesh, expected,
                           unit == 1.0 || unit == 0.5 ? 0.0 : unit * 4e-15);
  }
}

TEST(DaeUnit, IsReported) {
  DaeWriter dae;
  dae.asset = "<asset><unit name='centimeter' meter='0.01'/></asset>";
  EXPECT_EQ(test::read_dae(dae).report.unit.find("0.01 m"), 0u);
}

TEST(DaeUnit, OfZeroOrLessOrNoNumberIsRefused) {
  for (const char* const unit : {"0", "-1", "nan", "", "inch", "1e999"}) {
    DaeWriter dae;
    dae.asset = "<asset><unit meter='" + std::string(unit) + "'/></asset>";
    EXPECT_TRUE(test::is_refused(dae, "<unit>")) << unit;
  }
}

TEST(DaeUnit, OfANameAloneIsAMeterWithAWarning) {
  DaeWriter dae;
  dae.asset = "<asset><unit name='inch'/></asset>";
  const auto reading = test::read_dae(dae);
  test::expect_same_body(reading.mesh, test::moved_body(0.1, test::same));
  ASSERT_EQ(reading.report.warnings.size(), 1u);
  EXPECT_NE(reading.report.warnings[0].find("the size of the unit 'inch'; it is taken as 1 m"),
            std::string::npos)
      << reading.report.warnings[0];
  for (const char* const unit :
       {"<unit/>", "<unit name='meter'/>", "<unit name='inch' meter='1'/>"}) {
    dae.asset = "<asset>" + std::string(unit) + "</asset>";
    EXPECT_TRUE(test::read_dae(dae).report.warnings.empty()) << unit;
  }
}

TEST(DaeUnit, ThatDiffersWithinTheDocumentIsRefused) {
  DaeWriter dae;
  dae.nodes = "<node><asset><unit meter='0.01'/></asset><instance_geometry url='#body'/></node>";
  EXPECT_TRUE(test::is_refused(dae, "unit"));
  dae.nodes = "<node><asset><unit meter='1.0'/></asset><instance_geometry url='#body'/></node>";
  test::expect_same_body(test::read_dae(dae).mesh, test::moved_body(0.1, test::same));
}

TEST(DaeUpAxis, IsReportedAndNotTurned) {
  for (const char* const axis : {"X_UP", "Y_UP", "Z_UP"}) {
    DaeWriter dae;
    dae.asset = "<asset><up_axis>" + std::string(axis) + "</up_axis></asset>";
    const auto reading = test::read_dae(dae);
    test::expect_same_body(reading.mesh, test::moved_body(0.1, test::same));
    EXPECT_NE(reading.report.unit.find(axis), std::string::npos) << reading.report.unit;
  }
}

// Triangles of a mirrored closed body would face inwards.
TEST(DaeMirror, KeepsTheInsideInside) {
  DaeWriter dae;
  dae.nodes = "<node><scale>-1 1 1</scale><instance_geometry url='#body'/></node>";
  const Mesh mirrored = test::read_dae(dae).mesh;
  const Mesh plain = test::read_dae(DaeWriter{}).mesh;
  EXPECT_GT(test::volume_and_area(plain)[0], 0.0);
  EXPECT_NEAR(test::volume_and_area(mirrored)[0], test::volume_and_area(plain)[0], 1e-12);
}

TEST(DaeNodes, MultiplyAlongThePath) {
  DaeWriter dae;
  dae.nodes =
      "<node><translate>1 0 0</translate><node><rotate>0 0 1 90</rotate>"
      "<node><scale>2 2 2</scale><instance_geometry url='#body'/></node></node></node>";
  test::expect_same_body(test::read_dae(dae).mesh, test::moved_body(0.1, [](Point p) {
                           return Point{-2.0 * p[1] + 1.0, 2.0 * p[0], 2.0 * p[2]};
                         }));
}

TEST(DaeNodes, OfTheLibraryArePlacedWhereTheyAreInstanced) {
  DaeWriter dae;
  dae.library_nodes =
      "<node id='part'><translate>0 0 1</translate><instance_geometry url='#body'/></node>";
  dae.nodes =
      "<node><translate>1 0 0</translate><instance_node url='#part'/></node>"
      "<node><translate>64 0 0</translate><instance_node url='#part'/></node>";
  const auto reading = test::read_dae(dae);
  EXPECT_EQ(reading.mesh.triangles.size(), 24u);
  Mesh first = reading.mesh;
  first.triangles.resize(12);
  first.vertices.resize(8);
  test::expect_same_body(first, test::moved_body(0.1, [](Point p) {
                           return Point{p[0] + 1.0, p[1], p[2] + 1.0};
                         }));
}

TEST(DaeNodes, InstancedInChainsOfAnyLengthAreRead) {
  DaeWriter dae;
  constexpr int kLength = 20'000;
  for (int i = 0; i < kLength; ++i) {
    dae.library_nodes += "<node id='n" + std::to_string(i) + "'><instance_node url='#n" +
                         std::to_string(i + 1) + "'/></node>";
  }
  dae.library_nodes +=
      "<node id='n" + std::to_string(kLength) + "'><instance_geometry url='#body'/></node>";
  dae.nodes = "<node><instance_node url='#n0'/></node>";
  test::expect_same_body(test::read_dae(dae).mesh, test::moved_body(0.1, test::same));
}

TEST(DaeNodes, InRingsAreRefused) {
  DaeWriter dae;
  dae.library_nodes =
      "<node id='a'><instance_geometry url='#body'/><node><instance_node url='#b'/></node></node>"
      "<node id='b'><instance_node url='#a'/></node>";
  dae.nodes = "<node><instance_node url='#a'/></node>";
  EXPECT_TRUE(test::is_refused(dae, "inside of itself"));
  dae.nodes = "<node id='n'><instance_node url='#n'/></node>";
  EXPECT_TRUE(test::is_refused(dae, "inside of itself"));
}

TEST(DaeNodes, TenThousandDeepAreRefused) {
  DaeWriter dae;
  std::string open;
  std::string close;
  for (int i = 0; i < 10'000; ++i) {
    open += "<node>";
    close += "</node>";
  }
  dae.nodes = open + "<instance_geometry url='#body'/>" + close;
  EXPECT_TRUE(test::is_refused(dae, "100 elements"));
}

TEST(DaeNodes, ThatDoubleWithEveryLevelAreRefused) {
  DaeWriter dae;
  dae.library_nodes = "<node id='n40'><instance_geometry url='#body'/></node>";
  for (int i = 0; i < 40; ++i) {
    const std::string next = std::to_string(i + 1);
    dae.library_nodes += "<node id='n" + std::to_string(i) + "'><instance_node url='#n" + next +
                         "'/><instance_node url='#n" + next + "'/></node>";
  }
  dae.nodes = "<node><instance_node url='#n0'/></node>";
  EXPECT_TRUE(test::is_refused(dae, "unfold"));
}

TEST(DaeScene, IsTheOneThatTheDocumentInstances) {
  DaeWriter dae;
  dae.nodes +=
      "</visual_scene><visual_scene id='other'><node><instance_geometry url='#body'/>"
      "<translate>9 0 0</translate></node>";
  test::expect_same_body(test::read_dae(dae).mesh, test::moved_body(0.1, test::same));
  EXPECT_TRUE(test::leaves_out(test::read_dae(dae).report, "<visual_scene>"));
  dae.scene = "<scene><instance_visual_scene url='#other'/></scene>";
  test::expect_same_body(test::read_dae(dae).mesh, test::moved_body(0.1, [](Point p) {
                           return Point{p[0] + 9.0, p[1], p[2]};
                         }));
  dae.scene = "<scene><instance_visual_scene url='#none'/></scene>";
  EXPECT_TRUE(test::is_refused(dae, "'none'"));
  dae.scene = "<scene/>";
  EXPECT_TRUE(test::is_refused(dae, "instance_visual_scene"));
  dae.scene = "";
  EXPECT_TRUE(test::is_refused(dae, "<scene>"));
}

TEST(DaeTransform, ThatIsIncompleteOrNotFiniteIsRefused) {
  for (const char* const text :
       {"<translate>1 2</translate>", "<translate>1 2 3 4</translate>",
        "<translate>1 2 nan</translate>", "<rotate>0 0 0 5</rotate>", "<rotate>0 0 1</rotate>",
        "<matrix>1 0 0 0 0 1 0 0 0 0 1 0</matrix>",
        "<matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2</matrix>", "<scale/>",
        "<lookat>0 0 0 0 0 0 0 1 0</lookat>", "<lookat>0 0 0 0 1 0 0 1 0</lookat>",
        "<skew>95 0 1 0 1 0 0</skew>", "<skew>45 0 1 0 1 1 0</skew>",
        "<translate>1 2 <x/> 3</translate>", "<rotate>inf 0 1 90</rotate>", "<turn>0 0 1 90</turn>",
        "<Translate>1 0 0</Translate>"}) {
    DaeWriter dae;
    dae.nodes = "<node>" + std::string(text) + "<instance_geometry url='#body'/></node>";
    EXPECT_NE(test::error_of_dae(dae.text()), "") << text;
  }
}

}  // namespace
}  // namespace firstcontact
