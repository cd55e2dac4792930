#include <firstcontact/narrowphase/separating_direction.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using Type = TriangleFeature::Type;

Vector3d edge(const Triangle& T, const TriangleFeature& feature) {
  return T[(feature.index + 1) % 3] - T[feature.index];
}

Vector3d across(const Vector3d& d, const Vector3d& along) {
  const double length2 = along.squaredNorm();
  return length2 > 0.0 ? Vector3d(d - (d.dot(along) / length2) * along) : d;
}

}  // namespace

Vector3d separating_direction(const TrianglePair& pair, const ClosestFeatures& closest) {
  const Vector3d d = closest.p_B - closest.p_A;
  const Type a = closest.feature_A.type;
  const Type b = closest.feature_B.type;
  if (a == Type::face) {
    return (pair.A[1] - pair.A[0]).cross(pair.A[2] - pair.A[0]);
  }
  if (b == Type::face) {
    return (pair.B[1] - pair.B[0]).cross(pair.B[2] - pair.B[0]);
  }
  if (a == Type::edge && b == Type::edge) {
    return edge(pair.A, closest.feature_A).cross(edge(pair.B, closest.feature_B));
  }
  if (a == Type::edge) {
    return across(d, edge(pair.A, closest.feature_A));
  }
  return b == Type::edge ? across(d, edge(pair.B, closest.feature_B)) : d;
}

}  // namespace firstcontact
