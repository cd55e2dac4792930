#include <firstcontact/scene/shape_cache.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/scene/detail/make_shape.h>
#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/sha256.h>

#include "scene/load_text.h"
#include "scene/robot_text.h"

namespace firstcontact {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const std::string kPyramid =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 9 9 9\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

/// Shapes are the same where they share their hierarchy.
bool is_same(const CachedShape& a, const CachedShape& b) {
  return &a.shape.hierarchy() == &b.shape.hierarchy();
}

class ShapeCaches : public testing::Test {
 protected:
  ShapeCaches() {
    folder_.write("p.obj", kPyramid);
    folder_.write("p.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  }

  [[nodiscard]] MeshFile file(double scale = 1.0) const {
    return {folder_.path() / "p.obj", scale};
  }

  test::ArmFolder folder_;
  ShapeCache cache_;
};

TEST_F(ShapeCaches, MakeEachShapeOnce) {
  const std::vector<BodyShape> shapes = {
      {.source = file()},
      {.source = file(2.0)},
      {.source = file(), .radius = 0.1},
      {.source = file(), .filling = Filling::solid},
      {.source = ConvexHullShape{file()}},
      {.source = PointFile{folder_.path() / "p.xyz"}},
      {.source = SphereShape{1.0}},
      {.source = SphereShape{2.0}},
      {.source = CapsuleShape{1.0, 2.0}},
      {.source = CapsuleShape{2.0, 1.0}},
      {.source = BoxShape{{1, 2, 3}}},
      {.source = BoxShape{{3, 2, 1}}},
      {.source = CylinderShape{1.0, 2.0, {}}},
      {.source = CylinderShape{1.0, 2.0, 0.01}},
      {.source = ConeShape{1.0, 2.0, {}}},
      {.source = ConeShape{1.0, 2.0, 0.01}},
      {.source = EllipsoidShape{{1.0, 2.0, 3.0}, {}}},
      {.source = EllipsoidShape{{1.0, 2.0, 3.0}, 0.1}},
  };
  std::set<const Hierarchy*> made;
  for (const BodyShape& shape : shapes) {
    const CachedShape first = cache_.load(shape);
    EXPECT_TRUE(is_same(first, cache_.load(shape))) << shape.source.index();
    EXPECT_TRUE(made.insert(&first.shape.hierarchy()).second) << shape.source.index();
    const ShapeReading alone = detail::make_shape(shape);
    EXPECT_EQ(first.shape.compare(alone.shape), 0) << shape.source.index();
  }
}

TEST_F(ShapeCaches, KeepWhatAThreadMakesForAllOthers) {
  std::vector<CachedShape> loaded(8, {.shape = make_sphere(1.0), .digest = {}});
  std::vector<std::thread> threads;
  for (CachedShape& shape : loaded) {
    threads.emplace_back([&] { shape = cache_.load({.source = file()}); });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (const CachedShape& shape : loaded) {
    EXPECT_TRUE(is_same(shape, loaded.front()));
  }
}

TEST_F(ShapeCaches, NameTheFileByItsDigestAndDoNotReadItAgain) {
  const CachedShape before = cache_.load({.source = file()});
  EXPECT_EQ(before.digest, detail::sha256(kPyramid));
  ASSERT_TRUE(before.report);
  EXPECT_EQ(before.report->path, file().path.string());
  EXPECT_EQ(cache_.load({.source = SphereShape{1.0}}).digest, "");
  EXPECT_FALSE(cache_.load({.source = SphereShape{1.0}}).report);
  folder_.write("p.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_TRUE(is_same(cache_.load({.source = file()}), before));
  ShapeCache other;
  EXPECT_NE(other.load({.source = file()}).digest, before.digest);
}

// A failure is not kept: the next to ask reads again.
TEST_F(ShapeCaches, TryAgainWhereNoShapeCouldBeMade) {
  folder_.write("later.obj", "f 1 2 3\n");
  const BodyShape later{.source = MeshFile{folder_.path() / "later.obj"}};
  EXPECT_THROW((void)cache_.load(later), ParseError);
  folder_.write("later.obj", kPyramid);
  EXPECT_EQ(cache_.load(later).shape.mesh().triangles.size(), 4u);
}

// Also where the cache has a shape whose numbers compare as equal to them, as those of NaN do.
TEST_F(ShapeCaches, RefuseNumbersThatAreOutOfRange) {
  (void)cache_.load({.source = SphereShape{1.0}});
  EXPECT_THROW((void)cache_.load({.source = SphereShape{kNan}}), std::invalid_argument);
  EXPECT_THROW((void)cache_.load({.source = SphereShape{-1.0}}), std::invalid_argument);
  (void)cache_.load({.source = CylinderShape{1.0, 1.0, {}}});
  EXPECT_THROW((void)cache_.load({.source = CylinderShape{1.0, 1.0, 0.0}}), std::invalid_argument);
  (void)cache_.load({.source = ConeShape{1.0, 1.0, {}}});
  EXPECT_THROW((void)cache_.load({.source = ConeShape{1.0, 1.0, 0.0}}), std::invalid_argument);
  (void)cache_.load({.source = file()});
  EXPECT_THROW((void)cache_.load({.source = file(), .radius = kNan}), ParseError);
  EXPECT_EQ(cache_.load({.source = SphereShape{1.0}}).shape.radius(), 1.0);
}

TEST_F(ShapeCaches, RefuseASolidThatIsNotClosed) {
  const Mesh open{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  EXPECT_THROW((void)cache_.load({.source = open, .filling = Filling::solid}),
               std::invalid_argument);
  folder_.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string path = (folder_.path() / "open.obj").string();
  const std::string said = test::message_of<ParseError>(
      [&] { (void)cache_.load({.source = MeshFile{path}, .filling = Filling::solid}); });
  EXPECT_EQ(said.substr(0, path.size() + 2), path + ": ");
}

TEST_F(ShapeCaches, KnowWhichMeshesEncloseSpace) {
  folder_.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const BodyShape closed{.source = file()};
  const BodyShape open{.source = MeshFile{folder_.path() / "open.obj"}};
  const BodyShape inside_out{
      .source = Mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                     {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 3, 0}}}};  // The last one faces inwards.
  for (int again = 0; again < 2; ++again) {
    EXPECT_TRUE(cache_.encloses_space(cache_.load(closed).shape, &closed));
    EXPECT_FALSE(cache_.encloses_space(cache_.load(open).shape, &open));
    EXPECT_FALSE(cache_.encloses_space(cache_.load(inside_out).shape, &inside_out));
    EXPECT_TRUE(cache_.encloses_space(make_box({1, 1, 1}), nullptr));
  }
}

TEST_F(ShapeCaches, MakeEachRobotOnce) {
  const RobotFile arm{.urdf = folder_.path() / "arm.urdf"};
  const CachedRobot first = cache_.load(arm);
  const CachedRobot again = cache_.load(arm);
  EXPECT_EQ(first.model.links().data(), again.model.links().data());
  EXPECT_EQ(first.digest, again.digest);
  EXPECT_EQ(first.model.links()[1].collision.size(), 1u);
  ASSERT_TRUE(first.files);
  EXPECT_EQ(first.files->at(0).path, arm.urdf.string());
  // Only what checks it asks for geometry; a simulation takes links without any.
  const std::string scene = R"({"firstcontact": 1, "robots": [{"name": "arm", "urdf": ")" +
                            arm.urdf.string() + R"(", "surface": "visual"}]})";
  EXPECT_EQ(test::message_of<ParseError>([&] { (void)test::load_text(scene); }),
            arm.urdf.string() + ": expected links with <visual> geometry, none has any");
}

// All files of a robot are in its digest.
TEST_F(ShapeCaches, NameARobotByItsMeshesToo) {
  const auto digest = [&](const std::string& mesh) {
    folder_.write("link.obj", mesh);
    folder_.write("mesh.urdf", R"(<robot name="m"><link name="a"><collision><geometry>
        <mesh filename="link.obj"/></geometry></collision></link></robot>)");
    return ShapeCache().load(RobotFile{.urdf = folder_.path() / "mesh.urdf"}).digest;
  };
  const std::string pyramid = digest(kPyramid);
  EXPECT_EQ(digest(kPyramid), pyramid);
  EXPECT_NE(digest(kPyramid + "# more\n"), pyramid);
}

// A vertex that no triangle uses is no part of a hull; a scale applies to every kind of file.
TEST_F(ShapeCaches, MakeHullsOfVerticesThatTrianglesUse) {
  for (const double scale : {1.0, 0.5}) {
    const Shape hull = cache_.load({.source = ConvexHullShape{file(scale)}, .radius = 0.1}).shape;
    EXPECT_EQ(hull.mesh().vertices.size(), 4u);
    EXPECT_EQ(hull.radius(), 0.1);
    for (const Eigen::Vector3d& vertex : hull.mesh().vertices) {
      EXPECT_LE(vertex.maxCoeff(), scale);
    }
  }
  const PointFile points{folder_.path() / "p.xyz", 0.5};
  EXPECT_EQ(cache_.load({.source = points}).shape.mesh().vertices.at(1),
            Eigen::Vector3d(0.5, 0, 0));
}

TEST(MakeShape, NamesTheFileThatAShapeIsIn) {
  const MeshFile mesh{"a.obj"};
  EXPECT_EQ(*detail::file_of({.source = mesh}), "a.obj");
  EXPECT_EQ(*detail::file_of({.source = ConvexHullShape{mesh}}), "a.obj");
  EXPECT_EQ(*detail::file_of({.source = PointFile{"a.pcd"}}), "a.pcd");
  EXPECT_EQ(*detail::file_of({.source = HeightFile{"a.csv"}}), "a.csv");
  EXPECT_EQ(detail::file_of({.source = SphereShape{1.0}}), nullptr);
  EXPECT_EQ(detail::file_of({.source = ConvexHullShape{std::vector<Eigen::Vector3d>{}}}), nullptr);
}

}  // namespace
}  // namespace firstcontact
