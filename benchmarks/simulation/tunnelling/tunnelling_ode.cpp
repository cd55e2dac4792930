// Simulates boxes shot at a thin plate, in ODE: the plate as a box and as a mesh of triangles.

#include <array>

#include <ode/ode.h>

#include "benchmarks/simulation/tunnelling/shots.h"

namespace firstcontact::benchmarks {
namespace {

/// Mesh in the form that ODE reads; ODE keeps pointers to it.
struct OdeMesh {
  explicit OdeMesh(const BoxMesh& mesh) {
    for (const Eigen::Vector3d& p : mesh.corners) {
      corners.insert(corners.end(), {p.x(), p.y(), p.z()});
    }
    for (const Eigen::Vector3i& t : mesh.triangles) {
      for (const int corner : t) {
        indices.push_back(static_cast<dTriIndex>(corner));
      }
    }
    dGeomTriMeshDataBuildDouble(data, corners.data(), 3 * sizeof(double),
                                static_cast<int>(mesh.corners.size()), indices.data(),
                                static_cast<int>(indices.size()), 3 * sizeof(dTriIndex));
  }
  ~OdeMesh() { dGeomTriMeshDataDestroy(data); }
  OdeMesh(const OdeMesh&) = delete;
  OdeMesh& operator=(const OdeMesh&) = delete;

  std::vector<double> corners;
  std::vector<dTriIndex> indices;
  dTriMeshDataID data = dGeomTriMeshDataCreate();
};

class OdeFlight final : public Flight {
 public:
  OdeFlight(const Shot& shot, bool plate_is_mesh) {
    if (plate_is_mesh) {
      mesh_ = std::make_unique<OdeMesh>(plate_mesh());
      dCreateTriMesh(space_, mesh_->data, nullptr, nullptr, nullptr);
    } else {
      dCreateBox(space_, 2 * kPlateHalfThick, 2 * kPlateHalf, 2 * kPlateHalf);
    }
    dMass mass;
    dMassSetBoxTotal(&mass, kBoxMass, 2 * kBoxHalf, 2 * kBoxHalf, 2 * kBoxHalf);
    dBodySetMass(box_, &mass);
    dGeomSetBody(dCreateBox(space_, 2 * kBoxHalf, 2 * kBoxHalf, 2 * kBoxHalf), box_);
    const Eigen::Quaterniond q(shot.X_WB.linear());
    const dQuaternion rotation = {q.w(), q.x(), q.y(), q.z()};
    const Eigen::Vector3d p = shot.X_WB.translation();
    dBodySetPosition(box_, p.x(), p.y(), p.z());
    dBodySetQuaternion(box_, rotation);
    dBodySetLinearVel(box_, shot.speed, 0, 0);
    dBodySetAngularVel(box_, shot.spin.x(), shot.spin.y(), shot.spin.z());
    dBodySetFiniteRotationMode(box_, 1);  // Turns by the exact rotation of the spin, not by its
                                          // tangent.
  }
  ~OdeFlight() override {
    dJointGroupDestroy(contacts_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }

  void step() override {
    dSpaceCollide(space_, this, &OdeFlight::meet);
    dWorldStep(world_, kStep);
    dJointGroupEmpty(contacts_);
  }

  [[nodiscard]] Eigen::Isometry3d box() const override {
    const dReal* p = dBodyGetPosition(box_);
    const dReal* q = dBodyGetQuaternion(box_);
    return Eigen::Translation3d(p[0], p[1], p[2]) *
           Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
  }

 private:
  static void meet(void* flight, dGeomID A, dGeomID B) {
    const auto* self = static_cast<const OdeFlight*>(flight);
    std::array<dContact, 16> contacts{};
    const int count =
        dCollide(A, B, static_cast<int>(contacts.size()), &contacts[0].geom, sizeof(dContact));
    for (int k = 0; k < count; ++k) {
      contacts[k].surface.mode = 0;
      contacts[k].surface.mu = 0;
      dJointAttach(dJointCreateContact(self->world_, self->contacts_, &contacts[k]),
                   dGeomGetBody(A), dGeomGetBody(B));
    }
  }

  dWorldID world_ = dWorldCreate();
  dSpaceID space_ = dSimpleSpaceCreate(nullptr);
  dJointGroupID contacts_ = dJointGroupCreate(0);
  dBodyID box_ = dBodyCreate(world_);
  std::unique_ptr<OdeMesh> mesh_;
};

Contender contender(const char* name, bool plate_is_mesh) {
  return {name, [plate_is_mesh](const Shot& shot) {
            return std::make_unique<OdeFlight>(shot, plate_is_mesh);
          }};
}

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int argc, char** argv) {
  using namespace firstcontact::benchmarks;
  dInitODE();
  const int status = shoot(
      argc, argv, {contender("ODE, plate a box", false), contender("ODE, plate a mesh", true)});
  dCloseODE();
  return status;
}
