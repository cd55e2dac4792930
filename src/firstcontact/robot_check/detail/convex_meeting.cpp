#include <firstcontact/robot_check/detail/convex_meeting.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/narrowphase/convex_pair.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// Most triangles that are tried: those around the corners of one hull's triangle.
constexpr std::size_t kMostTriangles = 32;

/// The distinct triangles around a few corners.
class NearTriangles {
 public:
  void add(const HullCorners& corners, const Vector3d& corner) {
    const auto found = std::ranges::find(corners.points, corner);
    if (found == corners.points.end()) {
      return;
    }
    const auto all = corners.triangles_at(static_cast<std::size_t>(found - corners.points.begin()));
    for (const std::uint32_t triangle : all) {
      const std::span known = triangles();
      if (count_ < kMostTriangles && std::ranges::find(known, triangle) == known.end()) {
        triangles_[count_++] = triangle;
      }
    }
  }

  [[nodiscard]] std::span<const std::uint32_t> triangles() const {
    return std::span(triangles_).first(count_);
  }

 private:
  std::array<std::uint32_t, kMostTriangles> triangles_;
  std::size_t count_ = 0;
};

/// The places of two hulls at a state, and how near points have to be.
class Meeting {
 public:
  Meeting(const ShapeHull& A, const ShapeHull& B, const RelativeState& state, const Vector3d& n,
          double within)
      : state_(state), n_(n) {
    close_ = within - convex_gap_error(state, A.core.reach, B.core.reach) - (A.error + B.error);
  }

  [[nodiscard]] bool is_close(const ConvexCore& A, const ConvexCore& B) const {
    constexpr double kAnyGap = 1e-12;  // [-]  Any gap beyond ends the search.
    ConvexGuess guess;
    guess.n = n_;
    const PlacedConvex at_A{.core = A, .R = state_.R_WA};
    const PlacedConvex at_B{.core = B, .R = state_.R_WB, .centre = state_.p_AB};
    return closest_points(at_A, at_B, {.least = close_, .near = kAnyGap, .close = close_}, guess)
               .distance <= close_;
  }

 private:
  const RelativeState& state_;
  const Vector3d& n_;
  double close_;  // [m]
};

/// Whether a point is in a box or a cylinder, deeper than the error; p from the set's own origin.
bool is_in_core(const ConvexCore& core, const Vector3d& p, double error) {
  switch (core.kind) {
    case ConvexKind::box:
      return ((core.size - p.cwiseAbs()).array() > error).all();
    case ConvexKind::cylinder:
      return core.size.z() - std::abs(p.z()) > error &&
             core.size.x() - std::sqrt(p.x() * p.x() + p.y() * p.y()) > error;
    default:
      return false;
  }
}

/// Whether a vertex of a mesh is in a set, with the set's pose as seen from the mesh. The vertices
/// around a curved body are not points of it.
bool has_vertex_in(const ShapeHull& mesh, const ShapeHull& set, const Eigen::Matrix3d& R_mesh_set,
                   const Vector3d& p_mesh_set, double error) {
  const ConvexCore& core = set.core;
  if (mesh.shape->is_curved() || !set.shape->is_solid() ||
      (core.kind != ConvexKind::box && core.kind != ConvexKind::cylinder)) {
    return false;
  }
  const Eigen::Matrix3d R = R_mesh_set.transpose();
  const Vector3d shift = R * p_mesh_set + core.origin;
  const std::vector<Vector3d>& corners = mesh.corners->points;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    if (is_in_core(core, R * corners[k] - shift, error) && !mesh.corners->triangles_at(k).empty()) {
      return true;
    }
  }
  return false;
}

}  // namespace

bool has_vertex_inside(const ShapeHull& A, const ShapeHull& B, const RelativeState& state) {
  const double error =
      convex_gap_error(state, A.core.reach, B.core.reach) + 2.0 * (A.error + B.error);
  const Eigen::Matrix3d R_AB = state.R_WA.transpose() * state.R_WB;
  const Vector3d p_AB = state.R_WA.transpose() * state.p_AB;
  return has_vertex_in(A, B, R_AB, p_AB, error) ||
         has_vertex_in(B, A, R_AB.transpose(), -(R_AB.transpose() * p_AB), error);
}

bool have_met(const ShapeHull& A, const ShapeHull& B, const RelativeState& state,
              const ConvexGuess& near, double threshold, double tolerance) {
  const Meeting meeting(A, B, state, near.n, threshold + 0.5 * tolerance);
  const bool A_is_set = A.shape->convex_set() != nullptr;
  const bool B_is_set = B.shape->convex_set() != nullptr;
  if (A_is_set && B_is_set) {
    return meeting.is_close(A.core, B.core);
  }
  if (!A_is_set && !B_is_set) {
    return false;
  }
  const ShapeHull& mesh = A_is_set ? B : A;
  NearTriangles around;
  for (std::size_t k = 0; k < near.count; ++k) {
    around.add(*mesh.corners, A_is_set ? near.p_B[k] : near.p_A[k]);
  }
  if (near.count == 0) {
    const Vector3d n = A_is_set ? Vector3d(-(state.R_WB.transpose() * near.n))
                                : Vector3d(state.R_WA.transpose() * near.n);
    around.add(*mesh.corners, mesh.core.support_point(n));
  }
  const Hierarchy& hierarchy = mesh.shape->hierarchy();
  return std::ranges::any_of(around.triangles(), [&](std::uint32_t triangle) {
    std::array<Vector3d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = hierarchy.vertices[hierarchy.triangles[triangle][k]];
    }
    const ConvexCore core{.kind = ConvexKind::hull, .points = corners, .reach = hierarchy.radius};
    return A_is_set ? meeting.is_close(A.core, core) : meeting.is_close(core, B.core);
  });
}

}  // namespace firstcontact::detail
