#include <firstcontact/scene_files/write_scene.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>

#include "scene/scene_bits.h"

namespace firstcontact {
namespace {

using test::SceneBits;

/// Any sign, any size that a scene takes.
double random_number(std::mt19937_64& rng) {
  const double mantissa = std::ldexp(static_cast<double>(rng() >> 11), -53);
  const double size = std::ldexp(mantissa, static_cast<int>(rng() % 390) - 195);
  return rng() % 2 == 0 ? size : -size;
}

Eigen::Vector3d random_vector(std::mt19937_64& rng) {
  return {random_number(rng), random_number(rng), random_number(rng)};
}

Pose random_pose(std::mt19937_64& rng) {
  return {.position = random_vector(rng),
          .rotation = Eigen::Quaterniond(1.0 + std::abs(random_number(rng)), random_number(rng),
                                         random_number(rng), random_number(rng))};
}

FreeBody random_free_body(std::mt19937_64& rng) {
  const auto one = [&] { return 1.0 + 0.5 * std::abs(std::remainder(random_number(rng), 1.0)); };
  Eigen::Matrix3d inertia = Eigen::Vector3d(one(), one(), one()).asDiagonal();
  inertia(0, 1) = inertia(1, 0) = 0.1 * one();
  return {
      .density = {},
      .mass = one(),
      .centre_of_mass = random_vector(rng),
      .inertia = inertia,
      .linear_velocity = random_vector(rng),
      .angular_velocity = random_vector(rng).cwiseMin(1e7).cwiseMax(-1e7),
      .locked_translation = {true, false, false},
      .locked_rotation = {false, false, true},
      .forces = {{.from = 0.1, .to = one(), .force = random_vector(rng)},
                 {.to = std::numeric_limits<double>::infinity(), .torque = random_vector(rng)}}};
}

ContactState random_contacts(std::mt19937_64& rng) {
  const std::array<ContactState, 4> states = {ContactState::none, ContactState::first,
                                              ContactState::all,
                                              ContactState::nearest(1 + rng() % 100000)};
  return states.at(rng() % states.size());
}

/// Every kind of motion, with numbers of all sizes where no range forbids them.
Scene random_scene(std::mt19937_64& rng) {
  Scene scene;
  scene.id = "random \"quoted\" \n \xc3\xa4";
  const Mesh mesh{.vertices = {random_vector(rng), {0.0, -0.0, 5e-324}},
                  .triangles = {{0, 1, 1}, {0, 0, 0}}};
  const auto angle = [&] { return std::remainder(random_number(rng), 1e3); };
  const BodyMotion motions[] = {
      FixedMotion{random_pose(rng)},
      ConstantVelocityMotion{random_pose(rng), random_vector(rng), {angle(), angle(), angle()}},
      ScrewMotion{random_pose(rng), random_vector(rng), {angle(), 1.0, angle()}, angle(), angle()},
      TwoPoseMotion{random_pose(rng), random_pose(rng), Between::constant_velocity},
      TwoPoseMotion{random_pose(rng), random_pose(rng), Between::screw},
      WaypointMotion{{0.1, 1.0 / 3.0, 0.7}, {3, random_pose(rng)}, Between::screw},
      VertexMotion{{random_vector(rng), random_vector(rng)}}};
  for (const BodyMotion& motion : motions) {
    scene.bodies.push_back({.name = "body " + std::to_string(scene.bodies.size()),
                            .shape = {.source = mesh, .radius = std::abs(random_number(rng))},
                            .motion = motion});
  }
  const auto size = [&] { return 1e-3 + std::abs(angle()); };
  const BodyShape shapes[] = {
      {.source = SphereShape{size()}},
      {.source = CapsuleShape{size(), size()}},
      {.source = BoxShape{{size(), size(), size()}}},
      {.source = CylinderShape{size(), size(), 1e4}},
      {.source = ConeShape{size(), size(), {}}},
      {.source = EllipsoidShape{{size(), size(), size()}, {}}},
      {.source = EllipsoidShape{{size(), size(), size()}, 1e4}},
      {.source = ConvexHullShape{std::vector{random_vector(rng)}}, .radius = size()},
      {.source = PointCloud{{random_vector(rng), random_vector(rng)}}},
      {.source = HeightMap{{size(), size()}, 3, {0, 1, 2, 3, 4, size()}}}};
  for (const BodyShape& shape : shapes) {
    scene.bodies.push_back({.name = "body " + std::to_string(scene.bodies.size()),
                            .shape = shape,
                            .motion = FixedMotion{}});
  }
  for (const bool is_free : {false, true}) {
    scene.bodies.push_back({.name = "body " + std::to_string(scene.bodies.size()),
                            .shape = {.source = SphereShape{size()}},
                            .motion = FixedMotion{random_pose(rng)}});
    scene.bodies.back().surface = {.friction = size(), .restitution = 0.3};
    if (is_free) {
      scene.bodies.back().free = random_free_body(rng);
    }
  }
  scene.ignored_pairs = {{0, 3}, {1, 2}};
  scene.groups = {{"odd", {1, 3}}, {"even", {0, 2, 4}}};
  scene.ignored_groups = {{0, 0}};
  scene.group_margins = {{{1, 0}, std::abs(random_number(rng))}};
  scene.pair_margins = {{.bodies = {2, 4}, .margin = std::abs(random_number(rng))}};
  scene.options = {.tolerance = std::abs(random_number(rng)) + 1e-300,
                   .margin = std::abs(random_number(rng)),
                   .contacts = random_contacts(rng),
                   .start_contacts = StartContacts::keep_half,
                   .contact_band = 1e-3,
                   .deadline = 0.1};
  scene.duration = 0.7;
  scene.simulation = Simulation{.duration = 0.5,
                                .step = std::abs(random_number(rng)) + 1e-300,
                                .gravity = random_vector(rng),
                                .friction = std::abs(random_number(rng)),
                                .restitution = 1.0,
                                .contact_distance = 1e-3,
                                .events = 7,
                                .pairs = {{{1, 4}, {.friction = 0.1, .restitution = {}}}}};
  return scene;
}

TEST(WriteScene, ReadsBackToTheSameBits) {
  std::mt19937_64 rng(3);
  for (int i = 0; i < 500; ++i) {
    const Scene scene = random_scene(rng);
    const std::string text = write_scene(scene);
    ASSERT_EQ(SceneBits(parse_scene(text, "s")), SceneBits(scene)) << text;
  }
}

// A comparison that saw nothing would pass the test above.
TEST(WriteScene, ComparesEveryBit) {
  std::mt19937_64 rng(4);
  const Scene scene = random_scene(rng);
  Scene other = scene;
  double& x = std::get<ScrewMotion>(other.bodies[2].motion).axis_direction.x();
  x = std::nextafter(x, 1.0);
  EXPECT_NE(SceneBits(scene), SceneBits(other));
}

TEST(WriteScene, KeepsTheScenesOfTheCorpus) {
  const std::filesystem::path good =
      std::filesystem::path(FIRSTCONTACT_SOURCE_DIR) / "tests/fuzz/corpus/fuzz_scene/good";
  for (const auto& entry : std::filesystem::directory_iterator(good)) {
    const Scene scene = read_scene(entry.path());
    const std::string text = write_scene(scene);
    EXPECT_EQ(text.find('\n'), std::string::npos);
    EXPECT_EQ(SceneBits(parse_scene(text, "s")), SceneBits(scene)) << text;
  }
}

// A shape that is ready is written as its mesh, or as the curved body that it is, with as many
// triangles around it.
TEST(WriteScene, KeepsShapesThatAreReady) {
  for (const Shape& shape :
       {make_cylinder(0.5, 1.0, 1e-3), make_cylinder(0.7, 1.0), make_cylinder(3.0, 1.0, 3.0),
        make_cone(0.2, 1.0), make_cone(0.2, 0.01, 1e-7), make_ellipsoid({1, 2, 3}),
        make_ellipsoid({1, 0.2, 0.1}, 2e-4), make_ellipsoid({1, 0.2, 0.1}, 0.8), make_sphere(0.25),
        make_box({1, 2, 3}), make_cylinder(0.5, 1.0, 1e-3).as_triangles()}) {
    Scene scene;
    scene.bodies.push_back({.name = "a", .shape = {.source = shape}, .motion = {}});
    ShapeCache cache;
    const Scene again = parse_scene(write_scene(scene), "again");
    const Shape read = cache.load(again.bodies.at(0).shape).shape;
    EXPECT_EQ(read.compare(shape), 0);
    EXPECT_EQ(read.enclosure_error(), shape.enclosure_error());
    EXPECT_EQ(read.is_curved(), shape.is_curved());
    EXPECT_EQ(cache.load(scene.bodies.at(0).shape).shape.mesh().vertices.data(),
              shape.mesh().vertices.data());
  }
}

}  // namespace
}  // namespace firstcontact
