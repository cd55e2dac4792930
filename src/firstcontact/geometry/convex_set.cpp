#include <firstcontact/geometry/convex_set.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/math/number_text.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;

constexpr double kLeast = 1e-60;  // As of primitives.h.
constexpr double kGreatest = 1e60;
constexpr double kUp = 1.0 + 0x1p-48;

void require_size(const char* what, double length) {
  if (!(length >= kLeast && length <= kGreatest)) {
    throw std::invalid_argument(std::string("ConvexSet: ") + what +
                                " must be in 1e-60 ... 1e60, got " + detail::shortest(length));
  }
}

void require_size_or_zero(const char* what, double length) {
  if (length != 0.0) {
    require_size(what, length);
  }
}

double greatest_length(const std::vector<Vector3d>& points) {
  double greatest = 0.0;
  for (const Vector3d& p : points) {
    greatest = std::max(greatest, p.norm());
  }
  return greatest;
}

auto key_of(const Vector3d& v) { return std::tuple(v.x(), v.y(), v.z()); }

}  // namespace

ConvexSet::ConvexSet(ConvexKind kind, const Vector3d& size, double rounding,
                     std::vector<Vector3d> points)
    : points_(std::make_shared<const std::vector<Vector3d>>(std::move(points))),
      core_{.kind = kind, .size = size, .points = *points_, .reach = size.norm() * kUp},
      rounding_(rounding) {
  require_size_or_zero("the rounding", rounding);
  if (kind == ConvexKind::hull) {
    core_.reach = greatest_length(*points_) * kUp;
  } else if (kind == ConvexKind::ellipsoid) {
    core_.reach = size.maxCoeff();
  }
}

ConvexSet ConvexSet::sphere(double radius) {
  require_size("the radius", radius);
  return {ConvexKind::point, Vector3d::Zero(), radius};
}

ConvexSet ConvexSet::capsule(double radius, double length) {
  require_size("the radius", radius);
  require_size_or_zero("the length", length);
  return {ConvexKind::segment, {0.0, 0.0, 0.5 * length}, radius};
}

ConvexSet ConvexSet::box(const Vector3d& size, double rounding) {
  for (const double length : size) {
    require_size("the size", length);
  }
  return {ConvexKind::box, 0.5 * size, rounding};
}

ConvexSet ConvexSet::cylinder(double radius, double length, double rounding) {
  require_size("the radius", radius);
  require_size_or_zero("the length", length);
  return {ConvexKind::cylinder, {radius, 0.0, 0.5 * length}, rounding};
}

ConvexSet ConvexSet::cone(double radius, double length, double rounding) {
  require_size("the radius", radius);
  require_size("the length", length);
  return {ConvexKind::cone, {radius, 0.0, 0.5 * length}, rounding};
}

ConvexSet ConvexSet::ellipsoid(const Vector3d& radii) {
  for (const double length : radii) {
    require_size("a radius", length);
  }
  return {ConvexKind::ellipsoid, radii, 0.0};
}

ConvexSet ConvexSet::hull(std::vector<Vector3d> points, double rounding) {
  if (points.empty()) {
    throw std::invalid_argument("ConvexSet: a hull needs a point");
  }
  for (const Vector3d& p : points) {
    if (!(p.cwiseAbs().maxCoeff() <= kGreatest) || p.hasNaN()) {
      throw std::invalid_argument("ConvexSet: a point is not finite or beyond 1e60 m");
    }
  }
  return {ConvexKind::hull, Vector3d::Zero(), rounding, std::move(points)};
}

ConvexCore ConvexSet::core_from(const Vector3d& p) const {
  ConvexCore core = core_;
  core.origin = -p;
  core.reach = (core_.reach + p.norm()) * kUp;
  return core;
}

double ConvexSet::support_bound(const Vector3d& n) const {
  const FloatEnvironmentGuard guard;
  // The core's bound has room for the rounding of this sum.
  return core_.support_bound(n) + rounding_ * n.stableNorm() * (1.0 + 0x1p-47);
}

int ConvexSet::compare(const ConvexSet& other) const {
  const auto key = [](const ConvexSet& set) {
    return std::tuple(set.core_.kind, key_of(set.core_.size), set.rounding_, set.points_->size());
  };
  if (key(*this) != key(other)) {
    return key(*this) < key(other) ? -1 : 1;
  }
  for (std::size_t k = 0; k < points_->size(); ++k) {
    const auto a = key_of((*points_)[k]);
    const auto b = key_of((*other.points_)[k]);
    if (a != b) {
      return a < b ? -1 : 1;
    }
  }
  return 0;
}

}  // namespace firstcontact
