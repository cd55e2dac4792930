// Placement and shape of the meshes of glTF: scenes, nodes, instances, skins, morph targets.

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "model_files/gltf_body.h"
#include "model_files/gltf_reading.h"
#include "support/gltf_writer.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using test::Corners;
using test::float_corners;
using test::GltfTest;
using test::GltfWriter;
using test::has_corners;
using test::mapped;
using test::mesh_text;
using test::plain_gltf;
using test::primitive_text;
using test::turned_over;

class GltfNodes : public GltfTest {
 protected:
  /// The body below these nodes; the last of them has the mesh.
  static GltfWriter below(const std::vector<std::string>& members) {
    GltfWriter gltf = plain_gltf();
    gltf.nodes.clear();
    for (std::size_t i = 0; i < members.size(); ++i) {
      const bool last = i + 1 == members.size();
      gltf.nodes.push_back(
          "{" + members[i] + (members[i].empty() ? "" : ",") +
          (last ? "\"mesh\":0}" : "\"children\":[" + std::to_string(i + 1) + "]}"));
    }
    return gltf;
  }
};

TEST_F(GltfNodes, MoveTurnAndScaleInThisOrder) {
  // A quarter turn about z maps x to y; powers of two and whole numbers are exact.
  const GltfWriter gltf =
      below({R"("translation":[4,-2,1],"rotation":[0,0,0.5,0.5],"scale":[2,4,0.5])"});
  const Mesh mesh = read_glb(gltf);
  EXPECT_TRUE(has_corners(mesh, mapped(float_corners(), [](const Vector3d& p) {
                            return Vector3d(4.0 - 4.0 * p.y(), -2.0 + 2.0 * p.x(),
                                            1.0 + 0.5 * p.z());
                          })));
}

TEST_F(GltfNodes, TakeQuaternionsOfAnyLength) {
  for (const char* const rotation :
       {"[0,0,1e-200,1e-200]", "[0,0,3e38,3e38]", "[0,0,1e300,1e300]"}) {
    EXPECT_TRUE(has_corners(
        read_glb(below({R"("rotation":)" + std::string(rotation)})),
        mapped(float_corners(), [](const Vector3d& p) { return Vector3d(-p.y(), p.x(), p.z()); })))
        << rotation;
  }
}

TEST_F(GltfNodes, TakeMatricesByColumns) {
  const GltfWriter gltf = below({R"("matrix":[0,2,0,0, -1,0,0,0, 0,0,4,0, 3,5,7,1])"});
  EXPECT_TRUE(has_corners(read_glb(gltf), mapped(float_corners(), [](const Vector3d& p) {
                            return Vector3d(3.0 - p.y(), 5.0 + 2.0 * p.x(), 7.0 + 4.0 * p.z());
                          })));
}

TEST_F(GltfNodes, AreMovedWithTheirParents) {
  const GltfWriter gltf =
      below({R"("translation":[0,0,16])", R"("scale":[2,2,2])", R"("translation":[8,0,0])"});
  EXPECT_TRUE(
      has_corners(read_glb(gltf), mapped(float_corners(), [](const Vector3d& p) -> Vector3d {
                    return 2.0 * (p + Vector3d(8, 0, 0)) + Vector3d(0, 0, 16);
                  })));
}

TEST_F(GltfNodes, ThatMirrorKeepTheInsideInside) {
  const auto mirror = [](const Vector3d& p) { return Vector3d(-p.x(), p.y(), p.z()); };
  const Corners mirrored = turned_over(mapped(float_corners(), mirror));
  EXPECT_TRUE(has_corners(read_glb(below({R"("scale":[-1,1,1])"})), mirrored));
  EXPECT_TRUE(
      has_corners(read_glb(below({R"("matrix":[-1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1])"})), mirrored));
  // Two mirrors turn nothing over, and tiny ones count as well.
  EXPECT_TRUE(has_corners(
      read_glb(below({R"("scale":[-1,1,1])", R"("scale":[1,-1,1])"})),
      mapped(float_corners(), [](const Vector3d& p) { return Vector3d(-p.x(), -p.y(), p.z()); })));
  EXPECT_TRUE(has_corners(read_glb(below({R"("scale":[-1e-150,1e-150,1e-150])"})),
                          turned_over(mapped(float_corners(), [](const Vector3d& p) {
                            return Vector3d(-1e-150 * p.x(), 1e-150 * p.y(), 1e-150 * p.z());
                          }))));
}

TEST_F(GltfNodes, PlaceOneMeshOften) {
  GltfWriter gltf = plain_gltf();
  gltf.nodes = {R"({"children":[2,1]})", R"({"mesh":0})", R"({"mesh":0,"translation":[64,0,0]})"};
  Corners both =
      mapped(float_corners(), [](const Vector3d& p) -> Vector3d { return p + Vector3d(64, 0, 0); });
  const Corners second = float_corners();
  both.insert(both.end(), second.begin(), second.end());
  EXPECT_TRUE(has_corners(read_glb(gltf), both));  // In the order of the children.
}

TEST_F(GltfNodes, AreReadTenThousandDeep) {
  std::vector<std::string> chain(10'000, R"("translation":[0,0,1])");
  const Mesh mesh = read_glb(below(chain));
  EXPECT_TRUE(has_corners(mesh, mapped(float_corners(), [](Vector3d p) {
                            return Vector3d(p.x(), p.y(), p.z() + 10'000.0);
                          })));
}

class GltfScenes : public GltfTest {
 protected:
  /// Two nodes with the body, the second 64 m aside.
  static GltfWriter two(const std::string& scenes) {
    GltfWriter gltf = plain_gltf();
    gltf.nodes = {R"({"mesh":0})", R"({"mesh":0,"translation":[64,0,0]})"};
    gltf.scenes = scenes;
    return gltf;
  }
  static Corners aside() {
    return mapped(float_corners(),
                  [](const Vector3d& p) -> Vector3d { return p + Vector3d(64, 0, 0); });
  }
  static bool warns(const MeshReading& reading, const std::string& says) {
    for (const std::string& warning : reading.report.warnings) {
      if (warning.find(says) != std::string::npos) {
        return true;
      }
    }
    return false;
  }
};

TEST_F(GltfScenes, AreReadWhereTheyAreTheDefault) {
  const auto reading =
      read("body.glb", two(R"("scene":1,"scenes":[{"nodes":[0]},{"nodes":[1]}],)").glb());
  EXPECT_TRUE(has_corners(reading.mesh, aside()));
  EXPECT_TRUE(warns(reading, "nodes[0]: its mesh is left out"));
}

TEST_F(GltfScenes, AreReadWhereTheyAreTheFirstAndNoneIsTheDefault) {
  const auto reading = read("body.glb", two(R"("scenes":[{"nodes":[1]},{"nodes":[0]}],)").glb());
  EXPECT_TRUE(has_corners(reading.mesh, aside()));
  EXPECT_TRUE(warns(reading, "the first is read"));
  EXPECT_TRUE(warns(reading, "nodes[0]: its mesh is left out"));
}

TEST_F(GltfScenes, AreAllRootsWhereThereAreNone) {
  const auto reading = read("body.glb", two("").glb());
  EXPECT_EQ(reading.mesh.triangles.size(), 24u);
  EXPECT_TRUE(warns(reading, "no scene"));
}

class GltfInstances : public GltfTest {
 protected:
  static GltfWriter instanced(GltfWriter gltf, const std::string& attributes) {
    gltf.nodes = {R"({"mesh":0,"translation":[0,0,32],"extensions":{"EXT_mesh_gpu_instancing":)"
                  R"({"attributes":{)" +
                  attributes + "}}}}"};
    gltf.more = R"("extensionsRequired":["EXT_mesh_gpu_instancing"],)";
    return gltf;
  }
};

TEST_F(GltfInstances, AreMovedTurnedAndScaledBelowTheirNode) {
  GltfWriter gltf = plain_gltf();
  gltf.add_numbers(std::vector<float>{8, 0, 0, 0, -16, 0}, "VEC3");
  gltf.add_numbers(std::vector<float>{0, 0, 0, 1, 0, 0, 0.5f, 0.5f}, "VEC4");
  gltf.add_numbers(std::vector<float>{1, 1, 1, -2, 2, 2}, "VEC3");
  const Mesh mesh = read_glb(instanced(gltf, R"("TRANSLATION":2,"ROTATION":3,"SCALE":4,"_ID":1)"));
  Corners expected =
      mapped(float_corners(), [](const Vector3d& p) -> Vector3d { return p + Vector3d(8, 0, 32); });
  const Corners second = turned_over(mapped(float_corners(), [](const Vector3d& p) {
    return Vector3d(-2.0 * p.y(), -16.0 - 2.0 * p.x(), 32.0 + 2.0 * p.z());
  }));
  expected.insert(expected.end(), second.begin(), second.end());
  EXPECT_TRUE(has_corners(mesh, expected));
}

template <class T>
void expect_turned(const Mesh& mesh) {
  EXPECT_TRUE(has_corners(mesh, mapped(float_corners(), [](const Vector3d& p) {
                            return Vector3d(-p.y(), p.x(), p.z() + 32.0);
                          })));
}

TEST_F(GltfInstances, TakeNormalisedRotations) {
  GltfWriter bytes = plain_gltf();
  bytes.add_numbers(std::vector<std::int8_t>{0, 0, 90, 90}, "VEC4", "\"normalized\":true,");
  expect_turned<std::int8_t>(read_glb(instanced(bytes, R"("ROTATION":2)")));
  GltfWriter shorts = plain_gltf();
  shorts.add_numbers(std::vector<std::int16_t>{0, 0, 23170, 23170}, "VEC4", "\"normalized\":true,");
  expect_turned<std::int16_t>(read_glb(instanced(shorts, R"("ROTATION":2)")));
}

TEST_F(GltfInstances, AreRefusedWhereTheyDoNotFit) {
  GltfWriter gltf = plain_gltf();
  gltf.add_numbers(std::vector<float>{8, 0, 0, 0, -16, 0}, "VEC3");
  gltf.add_numbers(std::vector<float>{0, 0, 0, 1}, "VEC4");
  gltf.add_numbers(std::vector<float>{0, 0, 0, 0, 0, 0, 0, 1}, "VEC4");
  EXPECT_TRUE(is_refused(instanced(gltf, R"("TRANSLATION":2,"ROTATION":3)"), "as many elements"));
  EXPECT_TRUE(is_refused(instanced(gltf, R"("TRANSLATION":2,"ROTATION":4)"), "quaternion"));
  EXPECT_TRUE(is_refused(instanced(gltf, R"("TRANSLATION":9)"), "an index of accessors"));
  EXPECT_TRUE(is_refused(instanced(gltf, R"("TRANSLATE":2)"), "TRANSLATE"));
  EXPECT_TRUE(is_refused(instanced(gltf, ""), "TRANSLATION, ROTATION or SCALE"));
}

class GltfSkins : public GltfTest {
 protected:
  /// The body bound to two joints; accessor 2 is JOINTS_0, accessor 3 WEIGHTS_0.
  template <class Joint, class Weight>
  static GltfWriter bound(Weight first, Weight second, const std::string& skin_members = "") {
    GltfWriter gltf = plain_gltf();
    std::vector<Joint> joints;
    std::vector<Weight> weights;
    for (int i = 0; i < 8; ++i) {
      joints.insert(joints.end(), {0, 1, 0, 0});
      weights.insert(weights.end(), {first, second, 0, 0});
    }
    gltf.add_numbers(joints, "VEC4");
    gltf.add_numbers(weights, "VEC4", std::is_integral_v<Weight> ? "\"normalized\":true," : "");
    gltf.meshes = {mesh_text({primitive_text(0, 1, R"(,"JOINTS_0":2,"WEIGHTS_0":3)")})};
    gltf.skins = {R"({"joints":[1,2])" + skin_members + "}"};
    gltf.nodes = {R"({"mesh":0,"skin":0,"translation":[1000,0,0]})",
                  R"({"translation":[16,0,0],"children":[2]})", R"({"translation":[0,32,0]})"};
    gltf.scenes = R"("scene":0,"scenes":[{"nodes":[0,1]}],)";
    return gltf;
  }
  static Corners moved(const Vector3d& by) {
    return mapped(float_corners(), [&](const Vector3d& p) -> Vector3d { return p + by; });
  }
};

TEST_F(GltfSkins, FollowTheirJointsAndNotTheirNode) {
  EXPECT_TRUE(has_corners(read_glb(bound<std::uint8_t, float>(1, 0)), moved({16, 0, 0})));
  EXPECT_TRUE(has_corners(read_glb(bound<std::uint16_t, float>(0, 1)), moved({16, 32, 0})));
}

TEST_F(GltfSkins, TakeTheMeanOfJointsByWeightsOfEachType) {
  EXPECT_TRUE(has_corners(read_glb(bound<std::uint8_t, float>(0.5f, 0.5f)), moved({16, 16, 0})));
  // The weights are used as shares of their sum, so that rounded ones move nothing.
  EXPECT_TRUE(
      has_corners(read_glb(bound<std::uint8_t, std::uint8_t>(127, 127)), moved({16, 16, 0})));
  EXPECT_TRUE(
      has_corners(read_glb(bound<std::uint16_t, std::uint16_t>(32767, 32767)), moved({16, 16, 0})));
}

TEST_F(GltfSkins, WarnWhereWeightsDoNotAddUpToOne) {
  const auto reading = read("body.glb", bound<std::uint8_t, float>(0.25f, 0.25f).glb());
  EXPECT_TRUE(has_corners(reading.mesh, moved({16, 16, 0})));
  ASSERT_EQ(reading.report.warnings.size(), 1u);  // One for all of the vertices.
  EXPECT_NE(reading.report.warnings[0].find("add up to 0.5"), std::string::npos);
  EXPECT_TRUE(
      read("body.glb", bound<std::uint8_t, std::uint8_t>(127, 127).glb()).report.warnings.empty());
}

TEST_F(GltfSkins, HeedInverseBindMatrices) {
  GltfWriter gltf = bound<std::uint8_t, float>(0.5f, 0.5f, R"(,"inverseBindMatrices":4)");
  std::vector<float> matrices;
  for (const float x : {-16.0f, 48.0f}) {
    matrices.insert(matrices.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, 0, 1});
  }
  gltf.add_numbers(matrices, "MAT4");
  EXPECT_TRUE(has_corners(read_glb(gltf), moved({32, 16, 0})));
}

TEST_F(GltfSkins, AddTheirSetsOfJoints) {
  GltfWriter gltf = bound<std::uint8_t, float>(0.5f, 0.0f);
  gltf.add_numbers(std::vector<std::uint8_t>(32, 1), "VEC4");
  std::vector<float> weights;
  for (int i = 0; i < 8; ++i) {
    weights.insert(weights.end(), {0, 0.25f, 0, 0.25f});
  }
  gltf.add_numbers(weights, "VEC4");
  gltf.meshes = {mesh_text(
      {primitive_text(0, 1, R"(,"JOINTS_0":2,"WEIGHTS_0":3,"JOINTS_1":4,"WEIGHTS_1":5)")})};
  EXPECT_TRUE(has_corners(read_glb(gltf), moved({16, 16, 0})));
}

TEST_F(GltfSkins, WhoseJointsMirrorKeepTheInsideInside) {
  GltfWriter gltf = bound<std::uint8_t, float>(1, 0);
  gltf.nodes[1] = R"({"scale":[-1,1,1],"children":[2]})";
  EXPECT_TRUE(
      has_corners(read_glb(gltf), turned_over(mapped(float_corners(), [](const Vector3d& p) {
                    return Vector3d(-p.x(), p.y(), p.z());
                  }))));
}

TEST_F(GltfSkins, AreRefusedWhereTheyDoNotFit) {
  EXPECT_TRUE(is_refused(bound<std::uint8_t, float>(0, 0), "weights of zero"));
  EXPECT_TRUE(is_refused(bound<std::uint8_t, float>(2, -1), "weights >= 0"));
  GltfWriter gltf = bound<std::uint8_t, float>(0.5f, 0.5f);
  gltf.skins = {R"({"joints":[1]})"};
  EXPECT_TRUE(is_refused(gltf, "got joint 1"));
  gltf.skins = {R"({"joints":[1,7]})"};
  EXPECT_TRUE(is_refused(gltf, "an index of nodes"));
  gltf.skins = {R"({"joints":[1,2],"inverseBindMatrices":0})"};
  EXPECT_TRUE(is_refused(gltf, "MAT4"));
  gltf = bound<std::uint8_t, float>(0.5f, 0.5f);
  gltf.meshes = {mesh_text({primitive_text(0, 1)})};
  EXPECT_TRUE(is_refused(gltf, "JOINTS_0"));
  gltf.meshes = {mesh_text({primitive_text(0, 1, R"(,"JOINTS_0":2)")})};
  EXPECT_TRUE(is_refused(gltf, "WEIGHTS_0"));
}

// As shares of the greatest integer, all joints but one would be joint 0.
TEST_F(GltfSkins, HaveNoNormalisedJoints) {
  GltfWriter gltf = bound<std::uint8_t, float>(0.5f, 0.5f);
  const std::vector<std::uint8_t> joints(32, 1);
  const std::size_t index = gltf.add_numbers(joints, "VEC4", "\"normalized\":true,");
  gltf.meshes = {mesh_text(
      {primitive_text(0, 1, R"(,"JOINTS_0":)" + std::to_string(index) + R"(,"WEIGHTS_0":3)")})};
  EXPECT_TRUE(is_refused(gltf, "normalized: expected false here"));
}

class GltfMorphs : public GltfTest {
 protected:
  /// The body with a target that moves the top by (0, 0, 64), and a second one by (128, 0, 0).
  static GltfWriter morphing(const std::string& mesh_members,
                             const std::string& node_members = "") {
    GltfWriter gltf = plain_gltf();
    std::vector<float> up(24, 0.0f);
    std::vector<std::uint8_t> rows;
    std::string values;
    for (std::size_t i = 4; i < 8; ++i) {
      up[3 * i + 2] = 64.0f;
      rows.push_back(static_cast<std::uint8_t>(i));
      values += test::little_endian(128.0f) + std::string(8, '\0');
    }
    gltf.add_numbers(up, "VEC3");
    const auto indices = std::to_string(gltf.add_view(std::string(rows.begin(), rows.end())));
    const auto view = std::to_string(gltf.add_view(values));
    gltf.add_accessor(R"("sparse":{"count":4,"indices":{"bufferView":)" + indices +
                          R"(,"componentType":5121},"values":{"bufferView":)" + view + "}},",
                      5126, 8, "VEC3");
    gltf.meshes = {mesh_text(
        {primitive_text(0, 1, "", R"(,"targets":[{"POSITION":2,"NORMAL":2},{"POSITION":3}])")},
        mesh_members)};
    gltf.nodes = {R"({"mesh":0)" + node_members + "}"};
    return gltf;
  }
  /// The body with its top moved.
  static Corners top_moved(const Vector3d& by) {
    return mapped(float_corners(),
                  [&](const Vector3d& p) -> Vector3d { return p.z() > 0.0 ? p + by : p; });
  }
};

TEST_F(GltfMorphs, ActByTheWeightsOfTheMesh) {
  EXPECT_TRUE(has_corners(read_glb(morphing(R"(,"weights":[0.5,0.25])")), top_moved({32, 0, 32})));
  EXPECT_TRUE(has_corners(read_glb(morphing("")), float_corners()));
}

TEST_F(GltfMorphs, ActByTheWeightsOfTheNodeWhereItHasThem) {
  EXPECT_TRUE(has_corners(read_glb(morphing(R"(,"weights":[0.5,0.25])",
                                            R"(,"weights":[0,-0.5],"translation":[8,0,0])")),
                          mapped(top_moved({-64, 0, 0}), [](const Vector3d& p) -> Vector3d {
                            return p + Vector3d(8, 0, 0);
                          })));
}

TEST_F(GltfMorphs, AddIntegersToFloats) {
  GltfWriter gltf = morphing(R"(,"weights":[0.5])");
  std::vector<std::int8_t> up(24, 0);
  for (std::size_t i = 4; i < 8; ++i) {
    up[3 * i + 1] = -127;
  }
  const auto target = std::to_string(gltf.add_numbers(up, "VEC3", "\"normalized\":true,"));
  gltf.meshes = {
      mesh_text({primitive_text(0, 1, "", R"(,"targets":[{"POSITION":)" + target + "}]")},
                R"(,"weights":[0.5])")};
  EXPECT_TRUE(has_corners(read_glb(gltf), top_moved({0, -0.5, 0})));
}

TEST_F(GltfMorphs, AreRefusedWhereTheyDoNotFit) {
  EXPECT_TRUE(is_refused(morphing(R"(,"weights":[0.5])"), "a weight for each of 2"));
  EXPECT_TRUE(is_refused(morphing(R"(,"weights":["a",0])"), "a number"));
  GltfWriter gltf = morphing("");
  gltf.meshes = {mesh_text({primitive_text(0, 1, "", R"(,"targets":[{"POSITION":1}])")})};
  EXPECT_TRUE(is_refused(gltf, "VEC3"));
  gltf.meshes = {mesh_text({primitive_text(0, 1, "", R"(,"targets":[{"POSITION":12}])")})};
  EXPECT_TRUE(is_refused(gltf, "an index of accessors"));
}

}  // namespace
}  // namespace firstcontact
