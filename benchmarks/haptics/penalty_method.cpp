#include "penalty_method.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include <Eigen/Dense>

#include "signed_distance.h"

namespace firstcontact {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr double kDeepest = 0.003;   // [m]  Opposed triangles are sought within it.
constexpr double kFewPoints = 10.0;  // More points share the stiffness of so many.

Vector3d at(const Pose& X, const Vector3d& p) { return X.rotation * p + X.position; }

/// A point of a surface that may penetrate the other surface.
struct SurfacePoint {
  Vector3d place;
  Vector3d normal;
  std::uint32_t nearest = 0;  // The triangles that were found last.
  std::uint32_t opposed = 0;
  double due = 0.0;                    // [m]  Way of the tool from which on it may penetrate.
  Vector3d tested = Vector3d::Zero();  // Place in the other frame at the last test.
  // [m]  Distance then; negative where it was inside.
  double distance = -std::numeric_limits<double>::infinity();
};

/// A point that penetrates. Its normal points from the body to the tool.
struct Penetration {
  Vector3d place;   // World.
  Vector3d normal;  // World.
  double depth = 0.0;
};

/// Points on the triangles of a mesh, each with the normal of its triangle: the corners first. Of
/// the points with the same normal in a cube of the spacing only the first counts.
std::vector<SurfacePoint> points_of(const Mesh& mesh, double spacing) {
  std::vector<SurfacePoint> points;
  std::set<std::array<std::int64_t, 6>> known;
  const auto add = [&](const Vector3d& place, const Vector3d& normal) {
    std::array<std::int64_t, 6> key{};
    for (Eigen::Index i = 0; i < 3; ++i) {
      key[static_cast<std::size_t>(i)] = std::llround(place[i] / spacing);
      key[static_cast<std::size_t>(i + 3)] = std::llround(1e3 * normal[i]);
    }
    if (known.insert(key).second) {
      points.push_back({.place = place, .normal = normal});
    }
  };
  for (const auto& corners : mesh.triangles) {
    const Vector3d& a = mesh.vertices[corners[0]];
    const Vector3d ab = mesh.vertices[corners[1]] - a;
    const Vector3d ac = mesh.vertices[corners[2]] - a;
    const Vector3d normal = ab.cross(ac).normalized();
    if (!(normal.squaredNorm() > 0.5)) {
      continue;
    }
    add(a, normal);
    add(a + ab, normal);
    add(a + ac, normal);
    const double longest = std::max({ab.norm(), ac.norm(), (ab - ac).norm()});
    const int parts = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
    for (int i = 0; i <= parts; ++i) {
      for (int j = 0; i + j <= parts; ++j) {
        add(a + ab * i / parts + ac * j / parts, normal);
      }
    }
  }
  return points;
}

}  // namespace

class PenaltyMethod::Implementation {
 public:
  Implementation(const Mesh& tool, const Mesh& body, const Pose& X_WB, Vector3d p_BC,
                 double spacing, const PenaltyGains& gains)
      : tool_(tool),
        body_(body),
        on_tool_(points_of(tool, spacing)),
        on_body_(points_of(body, spacing)),
        X_WB_(X_WB),
        p_BC_(std::move(p_BC)),
        gains_(gains) {
    for (const Vector3d& vertex : tool.vertices) {
      reach_ = std::max(reach_, (vertex - p_BC_).norm());
    }
  }

  PenaltyForce tick(const Pose& target, double seconds) {
    return gains_.is_coupled ? tick_coupled(target, seconds) : tick_direct(target, seconds);
  }

  double depth_ = 0.0;

  [[nodiscard]] const Pose& pose() const { return X_WB_; }

 private:
  PenaltyForce tick_direct(const Pose& target, double seconds) {
    const Vector6d moved = way_to(target);
    move_to(target);
    find();
    PenaltyForce sum;
    const Vector3d centre = at(X_WB_, p_BC_);
    const double share = stiffness_of_a_point();
    for (const Penetration& p : penetrations_) {
      const Vector3d arm = p.place - centre;
      const Vector3d velocity = moved.head<3>() + Vector3d(moved.tail<3>()).cross(arm);
      const double rate = -velocity.dot(p.normal) / seconds;
      const double force = share * std::max(0.0, p.depth + gains_.damping * rate);
      sum.force += force * p.normal;
      sum.torque += force * arm.cross(p.normal);
    }
    return sum;
  }

  /// J. Barbic, D. L. James, "Six-DoF haptic rendering of contact between geometrically complex
  /// reduced deformable models", IEEE Transactions on Haptics 1 (2008): a static virtual coupling,
  /// one step of Newton's method a tick.
  PenaltyForce tick_coupled(const Pose& target, double seconds) {
    find();
    Matrix6d stiffness = Matrix6d::Zero();
    Vector6d force = springs().cwiseProduct(way_to(target));
    const Vector3d centre = at(X_WB_, p_BC_);
    const double share = stiffness_of_a_point();
    for (const Penetration& p : penetrations_) {
      Vector6d row;
      row << p.normal, (p.place - centre).cross(p.normal);
      force += share * p.depth * row;
      stiffness += share * row * row.transpose();
    }
    stiffness *= 1.0 + gains_.damping / seconds;
    stiffness.diagonal() += springs();
    const Vector6d step = stiffness.ldlt().solve(force);
    const double angle = step.tail<3>().norm();
    Pose next;
    next.rotation =
        angle > 0.0 ? Quaterniond(Eigen::AngleAxisd(angle, step.tail<3>() / angle)) * X_WB_.rotation
                    : X_WB_.rotation;
    next.rotation.normalize();
    next.position = centre + step.head<3>() - next.rotation * p_BC_;
    move_to(next);
    if (penetrations_.empty()) {
      return {};  // Else the tool's lag would be felt as a drag.
    }
    const Vector6d felt = -springs().cwiseProduct(way_to(target));
    return {.force = felt.head<3>(), .torque = felt.tail<3>()};
  }

  static Vector6d springs() {
    Vector6d springs;
    springs << Vector3d::Constant(kCoupling), Vector3d::Constant(kAngularCoupling);
    return springs;
  }

  /// The translation of the centre and the turn from the present pose to another one.
  [[nodiscard]] Vector6d way_to(const Pose& pose) const {
    const Eigen::AngleAxisd turn((pose.rotation * X_WB_.rotation.conjugate()).normalized());
    const double angle = std::remainder(turn.angle(), 2.0 * std::numbers::pi);
    Vector6d way;
    way << at(pose, p_BC_) - at(X_WB_, p_BC_), angle * turn.axis();
    return way;
  }

  void move_to(const Pose& pose) {
    const Vector6d way = way_to(pose);
    way_ += way.head<3>().norm() + reach_ * way.tail<3>().norm();
    X_WB_ = pose;
  }

  [[nodiscard]] double stiffness_of_a_point() const {
    const auto count = static_cast<double>(penetrations_.size());
    return gains_.stiffness * std::min(1.0, kFewPoints / std::max(1.0, count));
  }

  void find() {
    penetrations_.clear();
    const Pose X_BW{-(X_WB_.rotation.conjugate() * X_WB_.position), X_WB_.rotation.conjugate()};
    depth_ = 0.0;
    for (SurfacePoint& point : on_tool_) {
      if (point.due <= way_) {
        Penetration found;
        if (test(body_, at(X_WB_, point.place), X_WB_.rotation * point.normal, point, found)) {
          penetrations_.push_back(found);
        }
      }
    }
    for (SurfacePoint& point : on_body_) {
      if (point.due <= way_) {
        Penetration found;
        if (test(tool_, at(X_BW, point.place), X_BW.rotation * point.normal, point, found)) {
          found.place = point.place;
          found.normal = -(X_WB_.rotation * found.normal);
          penetrations_.push_back(found);
        }
      }
    }
  }

  bool test(const SignedDistance& other, const Vector3d& place, const Vector3d& normal,
            SurfacePoint& point, Penetration& found) {
    NearestPlace nearest;
    const double moved = (place - point.tested).norm();
    if (moved < point.distance) {
      point.due = way_ + point.distance - moved;
      return false;
    }
    const double most = std::abs(point.distance) + 1.001 * moved + 1e-9;
    if (!other.nearest(place, most, nullptr, point.nearest, nearest)) {
      return false;
    }
    point.tested = place;
    point.distance = nearest.is_inside ? -nearest.distance : nearest.distance;
    if (!nearest.is_inside) {
      point.due = way_ + nearest.distance;
      return false;
    }
    point.due = way_;  // Again in the next tick.
    depth_ = std::max(depth_, nearest.distance);
    NearestPlace opposed;
    if (other.nearest(place, kDeepest, &normal, point.opposed, opposed)) {
      nearest = opposed;
    }
    found = {.place = place,
             .normal = nearest.normal,
             .depth = std::max(0.0, nearest.normal.dot(nearest.place - place))};
    return true;
  }

  SignedDistance tool_;
  SignedDistance body_;
  std::vector<SurfacePoint> on_tool_;
  std::vector<SurfacePoint> on_body_;
  Pose X_WB_;
  Vector3d p_BC_;
  PenaltyGains gains_;
  double reach_ = 0.0;  // [m]
  double way_ = 0.0;    // [m]  By which no point of the tool has moved farther.
  std::vector<Penetration> penetrations_;
};

PenaltyMethod::PenaltyMethod(const Mesh& tool, const Mesh& body, const Pose& X_WB,
                             const Vector3d& p_BC, double spacing, const PenaltyGains& gains)
    : implementation_(std::make_unique<Implementation>(tool, body, X_WB, p_BC, spacing, gains)) {}

PenaltyMethod::~PenaltyMethod() = default;

PenaltyForce PenaltyMethod::tick(const Pose& target, double seconds) {
  return implementation_->tick(target, seconds);
}

double PenaltyMethod::depth() const { return implementation_->depth_; }

const Pose& PenaltyMethod::tool() const { return implementation_->pose(); }

}  // namespace firstcontact
