// The side of a cylinder on which an axis or an edge lies across: contacts where both are nearest.

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/scene/links_as_bodies.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/simulation_model/detail/manifold.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>

#include "simulation/random_body.h"
#include "simulation/simulated_run.h"

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kRadius = 0.4;     // [m]  Of the cylinder that lies below.
constexpr double kDistance = 1e-4;  // [m]  Contact distance.
constexpr double kHalf = 0.3;       // [m]  Half length of the line that crosses.

/// A body with a line, of an axis or of an edge, in its frame.
struct Crosser {
  std::string shape;
  Vector3d middle;      // [m]  Of the line.
  Vector3d along;       // [-]
  Vector3d inwards;     // [-]  Across the line.
  double radius = 0.0;  // [m]  Around the line.
  double most_roll;     // [rad]  About the line.
};

const Vector3d kX = Vector3d::UnitX();
const Vector3d kZ = Vector3d::UnitZ();
const std::string kRoof = R"({"convex_hull": {"vertices": [[-0.3, 0, 0], [0.3, 0, 0],
    [0.02, 0.1, 0.2], [-0.01, -0.1, 0.2]]})";
const std::vector<Crosser> kRound{
    {R"({"cylinder": {"radius": 0.1, "length": 0.6}})", {0, 0, 0}, kZ, kX, 0.1, 3.0},
    {R"({"capsule": {"radius": 0.1, "length": 0.6}})", {0, 0, 0}, kZ, kX, 0.1, 3.0}};
const std::vector<Crosser> kEdged{{R"({"box": {"size": [0.6, 0.2, 0.2]}})",
                                   {0.0, -0.1, -0.1},
                                   kX,
                                   Vector3d(0.0, 1.0, 1.0).normalized(),
                                   0.0,
                                   0.3},
                                  {kRoof + "}", {0, 0, 0}, kX, kZ, 0.0, 0.3},
                                  {kRoof + R"(, "radius": 0.02})", {0, 0, 0}, kX, kZ, 0.02, 0.3}};

double uniform(std::mt19937& rng, double from, double to) {
  return std::uniform_real_distribution(from, to)(rng);
}

/// A cylinder about z, and a body whose line crosses its axis.
class Crossing {
 public:
  explicit Crossing(const Crosser& crosser)
      : crosser_(crosser),
        loaded_(load_scene(parse_scene(R"({"firstcontact": 1, "bodies": [
      {"name": "below", "shape": {"cylinder": {"radius": 0.4, "length": 3}}},
      {"name": "across", "shape": )" + crosser.shape +
                                           R"(, "dynamics": {"mass": 1, "inertia":
      [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "centre_of_mass": [0, 0, 0]}}],
      "simulation": {"contact_distance": 1e-4}})",
                                       "test.json"),
                           cache_)) {}

  /// @param angle   [rad]  between the axis and the line
  /// @param beside  [m]    from the middle of the line to where it is nearest to the axis
  /// @param gap     [m]    from the axis to the line, without both radii
  Manifold find(std::mt19937& rng, double angle, double beside, double gap) {
    const double direction = uniform(rng, -3.0, 3.0);
    n = {std::cos(direction), std::sin(direction), 0.0};
    along = std::cos(angle) * kZ + std::sin(angle) * kZ.cross(n);
    const Vector3d foot = kRadius * n + uniform(rng, -1.0, 1.0) * kZ;
    point = foot + 0.5 * gap * n;
    middle = foot + (gap + crosser_.radius) * n - beside * along;
    Matrix3d in_world;
    in_world << along, n, along.cross(n);
    Matrix3d in_body;
    in_body << crosser_.along, crosser_.inwards, crosser_.along.cross(crosser_.inwards);
    const Quaterniond roll(
        Eigen::AngleAxisd(uniform(rng, -crosser_.most_roll, crosser_.most_roll), along));
    const Quaterniond R = roll * Quaterniond(Matrix3d(in_world * in_body.transpose()));
    const Pose X_WB{middle - R * crosser_.middle, R};
    const Pose X_WA{Vector3d::Zero(), Quaterniond(Eigen::AngleAxisd(uniform(rng, -3.0, 3.0), kZ))};
    return finder_.find({0, 1}, PlacedShape(model_.bodies[0].surface, X_WA),
                        PlacedShape(model_.bodies[1].surface, X_WB), 0.0);
  }

  Vector3d n;       // [-]  Of the cylinder where the line is nearest.
  Vector3d along;   // [-]  Of the line.
  Vector3d middle;  // [m]  Of the line.
  Vector3d point;   // [m]  Halfway between both surfaces, where they are nearest.

 private:
  const Crosser& crosser_;
  ShapeCache cache_;
  LoadedScene loaded_;
  LinksAsBodies linked_ = links_as_bodies(loaded_);
  SimulationModel model_{loaded_, linked_};
  Workspace workspace_;
  ManifoldFinder finder_{model_, workspace_};
};

/// Expects one point.
void expect_point(const Manifold& found, double gap, const Vector3d& point, const Vector3d& n) {
  ASSERT_EQ(found.touches.size(), 1u);
  EXPECT_NEAR(found.touches[0].gap, gap, 1e-12);
  EXPECT_LE((found.touches[0].point - point).norm(), 1e-10);
  EXPECT_LE((found.touches[0].normal - n).norm(), 1e-10);
}

void expect_crossing(const Crosser& crosser) {
  std::mt19937 rng(11);
  Crossing crossing(crosser);
  for (int trial = 0; trial < 300; ++trial) {
    const double gap = uniform(rng, 0.2, 1.5) * kDistance;
    const double angle = uniform(rng, 0.12, 3.02);
    // Ends of the line are beyond the band.
    const Manifold found = crossing.find(rng, angle, uniform(rng, -0.4, 0.4) * kHalf, gap);
    SCOPED_TRACE(crosser.shape + " " + std::to_string(trial) + " " + std::to_string(angle));
    ASSERT_NO_FATAL_FAILURE(expect_point(found, gap, crossing.point, crossing.n));
  }
}

// There were two points of one gap, as far apart as lines of both polygons cross: 14 mm at 0.2 rad.
TEST(CrossingContacts, OfAxesAreOnePoint) {
  for (const Crosser& crosser : kRound) {
    expect_crossing(crosser);
  }
}

TEST(CrossingContacts, OfEdgesAreOnePoint) {
  for (const Crosser& crosser : kEdged) {
    expect_crossing(crosser);
  }
}

// The gap was that of lines without ends, which is less or even negative.
TEST(CrossingContacts, EndWithTheEdge) {
  std::mt19937 rng(12);
  for (const Crosser& crosser : kEdged) {
    Crossing crossing(crosser);
    for (int trial = 0; trial < 300; ++trial) {
      const double gap = uniform(rng, 0.2, 1.5) * kDistance;
      const double angle = uniform(rng, 0.11, 3.03);
      const double beyond = uniform(rng, 0.0, 0.03);
      // The line is deeper, beyond the corner, than the corner.
      const double deep = beyond * std::sin(angle);
      const double to_axis = kRadius + crosser.radius + gap;
      const double line = std::sqrt(to_axis * to_axis - deep * deep);
      const bool is_first = trial % 2 == 0;
      const Manifold found = crossing.find(rng, angle, (is_first ? -1.0 : 1.0) * (kHalf + beyond),
                                           line - kRadius - crosser.radius);
      const Vector3d corner = crossing.middle + (is_first ? -kHalf : kHalf) * crossing.along;
      const Vector3d n = Vector3d(corner.x(), corner.y(), 0.0).normalized();
      SCOPED_TRACE(crosser.shape + " " + std::to_string(trial) + " " + std::to_string(angle));
      ASSERT_NO_FATAL_FAILURE(
          expect_point(found, gap, corner - (crosser.radius + 0.5 * gap) * n, n));
    }
  }
}

using test::numbers;

/// The state of a log after 0.5 s on a round body whose axis crosses its own.
RunBody rocked(const std::string& log, const std::string& base, double angle) {
  const Quaterniond turned = Quaterniond(Eigen::AngleAxisd(angle, kZ)) *
                             Quaterniond::FromTwoVectors(kZ, Vector3d::UnitY());
  const Vector3d place = 0.0015 * (turned * kZ) + 0.500012 * kZ;
  Simulator s =
      test::simulator(R"({"name": "log", "shape": )" + log + R"(, "pose": {"position": )" +
                          numbers({place.x(), place.y(), place.z()}) + R"(, "quaternion_wxyz": )" +
                          numbers({turned.w(), turned.x(), turned.y(), turned.z()}) +
                          R"(}, "dynamics": {"mass": 1, "centre_of_mass": [0, 0, 0],
      "inertia": [[0.0325, 0, 0], [0, 0.0325, 0], [0, 0, 0.005]]}},
      {"name": "base", "shape": )" +
                          base + R"(, "pose": {"rotation_vector": [-1.5707963267948966, 0, 0]}})",
                      test::settings(0.01, 2.0, 1e-5));
  return test::run(s, 50).back().bodies[0];
}

// Capsules have no facets. Cylinders came to rest on theirs.
TEST(CrossingContacts, LetCylindersRockAsCapsules) {
  const std::string capsule = R"({"capsule": {"radius": 0.4, "length": 3}})";
  const std::string cylinder = R"({"cylinder": {"radius": 0.4, "length": 3}})";
  for (const double angle : {0.12, 0.2, 0.5, 1.0, 1.57}) {
    const RunBody right = rocked(kRound[1].shape, capsule, angle);
    for (const auto& [log, base] :
         {std::pair{kRound[0].shape, capsule}, std::pair{kRound[1].shape, cylinder},
          std::pair{kRound[0].shape, cylinder}}) {
      const RunBody end = rocked(log, base, angle);
      EXPECT_LE((end.X_WB.position - right.X_WB.position).norm(), 1e-8) << angle << log << base;
      EXPECT_LE(end.X_WB.rotation.angularDistance(right.X_WB.rotation), 1e-7)
          << angle << log << base;
      EXPECT_LE((end.angular_velocity - right.angular_velocity).norm(), 1e-6)
          << angle << log << base;
    }
  }
}

// A corner of a hull slides over the side of a cylinder. Time stopped where a line beyond the
// corner seemed nearer than it.
TEST(CrossingContacts, LetCornersSlideOn) {
  struct Case {
    std::string vertices;
    std::string turned;
    std::string velocity;
    std::string spin;
    double friction;
    double step;
    double distance;
  };
  const std::vector<Case> cases{
      {"[[-0.13, -0.04, 0.07], [0.04, -0.03, -0.11], [-0.1, 0.03, 0], [0.01, 0.07, 0.02]]",
       "[-0.6, 0, -1]", "[-0.6, 0.4, -1]", "[-1, -9, -2]", 0.5, 0.002, 1e-5},
      {"[[-0.08, -0.13, 0.12], [-0.1, -0.03, -0.06], [-0.07, -0.04, 0.01], [-0.12, 0.01, -0.13]]",
       "[-0.6, -0.8, 1.3]", "[0.3, -0.1, -1]", "[5, 3, -3]", 0.0, 0.005, 3e-6},
      {"[[-0.02, 0.1, 0.04], [0.05, 0.01, -0.14], [0.13, 0.05, -0.02], [0.05, 0.02, 0.1]]",
       "[0.6, -1.6, 1.5]", "[0, -0.2, -1]", "[0, 8, 4]", 0.0, 0.002, 1e-5}};
  for (const Case& at : cases) {
    Simulator s = test::simulator(
        R"({"name": "b", "shape": {"convex_hull": {"vertices": )" + at.vertices +
            R"(}}, "pose": {"position": [0, 0, 0.35], "rotation_vector": )" + at.turned +
            R"(}, "dynamics": {"linear_velocity": )" + at.velocity + R"(, "angular_velocity": )" +
            at.spin + R"(}}, {"name": "s", "shape": {"cylinder": {"radius": 1, "length": 4}},
        "pose": {"position": [0, 0, -1], "rotation_vector": [1.5707963267948966, 0, 0]}})",
        test::settings(at.step, at.friction, at.distance));
    const auto steps = test::run(s, static_cast<std::size_t>(std::lround(0.6 / at.step)));
    const double begin = steps[0].kinetic_energy + steps[0].potential_energy;
    for (const RunStep& step : steps) {
      ASSERT_EQ(step.time_lost, 0.0) << at.vertices << step.time;
      ASSERT_LE(step.kinetic_energy + step.potential_energy, begin * (1.0 + 1e-3)) << step.time;
    }
    EXPECT_EQ(test::verify(s.header(), steps).verdict, ProofVerdict::proven) << at.vertices;
  }
}

}  // namespace
}  // namespace firstcontact::detail
