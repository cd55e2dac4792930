#include "benchmarks/support/fcl_peer.h"

#include <algorithm>

#include <fcl/math/motion/interp_motion.h>
#include <fcl/narrowphase/continuous_collision.h>
#include <fcl/narrowphase/detail/conservative_advancement_func_matrix.h>
#include <fcl/narrowphase/distance.h>

#include "benchmarks/support/fcl_model.h"

namespace firstcontact::benchmarks {
namespace {

double radius(const Mesh& mesh) {
  double radius = 0.0;
  for (const Eigen::Vector3d& p : mesh.vertices) {
    radius = std::max(radius, p.norm());
  }
  return radius;
}

}  // namespace

struct FclPeer::Models {
  std::shared_ptr<FclModel> A;
  std::shared_ptr<FclModel> B;
  double radius_A;
  double radius_B;
};

FclPeer::FclPeer(const Mesh& A, const Mesh& B)
    : models_(std::make_unique<Models>(Models{fcl_model(A), fcl_model(B), radius(A), radius(B)})) {}
FclPeer::~FclPeer() = default;
FclPeer::FclPeer(FclPeer&&) noexcept = default;
FclPeer& FclPeer::operator=(FclPeer&&) noexcept = default;

double FclPeer::distance(const PlainMotionPair& motions, double t) const {
  const fcl::DistanceRequestd request;
  fcl::DistanceResultd result;
  return fcl::distance(models_->A.get(), motions.A.pose(t), models_->B.get(), motions.B.pose(t),
                       request, result);
}

PeerAnswer FclPeer::distance_loop(const PlainMotionPair& motions, double tolerance) const {
  const double speed = (motions.B.translation - motions.A.translation).norm() +
                       motions.A.rotation_vector.norm() * models_->radius_A +
                       motions.B.rotation_vector.norm() * models_->radius_B;
  double t = 0.0;
  while (true) {
    const double gap = distance(motions, t);
    if (gap <= tolerance) {
      return {true, t};
    }
    if (t >= 1.0 || !(speed > 0.0)) {
      return {};
    }
    t = std::min(1.0, t + gap / speed);
  }
}

PeerAnswer FclPeer::oriented_advancement(const PlainMotionPair& motions) const {
  const fcl::InterpMotion<double> A(motions.A.pose(0.0), motions.A.pose(1.0));
  const fcl::InterpMotion<double> B(motions.B.pose(0.0), motions.B.pose(1.0));
  const fcl::CollisionRequestd request;
  fcl::CollisionResultd result;
  PeerAnswer answer;
  answer.contact = fcl::detail::conservativeAdvancementMeshOriented<
      fcl::OBBRSSd, fcl::detail::MeshConservativeAdvancementTraversalNodeOBBRSSd>(
      *models_->A, &A, *models_->B, &B, request, result, answer.t);
  return answer;
}

PeerAnswer FclPeer::continuous_collide(const PlainMotionPair& motions) const {
  fcl::ContinuousCollisionRequestd request;
  request.ccd_motion_type = fcl::CCDM_LINEAR;
  request.ccd_solver_type = fcl::CCDC_CONSERVATIVE_ADVANCEMENT;
  fcl::ContinuousCollisionResultd result;
  fcl::continuousCollide(models_->A.get(), motions.A.pose(0.0), motions.A.pose(1.0),
                         models_->B.get(), motions.B.pose(0.0), motions.B.pose(1.0), request,
                         result);
  return {result.is_collide, result.is_collide ? result.time_of_contact : 1.0};
}

}  // namespace firstcontact::benchmarks
