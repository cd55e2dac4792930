#include <firstcontact/robot_check/link_pair_motion.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>

#include <Eigen/Geometry>

#include <firstcontact/motion/time_window.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;

constexpr double kUp = 1.0 + 0x1p-40;

/// [-]  Rounding of sums of a few products of numbers and vectors.
constexpr double kRounding = 0x1p-47;

/// [-]  Greatest distance of a pole, by the other sizes of the pair. The rounding of a velocity
/// grows with it.
constexpr double kFarPole = 4.0;

const LinkPath& piece_at(const LinkMotion& motion, double t) {
  const std::span<const LinkPath> pieces = motion.pieces();
  const auto ends_later = [](double time, const LinkPath& piece) { return time < piece.t_end(); };
  return *std::upper_bound(pieces.begin(), pieces.end() - 1, t, ends_later);
}

/// The time for which second-order terms represent the path.
///
/// V T bounds the displacement of a point, J T^3 / 6 the error of these terms.
double window_length(double speed, double jerk) {
  return jerk > 0.0 ? std::sqrt(0.5 * speed / jerk) : std::numeric_limits<double>::infinity();
}

/// The end of a window: the smallest fraction of the piece by halving that begins before t and ends
/// about a length after it.
///
/// A window is at least a thousandth of the piece, so that the windows come to an end.
double end_of_window(const TimeWindow& piece, double t, double length) {
  constexpr double kLeast = 0x1p-10;
  constexpr double kEnough = 0.75;
  double share = 1.0;
  while (share > kLeast && share * (piece.end - piece.begin) > length / kEnough) {
    share *= 0.5;
  }
  const double done = (t - piece.begin) / (piece.end - piece.begin);
  const double next = (std::floor(done / share) + 1.0) * share;
  const double end = piece.begin + next * (piece.end - piece.begin);
  return end > t && next < 1.0 ? std::min(end, piece.end) : piece.end;
}

/// The motion of the centre of a ball: its offset from the link's origin, and its derivatives.
struct CentreMotion {
  Vector3d offset;
  Vector3d velocity;
  Vector3d acceleration;
};

CentreMotion centre_of(const LinkState& link, const LinkBall& ball) {
  CentreMotion centre;
  centre.offset = link.pose.R_FL * ball.p_LC;
  const Vector3d inward = link.spin.cross(centre.offset);
  centre.velocity = link.velocity + inward;
  centre.acceleration =
      link.acceleration + link.spin_rate.cross(centre.offset) + link.spin.cross(inward);
  return centre;
}

/// The vector from the pole of acceleration to the centre of a ball; zero where the link does not
/// turn.
Vector3d lever_of(const LinkState& link, const CentreMotion& centre, double radius) {
  const double rate = link.spin.norm();
  if (rate == 0.0) {
    return Vector3d::Zero();
  }
  const Vector3d axis = link.spin / rate;
  const Vector3d across = centre.acceleration - axis.dot(centre.acceleration) * axis;
  const double most = rate * (centre.velocity.norm() + rate * radius);
  const double scale = std::min(1.0, kFarPole * most / std::max(across.norm(), 1e-300));
  return -scale / (rate * rate) * across;
}

}  // namespace

/// The part of a RelativeState of one body, with positions from the pair's origin.
struct LinkPairMotion::BodyState {
  Eigen::Matrix3d R;
  Vector3d centre;
  Vector3d pivot;
  Vector3d pivot_velocity;
  Vector3d axis = Vector3d::Zero();
  double rate = 0.0;
  double drift = 0.0;
  double bend = 0.0;
  double bend_per_metre = 0.0;  ///< [per step^2]  Growth for each metre from the pivot.
  double position_error = 0.0;
  double rotation_error = 0.0;
};

LinkPairMotion::LinkPairMotion(const LinkBall& A, const LinkBall& B, LinkScratch& scratch,
                               double t_end)
    : bodies_{Body{A}, Body{B}}, t_end_(t_end), scratch_(scratch) {}

double LinkPairMotion::enter(double t) {
  TimeWindow piece{0.0, 1.0};
  for (Body& body : bodies_) {
    body.path = &piece_at(body.ball.X_FL, t);
    piece = {std::max(piece.begin, body.path->t_begin()), std::min(piece.end, body.path->t_end())};
  }
  const bool A_is_free = bodies_[0].path->constant_rates() != nullptr;
  p_FO_ = bodies_[A_is_free ? 1 : 0].path->anchor();
  const double asked = t < t_end_ ? std::min(piece.end, t_end_) : piece.end;
  double length = asked - t;
  bool bends = false;
  for (Body& body : bodies_) {
    bound(body, t, asked);
    length = std::min(length, window_length(body.speed, body.jerk));
    bends = bends || body.jerk > 0.0;
  }
  end_ = bends ? std::min(end_of_window(piece, t, length), asked) : asked;
  if (end_ < asked) {
    for (Body& body : bodies_) {
      bound(body, t, end_);
    }
  }
  return end_;
}

void LinkPairMotion::bound(Body& body, double t, double end) {
  if (const ConstantRatePath* path = body.path->constant_rates()) {
    // The path is that of the origin.
    body.speed =
        (path->pivot_velocity().value().norm() +
         path->rate() * (path->lever_length() + body.ball.p_LC.norm() + body.ball.radius)) *
        kUp;
    body.jerk = 0.0;
    return;
  }
  const LinkState link = body.path->state(t, scratch_, p_FO_);
  const Vector3d lever = lever_of(link, centre_of(link, body.ball), body.ball.radius);
  body.has_near_pole = lever.norm() <= body.ball.radius;
  body.p_LP = body.ball.p_LC;
  if (body.has_near_pole) {
    body.p_LP -= link.pose.R_FL.transpose() * lever;
  }
  const LinkWindow window = body.path->window(t, t, end, {.centre = body.p_LP}, scratch_, p_FO_);
  const double reach = ((body.ball.p_LC - body.p_LP).norm() + body.ball.radius) * kUp;
  body.speed = (window.bounds().rate + window.per_metre().rate * reach) * kUp;
  body.jerk = (window.bounds().jerk + window.per_metre().jerk * reach) * kUp;
  body.jerk_at_P = window.bounds().jerk;
  body.jerk_per_metre = window.per_metre().jerk;
}

LinkPairMotion::BodyState LinkPairMotion::free_state(const Body& body, const ConstantRatePath& path,
                                                     double t) const {
  const ConstantRatePath::State at = path.state(t);
  const Vector3d offset = at.R_WB * body.ball.p_LC;
  BodyState state;
  state.R = at.R_WB;
  state.pivot = (path.pivot(t) - p_FO_).value();
  state.centre = state.pivot + (at.p_QC_W + offset);
  state.pivot_velocity = path.pivot_velocity().value();
  state.axis = path.axis();
  state.rate = path.rate();
  // The error of the pivot is that of its distance from the centre.
  state.drift = kRounding * state.rate * (at.p_QC_W.norm() + offset.norm());
  state.rotation_error = path.rotation_error();
  state.position_error = path.position_error() + path.rotation_error() * body.ball.p_LC.norm() +
                         kRounding * (at.p_QC_W.norm() + offset.norm() + state.pivot.norm());
  return state;
}

LinkPairMotion::BodyState LinkPairMotion::state_of(const Body& body, double t) const {
  if (const ConstantRatePath* path = body.path->constant_rates()) {
    return free_state(body, *path, t);
  }
  const LinkState link = body.path->state(t, scratch_, p_FO_);
  const double radius = body.ball.radius * kUp;
  const CentreMotion centre = centre_of(link, body.ball);
  const double far = centre.offset.norm();
  const Vector3d& w = link.spin;

  BodyState state;
  state.R = link.pose.R_FL;
  state.centre = link.pose.p_OL + centre.offset;
  state.rotation_error = link.pose.rotation_error;
  state.position_error = link.pose.position_error + link.pose.rotation_error * far +
                         kRounding * (far + link.pose.p_OL.norm());
  state.rate = w.norm();
  if (state.rate > 0.0) {
    state.axis = w / state.rate;
  }
  const Vector3d lever = lever_of(link, centre, radius);
  state.pivot = state.centre - lever;
  state.pivot_velocity = centre.velocity - w.cross(lever);
  const double reach = lever.norm() + radius;
  const double w2 = state.rate * state.rate;
  const double misplaced = (far + radius) * (link.pose.rotation_error + kRounding);
  state.drift = (link.velocity_error + link.spin_error * (far + radius) + state.rate * misplaced +
                 kRounding * (link.velocity.norm() + state.rate * (far + reach))) *
                kUp;
  const double turn_error =
      link.spin_rate_error + link.spin_error * (2.0 * state.rate + link.spin_error);
  const double turn = link.spin_rate.norm() + w2;
  const double error = link.acceleration_error + turn_error * (far + reach) + turn * misplaced +
                       kRounding * (link.acceleration.norm() + turn * (far + reach));
  set_bend(body, link, centre.acceleration - w.cross(w.cross(lever)), lever, error, t, state);
  return state;
}

/// Bounds the bend of a body.
///
/// @param bent   [m per step^2]  acceleration of the ball's centre without that of its model
/// @param lever  [m]             vector from the pole to the centre
/// @param error  [m per step^2]  error of the acceleration of any point of the ball
void LinkPairMotion::set_bend(const Body& body, const LinkState& link, const Vector3d& bent,
                              const Vector3d& lever, double error, double t,
                              BodyState& state) const {
  const double third = std::max(end_ - t, 0.0) / 3.0;
  const double radius = body.ball.radius * kUp;
  const double twist = state.rate * state.rate * state.rate;
  if (body.has_near_pole) {
    const Vector3d P = link.pose.p_OL + link.pose.R_FL * body.p_LP;
    const double misplaced = (P - state.pivot).norm() + link.pose.position_error +
                             (link.pose.rotation_error + kRounding) * body.p_LP.norm();
    state.bend = (bent - link.spin_rate.cross(lever)).norm() +
                 (body.jerk_at_P + body.jerk_per_metre * misplaced) * third;
    state.bend_per_metre = link.spin_rate.norm() + (body.jerk_per_metre + twist) * third;
  } else {
    state.bend = bent.norm() + link.spin_rate.norm() * radius +
                 (body.jerk_at_P + body.jerk_per_metre * radius) * third;
    state.bend_per_metre = twist * third;
  }
  state.bend = (state.bend + error) * kUp;
  state.bend_per_metre *= kUp;
}

RelativeState LinkPairMotion::state(double t) const {
  const BodyState A = state_of(bodies_[0], t);
  const BodyState B = state_of(bodies_[1], t);
  RelativeState state;
  state.t = t;
  state.R_WA = A.R;
  state.R_WB = B.R;
  state.p_AB = B.centre - A.centre;
  state.p_AQa = A.pivot - A.centre;
  state.p_AQb = B.pivot - A.centre;
  state.axis_A = A.axis;
  state.axis_B = B.axis;
  state.rate_A = A.rate;
  state.rate_B = B.rate;
  state.pivot_velocity = B.pivot_velocity - A.pivot_velocity;
  state.drift = A.drift + B.drift + kRounding * (A.pivot_velocity.norm() + B.pivot_velocity.norm());
  const double size = state.p_AB.norm() + state.p_AQa.norm() + state.p_AQb.norm() +
                      bodies_[0].ball.radius + bodies_[1].ball.radius;
  // Distances from the pivots are differences of positions.
  state.bend = A.bend + B.bend + kRounding * size * (A.bend_per_metre + B.bend_per_metre);
  state.bend_A = A.bend_per_metre;
  state.bend_B = B.bend_per_metre;
  state.position_error =
      A.position_error + B.position_error + kRounding * (A.centre.norm() + B.centre.norm());
  state.rotation_error_A = A.rotation_error;
  state.rotation_error_B = B.rotation_error;
  return state;
}

double LinkPairMotion::speed_bound([[maybe_unused]] double radius_A,
                                   [[maybe_unused]] double radius_B) const {
  assert(radius_A <= bodies_[0].ball.radius && radius_B <= bodies_[1].ball.radius);
  return (bodies_[0].speed + bodies_[1].speed) * kUp;
}

Vector3d LinkPairMotion::origin(double t) const {
  return p_FO_.value() + state_of(bodies_[0], t).centre;
}

}  // namespace firstcontact
