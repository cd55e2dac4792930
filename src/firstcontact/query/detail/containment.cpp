#include <firstcontact/query/detail/containment.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>
#include <utility>

#include <Eigen/Geometry>

#include <firstcontact/query/detail/convex_contacts.h>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Directions of about unit length without any symmetry; the second is needed only where the first
/// is unsure.
constexpr std::array<std::array<double, 3>, 8> kDirections = {{{0.3141, 0.8723, 0.3742},
                                                               {-0.7291, 0.1823, 0.6597},
                                                               {0.5617, -0.6311, 0.5351},
                                                               {-0.1483, -0.9281, -0.3417},
                                                               {0.8831, 0.2269, -0.4107},
                                                               {-0.4463, 0.7013, -0.5561},
                                                               {0.1097, -0.3889, 0.9147},
                                                               {-0.9103, -0.3391, -0.2371}}};

/// Above the length of each direction.
constexpr double kDirectionLength = 1.02;

/// A box of a hierarchy in its own frame and unit.
struct OwnBox {
  Vector3d centre;
  Matrix3d axes;  // one per row
  Vector3d extent;
};

OwnBox own_box(const HierarchyNode& node, int slot) {
  OwnBox box{{}, box_axes(node, slot), {}};
  for (int k = 0; k < 3; ++k) {
    box.centre[k] = static_cast<double>(node.centre[k][slot]);
    box.extent[k] = static_cast<double>(node.half_extent(k, slot));
  }
  return box;
}

/// The way in which a ray meets a triangle.
enum class Crossing { none, leaving, entering, unsure };

/// The winding number around a point with an error bound, in the solid's frame and unit.
class WindingNumber {
 public:
  WindingNumber(const Hierarchy& solid, double t, const Vector3d& point, double error)
      : solid_(solid), t_(t), p_(point), error_(error), slack_(error + 0x1p-44) {}

  [[nodiscard]] Inside inside() {
    for (const auto& u : kDirections) {
      direction_ = Vector3d(u[0], u[1], u[2]);
      winding_ = 0;
      if (visit(0)) {
        return winding_ != 0 ? Inside::yes : Inside::no;
      }
    }
    return Inside::unsure;
  }

  /// The last triangle that the ray left or entered, in the hierarchy's order.
  [[nodiscard]] std::uint32_t crossed() const { return crossed_; }

 private:
  /// Counts the crossings below a node. False where a crossing is unsure.
  bool visit(std::uint32_t index) {
    HierarchyNode scratch;
    const HierarchyNode& node = solid_.node(index, t_, scratch);
    for (unsigned slots = node.used(); slots != 0; slots &= slots - 1) {
      const int slot = std::countr_zero(slots);
      if (misses(own_box(node, slot))) {
        continue;
      }
      const bool sure =
          node.is_leaf(slot) ? count(node.child_triangle(slot)) : visit(node.child_node(slot));
      if (!sure) {
        return false;
      }
    }
    return true;
  }

  /// Whether the ray misses a box, by the axes of the box and by their products with the ray.
  [[nodiscard]] bool misses(const OwnBox& box) const {
    const Vector3d q = box.axes * (p_ - box.centre);
    const Vector3d d = box.axes * direction_;
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3;
      const int j = (k + 2) % 3;
      const bool leaves = std::abs(q[k]) > box.extent[k] + slack_ && q[k] * d[k] >= 0.0;
      const bool passes = std::abs(q[i] * d[j] - q[j] * d[i]) >
                          (box.extent[i] + slack_) * std::abs(d[j]) +
                              (box.extent[j] + slack_) * std::abs(d[i]) + 0x1p-44;
      if (leaves || passes) {
        return true;
      }
    }
    return false;
  }

  bool count(std::uint32_t triangle) {
    switch (cross(triangle)) {
      case Crossing::none:
        return true;
      case Crossing::unsure:
        return false;
      case Crossing::leaving:
        ++winding_;
        break;
      case Crossing::entering:
        --winding_;
        break;
    }
    crossed_ = triangle;
    return true;
  }

  [[nodiscard]] Crossing cross(std::uint32_t triangle) const {
    const auto& t = solid_.triangles[triangle];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
      return Crossing::none;
    }
    const double scale = 1.0 / solid_.unit;
    std::array<Vector3d, 3> a;
    std::array<double, 3> reach{};  // Distances of the exact corners from the exact point, at most.
    for (std::size_t k = 0; k < 3; ++k) {
      a[k] = solid_.vertex(t[k], t_) * scale - p_;
      reach[k] = a[k].norm() * (1.0 + 0x1p-48) + 2.0 * error_;
    }
    // The ray passes each edge on the side of the sign of this volume.
    int left = 0;
    int right = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      const double volume = direction_.dot(a[k].cross(a[next]));
      const double doubt = kDirectionLength * (2.0 * error_ * (reach[k] + reach[next]) +
                                               0x1p-48 * reach[k] * reach[next]);
      left += volume > doubt ? 1 : 0;
      right += volume < -doubt ? 1 : 0;
    }
    if (left > 0 && right > 0) {
      return Crossing::none;
    }
    if (left < 3 && right < 3) {
      return Crossing::unsure;
    }
    const double depth = a[0].dot(a[1].cross(a[2]));
    const double doubt =
        2.0 * error_ * (reach[0] * reach[1] + reach[1] * reach[2] + reach[2] * reach[0]) +
        0x1p-47 * reach[0] * reach[1] * reach[2];
    if (!(std::abs(depth) > doubt)) {
      return Crossing::unsure;
    }
    if ((depth > 0.0) != (left == 3)) {
      return Crossing::none;  // The triangle lies behind.
    }
    return left == 3 ? Crossing::leaving : Crossing::entering;
  }

  const Hierarchy& solid_;
  double t_;
  Vector3d p_;
  double error_;
  double slack_;
  Vector3d direction_ = Vector3d::Zero();
  int winding_ = 0;
  std::uint32_t crossed_ = 0;
};

/// The box around a whole hierarchy along the axes of its frame, in its unit.
Eigen::AlignedBox3d bounds(const Hierarchy& hierarchy, double t) {
  Eigen::AlignedBox3d bounds;
  HierarchyNode scratch;
  const HierarchyNode& root = hierarchy.node(0, t, scratch);
  for (unsigned slots = root.used(); slots != 0; slots &= slots - 1) {
    const OwnBox box = own_box(root, std::countr_zero(slots));
    const Vector3d reach =
        box.axes.cwiseAbs().transpose() * box.extent + Vector3d::Constant(0x1p-44);
    bounds.extend(box.centre - reach);
    bounds.extend(box.centre + reach);
  }
  return bounds;
}

/// Looks for a vertex of a body in a solid.
class VertexSearch {
 public:
  /// @param R       turns from the body's frame to the solid's
  /// @param origin  [m]  of the body's centre in the solid's frame
  /// @param error   [m]  of any position
  VertexSearch(const Hierarchy& solid, const Hierarchy& body, double t, const Matrix3d& R,
               const Vector3d& origin, double error)
      : solid_(solid),
        body_(body),
        t_(t),
        R_(R),
        origin_(origin),
        error_(error / solid.unit),
        bounds_(bounds(solid, t)) {
    const Vector3d slack = Vector3d::Constant(error_ + 0x1p-44);
    bounds_ = {bounds_.min() - slack, bounds_.max() + slack};
  }

  Inside among(std::span<const std::uint32_t> vertices) {
    for (const std::uint32_t v : vertices) {
      if (test(v)) {
        return Inside::yes;
      }
    }
    return doubt_ ? Inside::unsure : Inside::no;
  }

  /// @param p  [m]  a point of the body, from its centre
  Inside at(const Vector3d& p) {
    return test_at(p) ? Inside::yes : doubt_ ? Inside::unsure : Inside::no;
  }

  Inside among_all() {
    const bool found = visit(0);
    return found ? Inside::yes : doubt_ ? Inside::unsure : Inside::no;
  }

  [[nodiscard]] std::uint32_t vertex() const { return vertex_; }  ///< In the hierarchy's order.
  [[nodiscard]] std::uint32_t crossed() const { return crossed_; }

 private:
  bool test(std::uint32_t v) {
    vertex_ = v;
    return test_at(body_.vertex(v, t_));
  }

  bool test_at(const Vector3d& p_body) {
    const Vector3d p = (origin_ + R_ * p_body) / solid_.unit;
    if (!bounds_.contains(p)) {
      return false;
    }
    WindingNumber winding(solid_, t_, p, error_);
    const Inside inside = winding.inside();
    doubt_ = doubt_ || inside == Inside::unsure;
    crossed_ = winding.crossed();
    return inside == Inside::yes;
  }

  bool visit(std::uint32_t index) {
    HierarchyNode scratch;
    const HierarchyNode& node = body_.node(index, t_, scratch);
    for (unsigned slots = node.used(); slots != 0; slots &= slots - 1) {
      const int slot = std::countr_zero(slots);
      if (is_apart(own_box(node, slot))) {
        continue;
      }
      const bool found = node.is_leaf(slot) ? test(body_.triangles[node.child_triangle(slot)][0])
                                            : visit(node.child_node(slot));
      if (found) {
        return true;
      }
    }
    return false;
  }

  /// Whether a box of the body lies outside of the solid's bounds, by the axes of both.
  [[nodiscard]] bool is_apart(const OwnBox& box) const {
    const double ratio = body_.unit / solid_.unit;
    const Vector3d centre = origin_ / solid_.unit + ratio * (R_ * box.centre);
    const Vector3d extent = ratio * box.extent + Vector3d::Constant(0x1p-44 * (1.0 + ratio));
    const Matrix3d axes = box.axes * R_.transpose();
    const Vector3d between = bounds_.center() - centre;
    const Vector3d half = 0.5 * bounds_.sizes();
    const Vector3d along_bounds = between.cwiseAbs() - half - axes.cwiseAbs().transpose() * extent;
    const Vector3d along_box = (axes * between).cwiseAbs() - axes.cwiseAbs() * half - extent;
    return along_bounds.maxCoeff() > 0.0 || along_box.maxCoeff() > 0.0;
  }

  const Hierarchy& solid_;
  const Hierarchy& body_;
  double t_;
  Matrix3d R_;
  Vector3d origin_;
  double error_;
  Eigen::AlignedBox3d bounds_;
  bool doubt_ = false;
  std::uint32_t vertex_ = 0;
  std::uint32_t crossed_ = 0;
};

/// Most components that are tested one by one; more are found by their boxes.
constexpr std::size_t kFewComponents = 64;

Containment search(const Shape& body, VertexSearch search, bool vertex_of_A) {
  const std::span<const std::uint32_t> components = body.component_vertices();
  Containment found;
  found.inside =
      components.size() <= kFewComponents ? search.among(components) : search.among_all();
  found.vertex_of_A = vertex_of_A;
  found.vertex = search.vertex();
  found.face = search.crossed();
  return found;
}

/// Looks for the origin of a convex set in a solid.
Containment search(const ConvexCore& core, VertexSearch search, bool set_is_A) {
  Containment found;
  found.inside = search.at(core.origin);
  found.vertex_of_A = set_is_A;
  found.is_set = true;
  found.face = search.crossed();
  return found;
}

/// A vertex (index in the mesh) with the first triangle that has it.
Feature vertex_feature(const Mesh& mesh, std::uint32_t vertex) {
  const auto has_it = [&](const std::array<std::uint32_t, 3>& t) {
    return std::find(t.begin(), t.end(), vertex) != t.end();
  };
  const auto triangle = std::find_if(mesh.triangles.begin(), mesh.triangles.end(), has_it);
  return {FeatureType::vertex, vertex,
          static_cast<std::uint32_t>(triangle - mesh.triangles.begin())};
}

}  // namespace

Inside winds_around(const Hierarchy& surface, const Vector3d& p_CP, double error) {
  const Vector3d p = p_CP / surface.unit;
  const double own_error = error / surface.unit;
  const Eigen::AlignedBox3d around = bounds(surface, 0.0);
  if (around.squaredExteriorDistance(p) > own_error * own_error) {
    return Inside::no;
  }
  return WindingNumber(surface, 0.0, p, own_error).inside();
}

Containment find_containment(const Shape& A, const Shape& B, const MovingPair& pair,
                             const RelativeState& state) {
  const double error = 2.0 * pair.gap_error(state);  // Positions are turned once more.
  const ConvexCore* set_A = pair.convex_A();
  const ConvexCore* set_B = pair.convex_B();
  if (set_A != nullptr && set_B != nullptr) {
    return {};
  }
  Containment in_A;
  if (A.is_solid() && set_A == nullptr) {
    const Matrix3d R_AW = state.R_WA.transpose();
    const VertexSearch look(A.hierarchy(), B.hierarchy(), state.t, R_AW * state.R_WB,
                            R_AW * state.p_AB, error);
    in_A = set_B != nullptr ? search(*set_B, look, false) : search(B, look, false);
    if (in_A.inside == Inside::yes) {
      return in_A;
    }
  }
  Containment in_B;
  if (B.is_solid() && set_B == nullptr) {
    const Matrix3d R_BW = state.R_WB.transpose();
    const VertexSearch look(B.hierarchy(), A.hierarchy(), state.t, R_BW * state.R_WA,
                            -(R_BW * state.p_AB), error);
    in_B = set_A != nullptr ? search(*set_A, look, true) : search(A, look, true);
  }
  return in_B.inside == Inside::no ? in_A : in_B;
}

Contact make_contact(const ContactFrame& frame, const RelativeState& state,
                     const Containment& found) {
  const Shape& body = found.vertex_of_A ? frame.A : frame.B;
  const Shape& solid = found.vertex_of_A ? frame.B : frame.A;
  const std::uint32_t face = solid.hierarchy().triangle_index[found.face];
  const Vector3d v = found.is_set ? Vector3d(-body.hierarchy().centre)
                                  : body.hierarchy().vertex(found.vertex, state.t);
  Contact contact;
  contact.feature_A =
      found.is_set ? feature_at(body, Vector3d::Zero())
                   : vertex_feature(body.mesh(), body.hierarchy().vertex_index[found.vertex]);
  contact.feature_B = {FeatureType::face, face, face};
  if (!found.vertex_of_A) {
    std::swap(contact.feature_A, contact.feature_B);
  }
  contact.p_WA = frame.p_WC + (found.vertex_of_A ? Vector3d(state.R_WA * v)
                                                 : Vector3d(state.p_AB + state.R_WB * v));
  contact.p_WB = contact.p_WA;
  return contact;
}

}  // namespace firstcontact::detail
