#include <firstcontact/mechanism/mechanism.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <firstcontact/mechanism/detail/spatial.h>
#include <firstcontact/motion/detail/turn.h>
#include <firstcontact/robot/detail/mimicked_joint.h>

namespace firstcontact {
namespace {

using detail::cross_force;
using detail::cross_motion;
using detail::solve_mass;
using detail::Spatial;
using detail::spatial;
using detail::spatial_inertia;
using detail::turn;
using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Tolerance of moments of inertia that were printed with few digits.
constexpr double kPrinted = 1e-3;  // [-]

Quaterniond quaternion(const VectorXd& positions, Index at) {
  return Quaterniond(positions[at], positions[at + 1], positions[at + 2], positions[at + 3])
      .normalized();
}

void set_quaternion(const Quaterniond& q, Index at, VectorXd& positions) {
  positions.segment<4>(at) << q.w(), q.x(), q.y(), q.z();
}

Index position_count(JointType type) {
  switch (type) {
    case JointType::floating:
      return 7;
    case JointType::ball:
      return 4;
    default:
      return static_cast<Index>(coordinate_count(type));
  }
}

Index velocity_count(JointType type) {
  switch (type) {
    case JointType::floating:
      return 6;
    case JointType::ball:
      return 3;
    default:
      return static_cast<Index>(coordinate_count(type));
  }
}

/// Finds the defect of a link's inertia; empty if some body can have it.
std::string wrong_inertia(const LinkInertia& inertia) {
  if (!inertia.defect.empty()) {
    return inertia.defect;
  }
  if (!std::isfinite(inertia.mass) || !inertia.p_LC.allFinite() || !inertia.about_C_L.allFinite() ||
      inertia.mass < 0.0) {
    return "its mass must be >= 0, and all numbers of its inertia finite";
  }
  const Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Matrix3d>(inertia.about_C_L, Eigen::EigenvaluesOnly)
          .eigenvalues();
  if (moments[0] < -kPrinted * moments[2]) {
    return "a principal moment of its inertia is negative: no body has such";
  }
  return {};
}

/// Whether a matrix with a positive diagonal is definite, beyond rounding.
bool is_definite(const MatrixXd& M) {
  constexpr double kSingular = 1e-13;  // [-]  Rounding of correlations.
  const VectorXd scale = M.diagonal().cwiseSqrt().cwiseInverse();
  const MatrixXd correlations = scale.asDiagonal() * M * scale.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(correlations, Eigen::EigenvaluesOnly)
             .eigenvalues()[0] > kSingular;
}

/// The effect of a joint on its child at one instant, about a reference point.
struct JointPlace {
  Vector3d p_WL;
  Quaterniond R_WL;
  Jacobian S;                      // (6, velocities)
  Spatial bias = Spatial::Zero();  // Beyond the share that the parent carries along.
};

JointPlace place_joint(const Joint& joint, const VectorXd& q, const VectorXd& v,
                       const Vector3d& p_WJ, const Quaterniond& R_WJ, const Vector3d& reference) {
  const Vector3d axis = R_WJ * joint.axis.normalized();
  const auto about = [&](const Vector3d& direction, const Vector3d& point) {
    return spatial(direction.cross(reference - point), direction);
  };
  const auto along = [](const Vector3d& direction) { return spatial(direction, Vector3d::Zero()); };
  JointPlace place{.p_WL = p_WJ, .R_WL = R_WJ, .S = Jacobian(6, v.size())};
  switch (joint.type) {
    case JointType::fixed:
      break;
    case JointType::revolute:
    case JointType::continuous:
    case JointType::screw:
      place.R_WL = turn(q[0] * axis) * R_WJ;
      place.p_WL += joint.type == JointType::screw ? Vector3d(joint.pitch * q[0] * axis)
                                                   : Vector3d(Vector3d::Zero());
      place.S.col(0) = about(axis, p_WJ);
      place.S.col(0) +=
          joint.type == JointType::screw ? along(joint.pitch * axis) : Spatial(Spatial::Zero());
      break;
    case JointType::prismatic:
      place.p_WL += q[0] * axis;
      place.S.col(0) = along(axis);
      break;
    case JointType::planar: {
      const Quaterniond tilt = Quaterniond::FromTwoVectors(Vector3d::UnitZ(), joint.axis);
      const Vector3d x = R_WJ * (tilt * Vector3d::UnitX());
      const Vector3d y = R_WJ * (tilt * Vector3d::UnitY());
      place.p_WL += q[0] * x + q[1] * y;
      place.R_WL = turn(q[2] * axis) * R_WJ;
      place.S << along(x), along(y), about(axis, place.p_WL);
      // The point about which the joint turns moves.
      place.bias = along((v[0] * x + v[1] * y).cross(v[2] * axis));
      break;
    }
    case JointType::floating:
    case JointType::ball: {
      const Index turns = joint.type == JointType::floating ? 3 : 0;
      if (turns > 0) {
        place.p_WL += R_WJ * q.head<3>();
      }
      place.R_WL = R_WJ * quaternion(q, turns);
      for (int k = 0; k < 3; ++k) {
        const Vector3d direction = R_WJ * Vector3d::Unit(k);
        place.S.col(turns + k) = about(direction, place.p_WL);
        if (turns > 0) {
          place.S.col(k) = along(direction);
        }
      }
      if (turns > 0) {
        place.bias = along((R_WJ * v.head<3>()).cross(R_WJ * v.tail<3>()));
      }
      break;
    }
  }
  return place;
}

}  // namespace

Mechanism::Mechanism(RobotModel model, const Pose& X_WR, bool free_base)
    : model_(std::move(model)),
      X_WR_{X_WR.position, X_WR.rotation.normalized()},
      free_base_(free_base) {
  lay_out(free_base);
  require_inertias();
}

void Mechanism::lay_out(bool free_base) {
  const auto add_block = [this](std::size_t joint, Index positions, Index velocities) {
    blocks_.push_back({joint, position_count_, positions, size_, velocities});
    position_count_ += positions;
    size_ += velocities;
  };
  const std::span<const Joint> joints = model_.joints();
  if (free_base) {
    add_block(joints.size(), 7, 6);
  }
  parts_.resize(joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].type != JointType::fixed && !joints[j].mimic) {
      parts_[j].block = blocks_.size();
      add_block(j, firstcontact::position_count(joints[j].type), velocity_count(joints[j].type));
    }
  }
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto [followed, multiplier, offset] = detail::mimicked_joint(model_, j);
    if (followed != j) {
      parts_[j] = {.block = parts_[followed].block, .multiplier = multiplier, .offset = offset};
    }
  }
  order_.push_back(model_.root());
  for (std::size_t k = 0; k < order_.size(); ++k) {
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (model_.parent_link(j) == order_[k]) {
        order_.push_back(model_.child_link(j));
      }
    }
  }
  moved_by_.resize(model_.links().size());
  for (const std::size_t link : order_) {
    const std::optional<std::size_t> joint = model_.parent_joint(link);
    std::vector<Index>& own = moved_by_[link];
    if (joint) {
      own = moved_by_[model_.parent_link(*joint)];
    }
    const std::size_t block = joint ? parts_[*joint].block : (free_base ? 0 : kFixed);
    if (block != kFixed && std::ranges::find(own, blocks_[block].velocity) == own.end()) {
      for (Index k = 0; k < blocks_[block].velocities; ++k) {
        own.push_back(blocks_[block].velocity + k);
      }
    }
  }
}

void Mechanism::require_inertias() const {
  for (const Link& link : model_.links()) {
    const std::string wrong = link.inertia ? wrong_inertia(*link.inertia) : std::string();
    if (!wrong.empty()) {
      throw std::invalid_argument("link \"" + link.name + "\": " + wrong);
    }
  }
}

void Mechanism::require_mass(const VectorXd& positions) const {
  const MatrixXd M = mass_matrix(at({positions, VectorXd::Zero(size_)}));
  const double size = M.size() > 0 ? M.diagonal().maxCoeff() : 0.0;
  for (const MechanismJoint& block : blocks_) {
    const auto mass = M.diagonal().segment(block.velocity, block.velocities);
    if (!(mass.minCoeff() > 1e-14 * size)) {
      throw std::invalid_argument(
          (block.joint < model_.joints().size()
               ? "joint \"" + model_.joints()[block.joint].name + "\""
               : std::string("the free base")) +
          " moves no mass: give the links that it carries an <inertial>, or the robot's "
          "\"dynamics\" a \"density\"");
    }
  }
  if (M.size() > 0 && !is_definite(M)) {
    throw std::invalid_argument(
        "robot \"" + model_.name() +
        "\": some of its joints together move no mass where it starts: give the links between them "
        "an <inertial>, or the robot another \"state\"");
  }
}

MechanismState Mechanism::rest() const {
  MechanismState state{VectorXd::Zero(position_count_), VectorXd::Zero(size_)};
  for (const MechanismJoint& block : blocks_) {
    if (const std::optional<Index> at = block.quaternion()) {
      set_quaternion(Quaterniond::Identity(), *at, state.positions);
    }
  }
  if (free_base_) {
    state.positions.head<3>() = X_WR_.position;
    set_quaternion(X_WR_.rotation, 3, state.positions);
  }
  return state;
}

VectorXd Mechanism::moved(const VectorXd& positions, const VectorXd& displacement) const {
  VectorXd result = positions;
  for (const MechanismJoint& block : blocks_) {
    const std::optional<Index> at = block.quaternion();
    const Index slides = at ? block.velocities - 3 : block.velocities;
    result.segment(block.position, slides) += displacement.segment(block.velocity, slides);
    if (at) {
      const Vector3d turned = displacement.segment<3>(block.velocity + slides);
      set_quaternion((turn(turned) * quaternion(positions, *at)).normalized(), *at, result);
    }
  }
  return result;
}

VectorXd Mechanism::between(const VectorXd& from, const VectorXd& to, double share) const {
  VectorXd result = from + share * (to - from);
  for (const MechanismJoint& block : blocks_) {
    if (const std::optional<Index> at = block.quaternion()) {
      set_quaternion(quaternion(from, *at).slerp(share, quaternion(to, *at)).normalized(), *at,
                     result);
    }
  }
  return result;
}

void Mechanism::place(const MechanismState& state, std::size_t link,
                      MechanismInstant& instant) const {
  const std::optional<std::size_t> joint = model_.parent_joint(link);
  Joint base{.type = free_base_ ? JointType::floating : JointType::fixed};
  const Joint& moved_by = joint ? model_.joints()[*joint] : base;
  const Part part = joint ? parts_[*joint] : Part{.block = free_base_ ? 0 : kFixed};
  VectorXd q;
  VectorXd v;
  if (part.block != kFixed) {
    const MechanismJoint& block = blocks_[part.block];
    q = state.positions.segment(block.position, block.positions);
    v = part.multiplier * state.velocities.segment(block.velocity, block.velocities);
    if (joint && moved_by.mimic) {
      q[0] = part.multiplier * q[0] + part.offset;
    }
  }
  Vector3d p_WJ = free_base_ ? Vector3d(Vector3d::Zero()) : X_WR_.position;
  Quaterniond R_WJ = free_base_ ? Quaterniond::Identity() : X_WR_.rotation;
  Spatial V = Spatial::Zero();
  Spatial bias = Spatial::Zero();
  Jacobian J = Jacobian::Zero(6, size_);
  if (joint) {
    const std::size_t parent = model_.parent_link(*joint);
    const Pose& X_WP = instant.X_WL[parent];
    p_WJ = X_WP.position + X_WP.rotation * moved_by.X_PJ.position;
    R_WJ = (X_WP.rotation * moved_by.X_PJ.rotation.normalized()).normalized();
    V = instant.velocity[parent];
    bias = instant.bias[parent];
    J = instant.J[parent];
  }
  const JointPlace placed = place_joint(moved_by, q, v, p_WJ, R_WJ, instant.reference);
  instant.X_WL[link] = {placed.p_WL, placed.R_WL.normalized()};
  if (part.block != kFixed) {
    const MechanismJoint& block = blocks_[part.block];
    const Spatial own = placed.S * v;
    bias += cross_motion(V, own) + placed.bias;
    V += own;
    J.middleCols(block.velocity, block.velocities) += part.multiplier * placed.S;
  }
  instant.velocity[link] = V;
  instant.bias[link] = bias;
  instant.J[link] = std::move(J);
}

MechanismInstant Mechanism::at(const MechanismState& state) const {
  MechanismInstant instant;
  instant.reference = free_base_ ? Vector3d(state.positions.head<3>()) : X_WR_.position;
  const std::size_t count = model_.links().size();
  instant.X_WL.resize(count);
  instant.velocity.resize(count);
  instant.bias.resize(count);
  instant.J.resize(count);
  for (const std::size_t link : order_) {
    place(state, link, instant);
  }
  return instant;
}

MatrixXd Mechanism::inverse_mass(const MatrixXd& mass_matrix) {
  return solve_mass<MatrixXd>(mass_matrix,
                              MatrixXd::Identity(mass_matrix.rows(), mass_matrix.cols()));
}

MatrixXd Mechanism::mass_matrix(const MechanismInstant& instant) const {
  MatrixXd M = MatrixXd::Zero(size_, size_);
  for (std::size_t l = 0; l < instant.X_WL.size(); ++l) {
    if (const auto& inertia = model_.links()[l].inertia) {
      const Jacobian& J = instant.J[l];
      const Eigen::Matrix<double, 6, 6> I =
          spatial_inertia(*inertia, instant.X_WL[l], instant.reference);
      const std::vector<Index>& moving = moved_by_[l];
      for (std::size_t i = 0; i < moving.size(); ++i) {
        const Spatial momentum = I * J.col(moving[i]);
        for (std::size_t k = 0; k <= i; ++k) {
          M(moving[k], moving[i]) += momentum.dot(Spatial(J.col(moving[k])));
        }
      }
    }
  }
  // Velocities of a link are not sorted: those of a mimic stand at the place of its joint.
  for (Index i = 0; i < size_; ++i) {
    for (Index k = 0; k < i; ++k) {
      M(k, i) += M(i, k);
      M(i, k) = M(k, i);
    }
  }
  return M;
}

VectorXd Mechanism::bias_forces(const MechanismInstant& instant, const Vector3d& gravity) const {
  VectorXd forces = VectorXd::Zero(size_);
  for (std::size_t l = 0; l < instant.X_WL.size(); ++l) {
    if (const auto& inertia = model_.links()[l].inertia) {
      const Eigen::Matrix<double, 6, 6> I =
          spatial_inertia(*inertia, instant.X_WL[l], instant.reference);
      const Spatial& V = instant.velocity[l];
      const Spatial a = instant.bias[l] - spatial(gravity, Vector3d::Zero());
      forces += instant.J[l].transpose() * (I * a + cross_force(V, I * V));
    }
  }
  return forces;
}

}  // namespace firstcontact
