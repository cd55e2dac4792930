#include "benchmarks/support/random_motion.h"

#include <cmath>
#include <numbers>
#include <optional>

#include <firstcontact/query/distance.h>

#include "tests/support/random.h"

namespace firstcontact::benchmarks {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using test::Random;

/// Moves B along `direction` until its gap to A is `gap`; none where B passes beside A.
std::optional<double> offset_for_gap(const Shape& A, const Shape& B, const Quaterniond& rotation_A,
                                     const Quaterniond& rotation_B, const Vector3d& direction,
                                     double gap, Workspace& workspace) {
  const Motion at_A = Motion::fixed({.rotation = rotation_A});
  double offset = 2.0 + gap;
  for (int i = 0; i < 100 && offset > 0.0; ++i) {
    const Motion at_B = Motion::fixed({.position = offset * direction, .rotation = rotation_B});
    const double excess = distance({A, at_A}, {B, at_B}, 0.0, workspace).distance - gap;
    if (excess <= 0.01 * gap) {
      return offset;
    }
    offset -= excess;
  }
  return std::nullopt;
}

std::optional<PlainMotionPair> random_motion(const Shape& A, const Shape& B, Random& random,
                                             Workspace& workspace) {
  PlainMotionPair pair;
  pair.A.rotation = random.rotation();
  pair.B.rotation = random.rotation();
  const Vector3d direction = random.direction();
  const double gap = random.uniform(0.003, 0.5);
  const bool aimed = random.chance(0.6);
  const Vector3d heading =
      aimed ? (random.uniform(0.0, 0.7) * random.direction() - direction).normalized()
            : random.direction();
  const Vector3d relative = random.uniform(0.1, 3.0) * heading;
  const double part = random.uniform(0.0, 1.0);
  pair.A.translation = -part * relative;
  pair.B.translation = (1.0 - part) * relative;
  for (PlainMotion* motion : {&pair.A, &pair.B}) {
    const Vector3d axis = random.direction();
    const double angle = random.uniform(0.0, 0.5 * std::numbers::pi);
    motion->rotation_vector = random.chance(0.2) ? Vector3d::Zero() : Vector3d(angle * axis);
  }
  const std::optional<double> offset =
      offset_for_gap(A, B, pair.A.rotation, pair.B.rotation, direction, gap, workspace);
  if (!offset) {
    return std::nullopt;
  }
  pair.B.position = *offset * direction;
  return pair;
}

}  // namespace

Motion PlainMotion::motion() const {
  return Motion::constant_velocity({position, rotation}, translation, rotation_vector);
}

Eigen::Isometry3d PlainMotion::pose(double t) const {
  const double angle = rotation_vector.norm();
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = position + t * translation;
  X.linear() = rotation.toRotationMatrix();
  if (angle > 0.0) {
    X.linear() = Eigen::AngleAxisd(t * angle, rotation_vector / angle) * X.linear();
  }
  return X;
}

std::vector<PlainMotionPair> random_motions(const Shape& A, const Shape& B, int count,
                                            std::uint64_t seed) {
  Workspace workspace;
  std::vector<PlainMotionPair> motions;
  for (int i = 0; i < count; ++i) {
    // Every motion has its own seed, so that slightly different shapes get slightly different
    // motions.
    Random random(seed + static_cast<std::uint64_t>(i));
    std::optional<PlainMotionPair> pair;
    while (!pair) {
      pair = random_motion(A, B, random, workspace);
    }
    motions.push_back(*pair);
  }
  return motions;
}

}  // namespace firstcontact::benchmarks
