#include <firstcontact/robot/rest.h>

#include <algorithm>
#include <variant>

namespace firstcontact {
bool rests(const Motion& motion) {
  if (motion.breaks().size() != 2) {
    return false;
  }
  const ConstantRatePath path = motion.path(0, Eigen::Vector3d::Zero());
  return path.rate() == 0.0 && path.pivot_velocity().value().isZero(0.0);
}

bool rests(const CoordinatePath& path) {
  const auto is_zero = [](const DoubleDouble& number) {
    return number.hi == 0.0 && number.lo == 0.0;
  };
  const DoubleDouble& first = path.segments().front().a[0];
  return std::ranges::all_of(path.segments(), [&](const CoordinateSegment& segment) {
    return std::all_of(segment.a.begin() + 1, segment.a.end(), is_zero) &&
           is_zero(segment.a[0] - first);
  });
}

bool rests(const JointMotion& motion) {
  if (const auto* planar = std::get_if<PlanarPath>(&motion)) {
    return std::ranges::all_of(*planar, [](const CoordinatePath& path) { return rests(path); });
  }
  if (const auto* path = std::get_if<CoordinatePath>(&motion)) {
    return rests(*path);
  }
  return rests(std::get<Motion>(motion));
}

}  // namespace firstcontact
