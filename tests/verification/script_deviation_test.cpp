// Pieces of runs beside scripts at random, judged by many samples of the library's own motions.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <firstcontact/scene/body_motion.h>
#include <firstcontact/verification/detail/script_deviation.h>

#include "support/random.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

constexpr double kScriptDuration = 2.0;  // [s]
constexpr double kScriptReach = 0.5;     // [m]

/// [m]  The greatest distance of points at the reach, at 500 times of the piece.
double sampled_deviation(const Motion& script, const RunPiece& piece, double begin) {
  const Motion straight =
      Motion::constant_velocity(piece.X_WB, piece.translation, piece.rotation_vector);
  double greatest = 0.0;
  for (int k = 0; k <= 500; ++k) {
    const Pose a = script.pose((begin + k / 500.0 * piece.to) / kScriptDuration);
    const Pose b = straight.pose(k / 500.0);
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d p = kScriptReach * Vector3d::Unit(axis);
      for (const double sign : {-1.0, 1.0}) {
        greatest = std::max(
            greatest,
            (a.position + sign * (a.rotation * p) - b.position - sign * (b.rotation * p)).norm());
      }
    }
  }
  return greatest;
}

TEST(ScriptDeviation, IsNoLessThanSamplesAndLittleMore) {
  test::Random random(11);
  int tight = 0;
  for (int n = 0; n < 100; ++n) {
    WaypointMotion waypoints;
    waypoints.between = n % 2 == 0 ? Between::screw : Between::constant_velocity;
    for (int k = 0; k < 5; ++k) {
      waypoints.times.push_back(0.4 * k);
      waypoints.poses.push_back({random.vector(0.0, 1.0), random.rotation()});
    }
    const BodyMotion motion = waypoints;
    const Motion script = normalised_motion(motion, kScriptDuration);
    const double begin = random.uniform(0.0, 1.9);
    RunPiece piece;
    piece.to = random.uniform(0.001, 0.1);  // The last ones go on after the script is over.
    piece.X_WB = script.pose(begin / kScriptDuration);
    const Pose end = script.pose((begin + piece.to) / kScriptDuration);
    const Eigen::AngleAxisd turn(end.rotation * piece.X_WB.rotation.conjugate());
    piece.translation = end.position - piece.X_WB.position;
    piece.rotation_vector = turn.angle() * turn.axis();
    const detail::PieceMotion followed(piece, 0.0, Vector3d::Zero());
    const detail::ScriptDeviation found = detail::script_deviation(
        followed, begin, detail::script_of(motion, kScriptDuration, Vector3d::Zero()),
        kScriptDuration, kScriptReach);
    const double least = sampled_deviation(script, piece, begin);
    EXPECT_GE(found.within, least * (1.0 - 1e-9) - 1e-13) << n;
    EXPECT_LE(found.at_end, 1e-12) << n;
    tight += found.within <= 1.3 * least + 1e-12 ? 1 : 0;
  }
  EXPECT_GE(tight, 50);
}

}  // namespace
}  // namespace firstcontact
