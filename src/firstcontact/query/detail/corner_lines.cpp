#include <firstcontact/query/detail/corner_lines.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include <firstcontact/geometry/hierarchy.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// The corners of a triangle, each once, as indices in the mesh.
struct Corners {
  std::array<std::uint32_t, 3> index;
  std::size_t count = 0;
};

Corners corners_of(const Hierarchy& hierarchy, std::uint32_t triangle) {
  Corners corners;
  for (const std::uint32_t v : hierarchy.triangles[triangle]) {
    const auto end = corners.index.begin() + static_cast<std::ptrdiff_t>(corners.count);
    const std::uint32_t index = hierarchy.vertex_index[v];
    if (std::find(corners.index.begin(), end, index) == end) {
      corners.index[corners.count++] = index;
    }
  }
  return corners;
}

class Lines {
 public:
  explicit Lines(const MovingShape& body) : body_(body) {}

  PreciseLinearFeature of(std::uint32_t triangle) {
    const Corners corners = corners_of(body_.shape.hierarchy(), triangle);
    PreciseLinearFeature feature;
    feature.count = corners.count;
    for (std::size_t k = 0; k < corners.count; ++k) {
      feature.corners[k] = line(corners.index[k]);
    }
    return feature;
  }

  [[nodiscard]] double position_error() const { return position_error_; }

 private:
  /// The place of a point that rests in the body, at a time.
  DoubleDoubleVector3 place(const Vector3d& p_BC, double t) {
    const ConstantRatePath path = body_.X_WS.path(0, p_BC);
    position_error_ = std::max(position_error_, path.position_error());
    return path.pivot(t);
  }

  /// The line of a vertex of a body that deforms.
  ///
  /// At the end the vertex is at to - translation in the body: R (to - translation), where
  /// `translation` is a vector of the body, too.
  PreciseLinearPoint line(std::uint32_t vertex) {
    const Vector3d& from = body_.shape.mesh().vertices[vertex];
    const std::span<const Vector3d> to = body_.shape.vertices_to();
    if (to.empty()) {
      return {place(from, 0.0), place(from, 1.0)};
    }
    const DoubleDoubleVector3 turned =
        place(body_.shape.translation_to(), 1.0) - place(Vector3d::Zero(), 1.0);
    return {place(from, 0.0), place(to[vertex], 1.0) - turned};
  }

  const MovingShape& body_;
  double position_error_ = 0.0;
};

}  // namespace

bool CornerLines::exist(const RelativeState& state) const {
  constexpr std::size_t kOnePiece = 2;
  return state.rate_A == 0.0 && state.rate_B == 0.0 && A_.X_WS.breaks().size() == kOnePiece &&
         B_.X_WS.breaks().size() == kOnePiece &&
         suits_double_doubles(A_.shape.hierarchy().radius + B_.shape.hierarchy().radius);
}

LinearTriangles CornerLines::triangles(std::uint32_t triangle_A, std::uint32_t triangle_B) const {
  Lines A(A_);
  Lines B(B_);
  LinearTriangles triangles;
  triangles.A = A.of(triangle_A);
  triangles.B = B.of(triangle_B);
  // Three places at most, and their sum.
  triangles.position_error = 4.0 * std::max(A.position_error(), B.position_error());
  return triangles;
}

}  // namespace firstcontact::detail
