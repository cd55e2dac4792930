#include <firstcontact/moving_pairs/detail/box_front.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr float kUnknown = -std::numeric_limits<float>::infinity();

/// Factor for the roundings of the double-precision formulas of this file.
constexpr double kRounding = 1.0 + 0x1p-40;
/// Rounding of single precision.
constexpr float kRoundingOfFloats = 0x1p-20f;

/// Growth from which a front is spent: this factor, and a few groups.
constexpr double kGrownBy = 1.2;
constexpr double kFewGroups = 64.0;

BoxFront::Place place_of(const MovingPair& pair, const RelativeState& state) {
  // Rotations err by 22 units of 2^-53 beyond what the state charges; products add less than 30.
  const double turn_error = 0x1p-46 + state.rotation_error_A + state.rotation_error_B;
  const double size = pair.A().radius + pair.B().radius + state.p_AB.norm();
  return {state.R_WA.transpose() * state.R_WB, state.R_WA.transpose() * state.p_AB,
          turn_error * size + state.position_error + pair.gap_error(state)};
}

BoxFront::Ball ball_of(const Hierarchy& hierarchy, const NodeBoxes& boxes) {
  const HierarchyNode& node = hierarchy.nodes[boxes.node];
  const auto unit = static_cast<float>(hierarchy.unit);
  const auto centre = [&](int slot) {
    return Eigen::Vector3f(node.centre[0][slot], node.centre[1][slot], node.centre[2][slot]);
  };
  Eigen::Vector3f middle = Eigen::Vector3f::Zero();
  for (unsigned slots = boxes.used; slots != 0; slots &= slots - 1) {
    middle += centre(std::countr_zero(slots));
  }
  middle /= static_cast<float>(std::popcount(boxes.used));
  float radius = 0.0f;
  for (unsigned slots = boxes.used; slots != 0; slots &= slots - 1) {
    const int slot = std::countr_zero(slots);
    const Eigen::Vector3f extent(node.half_extent(0, slot), node.half_extent(1, slot),
                                 node.half_extent(2, slot));
    radius = std::max(radius, (centre(slot) - middle).norm() + extent.norm());
  }
  // No coordinate is greater than two units.
  return {unit * middle, unit * (radius * (1.0f + kRoundingOfFloats) + 4.0f * kRoundingOfFloats)};
}

}  // namespace

void BoxFront::clear() {
  groups_.clear();
  balls_.clear();
  least_.clear();
  size_at_begin_ = 0;
}

void BoxFront::begin(const MovingPair& pair, const RelativeState& state) {
  clear();
  place_ = place_of(pair, state);
  add(pair, root(pair.A()), root(pair.B()));
}

void BoxFront::rebase(const MovingPair& pair, const RelativeState& state) {
  const FrontMotion motion(place_, pair, state, 0.0);
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    if (groups_[k].live == 0) {
      continue;
    }
    const float fallen = round_up(motion.of(balls_[k]));
    const auto fall = [fallen](float apart) {
      return apart - fallen - kRoundingOfFloats * (std::abs(apart) + fallen);
    };
    for (float& apart : groups_[k].apart) {
      apart = fall(apart);
    }
    least_[k] = fall(least_[k]);  // Monotonic: it stays the least of the lanes.
  }
  place_ = place_of(pair, state);
}

bool BoxFront::is_spent() const {
  return static_cast<double>(size()) > kGrownBy * static_cast<double>(size_at_begin_) + kFewGroups;
}

unsigned BoxFront::lanes_within(std::size_t k, double distance) const {
  const Group& group = groups_[k];
  const float within = round_up(distance);
  unsigned lanes = 0;
  for (unsigned i = 0; i < 16; ++i) {
    lanes |= (group.apart[i] > within ? 0u : 1u) << i;
  }
  return lanes & group.live;
}

unsigned BoxFront::raise(std::size_t k, const BoxBounds& bounds, double unit, double moved,
                         double reach) {
  Group& group = groups_[k];
  const auto scale = static_cast<float>(unit);
  const float fallen = round_up(moved);
  const float near = round_up(reach);
  unsigned lanes = 0;
  for (unsigned i = 0; i < 16; ++i) {
    const float gap = scale * bounds.gap[i];
    const float apart = gap - fallen;
    group.apart[i] = std::max(group.apart[i], apart - kRoundingOfFloats * (std::abs(gap) + fallen));
    lanes |= (gap > near ? 0u : 1u) << i;
  }
  return lanes & group.live;
}

void BoxFront::raise_lane(std::size_t k, int lane, double apart) {
  float& bound = groups_[k].apart[static_cast<std::size_t>(lane)];
  bound = std::max(bound, below(apart));
}

void BoxFront::open(const MovingPair& pair, std::size_t k, int lane, const BoxPair& inside) {
  add(pair, inside.A, inside.B);  // First: without memory for it, the front still covers all pairs.
  groups_[k].live = static_cast<std::uint16_t>(groups_[k].live & ~(1u << lane));
}

void BoxFront::settle(std::size_t k) {
  const Group& group = groups_[k];
  float least = std::numeric_limits<float>::infinity();
  for (unsigned lanes = group.live; lanes != 0; lanes &= lanes - 1) {
    least = std::min(least, group.apart[static_cast<std::size_t>(std::countr_zero(lanes))]);
  }
  least_[k] = least;
}

void BoxFront::give_up() {
  constexpr int kIdle = 100;
  clear();
  idle_ = kIdle;
}

bool BoxFront::is_due_again() {
  idle_ = std::max(0, idle_ - 1);
  return idle_ == 0;
}

void BoxFront::add(const MovingPair& pair, const NodeBoxes& a, const NodeBoxes& b) {
  const std::size_t k = groups_.size();
  balls_.resize(k + 1);
  least_.resize(k + 1);
  balls_[k] = ball_of(pair.B(), b);
  least_[k] = kUnknown;
  Group group{.node_a = a.node, .node_b = b.node, .live = lanes_of(a.used, b.used), .apart = {}};
  group.apart.fill(kUnknown);
  groups_.push_back(group);  // Last: it is counted once all of it is there.
}

FrontMotion::FrontMotion(const BoxFront::Place& begin, const MovingPair& pair,
                         const RelativeState& state, double tau) {
  const BoxFront::Place now = place_of(pair, state);
  turned_ = now.R_AB - begin.R_AB;
  moved_ = now.p_AB - begin.p_AB;
  const double turn = turned_.norm() * (0.5 * std::numbers::sqrt2);
  const double speed_bound = pair.speed_bound() * tau;
  const double radius = pair.B().radius;
  slack_ = begin.error + now.error;
  most_ = (moved_.norm() + turn * radius + speed_bound) * kRounding + slack_;
  if (state.rate_A == 0.0) {
    Matrix3d turning;
    for (int k = 0; k < 3; ++k) {
      turning.col(k) = state.axis_B.cross(state.R_WB.col(k));
    }
    const Vector3d lever = state.p_AB - state.p_AQb;
    rate_ = tau * state.rate_B * turning;
    way_ = tau * (state.pivot_velocity + state.rate_B * state.axis_B.cross(lever));
    by_radius_ = turn + tau * state.rate_B;
    const double reach_B = lever.norm() + radius;
    const double reach_A = state.p_AQa.norm() + pair.A().radius;
    slack_ +=
        tau * (state.drift + 0x1p-46 * pair.speed_bound()) +
        0.5 * tau * tau * (state.rate_B * state.rate_B * reach_B + state.bend_of(reach_A, reach_B));
  } else {
    rate_.setZero();
    way_.setZero();
    by_radius_ = turn;
    slack_ += speed_bound;
  }
  slack_ *= kRounding;
}

double FrontMotion::of(const BoxFront::Ball& ball) const {
  const Vector3d c = ball.centre.cast<double>();
  const double moved = (moved_ + turned_ * c).norm() + (way_ + rate_ * c).norm() +
                       by_radius_ * static_cast<double>(ball.radius);
  return std::min(most_, moved * kRounding + slack_);
}

}  // namespace firstcontact::detail
