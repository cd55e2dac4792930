#include <firstcontact/simulation_model/detail/flat_contact.h>

#include <cstdint>

#include <Eigen/Geometry>

#include <firstcontact/geometry/shape.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// [-]  Least cosine between a leaning normal and that of the face.
constexpr double kMostLean = 0.9;

/// The normal of a face in world axes, on the side of a direction; zero for a triangle without
/// area.
Vector3d face_normal(const PlacedSurface& body, std::uint32_t triangle, const Vector3d& outwards) {
  const Mesh& mesh = body.shape->mesh();
  const auto& corners = mesh.triangles[triangle];
  const Vector3d& a = mesh.vertices[corners[0]];
  const Vector3d n = body.pose.rotation.normalized() *
                     (mesh.vertices[corners[1]] - a).cross(mesh.vertices[corners[2]] - a);
  return n.dot(outwards) < 0.0 ? Vector3d(-n.stableNormalized()) : n.stableNormalized();
}

/// Lays the contact on the face of A.
void lay_on_face_of_A(const PlacedSurface& A, const PlacedSurface& B, Contact& contact) {
  const double around = A.neighbours->flat_around(contact.feature_A);
  if (around == 0.0) {  // As for points without triangles.
    return;
  }
  const Vector3d& before = *contact.n_AB_W;
  const Vector3d n = face_normal(A, contact.feature_A.triangle, before);
  if (!(n.dot(before) >= kMostLean)) {
    return;
  }
  const double radius_A = A.shape->radius();
  const double radius_B = B.shape->radius();
  const Vector3d core_A = contact.p_WA - radius_A * before;
  const Vector3d core_B = contact.p_WB + radius_B * before;
  const double height = n.dot(core_B - core_A);
  if ((core_B - core_A - height * n).norm() > around) {
    return;
  }
  contact.feature_A = {FeatureType::face, contact.feature_A.triangle, contact.feature_A.triangle};
  contact.p_WA = core_B + (radius_A - height) * n;
  contact.p_WB = core_B - radius_B * n;
  contact.n_AB_W = n;
  contact.distance = height - radius_A - radius_B;
}

}  // namespace

void lay_on_face(const std::array<PlacedSurface, 2>& bodies, Contact& contact) {
  if (contact.feature_B.type == FeatureType::vertex) {
    lay_on_face_of_A(bodies[0], bodies[1], contact);
  }
  if (contact.feature_A.type == FeatureType::vertex) {
    swap_bodies(contact);
    lay_on_face_of_A(bodies[1], bodies[0], contact);
    swap_bodies(contact);
  }
}

}  // namespace firstcontact::detail
