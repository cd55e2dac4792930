// Bodies inside of solid ones at the start.

#include <cmath>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/query/closest_approach.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;

Pose random_pose(std::mt19937_64& rng, const Vector3d& position) {
  std::normal_distribution<double> normal;
  return {.position = position,
          .rotation = Eigen::Quaterniond(normal(rng), normal(rng), normal(rng), normal(rng))};
}

Pose at(const Vector3d& position) {
  Pose pose;
  pose.position = position;
  return pose;
}

FirstContactResult ask(const Shape& A, const Motion& X_WA, const Shape& B, const Motion& X_WB) {
  Workspace workspace;
  return first_contact({A, X_WA}, {B, X_WB}, workspace);
}

Mesh joined(const Mesh& a, const Mesh& b) {
  Mesh mesh = a;
  const auto shift = static_cast<std::uint32_t>(a.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& t : b.triangles) {
    mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  }
  return mesh;
}

Mesh inside_out(Mesh mesh) {
  for (auto& t : mesh.triangles) {
    std::swap(t[0], t[1]);
  }
  return mesh;
}

TEST(Solid, ContainsWhatIsInside) {
  const Shape box = make_box({2.0, 2.0, 2.0});
  const Shape ball = make_sphere(0.1);
  const Motion rest = Motion::fixed({});
  const Motion moving = Motion::constant_velocity(at({0.3, 0.2, 0.1}), {5, 0, 0}, Vector3d::Zero());
  for (const bool swapped : {false, true}) {
    const FirstContactResult result =
        swapped ? ask(ball, moving, box, rest) : ask(box, rest, ball, moving);
    EXPECT_EQ(result.verdict, Verdict::contact_at_start);
    EXPECT_EQ(result.t, 0.0);
    ASSERT_EQ(result.contacts.size(), 1u);
    const Contact& contact = result.contacts[0];
    const Feature& vertex = swapped ? contact.feature_A : contact.feature_B;
    const Feature& face = swapped ? contact.feature_B : contact.feature_A;
    EXPECT_EQ(vertex, (Feature{FeatureType::vertex, 0, 0}));
    EXPECT_EQ(face.type, FeatureType::face);
    EXPECT_TRUE(contact.p_WA.isApprox(Vector3d(0.3, 0.2, 0.1)));
    EXPECT_EQ(contact.p_WA, contact.p_WB);
    EXPECT_EQ(contact.distance, 0.0);
    EXPECT_FALSE(contact.n_AB_W);
  }
}

TEST(Solid, IsFreeOfWhatIsOutside) {
  const FirstContactResult result =
      ask(make_box({2.0, 2.0, 2.0}), Motion::fixed({}), make_sphere(0.1),
          Motion::constant_velocity(at({1.2, 0.0, 0.0}), {5, 0, 0}, Vector3d::Zero()));
  EXPECT_EQ(result.verdict, Verdict::free);
}

TEST(Surface, DoesNotContain) {
  const Shape box(make_box({2.0, 2.0, 2.0}).mesh());
  EXPECT_EQ(ask(box, Motion::fixed({}), make_sphere(0.1), Motion::fixed({})).verdict,
            Verdict::free);
}

TEST(Solid, HasCavities) {
  const Mesh outer = make_box({2.0, 2.0, 2.0}).mesh();
  const Mesh inner = make_box({1.0, 1.0, 1.0}).mesh();
  const Shape hollow(joined(outer, inside_out(inner)), 0.0, Filling::solid);
  const Motion rest = Motion::fixed({});
  const Shape ball = make_sphere(0.1);
  EXPECT_EQ(ask(hollow, rest, ball, rest).verdict, Verdict::free);
  const Motion in_wall = Motion::fixed(at({0.75, 0.0, 0.0}));
  EXPECT_EQ(ask(hollow, rest, ball, in_wall).verdict, Verdict::contact_at_start);
  // A solid in the cavity, and a solid around it all.
  EXPECT_EQ(ask(hollow, rest, make_box({0.5, 0.5, 0.5}), rest).verdict, Verdict::free);
  EXPECT_EQ(ask(hollow, rest, make_box({5.0, 5.0, 5.0}), rest).verdict, Verdict::contact_at_start);
}

TEST(Solid, MayFaceInwards) {
  const Shape box(inside_out(make_box({2.0, 2.0, 2.0}).mesh()), 0.0, Filling::solid);
  const Motion rest = Motion::fixed({});
  EXPECT_EQ(ask(box, rest, make_sphere(0.1), rest).verdict, Verdict::contact_at_start);
}

TEST(Solid, ContainsOneComponentOfMany) {
  Mesh cloud;
  for (std::uint32_t k = 0; k < 1000; ++k) {
    cloud.vertices.emplace_back(2.0 + k, 0.0, 0.0);
    cloud.triangles.push_back({k, k, k});
  }
  const Shape box = make_box({2.0, 2.0, 2.0});
  const Motion rest = Motion::fixed({});
  EXPECT_EQ(ask(box, rest, Shape(cloud), rest).verdict, Verdict::free);
  cloud.vertices[777] = {0.5, 0.4, 0.3};
  const FirstContactResult result = ask(box, rest, Shape(cloud), rest);
  EXPECT_EQ(result.verdict, Verdict::contact_at_start);
  ASSERT_EQ(result.contacts.size(), 1u);
  EXPECT_EQ(result.contacts[0].feature_B, (Feature{FeatureType::vertex, 777, 777}));
}

TEST(Solid, HasDistanceZeroInside) {
  const Shape box = make_box({2.0, 2.0, 2.0});
  const Shape ball = make_sphere(0.1);
  const Motion rest = Motion::fixed({});
  const Motion leaving = Motion::constant_velocity({}, {5, 0, 0}, Vector3d::Zero());
  Workspace workspace;
  EXPECT_EQ(distance({box, rest}, {ball, leaving}, 0.0, workspace).distance, 0.0);
  EXPECT_NEAR(distance({box, rest}, {ball, leaving}, 1.0, workspace).distance, 3.9, 1e-12);
  EXPECT_EQ(closest_approach({box, rest}, {ball, leaving}, workspace).distance, 0.0);
}

// Against the closed form of what is inside, at any pose, near the surface and far from it.
TEST(Solid, ContainsByTheClosedForm) {
  std::mt19937_64 rng(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Vector3d size(1.0, 0.6, 0.2);
  const Shape box = make_box(size);
  const Shape cylinder = make_cylinder(0.5, 1.0, 1e-3);
  const Shape cone = make_cone(0.5, 1.0, 1e-3);
  const Shape point({.vertices = {{0, 0, 0}}, .triangles = {{0, 0, 0}}});
  int inside_count = 0;
  for (int i = 0; i < 3000; ++i) {
    const double scale = i % 3 == 0 ? 1e6 : 0.0;
    const Pose pose = random_pose(rng, scale * Vector3d(uniform(rng), uniform(rng), uniform(rng)));
    const Vector3d p = 0.6 * Vector3d(uniform(rng), uniform(rng), uniform(rng));
    const Motion X_WS = Motion::fixed(pose);
    const Motion X_WP = Motion::fixed(at(pose.position + pose.rotation.normalized() * p));
    const double in_box = (p.cwiseAbs() - 0.5 * size).maxCoeff();
    const double rho = std::hypot(p.x(), p.y());
    const double in_cylinder = std::max(rho - 0.5, std::abs(p.z()) - 0.5);
    const double in_cone = std::max(rho - 0.5 * (0.5 - p.z()), -0.5 - p.z());
    for (const auto& [shape, outside] :
         {std::pair(&box, in_box), {&cylinder, in_cylinder}, {&cone, in_cone}}) {
      if (std::abs(outside) < 2e-3) {
        continue;
      }
      const FirstContactResult result = ask(*shape, X_WS, point, X_WP);
      ASSERT_EQ(result.verdict, outside < 0.0 ? Verdict::contact_at_start : Verdict::free)
          << i << " " << outside;
      inside_count += outside < 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(inside_count, 1000);
}

// On the surface and a few roundings from it, whatever the answer, it is never undecided.
TEST(Solid, DecidesOnItsSurface) {
  std::mt19937_64 rng(6);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Shape box = make_box({1.0, 1.0, 1.0});
  const Shape point({.vertices = {{0, 0, 0}}, .triangles = {{0, 0, 0}}});
  for (int i = 0; i < 1000; ++i) {
    Vector3d p(uniform(rng), uniform(rng), uniform(rng));
    p = 0.5 * p / p.cwiseAbs().maxCoeff();
    p *= 1.0 + 1e-16 * static_cast<double>(i % 7 - 3);
    const Pose pose = random_pose(rng, Vector3d(uniform(rng), uniform(rng), uniform(rng)));
    const Vector3d p_WP = pose.position + pose.rotation.normalized() * p;
    EXPECT_EQ(ask(box, Motion::fixed(pose), point, Motion::fixed(at(p_WP))).verdict,
              Verdict::contact_at_start);
  }
}

TEST(EnclosureError, ComesWithTheResult) {
  const Shape cylinder = make_cylinder(0.5, 1.0);
  const Shape box = make_box({1.0, 1.0, 1.0});
  const Motion far = Motion::fixed(at({5.0, 0.0, 0.0}));
  const Motion rest = Motion::fixed({});
  EXPECT_EQ(ask(cylinder, rest, cylinder, far).enclosure_error, 0.0) << "exact";
  const Shape prism = cylinder.as_triangles();
  EXPECT_EQ(ask(prism, rest, prism, far).enclosure_error, 2.0 * cylinder.enclosure_error());
  EXPECT_EQ(ask(box, rest, box, far).enclosure_error, 0.0);
  Workspace workspace;
  EXPECT_EQ(distance({box, rest}, {prism, far}, 0.0, workspace).enclosure_error,
            cylinder.enclosure_error());
}

}  // namespace
}  // namespace firstcontact
