#include <firstcontact/haptics/detail/hull_proof.h>

#include <algorithm>
#include <cstddef>

#include <Eigen/Geometry>

#include <firstcontact/geometry/convex_core.h>
#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/math/float_environment.h>
#include <firstcontact/narrowphase/convex_pair.h>
#include <firstcontact/query/detail/budget_watch.h>
#include <firstcontact/query/detail/order.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// [vertices]  The most of a hull: each support point visits all of them.
constexpr std::size_t kMostVertices = 4096;
/// [-]  More than the rounding of the distance of a vertex from a plane, by the size of the shape.
constexpr double kRoundingOfPlanes = 1e-12;
/// [steps]  Steps between two looks at the budget.
constexpr std::uint64_t kStepsAtOnce = 16;

/// The hull of a shape's vertices, in the frame of its hierarchy; refers to the shape.
ConvexCore hull_of(const Shape& shape) {
  const Hierarchy& hierarchy = shape.hierarchy();
  return {.kind = ConvexKind::hull, .points = hierarchy.vertices, .reach = hierarchy.radius};
}

/// Searches a piece of the motion from t = `result.t` on. Returns whether that ends the search.
bool search_piece_of_hulls(const ConvexPair& cores, ConvexContactOptions steps,
                           const FirstContactOptions& options, FirstContactResult& result) {
  ConvexGuess guess;
  BudgetWatch watch(options.budget);
  while (true) {
    result.verdict = Verdict::undecided;
    result.reason = watch.spent(result.work.steps, 0);
    if (result.reason != UndecidedReason::none) {
      return true;
    }
    steps.most_steps = std::min(kStepsAtOnce, options.budget.steps - result.work.steps);
    const ConvexContact found = convex_first_contact(cores, steps, guess);
    result.work.steps += found.steps;
    result.t = found.t;
    steps.t_begin = found.t;
    switch (found.verdict) {
      case ConvexVerdict::free:
        result.verdict = Verdict::free;
        return false;
      case ConvexVerdict::contact:
        result.verdict = found.t > 0.0 ? Verdict::contact : Verdict::contact_at_start;
        return true;
      case ConvexVerdict::unresolved:
        result.reason = UndecidedReason::precision;
        return true;
      case ConvexVerdict::unfinished:
        break;
    }
  }
}

}  // namespace

bool is_convex(const Shape& shape, double slack) {
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
  double begin = 0.0;
  while (begin < 1.0) {
    const double end = std::min(motion.enter(begin), 1.0);
    const ConvexContactOptions steps{
        .threshold = options.margin + A.shape.radius() + B.shape.radius(),
        .tolerance = options.tolerance,
        .t_begin = begin,
        .t_end = end};
    if (search_piece_of_hulls({hull_A, hull_B, motion}, steps, options, result)) {
      return;
    }
    begin = end;
  }
  result.t = 1.0;
}

}  // namespace firstcontact::detail
