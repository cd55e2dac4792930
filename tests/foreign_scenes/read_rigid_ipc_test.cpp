#include <firstcontact/foreign_scenes/read_rigid_ipc.h>
#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/scene_files/read_simulation_scene.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>

#include <firstcontact/geometry/mass_properties.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_scene.h>
#include <firstcontact/text/parse_error.h>

#include "scene/scene_bits.h"
#include "support/data_dir.h"
#include "support/rounds.h"

namespace firstcontact {
namespace {

namespace fs = std::filesystem;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180.0;

/// A folder of fixtures with meshes: a cube of 1 m, two of them, a sheet of 2 m by 1 m whose middle
/// is at x = 1, a ring of four edges, four points.
class RigidIpc : public testing::Test {
 protected:
  RigidIpc()
      : folder_(fs::path(testing::TempDir()) /
                ("read_rigid_ipc_test." + std::to_string(getpid()))) {
    fs::create_directories(folder_ / "meshes");
    fs::create_directories(folder_ / "fixtures" / "deep");
    const std::string cube = cube_at(0.0);
    write("meshes/cube.obj", cube);
    write("meshes/two.obj", cube + cube_at(5.0));
    write("meshes/sheet.obj", "v 0 0 -0.5\nv 2 0 -0.5\nv 2 0 0.5\nv 0 0 0.5\nf 1 3 2\nf 1 4 3\n");
    write("meshes/ring.obj", "v 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nl 1 2\nl 2 3\nl 3 4\nl 4 1\n");
    write("meshes/points.obj", "# alone\nv 1 0 0\nv -1 0 0\nv 0 2 0\nv 0 -2 0\n");
    write("meshes/line.obj", "v 1 0 0\nv -1 0 0\nl 1 2\n");
  }
  ~RigidIpc() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }

  [[nodiscard]] fs::path source() const { return folder_ / "fixtures" / "deep" / "f.json"; }

  /// A scene of bodies; `more` has its other keys.
  [[nodiscard]] Scene read(const std::string& bodies, const std::string& more = "",
                           const std::string& problem = "") const {
    return parse_rigid_ipc(text(bodies, more, problem), source());
  }

  [[nodiscard]] std::string error(const std::string& bodies, const std::string& more = "",
                                  const std::string& problem = "") const {
    try {
      (void)read(bodies, more, problem);
    } catch (const ParseError& error) {
      return error.message();
    }
    return "accepted";
  }

  static std::string text(const std::string& bodies, const std::string& more,
                          const std::string& problem) {
    return "{" + more + R"("rigid_body_problem": {)" + problem + R"("rigid_bodies": [)" + bodies +
           "]}}";
  }

 private:
  static std::string cube_at(double x) {
    std::string text;
    for (int k = 0; k < 8; ++k) {
      text += "v " + std::to_string(x + (k & 1 ? 0.5 : -0.5)) + (k & 2 ? " 0.5" : " -0.5") +
              (k & 4 ? " 0.5" : " -0.5") + "\n";
    }
    // Counted back from the last vertex, so that cubes can follow each other.
    for (const char* face : {"1 5 7 3", "2 4 8 6", "1 2 6 5", "3 7 8 4", "1 3 4 2", "5 6 8 7"}) {
      text += "f";
      for (const char* c = face; *c != '\0'; ++c) {
        text += *c == ' ' ? "" : " " + std::to_string(*c - '0' - 9);
      }
      text += "\n";
    }
    return text;
  }

  fs::path folder_;
};

Pose fixed_pose(const Body& body) { return std::get<FixedMotion>(body.motion).pose; }

TEST_F(RigidIpc, TakesDefaultsOfItsOwn) {
  const Scene scene = read(R"({"mesh": "cube.obj"})");
  const Simulation& simulation = scene.simulation.value();
  EXPECT_EQ(scene.id, "f");
  EXPECT_EQ(simulation.gravity, Vector3d::Zero());
  EXPECT_EQ(simulation.friction, 0.0);
  EXPECT_EQ(simulation.restitution, 0.0);
  EXPECT_EQ(simulation.step, 0.01);
  EXPECT_EQ(simulation.duration, 10.0);
  EXPECT_EQ(simulation.contact_distance, 1e-4);
  EXPECT_EQ(scene.duration, 10.0);
  ASSERT_EQ(scene.bodies.size(), 1u);
  EXPECT_EQ(scene.bodies[0].name, "cube");
  EXPECT_EQ(scene.bodies[0].free.value().density, 1000.0);
  EXPECT_EQ(std::get<MeshFile>(scene.bodies[0].shape.source).scale, 1.0);
  EXPECT_TRUE(scene.groups.empty());
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(RigidIpc, TakesTheSimulation) {
  const Scene scene =
      read(R"({"mesh": "cube.obj"})",
           R"("timestep": 0.025, "max_time": 2, "max_iterations": 7, "solver": "ipc_solver",
              "distance_barrier_constraint": {"initial_barrier_activation_distance": 0.01,
                                              "minimum_separation_distance": 0.05},)",
           R"("gravity": [0, -9.8, 0], "coefficient_friction": 0.3,
              "coefficient_restitution": -1,)");
  const Simulation& simulation = scene.simulation.value();
  EXPECT_EQ(simulation.step, 0.025);
  EXPECT_EQ(simulation.duration, 2.0);
  EXPECT_EQ(simulation.gravity, Vector3d(0, -9.8, 0));
  EXPECT_EQ(simulation.friction, 0.3);
  EXPECT_EQ(simulation.restitution, 0.0);
  EXPECT_DOUBLE_EQ(simulation.contact_distance.value(), 0.051);

  const auto duration = [&](const std::string& more) {
    return read(R"({"mesh": "cube.obj"})", more).simulation.value().duration;
  };
  EXPECT_EQ(duration(R"("timestep": 0.5, "max_iterations": 7,)"), 3.5);
  EXPECT_EQ(duration(R"("timestep": 0.5, "max_time": -1, "max_iterations": -1,)"), 500.0);
  const Scene without =
      read(R"({"mesh": "cube.obj"})", R"("friction_constraints": {"iterations": 0},)",
           R"("coefficient_friction": 0.3,)");
  EXPECT_EQ(without.simulation.value().friction, 0.0);
}

// Turned about the axes x, then y, then z of the world, about the origin of the mesh, which stands
// at the position.
TEST_F(RigidIpc, TurnsAboutFixedAxesInDegrees) {
  const Scene scene =
      read(R"({"mesh": "cube.obj", "position": [1, 2, 3], "rotation": [90, 0, 90]})");
  const Pose X_WB = fixed_pose(scene.bodies.at(0));
  EXPECT_EQ(X_WB.position, Vector3d(1, 2, 3));
  // x stays under the turn about x, and goes to y about z; z goes to -y, and that to x.
  EXPECT_LE((X_WB.rotation * Vector3d::UnitX() - Vector3d::UnitY()).norm(), 1e-15);
  EXPECT_LE((X_WB.rotation * Vector3d::UnitZ() - Vector3d::UnitX()).norm(), 1e-15);
}

TEST_F(RigidIpc, TakesWhatMovesABody) {
  const Scene scene = read(R"({"mesh": "cube.obj", "density": 7,
      "linear_velocity": [1, 2, 3], "angular_velocity": [180, 90, 360], "force": [1, 0, 2],
      "torque": [0, 180, 0], "is_dof_fixed": [false, true, false, true, false, false]})");
  const FreeBody& free = scene.bodies.at(0).free.value();
  EXPECT_EQ(free.density, 7.0);
  EXPECT_EQ(free.linear_velocity, Vector3d(1, 0, 3));
  EXPECT_LE((free.angular_velocity - Vector3d(0, 90 * kDegree, 360 * kDegree)).norm(), 1e-14);
  EXPECT_EQ(free.locked_translation, (std::array{false, true, false}));
  EXPECT_EQ(free.locked_rotation, (std::array{true, false, false}));
  ASSERT_EQ(free.forces.size(), 1u);
  EXPECT_EQ(free.forces[0].force, Vector3d(1, 0, 2));
  EXPECT_LE((free.forces[0].torque - Vector3d(0, std::numbers::pi, 0)).norm(), 1e-15);
  EXPECT_TRUE(std::isinf(free.forces[0].to));
}

TEST_F(RigidIpc, ScalesByFactorsOrToDimensions) {
  const auto extent = [&](const std::string& keys) {
    ShapeCache cache;
    const Scene scene = read(R"({"mesh": "two.obj", )" + keys + "}");
    const Mesh mesh = cache.load(scene.bodies.at(0).shape).shape.mesh();
    Eigen::AlignedBox3d bounds;
    for (const Vector3d& v : mesh.vertices) {
      bounds.extend(v);
    }
    return Vector3d(bounds.sizes());
  };
  EXPECT_EQ(extent(R"("scale": 2)"), Vector3d(12, 2, 2));
  EXPECT_EQ(extent(R"("scale": [1, 2, 3])"), Vector3d(6, 2, 3));
  EXPECT_LE((extent(R"("scale": 9, "dimensions": [1, 2, 3])") - Vector3d(1, 2, 3)).norm(), 1e-15);
}

TEST_F(RigidIpc, GivesSheetsRingsAndPointsAMass) {
  const Scene scene =
      read(R"({"mesh": "sheet.obj", "density": 3}, {"mesh": "ring.obj", "density": 3},
                              {"mesh": "points.obj", "density": 3})");
  // A plate of 2 m by 1 m in the plane y = 0: a^2 / 12 about the axes in it, their sum about y.
  const FreeBody& sheet = scene.bodies.at(0).free.value();
  EXPECT_NEAR(sheet.mass.value(), 6.0, 1e-15);
  EXPECT_LE((sheet.centre_of_mass.value() - Vector3d(1, 0, 0)).norm(), 1e-15);
  const Matrix3d plate = Vector3d(0.5, 2.5, 2.0).asDiagonal();
  EXPECT_LE((sheet.inertia.value() - plate).norm(), 1e-14);
  // Four rods of length s = sqrt(2), their middles at distance s / 2.
  const FreeBody& ring = scene.bodies.at(1).free.value();
  const double m = 3.0 * std::sqrt(2.0);
  EXPECT_NEAR(ring.mass.value(), 4.0 * m, 1e-14);
  EXPECT_NEAR(ring.inertia.value()(2, 2), 4.0 * (m * 2.0 / 12.0 + m * 0.5), 1e-14);
  const FreeBody& points = scene.bodies.at(2).free.value();
  EXPECT_EQ(points.mass, 12.0);
  const Matrix3d of_points = 3.0 * Vector3d(8, 2, 10).asDiagonal().toDenseMatrix();
  EXPECT_LE((points.inertia.value() - of_points).norm(), 1e-14);
}

TEST_F(RigidIpc, FixesAndScriptsBodies) {
  const Scene scene = read(R"({"mesh": "cube.obj", "type": "static"},
      {"mesh": "cube.obj", "is_dof_fixed": true},
      {"mesh": "sheet.obj", "type": "kinematic", "position": [0, 1, 0], "rotation": [0, 90, 0],
       "linear_velocity": [1, 0, 0], "angular_velocity": [0, 90, 0]},
      {"mesh": "cube.obj"})",
                           R"("max_time": 4,)");
  EXPECT_FALSE(scene.bodies.at(0).free);
  EXPECT_FALSE(scene.bodies.at(1).free);
  EXPECT_FALSE(scene.bodies.at(2).free);
  EXPECT_TRUE(scene.bodies.at(3).free);
  const auto& sheet = std::get<ConstantVelocityMotion>(scene.bodies[2].motion);
  // Its middle, at (1, 0, 0) of the mesh, is where the frame is.
  EXPECT_LE((sheet.from.position - Vector3d(0, 1, -1)).norm(), 1e-15);
  EXPECT_LE((sheet.translation - Vector3d(4, 0, 0)).norm(), 1e-15);
  EXPECT_LE((sheet.rotation_vector - Vector3d(0, 2.0 * std::numbers::pi, 0)).norm(), 1e-14);
  EXPECT_LE(
      (std::get<Shape>(scene.bodies[2].shape.source).mesh().vertices[0] - Vector3d(-1, 0, -0.5))
          .norm(),
      1e-15);
  // None of the three touches another.
  ASSERT_EQ(scene.groups.size(), 1u);
  EXPECT_EQ(scene.groups[0].bodies, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(scene.ignored_groups, (std::vector<GroupPair>{{0, 0}}));
}

TEST_F(RigidIpc, FollowsKinematicPosesThenVelocities) {
  const std::string cube = R"({"mesh": "cube.obj", "type": "kinematic", "position": [0, 5, 0],
      "kinematic_poses": [{"position": [0, 1, 0]}, {"position": [0, 2, 0]}],
      "angular_velocity": [900, 0, 0], "linear_velocity": [0, 0, 1])";
  const Scene scene =
      read(cube + "}, " + cube + R"(, "kinematic_max_time": 0.25})", R"("max_time": 1,)");
  const auto& motion = std::get<WaypointMotion>(scene.bodies.at(0).motion);
  ASSERT_GE(motion.times.size(), 4u);
  EXPECT_EQ(motion.poses[0].position, Vector3d(0, 5, 0));
  EXPECT_EQ(motion.times[1], 0.01);
  EXPECT_EQ(motion.poses[1].position, Vector3d(0, 1, 0));
  EXPECT_EQ(motion.times[2], 0.02);
  EXPECT_EQ(motion.times.back(), 1.0);
  EXPECT_LE((motion.poses.back().position - Vector3d(0, 2, 0.98)).norm(), 1e-15);
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(0.98 * 900.0 * kDegree, Vector3d::UnitX()));
  EXPECT_LE(motion.poses.back().rotation.angularDistance(turned), 1e-12);
  for (std::size_t k = 1; k < motion.poses.size(); ++k) {
    // So that the shortest turn from each to the next is the one that is meant.
    EXPECT_LE(motion.poses[k].rotation.angularDistance(motion.poses[k - 1].rotation),
              std::numbers::pi / 2.0 + 1e-9);
  }
  const auto& stopped = std::get<WaypointMotion>(scene.bodies.at(1).motion);
  EXPECT_EQ(stopped.times.back(), 0.25);
}

TEST_F(RigidIpc, SplitsComponents) {
  const Scene scene = read(R"({"mesh": "two.obj", "split_components": true, "scale": 2,
                               "position": [1, 0, 0], "angular_velocity": [0, 0, 45]})");
  ASSERT_EQ(scene.bodies.size(), 2u);
  EXPECT_EQ(scene.bodies[0].name, "two-part0");
  EXPECT_EQ(scene.bodies[1].name, "two-part1");
  ShapeCache cache;
  const MassProperties second = mass_properties(cache.load(scene.bodies[1].shape).shape);
  EXPECT_NEAR(second.volume, 8.0, 1e-14);
  EXPECT_LE((second.p_BC - Vector3d(10, 0, 0)).norm(), 1e-14);
  EXPECT_EQ(fixed_pose(scene.bodies[1]).position, Vector3d(1, 0, 0));
}

TEST_F(RigidIpc, NamesAndGroupsBodies) {
  const Scene scene =
      read(R"({"mesh": "cube.obj", "group_id": 2}, {"mesh": "cube.obj", "enabled": false},
      {"mesh": "cube.obj", "group_id": 2}, {"mesh": "sheet.obj", "type": "static", "group_id": 3},
      {"mesh": "ring.obj", "group_id": 3}, {"mesh": "points.obj"})");
  std::vector<std::string> names;
  for (const Body& body : scene.bodies) {
    names.push_back(body.name);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"cube-0", "cube-2", "sheet", "ring", "points"}));
  ASSERT_EQ(scene.groups.size(), 2u);
  EXPECT_EQ(scene.groups[0].bodies, (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(scene.groups[1].bodies, (std::vector<std::size_t>{0, 1}));
}

TEST_F(RigidIpc, PassesOverCommentsAndWarnsOfUnknownKeys) {
  const Scene scene = read(R"({"mesh": "cube.obj", "#type": "static", "colour": 1})",
                           "\"#max_time\": 1,\n\"maximum\": 2,");
  EXPECT_EQ(scene.warnings,
            (std::vector<std::string>{"line 2: unknown key \"maximum\" passed over",
                                      "line 2: unknown key \"colour\" passed over"}));
}

TEST_F(RigidIpc, SaysWhatIsWrong) {
  const auto expect = [&](const std::string& got, const std::string& part) {
    EXPECT_NE(got.find(part), std::string::npos) << got;
  };
  expect(error(""), "expected at least one body that is enabled, got none");
  expect(error("{}"), "rigid_bodies[0]: expected a key \"mesh\"");
  expect(error(R"({"mesh": "none.obj"})"), "mesh: expected a mesh file");
  expect(error(R"({"mesh": "none.obj"})"), "meshes/none.obj");
  expect(error(R"({"mesh": "cube.obj", "type": "dynmic"})"), "did you mean \"dynamic\"?");
  expect(error(R"({"mesh": "cube.obj", "is_dof_fixed": [true]})"), "true, false, or six of them");
  expect(error(R"({"mesh": "cube.obj", "density": 0})"), "density: expected a number > 0, got 0");
  expect(error(R"({"mesh": "cube.obj", "position": [0, 0]})"), "position: expected three numbers");
  expect(error(R"({"mesh": "line.obj"})"), "expected a mesh that does not lie on a line");
  expect(error(R"({"mesh": "cube.obj", "type": "kinematic", "kinematic_poses": [{}],
                   "angular_velocity": [0, 0, 1e6]})"),
         "rigid_bodies[0]: expected at most 2500 turns of a kinematic body");
  expect(error(R"({"mesh": "cube.obj"})", R"("timestep": 0,)"), "timestep: expected a number > 0");
  expect(error(R"({"mesh": "cube.obj"})", "", R"("coefficient_restitution": 2,)"),
         "coefficient_restitution: expected a number of at most 1, got 2");
  try {
    (void)parse_rigid_ipc("{}", "f.json");
    FAIL();
  } catch (const ParseError& error) {
    EXPECT_STREQ(error.what(),
                 "f.json:1: expected a scene of Rigid IPC, an object with \"rigid_body_problem\"");
  }
}

TEST_F(RigidIpc, IsToldFromOurScenes) {
  write("fixtures/deep/theirs.json", text(R"({"mesh": "cube.obj"})", "", ""));
  write(
      "fixtures/deep/ours.json",
      R"({"firstcontact": 1, "bodies": [{"name": "a", "shape": {"mesh": "../../meshes/cube.obj"}}]})");
  const fs::path folder = source().parent_path();
  EXPECT_EQ(read_simulation_scene(folder / "theirs.json").bodies.at(0).name, "cube");
  EXPECT_EQ(read_simulation_scene(folder / "ours.json").bodies.at(0).name, "a");
}

TEST_F(RigidIpc, IsWrittenAsASceneOfOurs) {
  const Scene scene = read(R"({"mesh": "cube.obj", "force": [1, 0, 0]}, {"mesh": "points.obj"},
      {"mesh": "sheet.obj", "type": "kinematic"}, {"mesh": "sheet.obj", "type": "static"})");
  const Scene again = parse_scene(write_scene(scene), "s");
  EXPECT_EQ(write_scene(again), write_scene(scene));
  EXPECT_EQ(again.simulation.value().contact_distance, scene.simulation.value().contact_distance);
}

/// The fixtures of Rigid IPC, in the order of their names; empty where they are not there.
std::vector<fs::path> fixtures() {
  const fs::path folder = test::data_dir() / "sim_rigid_ipc" / "fixtures";
  std::vector<fs::path> files;
  if (!test::data_dir().empty() && fs::is_directory(folder)) {
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.path().extension() == ".json") {
        files.push_back(entry.path());
      }
    }
  }
  std::ranges::sort(files);
  return files;
}

fs::path fixture(const std::string& name) {
  return test::data_dir() / "sim_rigid_ipc" / "fixtures" / "3D" / name;
}

TEST(RigidIpcFixtures, AreAllReadWithoutWarnings) {
  if (fixtures().empty()) {
    GTEST_SKIP() << "needs FIRSTCONTACT_DATA_DIR";
  }
  EXPECT_EQ(fixtures().size(), 52u);
  for (const fs::path& file : fixtures()) {
    const Scene scene = read_simulation_scene(file);
    EXPECT_TRUE(scene.warnings.empty()) << file << ": " << scene.warnings.front();
    EXPECT_TRUE(std::ranges::any_of(scene.bodies, [](const Body& body) {
      return body.free.has_value();
    })) << file;
  }
}

struct Gap {
  double least = std::numeric_limits<double>::infinity();  // [m]  Proven.
  std::string bodies;
};

/// The least distance of those pairs that may not touch, at the start.
Gap gap_at_start(const LoadedScene& loaded) {
  const BodySet& bodies = loaded.bodies;
  const auto centre = [&](std::size_t k) {
    const Pose X_WS = bodies.motion(k).pose(0.0);
    return Vector3d(X_WS.position + X_WS.rotation * bodies.shape(k).hierarchy().centre);
  };
  Workspace workspace;
  Gap gap;
  for (std::size_t a = 0; a < bodies.size(); ++a) {
    for (std::size_t b = a + 1; b < bodies.size(); ++b) {
      const double balls = (centre(a) - centre(b)).norm() - bodies.shape(a).hierarchy().radius -
                           bodies.shape(b).hierarchy().radius;
      if (!bodies.rules().margin({a, b}) || balls > gap.least) {
        continue;
      }
      const double found =
          distance(bodies.moving_shape(a), bodies.moving_shape(b), 0.0, workspace).lower_bound;
      if (found < gap.least) {
        gap = {found, loaded.scene.bodies[a].name + " and " + loaded.scene.bodies[b].name};
      }
    }
  }
  return gap;
}

// The closest pair, in `spike-in-crack`, is 0.0707 mm apart. A wrong pose or scale would make some
// touch.
TEST(RigidIpcFixtures, BeginWithBodiesApart) {
  if (fixtures().empty()) {
    GTEST_SKIP() << "needs FIRSTCONTACT_DATA_DIR";
  }
  const std::vector<fs::path> files = fixtures();
  for (std::size_t k = 0; k < files.size(); k += test::rounds(1, 4)) {
    const fs::path& file = files[k];
    ShapeCache cache;
    const Gap gap = gap_at_start(load_scene(read_rigid_ipc(file), cache));
    EXPECT_GE(gap.least, 7e-5) << file << ": " << gap.bodies;
  }
}

// The scenes were made with gaps that are round numbers.
TEST(RigidIpcFixtures, BeginAsFarApartAsTheyWereMade) {
  if (fixtures().empty()) {
    GTEST_SKIP() << "needs FIRSTCONTACT_DATA_DIR";
  }
  const std::vector<std::pair<std::string, double>> made = {
      {"unit-tests/tunnel/2-walls.json", 1e-3}, {"friction/sliding.json", 5e-4},
      {"unit-tests/erleben/wedges.json", 1e-4}, {"unit-tests/bat.json", 2.5e-3},
      {"pendulum/pendulum.json", 2.5e-4},       {"friction/arch/arch-25-stones.json", 0.1}};
  for (const auto& [name, expected] : made) {
    ShapeCache cache;
    EXPECT_NEAR(gap_at_start(load_scene(read_rigid_ipc(fixture(name)), cache)).least, expected,
                1e-6)
        << name;
  }
}

TEST(RigidIpcFixtures, LeverArmTurnsAboutOneAxis) {
  if (fixtures().empty()) {
    GTEST_SKIP() << "needs FIRSTCONTACT_DATA_DIR";
  }
  const Scene scene = read_rigid_ipc(fixture("unit-tests/lever-arm.json"));
  EXPECT_EQ(scene.simulation.value().duration, 3.0);
  EXPECT_EQ(scene.simulation->gravity, Vector3d(0, -9.81, 0));
  const Body& arm = scene.bodies.at(0);
  EXPECT_EQ(arm.free.value().locked_translation, (std::array{true, true, true}));
  EXPECT_EQ(arm.free->locked_rotation, (std::array{true, true, false}));
  ShapeCache cache;
  // A beam of 15 m by 1 m by 1 m.
  const MassProperties beam = mass_properties(cache.load(arm.shape).shape);
  EXPECT_NEAR(500.0 * beam.volume, 7500.0, 1e-9);
  EXPECT_NEAR(beam.about_C(2, 2), 15.0 * (225.0 + 1.0) / 12.0, 1e-9);
  const Body& weight = scene.bodies.at(1);
  EXPECT_EQ(weight.free.value().density, 7680.0);
  EXPECT_EQ(fixed_pose(weight).position, Vector3d(7, 6, 0));
  EXPECT_NEAR(mass_properties(cache.load(weight.shape).shape).volume, 27.0, 1e-12);
}

TEST(RigidIpcFixtures, BatLiesAlongTheZAxis) {
  if (fixtures().empty()) {
    GTEST_SKIP() << "needs FIRSTCONTACT_DATA_DIR";
  }
  const Scene scene = read_rigid_ipc(fixture("unit-tests/bat.json"));
  ASSERT_EQ(scene.bodies.size(), 3u);
  const Body& bat = scene.bodies[0];
  ShapeCache cache;
  Eigen::AlignedBox3d bounds;
  for (const Vector3d& v : cache.load(bat.shape).shape.mesh().vertices) {
    bounds.extend(fixed_pose(bat).rotation * v);
  }
  EXPECT_LE((bounds.sizes() - Vector3d(0.0635, 0.0635, 0.8636)).norm(), 1e-12);
  EXPECT_LE((bat.free.value().angular_velocity - Vector3d(-500, 2000, 0) * kDegree).norm(), 1e-12);
  EXPECT_EQ(bat.free->density, 700.0);
  EXPECT_TRUE(bat.free->forces.empty());
  EXPECT_FALSE(scene.bodies[2].free);
}

TEST(RigidIpcFixtures, CardsHaveTheMassOfTheirArea) {
  if (fixtures().empty()) {
    GTEST_SKIP() << "needs FIRSTCONTACT_DATA_DIR";
  }
  const Scene scene = read_rigid_ipc(fixture("friction/card-house/card-tent.json"));
  EXPECT_EQ(scene.simulation.value().friction, 0.5);
  // 10 m by 10 m, scaled to 2.5 m by 1.25 m.
  const FreeBody& card = scene.bodies.at(1).free.value();
  EXPECT_NEAR(card.mass.value(), 3125.0, 1e-9);
  EXPECT_LE(card.centre_of_mass.value().norm(), 1e-15);
  const Vector3d squares(2.5 * 2.5, 0.0, 1.25 * 1.25);
  EXPECT_LE((card.inertia.value().diagonal() -
             3125.0 / 12.0 * Vector3d(squares.z(), squares.x() + squares.z(), squares.x()))
                .norm(),
            1e-9);
  // The upper end, at +x of the mesh, after a turn of 65 degrees about z.
  const Pose X_WB = fixed_pose(scene.bodies[1]);
  const Vector3d end = X_WB.position + X_WB.rotation * Vector3d(1.25, 0, 0);
  EXPECT_NEAR(end.x(), -0.55 + 1.25 * std::cos(65.0 * kDegree), 1e-14);
  EXPECT_NEAR(end.y(), 1.20830308488593 + 1.25 * std::sin(65.0 * kDegree), 1e-14);
}

TEST(RigidIpcFixtures, WallsMayTouchEachOther) {
  if (fixtures().empty()) {
    GTEST_SKIP() << "needs FIRSTCONTACT_DATA_DIR";
  }
  const Scene scene = read_rigid_ipc(fixture("unit-tests/tunnel/2-walls.json"));
  ASSERT_EQ(scene.groups.size(), 1u);
  EXPECT_EQ(scene.groups[0].bodies, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(scene.bodies.at(2).free.value().linear_velocity, Vector3d(0, 0, 25));
  EXPECT_EQ(scene.bodies[2].free->locked_rotation, (std::array{true, true, true}));
  EXPECT_DOUBLE_EQ(scene.simulation.value().contact_distance.value(), 1e-3);
}

}  // namespace
}  // namespace firstcontact
