#include <firstcontact/articulated/detail/swept_part.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <firstcontact/narrowphase/convex_separation.h>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kUp = 1.0 + 0x1p-40;

/// Products and sums of a few vectors, and of unit vectors that are so but for rounding.
constexpr double kRounding = 0x1p-46;

double middle_of(const TimeWindow& window) { return 0.5 * (window.begin + window.end); }

/// From the middle to the farther end; rounded up.
double half_length(const TimeWindow& window) {
  const double middle = middle_of(window);
  return std::max(window.end - middle, middle - window.begin) * kUp;
}

double extent_along(const SweptPart& part, const Vector3d& n) {
  return part.part->box.half_extents.dot((part.axes * n).cwiseAbs()) + part.part->box.radius;
}

/// The point of the box, without its thickening, next to p.
Vector3d next_to(const SweptPart& part, const Vector3d& p) {
  const Vector3d local = part.axes * (p - part.centre);
  const Vector3d& h = part.part->box.half_extents;
  return part.centre + part.axes.transpose() * local.cwiseMax(-h).cwiseMin(h);
}

/// The best of a few directions, and the gap of the boxes along it.
class BestDirection {
 public:
  BestDirection(const SweptPart& A, const SweptPart& B) : A_(A), B_(B), d_(B.centre - A.centre) {
    for (int k = 0; k < 3; ++k) {
      try_along(A.axes.row(k).transpose());
      try_along(B.axes.row(k).transpose());
    }
    // Two projections lead from corner to face at once, from edge to edge nearly.
    const Vector3d on_A = next_to(A, next_to(B, A.centre));
    try_towards(next_to(B, on_A) - on_A);
    try_towards(d_);
  }

  [[nodiscard]] const Separation& best() const { return best_; }

 private:
  void try_along(const Vector3d& n) { consider(n.dot(d_) < 0.0 ? Vector3d(-n) : n); }

  void try_towards(const Vector3d& way) {
    const double length = way.norm();
    if (length > 0.0) {
      consider(way / length);
    }
  }

  void consider(const Vector3d& n) {
    const double gap = n.dot(d_) - extent_along(A_, n) - extent_along(B_, n);
    if (gap > best_.gap) {
      best_ = {n, gap};
    }
  }

  const SweptPart& A_;
  const SweptPart& B_;
  Vector3d d_;
  Separation best_{Vector3d::UnitX(), -std::numeric_limits<double>::infinity()};
};

/// [m]  What A gains along n and B against it, at most, in a time T forth or back.
double approach(const SweptPart& A, const SweptPart& B, const Vector3d& n, double T) {
  const auto way = [T](const DirectedBound& a, const DirectedBound& b) {
    const double bend = std::max(a.acceleration + b.acceleration, 0.0);
    return std::max(0.0, (a.speed + b.speed) * T + 0.5 * bend * T * T);
  };
  const LinkPart& a = A.part->box;
  const LinkPart& b = B.part->box;
  return std::max(way(A.motion.displacement(a, n), B.motion.displacement(b, -n)),
                  way(A.motion.displacement_back(a, n), B.motion.displacement_back(b, -n))) *
         kUp;
}

SweptGap gap_along(const SweptPart& A, const SweptPart& B, const TimeWindow& window,
                   const Separation& found, double enough) {
  const double middle = found.gap - (A.error + B.error) * kUp;
  const double way =
      middle > enough ? approach(A, B, found.n, half_length(window)) : (A.sweep + B.sweep) * kUp;
  return {middle - way, middle, found.n};
}

}  // namespace

SweptPart sweep(const Part& part, const PartPath& path, const TimeWindow& window,
                LinkScratch& scratch) {
  const LinkPart& box = part.box;
  SweptPart swept;
  swept.part = &part;
  swept.motion = path.X_FS.window(middle_of(window), window.begin, window.end, box, scratch);
  const LinkPose& pose = swept.motion.pose();
  swept.centre = pose.p_OL + pose.R_FL * box.centre;
  swept.axes = box.axes * pose.R_FL.transpose();
  const double far = box.centre.norm() + box.reach();
  swept.error = (pose.position_error + pose.rotation_error * far + part.shape->bounds().error +
                 kRounding * (swept.centre.norm() + far)) *
                kUp;
  swept.sweep = swept.motion.bounds().rate * half_length(window) * kUp;
  swept.tracking_error = path.tracking_bound(box, window);
  return swept;
}

SweptGap gap_of_boxes(const SweptPart& A, const SweptPart& B, const TimeWindow& window,
                      double enough) {
  const double apart = (B.centre - A.centre).norm() * (1.0 - kRounding) -
                       (A.part->reach + B.part->reach + A.error + B.error) * kUp;
  const double bound = apart - (A.sweep + B.sweep) * kUp;
  if (bound > enough) {
    return {bound, apart};
  }
  return gap_along(A, B, window, BestDirection(A, B).best(), enough);
}

SweptGap gap_of_hulls(const SweptPart& A, const SweptPart& B, const TimeWindow& window,
                      double enough, const Vector3d& n) {
  const auto hull = [](const SweptPart& P) {
    return PlacedPolytope{P.part->shape->bounds().corners, P.motion.pose().R_FL, P.centre};
  };
  const double thickness = (A.part->box.radius + B.part->box.radius) * kUp;
  const GapRange range{thickness + enough, thickness + enough + (A.sweep + B.sweep) * kUp};
  Separation found = separate(hull(A), hull(B), n, range);
  found.gap -= thickness;
  return gap_along(A, B, window, found, enough);
}

}  // namespace firstcontact::detail
