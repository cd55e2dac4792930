#include "support/convex_distance.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Dense>

namespace firstcontact::oracle {
namespace {

using Eigen::Vector3d;

/// The point of a simplex nearest to the origin, and the corners that span its face.
struct Nearest {
  Vector3d point = Vector3d::Constant(std::numeric_limits<double>::infinity());
  std::vector<Vector3d> corners;
};

/// Of the plane through all corners; nothing where it is not inside of them.
void offer_face(const std::vector<Vector3d>& face, Nearest& best) {
  const auto count = static_cast<Eigen::Index>(face.size()) - 1;
  Eigen::Matrix3Xd edges(3, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    edges.col(k) = face[static_cast<std::size_t>(k) + 1] - face[0];
  }
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(count);
  if (count > 0) {
    weights = edges.colPivHouseholderQr().solve(-face[0]);
  }
  if (!weights.allFinite() || (weights.array() < 0.0).any() || weights.sum() > 1.0) {
    return;
  }
  Vector3d point = face[0];
  for (Eigen::Index k = 0; k < count; ++k) {
    point += weights[k] * edges.col(k);
  }
  if (point.squaredNorm() < best.point.squaredNorm()) {
    best = {point, face};
  }
}

Nearest nearest_of(const std::vector<Vector3d>& simplex) {
  Nearest best;
  for (unsigned mask = 1; mask < 1u << simplex.size(); ++mask) {
    std::vector<Vector3d> face;
    for (std::size_t k = 0; k < simplex.size(); ++k) {
      if ((mask >> k & 1u) != 0) {
        face.push_back(simplex[k]);
      }
    }
    offer_face(face, best);
  }
  return best;
}

}  // namespace

ConvexDistance convex_distance(const Support& A, const Support& B) {
  const auto support = [&](const Vector3d& n) { return Vector3d(A(n) - B(-n)); };
  Nearest nearest{support(Vector3d::UnitX()), {}};
  nearest.corners = {nearest.point};
  ConvexDistance result{0.0, nearest.point.norm()};
  constexpr int kMostSteps = 100;
  for (int i = 0; i < kMostSteps && result.upper - result.lower > 1e-11; ++i) {
    const double length = nearest.point.norm();
    if (!(length > 1e-12) || nearest.corners.size() == 4) {
      return {0.0, 0.0};
    }
    const Vector3d added = support(-nearest.point);
    result.lower = std::max(result.lower, nearest.point.dot(added) / length);
    std::vector<Vector3d> simplex = nearest.corners;
    simplex.push_back(added);
    const Nearest next = nearest_of(simplex);
    if (!(next.point.norm() < length)) {
      break;  // Rounding ends it.
    }
    nearest = next;
    result.upper = std::min(result.upper, nearest.point.norm());
  }
  return result;
}

}  // namespace firstcontact::oracle
