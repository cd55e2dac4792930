#include <firstcontact/geometry/screw_sliding.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace firstcontact {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// [triangles]  Fewer are tested one by one in less time.
constexpr std::size_t kFewTriangles = 500;

/// [triangles]  The bounds of more would take more memory and time than they save.
constexpr std::size_t kManyTriangles = std::size_t{1} << 20;

/// [triangles]  The number that is sampled, evenly among more.
constexpr std::size_t kLookedAt = 12'000;

/// [m]  Limits of lengths: bounds are in single precision, with squares of lengths.
constexpr double kSmallest = 1e-12;
constexpr double kLargest = 1e12;

/// [-]  Scale of the weights at first and at last: sines of angles between the surface and the
/// paths of its points.
constexpr double kCoarse = 0.5;
constexpr double kFine = 0.03;
constexpr int kRounds = 12;

/// The least fraction of the triangles that must slip.
constexpr double kSlipping = 0.5;
/// A second motion slips as well where its residual is below this fraction of the greatest.
constexpr double kUnique = 3e-3;

/// A triangle, relative to the centre, in units of the radius.
struct Facet {
  Vector3d centre;
  Vector3d normal;
  double area;
  double weight;  // Less for slivers; 1 for the rest.
};

void weigh(std::vector<Facet>& facets) {
  std::vector<double> areas;
  areas.reserve(facets.size());
  for (const Facet& facet : facets) {
    areas.push_back(facet.area);
  }
  const auto middle = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2);
  std::ranges::nth_element(areas, middle);
  for (Facet& facet : facets) {
    facet.weight = std::min(facet.area, *middle) / *middle;
  }
}

/// Samples the facets of some triangles, from all over the surface.
std::vector<Facet> facets_of(const Hierarchy& hierarchy) {
  std::vector<Facet> facets;
  // An odd stride, as neighbours lie in twos.
  const std::size_t stride = (hierarchy.triangles.size() / kLookedAt) | 1u;
  for (std::size_t k = 0; k < hierarchy.triangles.size(); k += stride) {
    const auto& t = hierarchy.triangles[k];
    const Vector3d& a = hierarchy.vertices[t[0]];
    const Vector3d& b = hierarchy.vertices[t[1]];
    const Vector3d& c = hierarchy.vertices[t[2]];
    const Vector3d normal = (b - a).cross(c - a);
    const double length = normal.norm();
    if (length > 0.0) {
      facets.push_back({(a + b + c) / (3.0 * hierarchy.radius), normal / length, length, 0.0});
    }
  }
  if (!facets.empty()) {
    weigh(facets);
  }
  return facets;
}

/// A motion: its angular velocity, and the velocity of the centre.
struct Slip {
  Vector3d w;
  Vector3d v;
  bool is_unique;

  /// [-]  The sine of the angle between the facet and the velocity of its centre.
  [[nodiscard]] double residual(const Facet& facet) const {
    const Vector3d way = v + w.cross(facet.centre);
    return std::abs(facet.normal.dot(way)) / (way.norm() + 1e-3);
  }
};

Slip least_slip(const std::vector<Facet>& facets, const std::vector<double>& weights) {
  Matrix6d sum = Matrix6d::Zero();
  for (std::size_t k = 0; k < facets.size(); ++k) {
    Vector6d row;
    row << facets[k].centre.cross(facets[k].normal), facets[k].normal;
    sum += weights[k] * row * row.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(sum);
  const auto& values = solver.eigenvalues();
  const Vector6d slip = solver.eigenvectors().col(0);
  return {slip.head<3>(), slip.tail<3>(), values[1] > kUnique * values[5]};
}

/// Finds the slip of most facets.
Slip find_slip(const std::vector<Facet>& facets) {
  std::vector<double> weights(facets.size(), 1.0);
  for (std::size_t k = 0; k < facets.size(); ++k) {
    weights[k] = facets[k].weight;
  }
  Slip slip = least_slip(facets, weights);
  for (int round = 0; round < kRounds; ++round) {
    const double part = static_cast<double>(round) / (kRounds - 1);
    const double scale = kCoarse * std::pow(kFine / kCoarse, part);
    for (std::size_t k = 0; k < facets.size(); ++k) {
      const double ratio = slip.residual(facets[k]) / scale;
      weights[k] = facets[k].weight / ((1.0 + ratio * ratio) * (1.0 + ratio * ratio));
    }
    slip = least_slip(facets, weights);
  }
  return slip;
}

std::vector<Facet> slipping(const std::vector<Facet>& facets, const Slip& slip) {
  std::vector<Facet> some;
  std::ranges::copy_if(facets, std::back_inserter(some),
                       [&](const Facet& facet) { return slip.residual(facet) < 2.0 * kFine; });
  return some;
}

/// The distance of a facet from the axis, and its normal in the plane of r and h. There f(r, h) is
/// constant on a surface whose normal is the gradient f_r r + f_h (z - pitch / r theta).
struct ProfilePoint {
  double radius;
  Vector2d normal;
  double weight;
};

std::vector<ProfilePoint> profile_of(const std::vector<Facet>& facets,
                                     const ScrewSliding& screw_sliding, double unit) {
  std::vector<ProfilePoint> profile;
  for (const Facet& facet : facets) {
    const Vector3d p = screw_sliding.R_SB * (unit * facet.centre - screw_sliding.p_BS);
    const double radius = p.head<2>().norm();
    const Vector3d n = screw_sliding.R_SB * facet.normal;
    const Vector2d normal(n.head<2>().dot(p.head<2>()) / radius, n.z());
    if (normal.norm() > 0.5) {
      profile.push_back({radius, normal.normalized(), facet.area});
    }
  }
  return profile;
}

/// Chooses the most frequent normals, a few degrees apart at least.
void choose_directions(const std::vector<ProfilePoint>& profile, ScrewSliding& screw_sliding) {
  constexpr int kBins = 180;
  constexpr int kApart = 4;
  std::array<double, kBins> weight{};
  std::array<Vector2d, kBins> sum;
  sum.fill(Vector2d::Zero());
  for (const ProfilePoint& point : profile) {
    const double angle = std::atan2(point.normal.y(), point.normal.x()) / std::numbers::pi;
    const int bin = (static_cast<int>(std::floor((angle + 2.0) * kBins + 0.5))) % kBins;
    const double along = std::cos(bin * std::numbers::pi / kBins) * point.normal.x() +
                         std::sin(bin * std::numbers::pi / kBins) * point.normal.y();
    weight[bin] += point.weight;
    sum[bin] += (along < 0.0 ? -point.weight : point.weight) * point.normal;
  }
  for (int apart = -kApart; apart <= kApart; ++apart) {
    weight[(apart + kBins) % kBins] = 0.0;  // The direction along r.
  }
  screw_sliding.directions[ScrewSliding::kRadius] = Vector2d::UnitX();
  screw_sliding.directions[ScrewSliding::kHeight] = Vector2d::UnitY();
  for (std::size_t k = 2; k < ScrewSliding::kDirections; ++k) {
    const auto most = std::ranges::max_element(weight) - weight.begin();
    const double angle = std::numbers::pi * static_cast<double>(k) / ScrewSliding::kDirections;
    screw_sliding.directions[k] =
        weight[most] > 0.0 ? sum[most].normalized() : Vector2d(std::cos(angle), std::sin(angle));
    for (int apart = -kApart; apart <= kApart; ++apart) {
      weight[(most + apart + kBins) % kBins] = 0.0;
    }
  }
}

}  // namespace

std::optional<ScrewSliding> find_screw_sliding(const Hierarchy& hierarchy) {
  if (hierarchy.triangles.size() < kFewTriangles || hierarchy.triangles.size() > kManyTriangles ||
      !(hierarchy.radius > kSmallest && hierarchy.radius < kLargest)) {
    return std::nullopt;
  }
  const std::vector<Facet> facets = facets_of(hierarchy);
  if (facets.empty()) {
    return std::nullopt;
  }
  const Slip slip = find_slip(facets);
  const std::vector<Facet> inner = slipping(facets, slip);
  const double rate = slip.w.norm();
  // Motions that turn less than they move are rather translations.
  if (!slip.is_unique || !(rate > 0.5) ||
      static_cast<double>(inner.size()) < kSlipping * static_cast<double>(facets.size())) {
    return std::nullopt;
  }
  ScrewSliding screw_sliding;
  const Vector3d axis = slip.w / rate;
  screw_sliding.R_SB.row(2) = axis.transpose();
  screw_sliding.R_SB.row(0) = axis.unitOrthogonal().transpose();
  screw_sliding.R_SB.row(1) = axis.cross(Vector3d(screw_sliding.R_SB.row(0))).transpose();
  screw_sliding.p_BS = hierarchy.radius * axis.cross(slip.v) / rate;
  screw_sliding.pitch = hierarchy.radius * axis.dot(slip.v) / rate;
  std::vector<ProfilePoint> profile = profile_of(inner, screw_sliding, hierarchy.radius);
  if (profile.empty()) {
    return std::nullopt;
  }
  choose_directions(profile, screw_sliding);
  const auto low = profile.begin() + static_cast<std::ptrdiff_t>(profile.size() / 50);
  std::ranges::nth_element(profile, low, {}, &ProfilePoint::radius);
  screw_sliding.least_radius = 0.47 * low->radius;
  return screw_sliding;
}

}  // namespace firstcontact
