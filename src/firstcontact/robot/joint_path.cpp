#include <firstcontact/robot/joint_path.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cmath>
#include <utility>

#include <firstcontact/math/fast_sine_cosine.h>

namespace firstcontact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d rounded(const std::array<DoubleDoubleVector3, 3>& columns) {
  Matrix3d m;
  for (int j = 0; j < 3; ++j) {
    m.col(j) = columns[static_cast<std::size_t>(j)].value();
  }
  return m;
}

bool is_zero(const DoubleDoubleVector3& v) {
  return std::all_of(v.c.begin(), v.c.end(),
                     [](const DoubleDouble& x) { return x.hi == 0.0 && x.lo == 0.0; });
}

bool is_identity(const PreciseTransform& X) {
  const PreciseTransform identity;
  return is_zero(X.position) && is_zero(X.columns[0] - identity.columns[0]) &&
         is_zero(X.columns[1] - identity.columns[1]) && is_zero(X.columns[2] - identity.columns[2]);
}

/// The terms of Rot(axis, angle) v = along + cos across + sin turned.
struct Turned {
  DoubleDoubleVector3 along;
  DoubleDoubleVector3 across;
  DoubleDoubleVector3 turned;
};

Turned turned(const DoubleDoubleVector3& axis, const DoubleDoubleVector3& v) {
  const DoubleDoubleVector3 along = dot(axis, v) * axis;
  return {along, v - along, cross(axis, v)};
}

std::uint64_t new_id() {
  static std::atomic<std::uint64_t> last = 0;
  return ++last;
}

}  // namespace

JointPath::JointPath(const Vector3d& anchor, std::variant<Polynomial, Piece> kind)
    : id_(new_id()), anchor_(anchor), kind_(std::move(kind)) {
  if (rests(kind_)) {
    rest_ = std::visit([](const auto& joint) { return state(joint, 0.0); }, kind_);
  }
}

bool JointPath::rests(const std::variant<Polynomial, Piece>& kind) {
  if (const auto* joint = std::get_if<Polynomial>(&kind)) {
    return !joint->angle && joint->slides.empty();
  }
  const ConstantRatePath& path = std::get<Piece>(kind).path;
  return path.rate() == 0.0 && path.pivot_velocity().value().isZero(0.0);
}

JointPath JointPath::polynomial(const PreciseTransform& X_PJ, const DoubleDoubleVector3& axis,
                                const std::optional<CoordinateSegment>& angle,
                                const std::vector<Slide>& slides, const PreciseTransform& X_EL) {
  Polynomial joint;
  joint.p_PJ = X_PJ.position;
  joint.axis = X_PJ.rotated(axis);
  joint.angle = angle;
  for (const Slide& slide : slides) {
    joint.slides.push_back({X_PJ.rotated(slide.direction), slide.coordinate});
  }
  // R_PJ Rot(u, q) = Rot(R_PJ u, q) R_PJ.
  const auto parts = [&](const DoubleDoubleVector3& v) {
    const DoubleDoubleVector3 at_zero = X_PJ.rotated(v);
    return angle ? turned(joint.axis, at_zero) : Turned{at_zero, {}, {}};
  };
  for (int j = 0; j < 3; ++j) {
    const Turned column = parts(X_EL.columns[static_cast<std::size_t>(j)]);
    joint.rotation_constant.col(j) = column.along.value();
    joint.rotation_cosine.col(j) = column.across.value();
    joint.rotation_sine.col(j) = column.turned.value();
  }
  const Turned lever = parts(X_EL.position);
  joint.lever_constant = lever.along.value();
  joint.lever_cosine = lever.across.value();
  joint.lever_sine = lever.turned.value();
  return {X_PJ.position.value(), std::move(joint)};
}

JointPath JointPath::moved(const std::optional<CoordinateSegment>& angle,
                           std::span<const CoordinateSegment> slides) const {
  Polynomial joint = std::get<Polynomial>(kind_);
  assert(joint.angle.has_value() == angle.has_value() && joint.slides.size() == slides.size());
  joint.angle = angle;
  for (std::size_t k = 0; k < slides.size(); ++k) {
    joint.slides[k].coordinate = slides[k];
  }
  return {anchor_, std::move(joint)};
}

JointPath JointPath::of_motion(const PreciseTransform& X_PJ, const ConstantRatePath& X_JL) {
  const DoubleDoubleVector3 pivot = X_PJ.position + X_PJ.rotated(X_JL.pivot_begin());
  return {pivot.value(), Piece{X_PJ, rounded(X_PJ.columns), X_JL, is_identity(X_PJ)}};
}

const ConstantRatePath* JointPath::free_body() const {
  const auto* piece = std::get_if<Piece>(&kind_);
  return piece != nullptr && piece->is_free_body ? &piece->path : nullptr;
}

JointPath JointPath::rigid(const PreciseTransform& X_PL) {
  return polynomial(X_PL, {}, {}, {}, {});
}

JointState JointPath::state(double t) const {
  if (rest_) {
    return *rest_;
  }
  return std::visit([t](const auto& joint) { return state(joint, t); }, kind_);
}

JointState JointPath::state(const Polynomial& joint, double t) {
  JointState state;
  state.axis = joint.axis.value();
  if (joint.angle) {
    const CoordinateSegment::State q = joint.angle->state(t);
    const SineCosine sc = fast_sine_cosine(q.value);
    state.R_PL =
        joint.rotation_constant + sc.cosine * joint.rotation_cosine + sc.sine * joint.rotation_sine;
    state.p_QL = joint.lever_constant + sc.cosine * joint.lever_cosine + sc.sine * joint.lever_sine;
    state.rate = q.rate;
    state.acceleration = q.acceleration;
    state.angle_error = q.value_error;
    state.rate_error = q.rate_error;
    state.acceleration_error = q.acceleration_error;
  } else {
    state.R_PL = joint.rotation_constant;
    state.p_QL = joint.lever_constant;
  }
  state.p_PQ = joint.p_PJ;
  state.slides = !joint.slides.empty();
  for (const Slide& slide : joint.slides) {
    const CoordinateSegment::State q = slide.coordinate.state(t);
    state.p_PQ = state.p_PQ + q.value * slide.direction;
    state.pivot_velocity += q.rate * slide.direction.value();
    state.pivot_acceleration += q.acceleration * slide.direction.value();
    // A sum and a product err by 2^-50 of each.
    state.position_error += 1.001 * q.value_error + 0x1p-90 * std::abs(q.value.hi);
    state.pivot_velocity_error += 1.001 * q.rate_error + 0x1p-50 * std::abs(q.rate);
    state.pivot_acceleration_error +=
        1.001 * q.acceleration_error + 0x1p-50 * std::abs(q.acceleration);
  }
  return state;
}

JointState JointPath::state(const Piece& joint, double t) {
  const ConstantRatePath& path = joint.path;
  const ConstantRatePath::State body = path.state(t);
  const DoubleDoubleVector3 pivot = path.pivot(t);
  JointState state;
  state.R_PL = joint.R_PJ * body.R_WB;
  state.p_PQ = joint.X_PJ.position + joint.X_PJ.rotated(pivot);
  state.p_QL = joint.R_PJ * body.p_QC_W;
  state.axis = joint.R_PJ * path.axis();
  state.rate = path.rate();
  state.slides = true;
  state.pivot_velocity = joint.R_PJ * path.pivot_velocity().value();
  // The product of two rotations, 9 2^-53, and the rounding of R_PJ.
  state.angle_error = path.rotation_error() + 0x1p-49;
  state.position_error =
      path.position_error() + 0x1p-90 * (pivot.value().norm() + path.pivot_begin().value().norm());
  state.rate_error = 0x1p-52 * path.rate();
  state.pivot_velocity_error = 0x1p-50 * state.pivot_velocity.norm();
  return state;
}

JointBounds JointPath::bounds(double t_from, double t_to) const {
  JointBounds bounds;
  if (const auto* piece = std::get_if<Piece>(&kind_)) {
    bounds.angle.rate = piece->path.rate() * (1.0 + 0x1p-50);
    bounds.pivot.rate = piece->path.pivot_velocity().value().norm() * (1.0 + 0x1p-50);
    return bounds;
  }
  const auto& joint = std::get<Polynomial>(kind_);
  if (joint.angle) {
    bounds.angle = joint.angle->bounds(t_from, t_to);
  }
  // The root of the squares would hold for two slides, too, as they are across each other.
  for (const Slide& slide : joint.slides) {
    const CoordinateSegment::Bounds b = slide.coordinate.bounds(t_from, t_to);
    bounds.pivot.rate += b.rate;
    bounds.pivot.acceleration += b.acceleration;
    bounds.pivot.jerk += b.jerk;
  }
  return bounds;
}

}  // namespace firstcontact
