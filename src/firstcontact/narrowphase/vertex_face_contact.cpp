#include <firstcontact/narrowphase/vertex_face_contact.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <firstcontact/narrowphase/detail/elementary_search.h>
#include <firstcontact/narrowphase/detail/gap_bounds.h>
#include <firstcontact/narrowphase/detail/vector_in_a.h>

namespace firstcontact {
namespace {

using detail::kUp;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// [-]  Sine of the angle of two edges below which the face's normal is no useful direction.
constexpr double kNeedle = 1e-6;

/// A face at rest and a vertex that moves, both from A's pivot in A's axes at the start.
class VertexAndFace {
 public:
  VertexAndFace(const ElementaryMotion& motion, const Triangle& face_A, const Vector3d& vertex_B)
      : motion_(motion),
        path_(detail::seen_point(motion, motion.B.lever + motion.B.rotation * vertex_B)),
        circle_B_(path_.cosine.norm()),
        corner_(motion.A.lever + motion.A.rotation * face_A[0]),
        edge_1_(motion.A.rotation * (face_A[1] - face_A[0])),
        edge_2_(motion.A.rotation * (face_A[2] - face_A[0])),
        corners_{corner_, corner_ + edge_1_, corner_ + edge_2_},
        edges_{edge_1_, edge_2_ - edge_1_, -edge_2_},
        normal_(edge_1_.cross(edge_2_)),
        inward_{normal_.cross(edges_[0]), normal_.cross(edges_[1]), normal_.cross(edges_[2])},
        inverse_(detail::inverse(edges_[0].squaredNorm()), detail::inverse(edges_[1].squaredNorm()),
                 detail::inverse(edges_[2].squaredNorm()), 0.0),
        normal_length_(normal_.norm()),
        edges_product_(std::sqrt(edge_1_.squaredNorm() * edge_2_.squaredNorm())),
        flat_(!(normal_length_ > kNeedle * edges_product_)),
        gap_(motion, detail::longest(face_A[0], face_A[1], face_A[2]), vertex_B.norm(),
             detail::longest(Vector2d(corners_[0].head<2>()), Vector2d(corners_[1].head<2>()),
                             Vector2d(corners_[2].head<2>())),
             circle_B_),
        inside_penalty_(flat_ ? 0.0 : 0x1p1000) {
    for (std::size_t i = 0; i < 3; ++i) {
      corner_lanes_[i] = Lanes(corners_[0][i], corners_[1][i], corners_[2][i], 0.0);
      edge_lanes_[i] = Lanes(edges_[0][i], edges_[1][i], edges_[2][i], 0.0);
      inward_lanes_[i] = Lanes(inward_[0][i], inward_[1][i], inward_[2][i], 0.0);
    }
  }

  void move_to(double t) {
    const detail::Turns turns(motion_, t);
    seen_ = path_.at(turns, motion_.B.rate);
    p_ = seen_.value;
    axis_B_ = turns.back(motion_.axis_B);
  }

  [[nodiscard]] ValueAndRate coplanarity() const {
    return {normal_.dot(p_ - corner_), normal_.dot(detail::relative_rate(seen_, motion_.A.rate))};
  }

  /// Bounds f = Rot(z) normal . (line + Rot(axis_B) swing) - normal . a.
  [[nodiscard]] CurvatureBound coplanarity_bounds() {
    const double w_A = motion_.A.rate;
    // The point that p turns about moves on a line, which is farthest from A's axis at an end.
    const Vector2d begin = path_.constant.head<2>();
    const Vector2d drift = path_.drift.head<2>();
    const double across =
        detail::longest(begin, Vector2d(begin + (motion_.t_end - motion_.t_begin) * drift));
    speed_bound_ =
        (motion_.drift_length + motion_.B.rate * circle_B_ + w_A * (across + circle_B_)) * kUp;
    // The normal is a product of rounded edges.
    const double normal_error = motion_.rounding * edges_product_;
    const AxialParts normal{std::abs(normal_.z()) + normal_error,
                            normal_.head<2>().norm() + normal_error};
    CurvatureBound bounds;
    bounds.value_error = (normal_length_ * gap_.position_error + normal_error * gap_.size) * kUp;
    bounds.rate_error = (normal_length_ * gap_.slip + normal_error * speed_bound_) * kUp;
    bounds.curvature = (motion_.oscillation.dot_derivative(2, normal, {0.0, circle_B_}) +
                        normal.across * w_A * (w_A * across + 2.0 * drift.norm()) +
                        (normal_length_ + normal_error) * gap_.unsteadiness) *
                       kUp;
    return bounds;
  }

  /// The gaps along the direction from the nearest point, which stands still in the world.
  [[nodiscard]] detail::Gaps<3> gaps() const {
    const Vector3d d = from_nearest_point();
    // A corner a moves at rate z x a, along d at -a . turn.
    const Vector3d turn(-motion_.A.rate * d.y(), motion_.A.rate * d.x(), 0.0);
    const double rate = d.dot(seen_.rate);
    detail::Gaps<3> gaps{{}, gap_.along(d, axis_B_)};
    for (std::size_t k = 0; k < 3; ++k) {
      gaps.corners[k] = {d.dot(p_ - corners_[k]), rate + turn.dot(corners_[k])};
    }
    return gaps;
  }

  /// Whether p provably meets the face where it is coplanar with it within `duration`.
  ///
  /// Derivation: on the plane of the face, p is inside where it is on the inner side of each edge.
  /// The computed inward normal of an edge errs by the tilt of the face's normal. p errs by its own
  /// error and by its displacement since t.
  [[nodiscard]] bool meet_if_coplanar(double duration) const {
    if (flat_) {
      return false;
    }
    const double way = speed_bound_ * duration * kUp + gap_.position_error;
    const double tilt = 0x1p-49 + motion_.rounding * edges_product_ / normal_length_;
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d r = p_ - corners_[k];
      const double margin = way + tilt * (r.norm() + way);
      inside = inside && inward_[k].dot(r) > margin * inward_[k].norm() * kUp;
    }
    return inside;
  }

 private:
  using Lanes = Eigen::Array4d;  // One for each edge, or for the corner where it begins.

  /// The direction from the face's nearest feature, of any length.
  ///
  /// It is along the face's normal, or across an edge that p is outside of, or from a corner. It
  /// stays accurate where p touches. All edges are computed at once, without branches: which one is
  /// nearest cannot be foreseen.
  [[nodiscard]] Vector3d from_nearest_point() const {
    const Lanes x = p_.x() - corner_lanes_[0];
    const Lanes y = p_.y() - corner_lanes_[1];
    const Lanes z = p_.z() - corner_lanes_[2];
    const Lanes s = (x * edge_lanes_[0] + y * edge_lanes_[1] + z * edge_lanes_[2]) * inverse_;
    const Lanes on_edge = s.max(0.0).min(1.0);
    Lanes d_x = x - on_edge * edge_lanes_[0];
    Lanes d_y = y - on_edge * edge_lanes_[1];
    Lanes d_z = z - on_edge * edge_lanes_[2];
    const Lanes inside = x * inward_lanes_[0] + y * inward_lanes_[1] + z * inward_lanes_[2];
    const Lanes square = d_x * d_x + d_y * d_y + d_z * d_z + inside.max(0.0) * inside_penalty_;
    // The rest along the edge that rounding has left.
    const Lanes left =
        (d_x * edge_lanes_[0] + d_y * edge_lanes_[1] + d_z * edge_lanes_[2]) * inverse_ -
        (s - on_edge);
    d_x -= left * edge_lanes_[0];
    d_y -= left * edge_lanes_[1];
    d_z -= left * edge_lanes_[2];
    // The last lane is the normal's.
    const Vector3d normal = std::copysign(1.0, normal_.dot(p_ - corner_)) * normal_;
    d_x[3] = normal.x();
    d_y[3] = normal.y();
    d_z[3] = normal.z();
    std::size_t nearest = square[1] < square[0] ? 1 : 0;
    nearest = square[2] < square[nearest] ? 2 : nearest;
    nearest = square[nearest] < 0x1p500 ? nearest : 3;
    return {d_x[nearest], d_y[nearest], d_z[nearest]};
  }

  const ElementaryMotion& motion_;
  detail::VectorInA path_;
  double circle_B_;
  Vector3d corner_;
  Vector3d edge_1_;
  Vector3d edge_2_;
  std::array<Vector3d, 3> corners_;
  std::array<Vector3d, 3> edges_;
  Vector3d normal_;
  std::array<Vector3d, 3> inward_;  // Across the edges, of any length.
  Lanes inverse_;                   // Reciprocals of the squared lengths of edges.
  double normal_length_;
  double edges_product_;
  bool flat_;
  detail::GapBounds gap_;
  double inside_penalty_;  // Keeps edges that p is inside of from being the nearest.
  std::array<Lanes, 3> corner_lanes_;
  std::array<Lanes, 3> edge_lanes_;
  std::array<Lanes, 3> inward_lanes_;
  double speed_bound_ = 0.0;  // From coplanarity_bounds().

  detail::VectorInA::State seen_;
  Vector3d p_;
  Vector3d axis_B_;
};

}  // namespace

ElementaryContact vertex_face_contact(const ElementaryMotion& motion, const Triangle& face_A,
                                      const Vector3d& vertex_B, const ElementaryOptions& options) {
  VertexAndFace pair(motion, face_A, vertex_B);
  return detail::ElementarySearch(pair, motion, options).run();
}

}  // namespace firstcontact
