#include <firstcontact/robot_check/detail/swept_geometry.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <firstcontact/narrowphase/convex_separation.h>
#include <firstcontact/robot/detail/chain_walk.h>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kUp = 1.0 + 0x1p-40;

/// [-]  Rounding of products and sums of a few vectors, and of unit vectors.
constexpr double kRounding = 0x1p-46;

/// [-]  Rounding of a middle of two times, twice.
constexpr double kTimeRounding = 0x1p-51;

void enclose(SweptGeometry& swept, std::span<const GeometryPlace> places) {
  const RoundedBox& box = swept.geometry->box;
  swept.low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  swept.high = -swept.low;
  for (const GeometryPlace& place : places) {
    const Vector3d extent = (place.R_FS * box.axes.transpose()).cwiseAbs() * box.half_extents;
    swept.low = swept.low.cwiseMin(place.centre - extent);
    swept.high = swept.high.cwiseMax(place.centre + extent);
  }
  const Vector3d more = Vector3d::Constant((box.radius + swept.error) * kUp);
  swept.low -= more;
  swept.high += more;
}

PlacedPolytope hull(const SweptGeometry& swept, const GeometryPlace& place) {
  return {swept.geometry->bounds->corners, place.R_FS, place.centre};
}

double thickness(const SweptGeometry& A, const SweptGeometry& B, double error) {
  return (A.geometry->box.radius + B.geometry->box.radius + error) * kUp;
}

}  // namespace

GeometryMount::GeometryMount(const BoundedGeometry& geometry, TreePoses& given_course,
                             std::size_t given_node, const JointPath& X_LS)
    : course(&given_course), node(given_node) {
  const JointState& rest = *X_LS.rest();
  const Vector3d p_LS = rest.p_PQ.value() + rest.p_QL;
  R_LS = rest.R_PL;
  p_LC = p_LS + R_LS * geometry.box.centre;
  far = (p_LS.norm() + geometry.box.centre.norm() + geometry.box.reach()) * kUp;
}

GeometryMount::GeometryMount(const BoundedGeometry& geometry, TreePoses& given_course)
    : course(&given_course),
      p_LC(geometry.box.centre),
      far((geometry.box.centre.norm() + geometry.box.reach()) * kUp) {}

GeometryTrack::GeometryTrack(const BoundedGeometry& geometry, const GeometryMount& mount,
                             std::size_t frame)
    : geometry_(&geometry), mount_(mount), frame_(frame) {
  const auto bounds = mount.course->bounds(mount.node, mount.p_LC, geometry.reach, frame);
  speed_ = bounds.rate;
  jerk_ = bounds.jerk;
}

GeometryPlace GeometryTrack::place(int k) const {
  const FramePlace& L = mount_.course->place(mount_.node, k);
  GeometryPlace place{L.R * mount_.R_LS, L.p + L.R * mount_.p_LC, 0.0};
  place.error =
      (L.position_error + L.rounding + (L.rotation_error + 2.0 * kRotationStep) * mount_.far +
       geometry_->bounds->error + kRounding * (place.centre.norm() + mount_.far)) *
      kUp;
  if (frame_ != TreePoses::kWorld) {
    const FramePlace& F = mount_.course->place(frame_, k);
    const Vector3d arm = place.centre - F.p;
    const double size = place.centre.norm() + F.p.norm() + mount_.far;
    place.error =
        (place.error + F.position_error + F.rounding + (F.rotation_error + kRounding) * size) * kUp;
    place.centre = F.R.transpose() * arm;
    place.R_FS = F.R.transpose() * place.R_FS;
  }
  return place;
}

SweptGeometry GeometryTrack::sweep(const TimeWindow& window, const GeometryPlace& begin,
                                   const GeometryPlace& middle, const GeometryPlace& end) const {
  SweptGeometry swept;
  swept.geometry = geometry_;
  swept.controls = {begin,
                    {2.0 * middle.R_FS - 0.5 * (begin.R_FS + end.R_FS),
                     2.0 * middle.centre - 0.5 * (begin.centre + end.centre)},
                    end};
  swept.middle = middle;
  const double T = window.end - window.begin;
  swept.error = (3.0 * std::max({begin.error, middle.error, end.error}) +
                 jerk_ * T * T * T / 124.0 + kTimeRounding * speed_) *
                kUp;
  enclose(swept, swept.controls);
  return swept;
}

SweptGeometry GeometryTrack::rest() const {
  SweptGeometry swept;
  swept.geometry = geometry_;
  swept.middle = place(TimeGrid::kMiddle);
  swept.controls.fill(swept.middle);
  swept.rests = true;
  swept.error = swept.middle.error;
  enclose(swept, std::span(swept.controls).first(1));
  return swept;
}

SweptGap gap_of_boxes(const SweptGeometry& A, const SweptGeometry& B) {
  const Vector3d forth = B.low - A.high;
  const Vector3d back = A.low - B.high;
  Eigen::Index axis = 0;
  const double most = forth.cwiseMax(back).maxCoeff(&axis);
  return {most, (forth[axis] >= back[axis] ? 1.0 : -1.0) * Vector3d::Unit(axis)};
}

SweptGap gap_at_middle(const SweptGeometry& A, const SweptGeometry& B, double enough,
                       const Vector3d& n, double near) {
  const double thick = thickness(A, B, A.middle.error + B.middle.error);
  const Separation found =
      separate(hull(A, A.middle), hull(B, B.middle), n, {.least = thick + enough, .near = near});
  return {found.gap - thick, found.n};
}

SweptGap gap_at_end(const SweptGeometry& A, const SweptGeometry& B, double enough,
                    const Vector3d& n) {
  const GeometryPlace& end_A = A.controls.back();
  const GeometryPlace& end_B = B.controls.back();
  const double thick = thickness(A, B, end_A.error + end_B.error);
  const double needed = (thick + enough) * kUp;
  const Separation found = separate(hull(A, end_A), hull(B, end_B), n, {needed, needed});
  return {found.gap - thick, found.n};
}

SweptGap gap_throughout(const SweptGeometry& A, const SweptGeometry& B, double enough,
                        const Vector3d& n) {
  const std::array<PlacedPolytope, 3> hulls_A = {hull(A, A.controls[0]), hull(A, A.controls[1]),
                                                 hull(A, A.controls[2])};
  const std::array<PlacedPolytope, 3> hulls_B = {hull(B, B.controls[0]), hull(B, B.controls[1]),
                                                 hull(B, B.controls[2])};
  const double thick = thickness(A, B, A.error + B.error);
  const double needed = (thick + enough) * kUp;
  const Separation found = separate(std::span(hulls_A).first(A.rests ? 1 : 3),
                                    std::span(hulls_B).first(B.rests ? 1 : 3), n, {needed, needed});
  return {found.gap - thick, found.n};
}

}  // namespace firstcontact::detail
