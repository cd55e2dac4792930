// Motion in contact: projected as Gauss' principle has it, proven edge by edge, and through no
// passage that is too narrow.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/geometry/mesh.h>
#include <firstcontact/geometry/point_cloud.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/math/random_numbers.h>
#include <firstcontact/planning/detail/contact_motion.h>
#include <firstcontact/planning/detail/contact_steering.h>
#include <firstcontact/planning/detail/loose_motions.h>
#include <firstcontact/planning/detail/mover_contact_finder.h>
#include <firstcontact/planning/detail/plan_work.h>
#include <firstcontact/planning/detail/tangent_space.h>
#include <firstcontact/planning/plan_path.h>
#include <firstcontact/robot/robot_motion.h>

#include "planning/plan_cases.h"
#include "robot/planar_arm.h"
#include "support/narrow_passages.h"
#include "support/random.h"
#include "support/rounds.h"
#include "support/thread_mesh.h"

namespace firstcontact::test {
namespace {

using detail::ContactMotion;
using detail::ContactsAt;
using detail::ContactSteering;
using detail::ContactWay;
using detail::MoverContactFinder;
using detail::PlanWork;
using detail::TangentSpace;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr ContactUse kUses[] = {ContactUse::none, ContactUse::sample, ContactUse::slide,
                                ContactUse::both};

Configuration any_place(Random& random) {
  const Vector3d p = random.vector(0.0, 1.0);
  const Eigen::Quaterniond r = random.rotation();
  return {p.x(), p.y(), p.z(), r.w(), r.x(), r.y(), r.z()};
}

Configuration placed(const Vector3d& p, const Eigen::Quaterniond& r) {
  return {p.x(), p.y(), p.z(), r.w(), r.x(), r.y(), r.z()};
}

const Configuration kAssembled = {0, 0, 0, 1, 0, 0, 0};

/// A cube of 0.2 m above the floor z = 0.
PlanScene cube_above_floor() {
  RobotScene scene;
  scene.add_body("floor", make_box({10.0, 10.0, 1.0}), resting_at({0.0, 0.0, -0.5}));
  return with_bar(std::move(scene), {0.2, 0.2, 0.2});
}

void expect_proven_way(const PlanScene& scene, Configuration from, const ContactWay& way) {
  const EdgeChecker fresh(scene, {.tolerance = 1e-7, .extra_clearance = 0.0});
  for (std::size_t k = 0; k < way.places.size(); ++k) {
    ASSERT_EQ(fresh.check(from, way.places[k]).verdict, EdgeVerdict::free) << k;
    from = way.places[k];
  }
}

/// The steering of a scene, with all that it works with.
struct Steered {
  explicit Steered(const PlanScene& scene, double range = 0.5)
      : checker(scene, {.extra_clearance = 2e-6}),
        work(checker, options, PlanWork::Clock::now(),
             PlanWork::Clock::now() + std::chrono::seconds(100)),
        steering(work, checker.scene(), range) {}

  PlanOptions options;
  EdgeChecker checker;
  PlanWork work;
  ContactSteering steering;
};

/// A body in another one, to be taken out of it.
PlanScene assembly(const Shape& fixed, const Shape& moved) {
  RobotScene scene;
  scene.add_body("fixed", fixed);
  ConfigurationSpace space = ConfigurationSpace::of_body("moved", moved, Vector3d::Constant(-5.0),
                                                         Vector3d::Constant(5.0));
  const std::size_t robot = scene.add_robot("moved", space.motion(kAssembled, kAssembled));
  return {.scene = std::move(scene), .robots = {robot}, .space = std::move(space)};
}

/// A nut on its rod, 0.5 m a turn.
PlanScene nut_on_rod(int segments, int turns) {
  return assembly(make_thread({.segments = segments, .turns = turns + 1}),
                  make_thread({.segments = segments, .turns = turns, .wider = 0.06, .shift = 1.0}));
}

/// A tube in another one: threads of no depth.
PlanScene tube_in_tube(int segments, int turns) {
  return assembly(
      make_thread({.segments = segments, .turns = 2 * turns, .depth = 0.0, .wider = 0.03}),
      make_thread({.segments = segments, .turns = turns, .depth = 0.0}));
}

std::vector<VectorXd> loose_at_start(const PlanScene& scene) {
  const TangentSpace tangents(scene);
  MoverContactFinder finder(scene, tangents, 2e-6);
  ContactsAt at = finder.near(kAssembled, 0.04 * tangents.reach());
  at.contacts.resize((at.contacts.size() + 1) / 2);
  EXPECT_GT(at.contacts.size(), 5u);
  std::vector<VectorXd> loose;
  for (const VectorXd& dq : detail::loose_motions(tangents, at)) {
    EXPECT_NEAR(tangents.product(dq, dq), 1.0, 1e-12);
    loose.push_back(tangents.in_body(kAssembled, dq));
  }
  return loose;
}

TEST(LooseMotions, GiveTheScrewOfAThread) {
  const std::vector<VectorXd> loose = loose_at_start(nut_on_rod(48, 3));
  ASSERT_FALSE(loose.empty());
  const VectorXd& screw = loose.front();
  EXPECT_LT(screw.segment<2>(3).norm(), 0.02 * std::abs(screw[5]));
  // The facets of the two tilt normals.
  EXPECT_NEAR(screw[2] / screw[5], 0.5 / (2.0 * std::numbers::pi), 0.015);
}

TEST(LooseMotions, GiveTheAxisOfAHole) {
  const std::vector<VectorXd> loose = loose_at_start(tube_in_tube(48, 3));
  ASSERT_GE(loose.size(), 2u);  // Along the axis and about it, mixed in any way.
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_LT(loose[k].head<2>().norm(), 0.05) << k;
    EXPECT_LT(loose[k].segment<2>(3).norm(), 0.05) << k;
  }
}

// A body whose middle is off its frame's axes: steps of one screw are one twist all the same.
TEST(TangentSpace, TellsScrewsOfABodyBesideItsAxis) {
  Mesh beside = make_box({0.2, 0.4, 0.6}).mesh();
  for (Vector3d& vertex : beside.vertices) {
    vertex += Vector3d(0.7, 0.2, -0.3);
  }
  const PlanScene scene = assembly(make_box({1, 1, 1}), Shape(std::move(beside)));
  const TangentSpace tangents(scene);
  const Vector3d centre(0.7, 0.2, -0.3);
  Random random(6);
  for (int k = 0; k < 200; ++k) {
    const Vector3d axis = Vector3d::Unit(k % 3);
    const Vector3d turn = (k % 2 == 0 ? 1.0 : -1.0) * random.uniform(0.3, 2.5) * axis;
    VectorXd screw(6);
    screw << random.uniform(-1.0, 1.0) * axis + turn.cross(centre), turn;
    ASSERT_TRUE(tangents.about_an_axis(screw)) << k;
    EXPECT_LT((*tangents.about_an_axis(screw) - screw).norm(), 1e-12) << k;
    const Configuration from = any_place(random);
    const std::optional<Configuration> to = tangents.screwed(from, tangents.in_world(from, screw));
    ASSERT_TRUE(to) << k;
    EXPECT_LT((tangents.twist(from, *to) - screw).norm(), 1e-9) << k;
    VectorXd other = screw;
    other.tail<3>() += 0.2 * turn.norm() * Vector3d::Unit((k + 1) % 3);
    EXPECT_FALSE(tangents.about_an_axis(other)) << k;
  }
}

/// A proven path in contact, each way.
void expect_out_and_in(const PlanScene& scene, double least_turns) {
  const Configuration outside = {4.0, 0.0, 1.0, 1, 0, 0, 0};
  for (const bool is_out : {true, false}) {
    const PlanResult result =
        plan_path(scene, is_out ? kAssembled : outside, {is_out ? outside : kAssembled},
                  {.contacts = ContactUse::both, .time = 60.0, .shortcuts = 0});
    ASSERT_EQ(result.verdict, PlanVerdict::proven) << is_out;
    double turn = 0.0;
    for (std::size_t k = 0; k + 1 < result.path.size(); ++k) {
      const auto turn_of = [&](std::size_t at) {
        const Configuration& q = result.path[at];
        return Eigen::Quaterniond(q[3], q[4], q[5], q[6]);
      };
      turn += turn_of(k).angularDistance(turn_of(k + 1));
    }
    EXPECT_GE(turn, least_turns * 2.0 * std::numbers::pi) << is_out;
  }
}

TEST(Assemblies, ATubeComesOutOfATubeAndGoesIn) { expect_out_and_in(tube_in_tube(32, 2), 0.0); }

TEST(Assemblies, ANutComesOffItsRodAndGoesOn) { expect_out_and_in(nut_on_rod(32, 2), 1.0); }

/// A plate in the plane x = 0 with a square hole of 0.22 m, and a body that moves in a box of 2 m.
PlanScene plate_with_hole(const Shape& moved) {
  RobotScene scene;
  scene.add_body("l", make_box({0.1, 2.0, 4.0}), resting_at({0.0, -1.11, 0.0}));
  scene.add_body("r", make_box({0.1, 2.0, 4.0}), resting_at({0.0, 1.11, 0.0}));
  scene.add_body("u", make_box({0.1, 4.0, 2.0}), resting_at({0.0, 0.0, 1.11}));
  scene.add_body("d", make_box({0.1, 4.0, 2.0}), resting_at({0.0, 0.0, -1.11}));
  ConfigurationSpace space = ConfigurationSpace::of_body("moved", moved, Vector3d::Constant(-1.0),
                                                         Vector3d::Constant(1.0));
  const std::size_t robot = scene.add_robot("moved", space.motion(kAssembled, kAssembled));
  return {.scene = std::move(scene), .robots = {robot}, .space = std::move(space)};
}

/// A shape on three slides, which start at some places.
PlanScene on_slides(const Shape& shape, const Vector3d& start) {
  RobotDescription robot{.name = "slides", .links = {{"base"}, {"lx"}, {"ly"}, {"tool"}}};
  // The frame rests: it is no part of the reach.
  robot.links[0].collision.push_back({.name = "",
                                      .X_LG = {{0.0, 0.0, -9.0}, Eigen::Quaterniond::Identity()},
                                      .source = SphereGeometry{},
                                      .shape = make_box({9.0, 9.0, 0.1})});
  robot.links[3].collision.push_back(
      {.name = "", .X_LG = {}, .source = SphereGeometry{}, .shape = shape});
  std::map<std::string, JointMotion> held;
  for (const int k : {0, 1, 2}) {
    Joint joint{.name = std::string(1, "xyz"[k]),
                .type = JointType::prismatic,
                .parent = robot.links[static_cast<std::size_t>(k)].name,
                .child = robot.links[static_cast<std::size_t>(k) + 1].name,
                .axis = Vector3d::Unit(k)};
    joint.limits = {.lower = -2.0, .upper = 2.0};
    held.emplace(joint.name, CoordinatePath::constant(start[k]));
    robot.joints.push_back(joint);
  }
  const RobotModel model(robot);
  RobotScene scene;
  const std::size_t index = scene.add_robot("slides", RobotMotion(model, held));
  const std::vector<std::string> names = {"x", "y", "z"};
  return {.scene = std::move(scene),
          .robots = {index},
          .space = ConfigurationSpace::of_joints(model, names, held)};
}

TEST(TangentSpace, ReachesAsFarAsThickenedShapes) {
  EXPECT_NEAR(TangentSpace(plate_with_hole(make_sphere(0.1))).reach(), 0.1, 1e-12);
  EXPECT_NEAR(TangentSpace(plate_with_hole(make_capsule(0.1, 0.02))).reach(), 0.11, 1e-12);
  // A point has no size: a length of the scene is the scale.
  const TangentSpace point(plate_with_hole(make_point_cloud({Vector3d::Zero()})));
  EXPECT_GT(point.reach(), 1e-4);
  EXPECT_LT(point.reach(), 0.1);
  EXPECT_TRUE(point.inverse_metric().allFinite());
}

TEST(TangentSpace, ReachesAsFarWhereverARobotStarts) {
  for (const Vector3d& start : {Vector3d(0, 0, 0), Vector3d(1.0, 0.3, 0), Vector3d(-2, 2, 2)}) {
    EXPECT_NEAR(TangentSpace(on_slides(make_sphere(0.1), start)).reach(), 0.1, 1e-12);
  }
  EXPECT_GT(TangentSpace(on_slides(make_point_cloud({Vector3d::Zero()}), Vector3d::Zero())).reach(),
            1e-4);
  // Turned by its first joint, an arm reaches as far as it is long.
  const RobotMotion rest = at_rest(planar_arm(2));
  const std::vector<std::string> names = {"j0", "j1"};
  RobotScene scene;
  const std::size_t arm = scene.add_robot("arm", rest);
  const PlanScene plan{
      .scene = std::move(scene),
      .robots = {arm},
      .space = ConfigurationSpace::of_joints(rest.model(), names, detail::given_motions(rest))};
  EXPECT_NEAR(TangentSpace(plan).reach(), 2.05, 1e-9);
}

TEST(Contacts, LeadBallsAndPointsThroughAHole) {
  for (const Shape& moved :
       {make_sphere(0.1), make_capsule(0.1, 0.001), make_point_cloud({Vector3d::Zero()}),
        make_point_cloud({Vector3d::Zero()}, 0.1)}) {
    const PlanScene scene = plate_with_hole(moved);
    for (const ContactUse use : {ContactUse::slide, ContactUse::both}) {
      const PlanResult result =
          plan_path(scene, {-0.5, 0.7, 0.0, 1, 0, 0, 0}, {{0.5, -0.6, 0.2, 1, 0, 0, 0}},
                    {.contacts = use, .time = 30.0});
      EXPECT_EQ(result.verdict, PlanVerdict::proven);
    }
  }
}

TEST(TangentSpace, LeadsFromOnePlaceToTheOther) {
  const PlanScene scene = cube_above_floor();
  const TangentSpace tangents(scene);
  Random random(3);
  for (int k = 0; k < 200; ++k) {
    const Configuration from = any_place(random);
    const Configuration to = any_place(random);
    const Configuration reached = tangents.moved(from, tangents.difference(from, to));
    EXPECT_LT(scene.space.distance(reached, to), 1e-12) << k;
    const VectorXd dq = tangents.difference(from, to);
    EXPECT_LT((tangents.in_world(from, tangents.in_body(from, dq)) - dq).norm(), 1e-12) << k;
  }
}

// To first order a gap changes by J dq: what is found now tells the distance a little later.
TEST(MoverContactFinder, TellsHowGapsChange) {
  const PlanScene scene = cube_above_floor();
  const TangentSpace tangents(scene);
  MoverContactFinder finder(scene, tangents, 0.0);
  const EdgeChecker checker(scene, {.extra_clearance = 0.0});
  Random random(4);
  for (int k = 0; k < 100; ++k) {
    const Configuration q = placed({0.1, -0.2, 0.25}, random.rotation());
    VectorXd dq(6);
    dq.head<3>() = random.vector(0.0, 1e-4);
    dq.tail<3>() = random.vector(0.0, 5e-4);
    const ContactsAt at = finder.near(q, 0.3);
    ASSERT_FALSE(at.contacts.empty());
    double least = 1.0;
    for (const detail::NearContact& contact : at.contacts) {
      // A is the floor, B the cube.
      const Eigen::Matrix<double, 6, 1> V = at.members[1].J * dq;
      const Vector3d v = V.head<3>() + V.tail<3>().cross(contact.p_WP - at.members[1].p_WR);
      least = std::min(least, contact.gap + contact.n_AB_W.dot(v));
    }
    const Configuration moved = tangents.moved(q, dq);
    EXPECT_NEAR(checker.state(moved).clearance.value(), least, 3e-6) << k;
  }
}

// The same for the joints of a robot, whose Jacobians are differences.
TEST(MoverContactFinder, TellsHowGapsOfRobotsChange) {
  const PlanScene scene = with_gantry(thin_wall(0.0));
  const TangentSpace tangents(scene);
  MoverContactFinder finder(scene, tangents, 0.0);
  const ContactsAt at = finder.near({-0.12, 0.3, 0.1}, 0.1);
  ASSERT_FALSE(at.contacts.empty());
  EXPECT_NEAR(at.contacts.front().gap, 0.12 - 0.1 - 5e-6, 1e-9);
  const std::size_t tool = scene.scene.first_member(scene.robots.front()) + 3;
  EXPECT_LT((at.members[tool].J.leftCols(3).topRows<3>() - Eigen::Matrix3d::Identity()).norm(),
            1e-6);
}

// A closed form: what is wanted into the floor is left out, what is wanted along it is kept.
TEST(ContactMotion, KeepsWhatLeadsAlongContacts) {
  const PlanScene scene = cube_above_floor();
  const TangentSpace tangents(scene);
  MoverContactFinder finder(scene, tangents, 0.0);
  const double gap = 0.001;
  const Configuration q = placed({0.0, 0.0, 0.1 + gap}, Eigen::Quaterniond::Identity());
  const ContactsAt at = finder.near(q, 0.01);
  const VectorXd wanted = (VectorXd(6) << 0.02, 0.01, -0.05, 0.0, 0.0, 0.03).finished();
  const ContactMotion motion = contact_motion(tangents, at, wanted, gap);
  EXPECT_NEAR(motion.dq[0], 0.02, 1e-6);
  EXPECT_NEAR(motion.dq[1], 0.01, 1e-6);
  EXPECT_NEAR(motion.dq[5], 0.03, 1e-5);
  // The gap is held by a weight of 100 against the wish.
  EXPECT_NEAR(motion.dq[2], -0.05 / 101.0, 1e-4);
  EXPECT_GT(motion.active, 0u);
  EXPECT_GE(gap + motion.dq[2], motion.gap - 1e-6);
  // A wish that leads away is kept whole.
  const VectorXd away = (VectorXd(6) << 0.0, 0.0, 0.05, 0.0, 0.0, 0.0).finished();
  EXPECT_LT((contact_motion(tangents, at, away, gap).dq - away).norm(), 1e-6);
}

TEST(ContactMotion, LeadsToTheMiddleOfANarrowPassage) {
  RobotScene between;
  between.add_body("left", make_box({1.0, 4.0, 4.0}), resting_at({-0.602, 0.0, 0.0}));
  between.add_body("right", make_box({1.0, 4.0, 4.0}), resting_at({0.606, 0.0, 0.0}));
  const PlanScene scene = with_bar(std::move(between), {0.2, 0.2, 0.2});
  const TangentSpace tangents(scene);
  MoverContactFinder finder(scene, tangents, 0.0);
  const Configuration q = placed(Vector3d::Zero(), Eigen::Quaterniond::Identity());
  const ContactMotion motion =
      contact_motion(tangents, finder.near(q, 0.05), VectorXd::Zero(6), 0.02);
  EXPECT_NEAR(motion.dq[0], 0.002, 3e-5);  // To the tolerance of the projection.
  EXPECT_NEAR(motion.gap, 0.004, 3e-5);
}

TEST(ContactSteering, SlidesAlongAFloor) {
  const PlanScene scene = cube_above_floor();
  Steered steered(scene);
  const Configuration from = placed({0.0, 0.0, 0.15}, Eigen::Quaterniond::Identity());
  // The target lies in the floor: no way ends there, but one above it.
  const Configuration target = placed({0.8, 0.3, -0.3}, Eigen::Quaterniond::Identity());
  const ContactWay way = steered.steering.slide(from, target);
  expect_proven_way(scene, from, way);
  ASSERT_FALSE(way.places.empty());
  EXPECT_FALSE(way.reaches_target);
  EXPECT_TRUE(way.is_near);
  EXPECT_NEAR(way.places.back()[0], 0.8, 0.05);
  EXPECT_NEAR(way.places.back()[1], 0.3, 0.05);
}

// A push out of a hole of 0.2 mm leads far out of it, however it is directed, if only outwards.
TEST(ContactSteering, GetsOutOfATightHole) {
  RobotScene walls;
  const double h = 0.1001;
  walls.add_body("a", make_box({1.0, 1.0, 1.0}), resting_at({0.5 + h, 0.0, 0.0}));
  walls.add_body("b", make_box({1.0, 1.0, 1.0}), resting_at({-0.5 - h, 0.0, 0.0}));
  walls.add_body("c", make_box({1.0, 1.0, 1.0}), resting_at({0.0, 0.5 + h, 0.0}));
  walls.add_body("d", make_box({1.0, 1.0, 1.0}), resting_at({0.0, -0.5 - h, 0.0}));
  const PlanScene scene = with_bar(std::move(walls), {0.2, 0.2, 0.4});
  Steered steered(scene);
  const Configuration from = placed({0.0, 0.0, 0.2}, Eigen::Quaterniond::Identity());
  const VectorXd up = (VectorXd(6) << 0.2, 0.1, 0.3, 0.5, 0.2, 0.3).finished();
  const ContactWay way = steered.steering.push(from, up);
  expect_proven_way(scene, from, way);
  ASSERT_FALSE(way.places.empty());
  EXPECT_GT(way.places.back()[2], 0.6);
  EXPECT_LT(steered.work.counts().edges_checked, 200u);
}

/// Samples the edges of a triangle mesh's core and its inside, at most `step` apart.
std::vector<Vector3d> points_of_core(const Mesh& mesh, double step) {
  std::vector<Vector3d> points;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3d& from = mesh.vertices[a];
    const Vector3d u = mesh.vertices[b] - from;
    const Vector3d v = mesh.vertices[c] - mesh.vertices[b];
    const int n = static_cast<int>(std::ceil(std::max(u.norm(), (u + v).norm()) / step));
    for (int i = 0; i <= n; ++i) {
      const int m = v.isZero() ? 0 : i;
      for (int j = 0; j <= m; ++j) {
        points.push_back(from + u * i / n + v * j / n);
      }
    }
  }
  return points;
}

/// [m]  The distance of a point from a box or from a chain of round tubes, by closed forms.
double distance_from(const Vector3d& p, const Shape& shape) {
  if (shape.radius() == 0.0) {
    const Vector3d half = shape.mesh().vertices.back().cwiseAbs();
    return (p.cwiseAbs() - half).cwiseMax(0.0).norm();
  }
  double least = 1e300;
  for (const auto& [a, b, c] : shape.mesh().triangles) {
    const Vector3d& from = shape.mesh().vertices[a];
    const Vector3d u = shape.mesh().vertices[b] - from;
    const double t = std::clamp((p - from).dot(u) / u.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (p - from - t * u).norm() - shape.radius());
  }
  return least;
}

/// [m]  The least distance along the written way; less than 0 where cores alone have room.
double least_on_way(const NarrowPassage& passage) {
  const RobotScene& scene = passage.scene.scene;
  const std::size_t mover = scene.first_member(passage.scene.robots.front());
  const Shape& moved = scene.geometries(mover)[0].shape;
  const std::vector<Vector3d> core = points_of_core(moved.mesh(), 0.01);
  double least = 1e300;
  for (std::size_t k = 0; k + 1 < passage.way.size(); ++k) {
    const Configuration& a = passage.way[k];
    const Configuration& b = passage.way[k + 1];
    const Eigen::Quaterniond from(a[3], a[4], a[5], a[6]);
    const Eigen::Quaterniond to(b[3], b[4], b[5], b[6]);
    for (int i = 0; i <= 32; ++i) {
      const double t = i / 32.0;
      const Vector3d p(a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]),
                       a[2] + t * (b[2] - a[2]));
      const Eigen::Matrix3d R = from.slerp(t, to).toRotationMatrix();
      for (std::size_t member = 0; member < scene.size(); ++member) {
        if (member != mover) {
          const Pose X = scene.geometry_pose(member, 0, 0.0);
          for (const Vector3d& point : core) {
            least = std::min(least, distance_from(p + R * point - X.position,
                                                  scene.geometries(member)[0].shape));
          }
        }
      }
    }
  }
  return least - moved.radius();
}

// The oracle samples the cores, and knows distances of points alone.
TEST(NarrowPassages, AreAsWideAsStated) {
  for (const char* family : {"tubes", "key", "screw"}) {
    const double share = std::string_view(family) == "tubes" ? 1.0 : 0.5;
    constexpr std::array kClearances = {1e-3, -1e-3, 0.02, 1e-5, -1e-5};
    for (const double clearance : std::span(kClearances).first(rounds(5, 2))) {
      const NarrowPassage passage = narrow_passage(family, clearance);
      EXPECT_NEAR(least_on_way(passage), share * clearance, 1e-9) << family << ' ' << clearance;
      const EdgeChecker checker(passage.scene, {.tolerance = 1e-7, .extra_clearance = 0.0});
      bool is_free = passage.way.front() == passage.start && passage.way.back() == passage.goal;
      for (std::size_t k = 0; k + 1 < passage.way.size(); ++k) {
        is_free = is_free && checker.check_quickly(passage.way[k], passage.way[k + 1]).verdict ==
                                 EdgeVerdict::free;
      }
      EXPECT_EQ(is_free, clearance > 0.0) << family << ' ' << clearance;
      // The ends of twins are free, so that it is the way that is missing.
      EXPECT_TRUE(checker.is_free(passage.start)) << family << ' ' << clearance;
      EXPECT_TRUE(checker.is_free(passage.goal)) << family << ' ' << clearance;
    }
  }
}

// The time only ends a search that hangs: machines under sanitizers are 50 times slower. There the
// first five families are enough.
TEST(NarrowPassages, AreSolvedInContact) {
  const std::span<const char* const> families = narrow_families();
  const auto tested = static_cast<std::size_t>(rounds(static_cast<int>(families.size()), 5));
  for (const char* family : families.first(tested)) {
    const NarrowPassage passage = narrow_passage(family, rounds(50, 100) * 1e-3);
    const PlanResult result = plan_path(passage.scene, passage.start, {passage.goal},
                                        {.contacts = ContactUse::both, .time = 300.0});
    ASSERT_EQ(result.verdict, PlanVerdict::proven) << family;
    EXPECT_EQ(result.path.front(), passage.start);
    EXPECT_EQ(result.path.back(), passage.goal);
    const EdgeChecker fresh(passage.scene);
    for (std::size_t k = 0; k + 1 < result.path.size(); ++k) {
      ASSERT_EQ(fresh.check(result.path[k], result.path[k + 1]).verdict, EdgeVerdict::free)
          << family << ' ' << k;
    }
  }
}

// Slides along blocked edges must leave work for pushes and passages, or searches take 100 times as
// many edges. A bound is three times the median of nine seeds.
TEST(NarrowPassages, NeedFewEdgesInContact) {
  struct Case {
    const char* family;
    std::size_t edges;
  };
  for (const auto& [family, edges] :
       {Case{"window", 1700}, Case{"peg", 2200}, Case{"tunnel", 6300}}) {
    const NarrowPassage passage = narrow_passage(family, 0.01);
    std::vector<std::size_t> needed;
    for (std::uint64_t seed = 1; seed <= rounds(9, 3); ++seed) {
      const PlanResult result =
          plan_path(passage.scene, passage.start, {passage.goal},
                    {.contacts = ContactUse::both, .seed = seed, .time = 300.0, .shortcuts = 0});
      ASSERT_EQ(result.verdict, PlanVerdict::proven) << family << ' ' << seed;
      needed.push_back(result.statistics.edges_checked);
    }
    std::ranges::sort(needed);
    EXPECT_LT(needed[needed.size() / 2], edges) << family;
  }
}

// Through a gap of 10 um less than nothing there is no way, whatever is done in contact.
TEST(NarrowPassages, HaveTwinsThatNothingGetsThrough) {
  for (const char* family : narrow_families()) {
    const NarrowPassage twin = narrow_passage(family, -1e-5);
    for (const ContactUse use : kUses) {
      const PlanResult result = plan_path(twin.scene, twin.start, {twin.goal},
                                          {.contacts = use, .time = rounds(40, 20) * 1e-3});
      EXPECT_EQ(result.verdict, PlanVerdict::none)
          << family << ' ' << kContactUseWords.at(static_cast<std::size_t>(use));
    }
  }
}

TEST(NarrowPassages, HaveTheSamePathForASeed) {
  const NarrowPassage passage = narrow_passage("dovetail", 0.002);
  const auto planned = [&](std::uint64_t seed, int threads) {
    return plan_path(
        passage.scene, passage.start, {passage.goal},
        {.contacts = ContactUse::both, .seed = seed, .time = 100.0, .threads = threads});
  };
  const PlanResult first = planned(3, 1);
  const PlanResult second = planned(3, 2);
  ASSERT_EQ(first.verdict, PlanVerdict::proven);
  EXPECT_EQ(first.path, second.path);
  EXPECT_EQ(first.statistics.edges_checked, second.statistics.edges_checked);
  EXPECT_NE(planned(4, 1).path, first.path);
}

// An easy question is answered as it is without contacts, but for a few edges.
TEST(NarrowPassages, CostLittleWhereTheWayIsWide) {
  const PlanScene scene = with_bar(thin_wall(0.6), {0.1, 0.1, 0.1});
  const Configuration start = placed({-0.8, 0.2, 0.1}, Eigen::Quaterniond::Identity());
  const Configuration goal = placed({0.8, -0.9, 0.2}, Eigen::Quaterniond::Identity());
  std::size_t without = 0;
  std::size_t with = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto edges = [&](ContactUse use) {
      const PlanResult result =
          plan_path(scene, start, {goal}, {.contacts = use, .seed = seed, .shortcuts = 0});
      EXPECT_EQ(result.verdict, PlanVerdict::proven);
      return result.statistics.edges_checked;
    };
    without += edges(ContactUse::none);
    with += edges(ContactUse::both);
  }
  EXPECT_LE(static_cast<double>(with), 1.25 * static_cast<double>(without));
}

// Where trees grow freely, no slide and no push comes before some hundreds of edges.
TEST(NarrowPassages, BeginWithoutContacts) {
  const NarrowPassage passage = narrow_passage("links", 0.1);
  int early = 0;
  for (std::uint64_t seed = 1; seed <= rounds(10, 3); ++seed) {
    const PlanResult result = plan_path(passage.scene, passage.start, {passage.goal},
                                        {.contacts = ContactUse::both, .seed = seed});
    ASSERT_EQ(result.verdict, PlanVerdict::proven) << seed;
    if (result.statistics.edges_checked < 500) {
      ++early;
      EXPECT_EQ(result.statistics.contacts.slides, 0u) << seed;
      EXPECT_EQ(result.statistics.contacts.nodes, 0u) << seed;
    }
  }
  EXPECT_GT(early, 0);
}

TEST(NarrowPassages, AreForRrtConnectOnly) {
  const NarrowPassage passage = narrow_passage("window", 0.05);
  EXPECT_THROW((void)plan_path(passage.scene, passage.start, {passage.goal},
                               {.planner = Planner::lazy_prm_star, .contacts = ContactUse::slide}),
               std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact::test
