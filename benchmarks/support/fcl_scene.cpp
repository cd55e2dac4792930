#include "benchmarks/support/fcl_scene.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/default_broadphase_callbacks.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision_object.h>

#include "benchmarks/support/fcl_model.h"

namespace firstcontact::benchmarks {

struct FclScene::Data {
  std::vector<PlainMotion> motions;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects;
  fcl::DynamicAABBTreeCollisionManagerd manager;

  void move_to(double t) {
    for (std::size_t k = 0; k < objects.size(); ++k) {
      objects[k]->setTransform(motions[k].pose(t));
      objects[k]->computeAABB();
    }
    manager.update();
  }
};

FclScene::FclScene(const Mesh& mesh, const std::vector<PlainMotion>& motions)
    : data_(std::make_unique<Data>()) {
  const auto model = fcl_model(mesh);
  data_->motions = motions;
  for (const PlainMotion& motion : motions) {
    data_->objects.push_back(std::make_unique<fcl::CollisionObjectd>(model, motion.pose(0.0)));
    data_->manager.registerObject(data_->objects.back().get());
  }
  data_->manager.setup();
}
FclScene::~FclScene() = default;

FclScene::Answer FclScene::sample(int count) {
  for (int k = 0; k < count; ++k) {
    const double t = static_cast<double>(k) / (count - 1);
    data_->move_to(t);
    fcl::DefaultCollisionData<double> found;
    data_->manager.collide(&found, fcl::DefaultCollisionFunction<double>);
    if (found.result.isCollision()) {
      return {true, t};
    }
  }
  return {};
}

}  // namespace firstcontact::benchmarks
