#include <random>
#include <string>

#include <gtest/gtest.h>

#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/PrismaticJoint.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>

#include <firstcontact/mechanism/mechanism.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

const Vector3d kFall{0.0, 0.0, -9.81};

/// The same tree of links for us and for DART; the base is fixed.
struct Twins {
  RobotDescription ours{.name = "twin"};
  dart::dynamics::SkeletonPtr theirs = dart::dynamics::Skeleton::create("twin");
  std::vector<dart::dynamics::BodyNode*> nodes{nullptr};

  Twins() {
    theirs->setGravity(kFall);
    ours.links.push_back({.name = "l0"});
  }

  void add(std::size_t parent, JointType type, const Pose& X_PJ, const Vector3d& axis,
           const LinkInertia& inertia) {
    const std::string name = "l" + std::to_string(ours.links.size());
    ours.links.push_back({.name = name, .inertia = inertia});
    ours.joints.push_back({.name = "j" + name,
                           .type = type,
                           .parent = ours.links[parent].name,
                           .child = name,
                           .X_PJ = X_PJ,
                           .axis = axis});
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = X_PJ.rotation.toRotationMatrix();
    T.translation() = X_PJ.position;
    dart::dynamics::BodyNode::Properties properties{
        dart::dynamics::BodyNode::AspectProperties(name)};
    properties.mInertia = dart::dynamics::Inertia(inertia.mass, inertia.p_LC, inertia.about_C_L);
    nodes.push_back(type == JointType::prismatic
                        ? node<dart::dynamics::PrismaticJoint>(parent, T, axis, properties)
                        : node<dart::dynamics::RevoluteJoint>(parent, T, axis, properties));
  }

 private:
  template <class DartJoint>
  dart::dynamics::BodyNode* node(std::size_t parent, const Eigen::Isometry3d& T,
                                 const Vector3d& axis,
                                 const dart::dynamics::BodyNode::Properties& properties) {
    typename DartJoint::Properties joint;
    joint.mName = "j" + properties.mName;
    joint.mAxis = axis.normalized();
    joint.mT_ParentBodyToJoint = T;
    return theirs->createJointAndBodyNodePair<DartJoint>(nodes[parent], joint, properties).second;
  }
};

Twins random_twins(std::mt19937& rng, std::size_t links) {
  std::normal_distribution<double> n;
  Twins twins;
  for (std::size_t k = 0; k < links; ++k) {
    const Eigen::Matrix3d root = Eigen::Matrix3d::NullaryExpr([&] { return n(rng); });
    const Eigen::Matrix3d points = root * root.transpose();
    const LinkInertia inertia{.mass = std::exp(n(rng)),
                              .p_LC = {n(rng), n(rng), n(rng)},
                              .about_C_L = points.trace() * Eigen::Matrix3d::Identity() - points};
    const Pose X_PJ{{n(rng), n(rng), n(rng)},
                    Eigen::Quaterniond(n(rng), n(rng), n(rng), n(rng)).normalized()};
    // DART has one root for each tree: the first joint hangs on our base, all others below it.
    const std::size_t parent = k == 0 ? 0 : 1 + rng() % k;
    twins.add(parent, k % 3 == 2 ? JointType::prismatic : JointType::continuous, X_PJ,
              {n(rng), n(rng), n(rng)}, inertia);
  }
  return twins;
}

TEST(MechanismAgainstDart, HasTheSameMassMatrixAndForces) {
  std::mt19937 rng(8);
  std::normal_distribution<double> n;
  for (int i = 0; i < 30; ++i) {
    const Twins twins = random_twins(rng, 1 + static_cast<std::size_t>(i) % 10);
    const Mechanism mechanism(RobotModel(twins.ours), {}, false);
    const auto random = [&] { return n(rng); };
    MechanismState state{VectorXd::NullaryExpr(mechanism.size(), random),
                         VectorXd::NullaryExpr(mechanism.size(), random)};
    const auto& theirs = twins.theirs;
    ASSERT_EQ(static_cast<Eigen::Index>(theirs->getNumDofs()), mechanism.size());
    // DART may order coordinates by the tree.
    Eigen::PermutationMatrix<Eigen::Dynamic> order(mechanism.size());
    for (Eigen::Index k = 0; k < mechanism.size(); ++k) {
      const auto name = mechanism.model().joints()[static_cast<std::size_t>(k)].name;
      order.indices()[k] = static_cast<int>(theirs->getJoint(name)->getIndexInSkeleton(0));
    }
    theirs->setPositions(order * state.positions);
    theirs->setVelocities(order * state.velocities);
    const MechanismInstant instant = mechanism.at(state);
    const Eigen::MatrixXd M = mechanism.mass_matrix(instant);
    const Eigen::MatrixXd M_theirs = order.transpose() * theirs->getMassMatrix() * order;
    ASSERT_LE((M - M_theirs).norm(), 1e-12 * M.norm()) << i;
    const VectorXd b = mechanism.bias_forces(instant, kFall);
    const VectorXd b_theirs = order.transpose() * theirs->getCoriolisAndGravityForces();
    ASSERT_LE((b - b_theirs).norm(), 1e-12 * (1.0 + b.norm())) << i;
  }
}

/// DART's own integration, of first order: a fine step tells where the mechanism is.
VectorXd dart_after(const dart::dynamics::SkeletonPtr& skeleton, const MechanismState& begin,
                    double dt, int steps) {
  skeleton->setPositions(begin.positions);
  skeleton->setVelocities(begin.velocities);
  for (int k = 0; k < steps; ++k) {
    skeleton->computeForwardDynamics();
    skeleton->integrateVelocities(dt / steps);
    skeleton->integratePositions(dt / steps);
  }
  return skeleton->getPositions();
}

// Richardson's limit of two fine runs of DART, beside one of ours at 1/240 s.
TEST(MechanismAgainstDart, ADoublePendulumSwingsAlike) {
  Twins twins;
  const LinkInertia rod{.mass = 1.0,
                        .p_LC = {0.0, 0.0, -0.25},
                        .about_C_L = Vector3d(0.02, 0.02, 0.001).asDiagonal()};
  twins.add(0, JointType::continuous, {}, {0.0, 1.0, 0.0}, rod);
  twins.add(1, JointType::continuous, {{0.0, 0.0, -0.5}, Eigen::Quaterniond::Identity()},
            {0.0, 1.0, 0.0}, rod);
  const Mechanism mechanism(RobotModel(twins.ours), {}, false);
  MechanismState state{Eigen::Vector2d(1.0, 0.5), Eigen::Vector2d(0.0, 2.0)};
  const VectorXd coarse = dart_after(twins.theirs, state, 1.0, 20'000);
  const VectorXd fine = dart_after(twins.theirs, state, 1.0, 40'000);
  const VectorXd limit = 2.0 * fine - coarse;
  for (int k = 0; k < 240; ++k) {
    state = mechanism.after_free_motion(state, kFall, 1.0 / 240.0);
  }
  EXPECT_LE((state.positions - limit).norm(), 1e-6);
}

}  // namespace
}  // namespace firstcontact
