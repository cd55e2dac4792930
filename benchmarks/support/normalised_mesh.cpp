#include "benchmarks/support/normalised_mesh.h"

#include <algorithm>
#include <filesystem>

#include <Eigen/Geometry>

#include <firstcontact/mesh_files/read_mesh.h>

namespace firstcontact::benchmarks {

Mesh normalised(Mesh mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : mesh.vertices) {
    box.extend(p);
  }
  double radius = 0.0;
  for (Eigen::Vector3d& p : mesh.vertices) {
    p -= box.center();
    radius = std::max(radius, p.norm());
  }
  for (Eigen::Vector3d& p : mesh.vertices) {
    p /= radius;
  }
  return mesh;
}

Mesh bunny() {
  return normalised(read_mesh(std::filesystem::path(FIRSTCONTACT_SOURCE_DIR) / "data" / "stanford" /
                              "stanford-bunny.obj"));
}

}  // namespace firstcontact::benchmarks
