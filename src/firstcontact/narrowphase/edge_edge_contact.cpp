#include <firstcontact/narrowphase/edge_edge_contact.h>

#include <algorithm>
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

double clamp_to_unit(double x) { return x > 0.0 ? std::min(x, 1.0) : 0.0; }

/// Edge a + u of A at rest and edge c + v of B that moves, from A's pivot in A's axes at the start.
class TwoEdges {
 public:
  TwoEdges(const ElementaryMotion& motion, const Edge& edge_A, const Edge& edge_B)
      : motion_(motion),
        a_(motion.A().lever + motion.A().rotation * edge_A[0]),
        u_(motion.A().rotation * (edge_A[1] - edge_A[0])),
        lever_B_(motion.B().lever + motion.B().rotation * edge_B[0]),
        start_v_(motion.B().rotation * (edge_B[1] - edge_B[0])),
        path_c_(detail::seen_point(motion, lever_B_)),
        path_v_(detail::seen_vector(motion, start_v_)) {
    bound_motion(edge_A, edge_B);
  }

  void move_to(double t) {
    const detail::Turns turns = detail::turns_at(motion_, t);
    const detail::SeenVector::State c = path_c_.at(motion_, turns);
    const detail::SeenVector::State v = path_v_.at(motion_, turns);
    e_ = c.value - a_;
    v_ = v.value;
    normal_ = u_.cross(v_);
    world_rate_c_ = c.rate;
    world_rate_v_ = v.rate;
    spin_c_ = spin_.cross(c.value);
    spin_v_ = spin_.cross(v_);
  }

  [[nodiscard]] CoplanarityValue coplanarity() const {
    const Vector3d rate_e = world_rate_c_ - spin_c_;
    const Vector3d rate_v = world_rate_v_ - spin_v_;
    return {e_.dot(normal_), rate_e.dot(normal_) + e_.cross(u_).dot(rate_v), value_error_,
            rate_error_, curvature_};
  }

  /// Along the nearest points' direction, which stands still in the world.
  [[nodiscard]] double separated_for() const {
    const Vector3d d = between_nearest_points();
    const double distance = d.norm();
    if (!(distance > position_error_)) {
      return 0.0;
    }
    const Vector3d n = d / distance;
    const Vector3d turn = spin_.cross(n);  // A point p of A moves along n at -p . turn.
    const double half_acceleration =
        0.5 * (fixed_acceleration_ + motion_.A().rate * turn.norm() * reach_A_ + unsteadiness_) *
        kUp;
    const double gap = n.dot(e_) - position_error_;
    const double speed = slip_ - n.dot(world_rate_c_) - turn.dot(a_);
    const double gap_u = -n.dot(u_);
    const double speed_u = -turn.dot(u_);
    const double gap_v = n.dot(v_);
    const double speed_v = -n.dot(world_rate_v_);
    double time = std::numeric_limits<double>::infinity();
    for (const Gap& corners :
         {Gap{gap, speed, half_acceleration}, Gap{gap + gap_u, speed + speed_u, half_acceleration},
          Gap{gap + gap_v, speed + speed_v, half_acceleration},
          Gap{gap + gap_u + gap_v, speed + speed_u + speed_v, half_acceleration}}) {
      if (!corners.open_for(time)) {
        time = corners.time_open();
      }
    }
    return time;
  }

  /// Derivation: coplanar lines that are not parallel cross at a + s u = c + r v with
  /// s |N|^2 = (e x v) . N, r |N|^2 = (e x u) . N, N = u x v. Each product changes by no more than
  /// the product of its factors' greatest lengths times the sum of their relative changes.
  [[nodiscard]] bool meet_if_coplanar(double duration) const {
    const double e_change = speed_bound_ * duration * kUp + position_error_;
    const double turn_change =
        2.0 * (motion_.A().rate + motion_.B().rate) * duration * kUp + 8.0 * motion_.rounding();
    const double e_length = e_.norm() + e_change;
    const double grown = (1.0 + turn_change) * (1.0 + turn_change) * kUp;
    const double uu = u_.squaredNorm() * grown;
    const double vv = v_.squaredNorm() * grown;
    const double uv = std::sqrt(uu * vv);
    const double change = (e_change + e_length * turn_change) * uv * kUp;
    const double nn = normal_.squaredNorm();
    const double nn_change = uu * vv * turn_change * kUp;
    const double s = e_.cross(v_).dot(normal_);
    const double r = e_.cross(u_).dot(normal_);
    const double s_change = change * std::sqrt(vv) * kUp;
    const double r_change = change * std::sqrt(uu) * kUp;
    return s > s_change && nn - s > s_change + nn_change && r > r_change &&
           nn - r > r_change + nn_change;
  }

 private:
  /// All bounds that hold to the end of the piece.
  void bound_motion(const Edge& edge_A, const Edge& edge_B) {
    const Vector3d& u_A = motion_.A().axis;
    const Vector3d& u_B = motion_.B().axis;
    const double w_A = motion_.A().rate;
    const double w_B = motion_.B().rate;
    const double length_u = u_.norm();
    const double length_v = start_v_.norm();
    const double drift = motion_.drift().norm();
    const double body_reach_A =
        motion_.A().lever.norm() + std::max(edge_A[0].norm(), edge_A[1].norm());
    const double body_reach_B =
        motion_.B().lever.norm() + std::max(edge_B[0].norm(), edge_B[1].norm());
    reach_A_ = std::max(a_.norm(), (a_ + u_).norm());
    const double swing_B = std::max(path_c_.swing, (path_c_.cosine + path_v_.cosine).norm());
    const double size = (body_reach_A + body_reach_B + motion_.offset_bound()) * kUp;
    const double speed = drift + w_B * swing_B;
    spin_ = w_A * u_A;
    speed_bound_ = (speed + w_A * (motion_.offset_bound() + lever_B_.norm())) * kUp;
    position_error_ = motion_.rounding() * size + motion_.position_error() +
                      motion_.A().rotation_error * body_reach_A +
                      motion_.B().rotation_error * body_reach_B;
    slip_ = motion_.rounding() * (speed + (w_A + w_B) * size) + (w_A + w_B) * position_error_;
    unsteadiness_ = slip_ * (w_A + w_B);
    fixed_acceleration_ = w_B * w_B * swing_B * kUp;
    // The rounding of N = u x v and of e' are relative to their factors.
    const double lengths = length_u * length_v * kUp;
    value_error_ = lengths * (position_error_ + 4.0 * motion_.rounding() * size);
    rate_error_ =
        lengths * (2.0 * slip_ + 4.0 * motion_.rounding() * (speed_bound_ + (w_A + w_B) * size));
    // f = u . (v x c_B) - (a x u) . v + (offset + tau drift) . (u x v).
    const detail::Oscillation oscillation(motion_);
    const detail::Parts u = detail::parts(u_, u_A);
    const detail::Parts v = detail::parts(start_v_, u_B);
    curvature_ = (oscillation.of_dot(u, detail::parts(start_v_.cross(lever_B_), u_B)) +
                  oscillation.of_dot(detail::parts(a_.cross(u_), u_A), v) +
                  motion_.offset_bound() * oscillation.of_cross(u, v) +
                  2.0 * drift * oscillation.rate_of_cross(u, v) + 8.0 * lengths * unsteadiness_) *
                 kUp;
  }

  /// From the point of A's edge to that of B's. One parameter comes from the normal equations, then
  /// each is made the best for the other, which also serves near-parallel edges.
  [[nodiscard]] Vector3d between_nearest_points() const {
    const double uu = u_.squaredNorm();
    const double vv = v_.squaredNorm();
    const double uv = u_.dot(v_);
    const double ue = u_.dot(e_);
    const double ve = v_.dot(e_);
    const double determinant = uu * vv - uv * uv;
    double s = determinant > 0.0 ? clamp_to_unit((ue * vv - ve * uv) / determinant) : 0.0;
    const double r = vv > 0.0 ? clamp_to_unit((s * uv - ve) / vv) : 0.0;
    s = uu > 0.0 ? clamp_to_unit((r * uv + ue) / uu) : 0.0;
    return e_ + r * v_ - s * u_;
  }

  const ElementaryMotion& motion_;
  Vector3d a_;
  Vector3d u_;
  Vector3d lever_B_;
  Vector3d start_v_;
  detail::SeenVector path_c_;
  detail::SeenVector path_v_;

  Vector3d spin_;
  double reach_A_;
  double fixed_acceleration_;
  double unsteadiness_;
  double speed_bound_;
  double position_error_;
  double slip_;
  double value_error_;
  double rate_error_;
  double curvature_;

  Vector3d e_;
  Vector3d v_;
  Vector3d normal_;
  Vector3d world_rate_c_;
  Vector3d world_rate_v_;
  Vector3d spin_c_;
  Vector3d spin_v_;
};

}  // namespace

ElementaryContact edge_edge_contact(const ElementaryMotion& motion, const Edge& edge_A,
                                    const Edge& edge_B, const ElementaryOptions& options) {
  TwoEdges pair(motion, edge_A, edge_B);
  return detail::search_contact(pair, motion, options);
}

}  // namespace firstcontact
