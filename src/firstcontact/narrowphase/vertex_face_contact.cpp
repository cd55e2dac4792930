#include <firstcontact/narrowphase/vertex_face_contact.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <firstcontact/narrowphase/detail/elementary_search.h>
#include <firstcontact/narrowphase/detail/seen_vector.h>

namespace firstcontact {
namespace {

using detail::CoplanarityValue;
using detail::Gap;
using detail::kUp;
using Eigen::Vector3d;

/// A face at rest and a vertex that moves, both from A's pivot in A's axes at the start.
class VertexAndFace {
 public:
  VertexAndFace(const ElementaryMotion& motion, const Triangle& face_A, const Vector3d& vertex_B)
      : motion_(motion),
        path_(detail::seen_point(motion, motion.B().lever + motion.B().rotation * vertex_B)) {
    for (int k = 0; k < 3; ++k) {
      corners_[k] = motion.A().lever + motion.A().rotation * face_A[k];
      reach_A_ = std::max(reach_A_, corners_[k].norm());
    }
    edge_1_ = corners_[1] - corners_[0];
    edge_2_ = corners_[2] - corners_[0];
    normal_ = edge_1_.cross(edge_2_);
    normal_length_ = normal_.norm();
    edges_product_ = edge_1_.norm() * edge_2_.norm();
    bound_motion(vertex_B.norm());
  }

  void move_to(double t) {
    const detail::Turns turns = detail::turns_at(motion_, t);
    const detail::SeenVector::State seen = path_.at(motion_, turns);
    p_ = seen.value;
    world_rate_ = seen.rate;
    rate_ = seen.rate - spin_.cross(p_);
  }

  [[nodiscard]] CoplanarityValue coplanarity() const {
    return {normal_.dot(p_ - corners_[0]), normal_.dot(rate_), value_error_, rate_error_,
            curvature_};
  }

  [[nodiscard]] double separated_for() const {
    const Vector3d r = p_ - closest_point();
    const double distance = r.norm();
    if (!(distance > position_error_)) {
      return 0.0;
    }
    const Vector3d n = r / distance;
    return std::max(separated_along_fixed(n), separated_along_carried(n));
  }

  /// Derivation: on the plane of the face, p is inside where it is on the inner side of each edge.
  /// The computed inward normal of an edge errs by the tilt of the face's normal, p by its own
  /// error and by its way since t.
  [[nodiscard]] bool meet_if_coplanar(double duration) const {
    if (!(normal_length_ > 0.0)) {
      return false;
    }
    const double way = speed_bound_ * duration * kUp + position_error_;
    const double tilt = 0x1p-49 + motion_.rounding() * edges_product_ / normal_length_;
    for (int k = 0; k < 3; ++k) {
      const Vector3d edge = corners_[(k + 1) % 3] - corners_[k];
      const Vector3d inward = normal_.cross(edge);
      const Vector3d r = p_ - corners_[k];
      if (!(inward.dot(r) > (way + tilt * (r.norm() + way)) * inward.norm() * kUp)) {
        return false;
      }
    }
    return true;
  }

 private:
  /// All bounds that hold to the end of the piece.
  void bound_motion(double vertex_length) {
    const Vector3d& u_A = motion_.A().axis;
    const double w_A = motion_.A().rate;
    const double w_B = motion_.B().rate;
    const double duration = motion_.t_end() - motion_.t_begin();
    const double reach_B = motion_.B().lever.norm() + vertex_length;
    const double size = (reach_A_ + reach_B + motion_.offset_bound()) * kUp;
    const double speed = motion_.drift().norm() + w_B * path_.swing;
    spin_ = w_A * u_A;
    // The pivot's line across A's axis is farthest from it at an end.
    const Vector3d begin = path_.constant - u_A.dot(path_.constant) * u_A;
    const Vector3d drift = path_.drift - u_A.dot(path_.drift) * u_A;
    const double across = std::max(begin.norm(), (begin + duration * drift).norm());
    const detail::Oscillation oscillation(motion_);
    const detail::Parts swing{0.0, path_.swing};
    carried_along_ = oscillation.of_dot({1.0, 0.0}, swing) * kUp;
    carried_across_ =
        (oscillation.of_dot({0.0, 1.0}, swing) + w_A * w_A * across + 2.0 * w_A * drift.norm()) *
        kUp;
    fixed_acceleration_ = w_B * w_B * path_.swing * kUp;
    speed_bound_ = (speed + w_A * (across + path_.swing)) * kUp;
    position_error_ = motion_.rounding() * size + motion_.position_error() +
                      motion_.A().rotation_error * reach_A_ + motion_.B().rotation_error * reach_B;
    slip_ = motion_.rounding() * (speed + (w_A + w_B) * size) + (w_A + w_B) * position_error_;
    // The normal is a product of edges that are rounded themselves.
    const double normal_error = motion_.rounding() * edges_product_;
    value_error_ = (normal_length_ * position_error_ + normal_error * size) * kUp;
    rate_error_ = (normal_length_ * slip_ + normal_error * speed_bound_) * kUp;
    // What the errors of positions add to any acceleration.
    unsteadiness_ = slip_ * (w_A + w_B);
    const detail::Parts n = detail::parts(normal_, u_A);
    curvature_ = (n.along + normal_error) * carried_along_ +
                 (n.across + normal_error) * carried_across_ +
                 (normal_length_ + normal_error) * unsteadiness_;
  }

  /// The face's point nearest to p: its foot, or on an edge that p is outside of.
  [[nodiscard]] Vector3d closest_point() const {
    const Vector3d r = p_ - corners_[0];
    const double g11 = edge_1_.squaredNorm();
    const double g12 = edge_1_.dot(edge_2_);
    const double g22 = edge_2_.squaredNorm();
    const double r1 = edge_1_.dot(r);
    const double r2 = edge_2_.dot(r);
    const double determinant = g11 * g22 - g12 * g12;
    const double b = g22 * r1 - g12 * r2;
    const double c = g11 * r2 - g12 * r1;
    // Needles have no normal worth using.
    const bool flat = !(determinant > 1e-12 * g11 * g22);
    const std::array<bool, 3> outside = {flat || c < 0.0, flat || b + c > determinant,
                                         flat || b < 0.0};
    if (!outside[0] && !outside[1] && !outside[2]) {
      return p_ - (normal_.dot(r) / (normal_length_ * normal_length_)) * normal_;
    }
    Vector3d closest = corners_[0];
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      if (outside[k]) {
        const Vector3d& start = corners_[k];
        const Vector3d edge = corners_[(k + 1) % 3] - start;
        const double length2 = edge.squaredNorm();
        const double s = length2 > 0.0 ? edge.dot(p_ - start) / length2 : 0.0;
        const Vector3d q = start + std::clamp(s, 0.0, 1.0) * edge;
        if (const double d2 = (p_ - q).squaredNorm(); d2 < least) {
          least = d2;
          closest = q;
        }
      }
    }
    return closest;
  }

  /// n turns with A.
  [[nodiscard]] double separated_along_carried(const Vector3d& n) const {
    const double clear =
        std::min({n.dot(p_ - corners_[0]), n.dot(p_ - corners_[1]), n.dot(p_ - corners_[2])}) -
        position_error_;
    const double along = std::abs(n.dot(motion_.A().axis));
    const double across = std::sqrt(std::max(0.0, 1.0 - along * along) + 0x1p-40);
    const double acceleration = along * carried_along_ + across * carried_across_ + unsteadiness_;
    return time_to_close(clear, slip_ - n.dot(rate_), 0.5 * acceleration * kUp);
  }

  /// n stands still in the world; each corner then moves by itself.
  [[nodiscard]] double separated_along_fixed(const Vector3d& n) const {
    // A corner a moves at spin x a, along n at -a . (spin x n).
    const Vector3d turn = spin_.cross(n);
    const double half_acceleration =
        0.5 * (fixed_acceleration_ + motion_.A().rate * turn.norm() * reach_A_ + unsteadiness_) *
        kUp;
    const double drift = n.dot(world_rate_);
    double time = std::numeric_limits<double>::infinity();
    for (const Vector3d& a : corners_) {
      const Gap gap{n.dot(p_ - a) - position_error_, slip_ - drift - turn.dot(a),
                    half_acceleration};
      if (!gap.open_for(time)) {
        time = gap.time_open();
      }
    }
    return time;
  }

  const ElementaryMotion& motion_;
  std::array<Vector3d, 3> corners_;
  Vector3d edge_1_;
  Vector3d edge_2_;
  Vector3d normal_;
  double normal_length_;
  double edges_product_;
  detail::SeenVector path_;
  double reach_A_ = 0.0;

  Vector3d spin_;
  double carried_along_;
  double carried_across_;
  double fixed_acceleration_;
  double speed_bound_;
  double position_error_;
  double slip_;
  double unsteadiness_;
  double value_error_;
  double rate_error_;
  double curvature_;

  Vector3d p_;
  Vector3d world_rate_;
  Vector3d rate_;
};

}  // namespace

ElementaryContact vertex_face_contact(const ElementaryMotion& motion, const Triangle& face_A,
                                      const Vector3d& vertex_B, const ElementaryOptions& options) {
  VertexAndFace pair(motion, face_A, vertex_B);
  return detail::search_contact(pair, motion, options);
}

}  // namespace firstcontact
