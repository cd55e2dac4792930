#include <firstcontact/haptics/detail/hull_proof.h>

#include <algorithm>
#include <cstddef>

#include <Eigen/Geometry>

#include <firstcontact/geometry/convex_core.h>
#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/math/float_environment.h>
#include <firstcontact/query/detail/contact_search.h>
#include <firstcontact/query/detail/convex_search.h>
#include <firstcontact/query/detail/order.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// [vertices]  The most of a hull: each support point visits all of them.
constexpr std::size_t kMostVertices = 4096;
/// [-]  More than the rounding of the distance of a vertex from a plane, by the size of the shape.
constexpr double kRoundingOfPlanes = 1e-12;

}  // namespace

bool fills_its_hull(const Shape& shape, double slack) {
  const Mesh& mesh = shape.mesh();
  const bool is_closed = 2 * shape.edge_count() == 3 * mesh.triangles.size();
  if (mesh.vertices.size() > kMostVertices || !shape.vertices_to().empty() || !is_closed) {
    return false;
  }
  const double most = slack + kRoundingOfPlanes * shape.hierarchy().radius;
  double side = 0.0;  // The side of the triangles on which the vertices lie.
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3d& origin = mesh.vertices[a];
    const Vector3d normal =
        (mesh.vertices[b] - origin).cross(mesh.vertices[c] - origin).stableNormalized();
    double above = 0.0;
    double below = 0.0;
    for (const Vector3d& vertex : mesh.vertices) {
      const double height = normal.dot(vertex - origin);
      above = std::max(above, height);
      below = std::max(below, -height);
    }
    if (above > most && below > most) {
      return false;
    }
    const double its_side = above > most ? 1.0 : (below > most ? -1.0 : 0.0);
    if (side * its_side < 0.0) {
      return false;
    }
    side = its_side != 0.0 ? its_side : side;
  }
  return side != 0.0;
}

ConvexCore hull_of(const Shape& shape) {
  const Hierarchy& hierarchy = shape.hierarchy();
  return {.kind = ConvexKind::hull, .points = hierarchy.vertices, .reach = hierarchy.radius};
}

void first_contact_of_hulls(const MovingShape& A, const MovingShape& B,
                            const FirstContactOptions& options, FirstContactResult& result) {
  const FloatEnvironmentGuard guard;
  result.contacts.clear();
  result.contact_count = {};
  result.work = {};
  result.t = 0.0;
  result.t_upper.reset();
  result.clearance = options.margin;
  ConstantRatePair motion = motion_of(A, B, options.tolerance);
  const ConvexCore hull_A = hull_of(A.shape);
  const ConvexCore hull_B = hull_of(B.shape);
  const double threshold = options.margin + A.shape.radius() + B.shape.radius();
  const SearchLimits limits{.threshold = threshold,
                            .tolerance = options.tolerance,
                            .band = threshold + options.tolerance,
                            .budget = options.budget};
  while (result.t < 1.0) {
    const double end = std::min(motion.enter(result.t), 1.0);
    const PieceResult found =
        search_convex_pair({hull_A, hull_B, motion}, result.t, end, limits, result.work);
    result.t = found.t;
    result.reason = found.reason;
    if (found.contact) {
      result.verdict = found.t > 0.0 ? Verdict::contact : Verdict::contact_at_start;
      return;
    }
    if (!found.finished) {
      result.verdict = Verdict::undecided;
      return;
    }
  }
  result.verdict = Verdict::free;
}

}  // namespace firstcontact::detail
