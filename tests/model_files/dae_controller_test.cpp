// Skins and morphs of COLLADA documents.

#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "model_files/dae_reading.h"

namespace firstcontact {
namespace {

using test::DaeWriter;
using test::Point;

const char* const kIdentity = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1";

/// A skin of the body. Its vertices go to the joint by turns, unless the parts say otherwise.
struct Skin {
  std::string source = "#body";
  std::string bind_shape = kIdentity;
  std::vector<std::string> joints = {"upper", "lower"};
  std::string joint_array = "Name_array";
  std::vector<std::string> inverse_binds = {kIdentity, kIdentity};
  std::vector<double> weights = {1.0};
  std::string count = "8";
  std::string counts = "1 1 1 1 1 1 1 1";
  std::string influences = "0 0 1 0 0 0 1 0 0 0 1 0 0 0 1 0";

  [[nodiscard]] std::string text(const std::string& id = "skin") const {
    return "<controller id='" + id + "'><skin source='" + source + "'><bind_shape_matrix>" +
           bind_shape + "</bind_shape_matrix>" +
           test::dae_name_source(id + "-j", joints, joint_array) +
           test::dae_matrix_source(id + "-b", inverse_binds) +
           test::dae_source(id + "-w", weights, "W") + "<joints><input semantic='JOINT' source='#" +
           id + "-j'/><input semantic='INV_BIND_MATRIX' source='#" + id +
           "-b'/></joints><vertex_weights count='" + count + "'><input semantic='JOINT' source='#" +
           id + "-j' offset='0'/><input semantic='WEIGHT' source='#" + id +
           "-w' offset='1'/><vcount>" + counts + "</vcount><v>" + influences +
           "</v></vertex_weights></skin></controller>";
  }
};

/// The skin in a scene with a joint "upper" at x = 4 and "lower" inside of it, at y = 2 more.
DaeWriter skinned(const Skin& skin) {
  DaeWriter dae;
  dae.controllers = skin.text();
  dae.nodes =
      "<node id='root' sid='root'><node id='j1' sid='upper' type='JOINT'>"
      "<translate>4 0 0</translate><node id='j2' sid='lower' type='JOINT'>"
      "<translate>0 2 0</translate></node></node></node>"
      "<node><translate>100 100 100</translate><instance_controller url='#skin'>"
      "<skeleton>#root</skeleton></instance_controller></node>";
  return dae;
}

Mesh with_even_and_odd(double unit, Point even, Point odd) {
  int i = 0;
  return test::moved_body(unit, [&](Point p) {
    const Point& shift = i++ % 2 == 0 ? even : odd;
    return Point{p[0] + shift[0], p[1] + shift[1], p[2] + shift[2]};
  });
}

void expect_vertices(const Mesh& mesh, const Mesh& expected, double tolerance = 0.0) {
  ASSERT_EQ(mesh.triangles.size(), expected.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d difference =
          mesh.vertices[mesh.triangles[i][k]] - expected.vertices[expected.triangles[i][k]];
      EXPECT_LE(difference.cwiseAbs().maxCoeff(), tolerance) << i;
    }
  }
}

// The pose is that of the nodes; the node of the instance plays no part.
TEST(DaeSkin, FollowsItsJoints) {
  expect_vertices(test::read_dae(skinned({})).mesh,
                  with_even_and_odd(0.1, {4.0, 0.0, 0.0}, {4.0, 2.0, 0.0}));
}

TEST(DaeSkin, InItsBindPoseHasItsBindShape) {
  Skin skin;
  skin.bind_shape = "1 0 0 2 0 1 0 0 0 0 1 0 0 0 0 1";
  skin.inverse_binds = {"1 0 0 -4 0 1 0 0 0 0 1 0 0 0 0 1", "1 0 0 -4 0 1 0 -2 0 0 1 0 0 0 0 1"};
  expect_vertices(test::read_dae(skinned(skin)).mesh,
                  with_even_and_odd(0.1, {2.0, 0.0, 0.0}, {2.0, 0.0, 0.0}), 1e-15);
}

TEST(DaeSkin, IsScaledByTheUnit) {
  DaeWriter dae = skinned({});
  dae.asset = "<asset><unit meter='0.5'/></asset>";
  expect_vertices(test::read_dae(dae).mesh,
                  with_even_and_odd(0.05, {2.0, 0.0, 0.0}, {2.0, 1.0, 0.0}));
}

TEST(DaeSkin, MixesJointsByWeightsWhoseSumIsDividedOut) {
  Skin skin;
  skin.weights = {0.375, 0.125};
  skin.counts = "2 2 2 2 2 2 2 2";
  skin.influences = "";
  for (int i = 0; i < 8; ++i) {
    skin.influences += "0 0 1 1 ";
  }
  expect_vertices(test::read_dae(skinned(skin)).mesh,
                  with_even_and_odd(0.1, {4.0, 0.5, 0.0}, {4.0, 0.5, 0.0}), 1e-15);
}

TEST(DaeSkin, OfTheJointMinusOneIsTheBindShape) {
  Skin skin;
  skin.bind_shape = "1 0 0 2 0 1 0 0 0 0 1 0 0 0 0 1";
  skin.influences = "-1 0 1 0 -1 0 1 0 -1 0 1 0 -1 0 1 0";
  expect_vertices(test::read_dae(skinned(skin)).mesh,
                  with_even_and_odd(0.1, {2.0, 0.0, 0.0}, {6.0, 2.0, 0.0}), 1e-15);
}

TEST(DaeSkin, FindsItsJointsByIdAndByName) {
  Skin by_id;
  by_id.joints = {"j1", "j2"};
  by_id.joint_array = "IDREF_array";
  expect_vertices(test::read_dae(skinned(by_id)).mesh,
                  with_even_and_odd(0.1, {4.0, 0.0, 0.0}, {4.0, 2.0, 0.0}));
  Skin by_name;
  by_name.joints = {"first", "j2"};
  DaeWriter dae = skinned(by_name);
  dae.nodes.replace(dae.nodes.find("id='j1'"), 7, "name='first' id='j1'");
  expect_vertices(test::read_dae(dae).mesh,
                  with_even_and_odd(0.1, {4.0, 0.0, 0.0}, {4.0, 2.0, 0.0}));
}

TEST(DaeSkin, TakesJointsBelowItsSkeletonFirst) {
  DaeWriter dae = skinned({});
  dae.nodes = "<node sid='upper'><translate>-50 0 0</translate></node>" + dae.nodes;
  expect_vertices(test::read_dae(dae).mesh,
                  with_even_and_odd(0.1, {4.0, 0.0, 0.0}, {4.0, 2.0, 0.0}));
}

TEST(DaeSkin, MayHaveJointsThatNoVertexNeeds) {
  Skin skin;
  skin.joints.push_back("nowhere");
  skin.inverse_binds.push_back(kIdentity);
  expect_vertices(test::read_dae(skinned(skin)).mesh,
                  with_even_and_odd(0.1, {4.0, 0.0, 0.0}, {4.0, 2.0, 0.0}));
}

TEST(DaeSkin, WhoseJointsAreNotOnceInTheSceneIsRefused) {
  Skin skin;
  skin.joints = {"upper", "nowhere"};
  EXPECT_TRUE(test::is_refused(skinned(skin), "joint 'nowhere' of a skin"));
  DaeWriter twice = skinned({});
  twice.nodes += "<node><instance_node url='#root'/></node>";
  EXPECT_TRUE(test::is_refused(twice, "several times"));
  DaeWriter outside = skinned({});
  outside.library_nodes = "<node id='lost' sid='upper'/>";
  outside.nodes.replace(outside.nodes.find("#root"), 5, "#lost");
  EXPECT_TRUE(test::is_refused(outside, "skin"));
}

TEST(DaeSkin, OfJointsInARingIsRefused) {
  DaeWriter dae = skinned({});
  dae.nodes.replace(dae.nodes.find("<node id='j2'"), 0, "<instance_node url='#root'/>");
  EXPECT_TRUE(test::is_refused(dae, "inside of itself"));
}

TEST(DaeSkin, WhosePartsContradictIsRefused) {
  const std::vector<void (*)(Skin&)> changes = {
      [](Skin& s) { s.count = "7"; },
      [](Skin& s) { s.counts = "1 1 1 1"; },
      [](Skin& s) { s.counts = "1 1 1 1 1 1 1 1 1"; },
      [](Skin& s) { s.counts = "1 1 1 1 1 1 1 99999999"; },
      [](Skin& s) { s.counts = "0 1 1 1 1 1 1 1"; },
      [](Skin& s) { s.influences += " 0 0"; },
      [](Skin& s) { s.influences = "0 0"; },
      [](Skin& s) { s.influences[0] = '2'; },
      [](Skin& s) { s.influences[2] = '1'; },
      [](Skin& s) { s.inverse_binds.pop_back(); },
      [](Skin& s) { s.weights = {0.0}; },
      [](Skin& s) { s.weights = {1.0 / 0.0}; },
      [](Skin& s) { s.bind_shape = "1 0 0"; },
      [](Skin& s) { s.inverse_binds[0] = "nan 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"; },
      [](Skin& s) { s.source = "#skin"; },
      [](Skin& s) { s.source = "#none"; },
      [](Skin& s) { s.source = "other.dae#body"; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Skin skin;
    changes[i](skin);
    const std::string line = test::error_of_dae(skinned(skin).text());
    EXPECT_NE(line, "") << i;
  }
}

/// A morph of the body towards one twice its size, moved.
struct Morph {
  std::string method = "NORMALIZED";
  std::vector<std::string> targets = {"large", "body"};
  std::string target_array = "IDREF_array";
  std::vector<double> weights = {0.25, 0.0};

  [[nodiscard]] std::string text() const {
    return "<controller id='morph'><morph source='#body' method='" + method + "'>" +
           test::dae_name_source("m-t", targets, target_array) +
           test::dae_source("m-w", weights, "W") +
           "<targets><input semantic='MORPH_TARGET' source='#m-t'/>"
           "<input semantic='MORPH_WEIGHT' source='#m-w'/></targets></morph></controller>";
  }
};

DaeWriter morphed(const Morph& morph) {
  DaeWriter dae;
  dae.geometries += test::dae_body("large", 0.2);
  dae.controllers = morph.text();
  dae.nodes = "<node><translate>16 0 0</translate><instance_controller url='#morph'/></node>";
  return dae;
}

Mesh scaled_and_moved(double scale) {
  return test::moved_body(0.1, [&](Point p) {
    return Point{scale * p[0] + 16.0, scale * p[1], scale * p[2]};
  });
}

TEST(DaeMorph, MixesShapesByItsMethod) {
  test::expect_same_body(test::read_dae(morphed({})).mesh, scaled_and_moved(1.25), 8e-15);
  Morph relative;
  relative.method = "RELATIVE";
  test::expect_same_body(test::read_dae(morphed(relative)).mesh, scaled_and_moved(1.5), 8e-15);
}

TEST(DaeMorph, OfWeightZeroIsItsBaseToTheLastBit) {
  for (const char* const method : {"NORMALIZED", "RELATIVE"}) {
    Morph morph;
    morph.method = method;
    morph.weights = {0.0, 0.0};
    morph.targets = {"large", "nowhere"};
    test::expect_same_body(test::read_dae(morphed(morph)).mesh, scaled_and_moved(1.0));
  }
}

TEST(DaeMorph, OfWeightOneIsItsTargetToTheLastBit) {
  Morph morph;
  morph.weights = {1.0, 0.0};
  test::expect_same_body(test::read_dae(morphed(morph)).mesh, scaled_and_moved(2.0));
}

TEST(DaeMorph, CanBeSkinned) {
  Skin skin;
  skin.source = "#morph";
  DaeWriter dae = skinned(skin);
  Morph morph;
  morph.weights = {1.0, 0.0};
  dae.geometries += test::dae_body("large", 0.2);
  dae.controllers += morph.text();
  expect_vertices(test::read_dae(dae).mesh,
                  with_even_and_odd(0.2, {4.0, 0.0, 0.0}, {4.0, 2.0, 0.0}));
}

TEST(DaeMorph, WhosePartsContradictIsRefused) {
  const std::vector<void (*)(Morph&)> changes = {
      [](Morph& m) { m.method = "TWISTED"; },     [](Morph& m) { m.weights = {1.0}; },
      [](Morph& m) { m.weights[0] = 0.0 / 0.0; }, [](Morph& m) { m.targets[0] = "nowhere"; },
      [](Morph& m) { m.targets.pop_back(); },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Morph morph;
    changes[i](morph);
    EXPECT_NE(test::error_of_dae(morphed(morph).text()), "") << i;
  }
  DaeWriter dae = morphed({});
  dae.geometries +=
      test::dae_geometry("small", test::dae_source("small-p", {0, 0, 0, 1, 0, 0}, "XYZ"), "");
  const std::size_t target = dae.controllers.find("large");
  dae.controllers.replace(target, 5, "small");
  EXPECT_TRUE(test::is_refused(dae, "8 vertices"));
}

TEST(DaeController, OfNeitherKindIsRefused) {
  DaeWriter dae;
  dae.controllers = "<controller id='c'/>";
  dae.nodes = "<node><instance_controller url='#c'/></node>";
  EXPECT_TRUE(test::is_refused(dae, "<skin>"));
}

}  // namespace
}  // namespace firstcontact
