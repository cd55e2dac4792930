#include "benchmarks/support/fcl_robot.h"

#include <optional>
#include <set>
#include <variant>

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/collision_object.h>

#include "benchmarks/support/fcl_model.h"

namespace firstcontact::benchmarks {
namespace {

using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;

struct Piece {
  std::size_t link = 0;
  Eigen::Isometry3d X_LG;
  std::unique_ptr<fcl::CollisionObjectd> object;
};

Eigen::Isometry3d isometry(const Pose& pose) {
  return Eigen::Translation3d(pose.position) * pose.rotation.normalized();
}

Geometry geometry_of(const BodyShape& source, const Shape& shape) {
  if (const auto* box = std::get_if<BoxShape>(&source.source)) {
    return std::make_shared<fcl::Boxd>(box->size);
  }
  if (const auto* cylinder = std::get_if<CylinderShape>(&source.source)) {
    return std::make_shared<fcl::Cylinderd>(cylinder->radius, cylinder->length);
  }
  if (const auto* sphere = std::get_if<SphereShape>(&source.source)) {
    return std::make_shared<fcl::Sphered>(sphere->radius);
  }
  return fcl_model(shape.mesh());
}

bool meet(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b) {
  fcl::CollisionRequestd request;
  fcl::CollisionResultd result;
  return fcl::collide(a, b, request, result) > 0;
}

}  // namespace

struct FclRobot::Data {
  std::vector<Piece> pieces;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> obstacles;
  std::set<std::array<std::size_t, 2>> tested;
  fcl::DynamicAABBTreeCollisionManagerd robot;
  fcl::DynamicAABBTreeCollisionManagerd surroundings;
  bool found = false;

  [[nodiscard]] bool is_tested(const fcl::CollisionObjectd* a,
                               const fcl::CollisionObjectd* b) const {
    const std::size_t first = static_cast<const Piece*>(a->getUserData())->link;
    const std::size_t second = static_cast<const Piece*>(b->getUserData())->link;
    return tested.contains({std::min(first, second), std::max(first, second)});
  }

  static bool test_links(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
    auto& self = *static_cast<Data*>(data);
    self.found = self.found || (self.is_tested(a, b) && meet(a, b));
    return self.found;
  }
  static bool test_obstacle(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
    auto& self = *static_cast<Data*>(data);
    self.found = self.found || meet(a, b);
    return self.found;
  }
};

FclRobot::FclRobot() : data_(std::make_unique<Data>()) {}
FclRobot::~FclRobot() = default;

void FclRobot::add_link_geometry(std::size_t link, const Shape& shape,
                                 const Eigen::Isometry3d& X_LG) {
  data_->pieces.push_back(
      {link, X_LG, std::make_unique<fcl::CollisionObjectd>(fcl_model(shape.mesh()), X_LG)});
}

void FclRobot::add_obstacle(const BodyShape& source, const Shape& shape,
                            const Eigen::Isometry3d& X_WG) {
  data_->obstacles.push_back(
      std::make_unique<fcl::CollisionObjectd>(geometry_of(source, shape), X_WG));
}

void FclRobot::set_tested_links(std::span<const std::array<std::size_t, 2>> tested) {
  data_->tested = {tested.begin(), tested.end()};
}

void FclRobot::set_up() {
  for (Piece& piece : data_->pieces) {
    piece.object->setUserData(&piece);
    data_->robot.registerObject(piece.object.get());
  }
  for (const auto& obstacle : data_->obstacles) {
    data_->surroundings.registerObject(obstacle.get());
  }
  data_->robot.setup();
  data_->surroundings.setup();
}

bool FclRobot::collides(const std::vector<Eigen::Isometry3d>& X_WL) {
  for (Piece& piece : data_->pieces) {
    piece.object->setTransform(X_WL[piece.link] * piece.X_LG);
    piece.object->computeAABB();
  }
  data_->robot.update();
  data_->found = false;
  data_->robot.collide(data_.get(), &Data::test_links);
  if (!data_->found) {
    data_->robot.collide(&data_->surroundings, data_.get(), &Data::test_obstacle);
  }
  return data_->found;
}

void fill(FclRobot& peer, const RobotScene& scene, const std::vector<BodyShape>& sources) {
  std::vector<std::array<std::size_t, 2>> tested;
  const RobotModel& model = scene.robot_motion(0).model();
  const std::size_t first = scene.first_member(0);
  std::size_t body = 0;
  for (std::size_t member = 0; member < scene.size(); ++member) {
    const std::optional<RobotLink> link = scene.robot_link(member);
    if (link) {
      for (const MemberGeometry& geometry : scene.geometries(member)) {
        peer.add_link_geometry(link->link, geometry.shape, isometry(geometry.X_MG));
      }
    } else {
      const Shape& shape = scene.geometries(member)[0].shape;
      peer.add_obstacle(body < sources.size() ? sources[body] : BodyShape{}, shape,
                        isometry(scene.pose(member, 0.0)));
      ++body;
    }
  }
  for (std::size_t a = 0; a < model.links().size(); ++a) {
    for (std::size_t b = a + 1; b < model.links().size(); ++b) {
      if (scene.margin({first + a, first + b})) {
        tested.push_back({a, b});
      }
    }
  }
  peer.set_tested_links(tested);
  peer.set_up();
}

std::vector<BodyShape> sources_of(const Scene& scene) {
  std::vector<BodyShape> sources;
  for (const Body& body : scene.bodies) {
    sources.push_back(body.shape);
  }
  return sources;
}

}  // namespace firstcontact::benchmarks
