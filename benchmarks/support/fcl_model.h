/// @file
/// Mesh in the form that FCL reads.

#pragma once

#include <memory>

#include <fcl/geometry/bvh/BVH_model.h>

#include <firstcontact/geometry/mesh.h>

namespace firstcontact::benchmarks {

using FclModel = fcl::BVHModel<fcl::OBBRSSd>;

inline std::shared_ptr<FclModel> fcl_model(const Mesh& mesh) {
  std::vector<fcl::Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    triangles.emplace_back(a, b, c);
  }
  auto model = std::make_shared<FclModel>();
  model->beginModel();
  model->addSubModel(mesh.vertices, triangles);
  model->endModel();
  return model;
}

}  // namespace firstcontact::benchmarks
