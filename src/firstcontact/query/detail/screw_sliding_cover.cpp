#include <firstcontact/query/detail/screw_sliding_cover.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Factor that exceeds 1 by more than 2^30 times the unit of rounding.
constexpr double kRounding = 1.0 + 0x1p-20;

/// [rad]  Greatest turn over a window; half a turn would meet itself.
constexpr double kMostTurn = 1.0;

/// [m]  Squares of such lengths are within single precision.
constexpr double kFarthest = 1e12;

/// Whether the rates of the state are the whole motion.
bool has_constant_rates(const RelativeState& state) {
  return state.drift == 0.0 && state.bend == 0.0 && state.bend_A == 0.0 && state.bend_B == 0.0;
}

/// The other body at one time, seen from the screw.
struct SeenBody {
  Matrix3d R_SO;
  Vector3d p_SO;   // [m]  Centre.
  Vector3d p_SQ;   // [m]  Pivot.
  Vector3d speed;  // [m per step]  Velocity of the pivot.
  Vector3d spin;   // [rad per step]
};

SeenBody seen_from(const ScrewSliding& screw_sliding, const RelativeState& state,
                   bool carrier_is_A) {
  const Matrix3d R_SW = screw_sliding.R_SB * (carrier_is_A ? state.R_WA : state.R_WB).transpose();
  const Vector3d p_SC = screw_sliding.R_SB * screw_sliding.p_BS;
  if (carrier_is_A) {
    return {R_SW * state.R_WB, R_SW * state.p_AB - p_SC, R_SW * state.p_AQb - p_SC,
            R_SW * state.pivot_velocity, R_SW * (state.rate_B * state.axis_B)};
  }
  return {R_SW * state.R_WA, -(R_SW * state.p_AB) - p_SC, R_SW * (state.p_AQa - state.p_AB) - p_SC,
          -(R_SW * state.pivot_velocity), R_SW * (state.rate_A * state.axis_A)};
}

/// Removes a turn about the screw.
void unscrew(double turn, double pitch, Matrix3d& R, Vector3d& p) {
  const Matrix3d back = Eigen::AngleAxisd(-turn, Vector3d::UnitZ()).toRotationMatrix();
  R = back * R;
  p = back * p - Vector3d(0.0, 0.0, pitch * turn);
}

/// [m]  Bound of the distance of the body's points, as seen from the screw, from their chords.
double stray_of(const SeenBody& begin, const SeenBody& end, double pitch, double rate,
                double duration, double radius) {
  const Vector3d screw(0.0, 0.0, rate);
  const double w = std::abs(rate);
  const double w_d = (begin.spin - screw).norm();
  const double reach = (begin.p_SO - begin.p_SQ).norm() + radius;
  // The pivot moves on a line, so that it is farthest from the axis at an end.
  const double from_axis = std::max(begin.p_SQ.head<2>().norm(), end.p_SQ.head<2>().norm());
  const double u = (begin.speed - pitch * screw).norm() + w * from_axis + w_d * reach;
  const double bend = w * begin.speed.head<2>().norm() + w_d * begin.spin.norm() * reach + w * u;
  return kRounding * 0.125 * duration * duration * bend;
}

}  // namespace

struct ScrewSlidingCover::Window {
  ScrewSlidingPath path;
  ScrewSlidingLimits limits;
};

std::optional<ScrewSlidingCover> ScrewSlidingCover::of(const MovingPair& pair, const Shape& A,
                                                       const Shape& B, double t) {
  const RelativeState state = pair.motion().state(t);
  if (pair.deforms() || !has_constant_rates(state)) {
    return std::nullopt;
  }
  const bool larger_is_A = pair.A().triangles.size() >= pair.B().triangles.size();
  for (const bool carrier_is_A : {larger_is_A, !larger_is_A}) {
    if ((carrier_is_A ? state.rate_A : state.rate_B) == 0.0) {
      const ScrewSlidingSurface* carrier = (carrier_is_A ? A : B).screw_sliding();
      const ScrewSlidingSurface* other = (carrier_is_A ? B : A).screw_sliding();
      return carrier != nullptr && other != nullptr
                 ? std::optional(ScrewSlidingCover(pair, *carrier, *other, carrier_is_A, t))
                 : std::nullopt;
    }
  }
  return std::nullopt;
}

std::optional<ScrewSlidingCover::Window> ScrewSlidingCover::window(double t_end,
                                                                   double threshold) const {
  const ScrewSliding& screw_sliding = carrier_.screw_sliding;
  const Hierarchy& other = carrier_is_A_ ? pair_.B() : pair_.A();
  const RelativeState state = pair_.motion().state(t_);
  const RelativeState state_end = pair_.motion().state(t_end);
  const SeenBody begin = seen_from(screw_sliding, state, carrier_is_A_);
  SeenBody end = seen_from(screw_sliding, state_end, carrier_is_A_);
  const double duration = t_end - t_;
  const double rate = begin.spin.z();
  const double turn = rate * duration;
  Window window;
  window.path.stray = stray_of(begin, end, screw_sliding.pitch, rate, duration, other.radius);
  unscrew(turn, screw_sliding.pitch, end.R_SO, end.p_SO);
  window.path.R_SB = {begin.R_SO, end.R_SO};
  window.path.p_SB = {begin.p_SO, end.p_SO};
  const double apart =
      (threshold + pair_.gap_error(state) + pair_.gap_error(state_end)) * kRounding;
  if (!(apart + window.path.stray < screw_sliding.least_radius && std::abs(turn) < kMostTurn &&
        std::max(begin.p_SO.norm(), end.p_SO.norm()) < kFarthest)) {
    return std::nullopt;
  }
  constexpr std::size_t kAngle = ScrewSliding::kDirections;
  constexpr std::size_t kHalf = kAngle + 1;
  const double whole_turn = 2.0 * std::numbers::pi;
  for (std::size_t k = 0; k < kAngle; ++k) {
    const double limit = slope_of(screw_sliding, k) * apart + carrier_.bounds.error;
    const double by_turn = whole_turn * screw_sliding.pitch * screw_sliding.directions[k].y();
    window.limits.least[k] = window.limits.least[kHalf + k] =
        static_cast<float>(-limit * kRounding);
    window.limits.turn[k] = static_cast<float>(by_turn);
    window.limits.turn[kHalf + k] = static_cast<float>(-by_turn);
  }
  const double climb = screw_sliding.pitch * turn;
  float* const height = &window.limits.least[ScrewSliding::kHeight];
  height[0] -= static_cast<float>(std::max(climb, 0.0) * kRounding);
  height[kHalf] -= static_cast<float>(std::max(-climb, 0.0) * kRounding);
  window.limits.turn[ScrewSliding::kHeight] = window.limits.turn[kHalf + ScrewSliding::kHeight] =
      0.0f;
  // For points farther than r from the axis the angle is at most 2 asin(d / 2 r), below 1.05 d / r.
  const double reach = apart + window.path.stray;
  const double angle = 1.1 * reach / (2.0 * screw_sliding.least_radius - reach) + 0x1p-18;
  window.limits.least[kAngle] = static_cast<float>(-(angle + std::max(turn, 0.0)) * kRounding);
  window.limits.least[kHalf + kAngle] =
      static_cast<float>(-(angle + std::max(-turn, 0.0)) * kRounding);
  window.limits.turn[kAngle] = static_cast<float>(-whole_turn);
  window.limits.turn[kHalf + kAngle] = static_cast<float>(whole_turn);
  return window;
}

bool ScrewSlidingCover::find(double t_end, double threshold, std::size_t most,
                             WorkspaceData& workspace) const {
  const std::optional<Window> found = window(t_end, threshold);
  if (!found) {
    return false;
  }
  ScrewSlidingBounds& other = workspace.screw_sliding_bounds;
  bound_screw_sliding(carrier_.screw_sliding, carrier_is_A_ ? pair_.B() : pair_.A(), other_.order,
                      found->path, true, other);
  ScrewSlidingLimits limits = found->limits;
  for (float& limit : limits.least) {
    limit -= static_cast<float>(other.error * kRounding);
  }
  walk(limits, most, workspace);
  return workspace.left_by_screw_sliding.size() <= most;
}

void ScrewSlidingCover::walk(const ScrewSlidingLimits& limits, std::size_t most,
                             WorkspaceData& workspace) const {
  auto& left = workspace.left_by_screw_sliding;
  left.clear();
  auto& stack = workspace.screw_sliding_stack;
  stack.assign(1, {ScrewSlidingBounds::kLevels - 1, 0, 0});
  while (!stack.empty() && left.size() <= most) {
    const ScrewSlidingNodes top = stack.back();
    stack.pop_back();
    unsigned lanes =
        near_by_screw_sliding(carrier_.bounds.levels[top.level][top.carrier],
                              workspace.screw_sliding_bounds.levels[top.level][top.other], limits);
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
      const std::uint32_t c = 4 * top.carrier + lane / 4;
      const std::uint32_t o = 4 * top.other + lane % 4;
      if (top.level > 0) {
        stack.push_back({top.level - 1, c, o});
      } else if (carrier_is_A_) {
        left.push_back({carrier_.order[c], other_.order[o]});
      } else {
        left.push_back({other_.order[o], carrier_.order[c]});
      }
    }
  }
}

}  // namespace firstcontact::detail
