#include <firstcontact/verification/detail/explained_tolerance.h>

#include <algorithm>

#include <firstcontact/verification/detail/scene_courses.h>

namespace firstcontact::detail {
namespace {

constexpr double kOfSize = 0x1p-31;   // [-]  Checks take 2^-34 of the sizes at most.
constexpr double kOfSpeed = 0x1p-46;  // [-]  Checks take 2^-49 of the way in a step at most.
constexpr double kOfErrors = 0x1p6;   // [-]  Factor of the errors of the motion itself.

double explained_by(const CourseGeometry& geometry, const CoveredMotion& motion, double margin) {
  const double half = 0.5 * (motion.to() - motion.from());
  const BodyInstant now = motion.around(motion.from() + half, half, motion.position());
  const double reach = geometry.tree->nodes[0].reach + geometry.shape.radius();
  const double size = motion.position().norm() + now.pivot.norm() + reach + margin;
  const double bend =
      now.constant_rates ? 0.0 : half * (now.acceleration + now.turn_acceleration * reach);
  const double speed =
      now.velocity.norm() + now.velocity_error + (now.spin.norm() + now.spin_error) * reach + bend;
  const double errors = now.pivot_error + now.turn_error * reach;
  return kOfSize * size + kOfSpeed * speed + kOfErrors * errors;
}

}  // namespace

double explained_tolerance(const SceneCourses& courses, std::size_t member) {
  double tolerance = 0.0;
  const double margin = courses.pairs().greatest_margin();
  const std::vector<double>& breaks = courses.breaks();
  for (const CourseGeometry& geometry : courses.of_member(member)) {
    for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
      for (const auto& motion : courses.motions(geometry, {breaks[k], breaks[k + 1]})) {
        tolerance = std::max(tolerance, explained_by(geometry, *motion, margin));
      }
    }
  }
  return tolerance;
}

}  // namespace firstcontact::detail
