#include <firstcontact/planning/detail/gap_sampler.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

#include <Eigen/Geometry>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/mesh.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/robot_check/robot_scene.h>

namespace firstcontact::detail {
namespace {

constexpr std::size_t kRays = 64;  // Number of tries to find a gap.
constexpr std::size_t kWork =
    300'000;  // Number of triangles for these tries; fewer tries where there are many triangles.
constexpr std::size_t kParts = 32;  // Number of thin parts that are kept.
constexpr int kDrawsOfParts = 200;  // Number of rays for them.
constexpr double kThinnest = 0.25;  // [-]  Part of a gap; a thinner part may be anywhere in it.
constexpr double kSnug = 1e-9;      // [-]  A part may be as wide as its gap, less this.

Eigen::Vector3d any_across(const Eigen::Vector3d& n, RandomNumbers& random) {
  const Eigen::Vector3d t = n.unitOrthogonal();
  const double angle = random.uniform(0.0, 6.283185307179586);
  return std::cos(angle) * t + std::sin(angle) * n.cross(t);
}

/// Adds a square prism around a segment; around a point, a cube without ends.
void add_round_edge(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius,
                    RayTarget& target) {
  const Eigen::Vector3d along = (b - a).stableNormalized();
  const Eigen::Vector3d u = along.isZero() ? Eigen::Vector3d::UnitX() : along.unitOrthogonal();
  const Eigen::Vector3d v = along.isZero() ? Eigen::Vector3d::UnitY() : along.cross(u);
  const Eigen::Vector3d end = radius * (along.isZero() ? Eigen::Vector3d::UnitZ() : along);
  std::array<Eigen::Vector3d, 4> corners = {u + v, v - u, -u - v, u - v};
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector3d p = radius * corners[k];
    const Eigen::Vector3d q = radius * corners[(k + 1) % 4];
    target.add(a - end + p, a - end + q, b + end + q);
    target.add(a - end + p, b + end + q, b + end + p);
  }
}

/// The edges of triangles, with the number of triangles that they bound.
using EdgeCounts = std::map<std::array<std::uint32_t, 2>, int>;

EdgeCounts edge_counts(const Mesh& mesh) {
  EdgeCounts counts;
  for (const auto& [a, b, c] : mesh.triangles) {
    for (const auto& [u, v] : {std::array{a, b}, std::array{b, c}, std::array{c, a}}) {
      ++counts[{std::min(u, v), std::max(u, v)}];
    }
  }
  return counts;
}

/// Adds both sides of a thickened triangle, and its rims where no other triangle continues it.
void add_thick_triangle(const std::array<std::uint32_t, 3>& triangle,
                        const std::array<Eigen::Vector3d, 3>& p, double radius,
                        const EdgeCounts& counts, RayTarget& target) {
  const Eigen::Vector3d out = radius * (p[1] - p[0]).cross(p[2] - p[0]).stableNormalized();
  if (out.isZero()) {
    add_round_edge(p[0], triangle[0] == triangle[1] ? p[2] : p[1], radius, target);
    return;
  }
  target.add(p[0] + out, p[1] + out, p[2] + out);
  target.add(p[0] - out, p[2] - out, p[1] - out);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const auto [u, v] = std::minmax(triangle[k], triangle[next]);
    if (counts.at({u, v}) == 1) {
      const Eigen::Vector3d rim = (p[next] - p[k]).normalized().cross(out);
      target.add(p[k] + rim - out, p[next] + rim - out, p[next] + rim + out);
      target.add(p[k] + rim - out, p[next] + rim + out, p[k] + rim + out);
    }
  }
}

/// Adds the triangles of a shape; those of thickened sheets, tubes and balls about as thick.
void add_triangles(const Shape& shape, const Pose& X, RayTarget& target) {
  const Mesh& mesh = shape.mesh();
  const Eigen::Quaterniond R = X.rotation.normalized();
  const bool is_thick = shape.radius() > 0.0 && !shape.is_solid();
  const EdgeCounts counts = is_thick ? edge_counts(mesh) : EdgeCounts();
  const auto place = [&](std::uint32_t vertex) -> Eigen::Vector3d {
    return X.position + R * mesh.vertices[vertex];
  };
  for (const auto& triangle : mesh.triangles) {
    const std::array<Eigen::Vector3d, 3> p = {place(triangle[0]), place(triangle[1]),
                                              place(triangle[2])};
    if (is_thick) {
      add_thick_triangle(triangle, p, shape.radius(), counts, target);
    } else {
      target.add(p[0], p[1], p[2]);
    }
  }
}

Eigen::Matrix3d axes_of(const GapFrame& frame, double sign_of_first, double sign_of_second) {
  Eigen::Matrix3d axes;
  axes.col(0) = sign_of_first * frame.first;
  axes.col(1) = sign_of_second * frame.second;
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

bool fits(const GapFrame& part, const GapFrame& gap) {
  const bool is_first =
      part.width * (1.0 - kSnug) <= gap.width && part.width >= kThinnest * gap.width;
  const bool is_second = !gap.across || !part.across || *part.across * (1.0 - kSnug) <= *gap.across;
  return is_first && is_second;
}

}  // namespace

void RayTarget::add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d product = (b - a).cross(c - a);
  const double size = product.norm();
  if (size > 0.0) {
    triangles_.push_back({a, b - a, c - a, product / size});
    areas_.push_back((areas_.empty() ? 0.0 : areas_.back()) + 0.5 * size);
  }
}

// Source: T. Moeller, B. Trumbore, "Fast, minimum storage ray/triangle intersection", JGT 2 (1997).
std::optional<RayTarget::Hit> RayTarget::cast(const Eigen::Vector3d& from,
                                              const Eigen::Vector3d& along) const {
  constexpr double kHair = 1e-9;  // [m]  Least distance from the surface where the ray begins.
  double least = std::numeric_limits<double>::infinity();
  const Triangle* hit = nullptr;
  for (const Triangle& triangle : triangles_) {
    const Eigen::Vector3d p = along.cross(triangle.ac);
    const double det = triangle.ab.dot(p);
    if (det == 0.0) {
      continue;
    }
    const Eigen::Vector3d s = from - triangle.a;
    const double u = s.dot(p) / det;
    if (!(u >= 0.0 && u <= 1.0)) {
      continue;
    }
    const Eigen::Vector3d r = s.cross(triangle.ab);
    const double v = along.dot(r) / det;
    const double t = triangle.ac.dot(r) / det;
    if (v >= 0.0 && u + v <= 1.0 && t > kHair && t < least) {
      least = t;
      hit = &triangle;
    }
  }
  return hit == nullptr ? std::nullopt : std::optional(Hit{least, hit->normal});
}

std::size_t RayTarget::draw(RandomNumbers& random) const {
  // Draws by area, or each triangle as often: narrow gaps have small sides.
  if (random.below(2) == 0) {
    return random.below(triangles_.size());
  }
  const double area = random.uniform() * areas_.back();
  const auto found = std::upper_bound(areas_.begin(), areas_.end(), area);
  return std::min(static_cast<std::size_t>(found - areas_.begin()), triangles_.size() - 1);
}

std::optional<double> RayTarget::centre(Eigen::Vector3d& point,
                                        const Eigen::Vector3d& along) const {
  const std::optional<Hit> ahead = cast(point, along);
  const std::optional<Hit> behind = cast(point, -along);
  if (!ahead || !behind) {
    return std::nullopt;
  }
  point += 0.5 * (ahead->distance - behind->distance) * along;
  return ahead->distance + behind->distance;
}

std::optional<GapFrame> RayTarget::gap(double side, double most, RandomNumbers& random) const {
  const Triangle& from = triangles_[draw(random)];
  double u = random.uniform();
  double v = random.uniform();
  if (u + v > 1.0) {
    u = 1.0 - u;
    v = 1.0 - v;
  }
  GapFrame frame;
  frame.first = side * from.normal;
  const Eigen::Vector3d begin = from.a + u * from.ab + v * from.ac;
  const std::optional<Hit> opposite = cast(begin, frame.first);
  if (!opposite || opposite->distance > most) {
    return std::nullopt;
  }
  frame.middle = begin + 0.5 * opposite->distance * frame.first;
  frame.width = opposite->distance;
  frame.second = any_across(frame.first, random);
  if (const std::optional<Hit> beside = cast(frame.middle, frame.second)) {
    const Eigen::Vector3d flat = beside->normal - beside->normal.dot(frame.first) * frame.first;
    if (flat.norm() > 0.5) {
      Eigen::Vector3d middle = frame.middle;
      const Eigen::Vector3d along = flat.normalized();
      const std::optional<double> across = centre(middle, along);
      if (across && *across <= most) {
        frame.second = along;
        frame.across = across;
        frame.middle = middle;
        frame.width = centre(frame.middle, frame.first).value_or(frame.width);
      }
    }
  }
  return frame;
}

GapSampler::GapSampler(const PlanScene& scene) : scene_(scene), space_(scene.space) {}

void GapSampler::fill() {
  is_filled_ = true;
  const RobotScene& all = scene_.scene;
  const std::size_t mover = all.first_member(scene_.robots.front());
  const Shape& shape = all.geometries(mover)[0].shape;
  most_ = 2.0 * (shape.hierarchy().radius + shape.radius());
  add_triangles(shape, {}, moved_);
  for (std::size_t member = 0; member < all.size(); ++member) {
    if (member == mover) {
      continue;
    }
    for (std::size_t k = 0; k < all.geometries(member).size(); ++k) {
      add_triangles(all.geometries(member)[k].shape, all.geometry_pose(member, k, 0.0), fixed_);
    }
  }
}

std::optional<GapSampler::Place> GapSampler::draw(RandomNumbers& random) {
  if (may_draw() && !is_filled_) {
    fill();
  }
  if (!may_draw()) {
    return std::nullopt;
  }
  for (int k = 0; parts_.size() < kParts && k < kDrawsOfParts; ++k) {
    if (const std::optional<GapFrame> part = moved_.gap(-1.0, most_, random)) {
      parts_.push_back(*part);
    }
  }
  const std::size_t rays = std::clamp<std::size_t>(kWork / fixed_.size(), 4, kRays);
  for (std::size_t k = 0; k < rays && !parts_.empty(); ++k) {
    const std::optional<GapFrame> gap = fixed_.gap(1.0, most_, random);
    const GapFrame& part = parts_[random.below(parts_.size())];
    if (!gap || !fits(part, *gap)) {
      continue;
    }
    const double s = random.below(2) == 0 ? 1.0 : -1.0;
    const double t = random.below(2) == 0 ? 1.0 : -1.0;
    const Eigen::Matrix3d in_body = axes_of(part, 1.0, 1.0);
    const Eigen::Quaterniond R(Eigen::Matrix3d(axes_of(*gap, s, t) * in_body.transpose()));
    const Eigen::Vector3d p = gap->middle - R * part.middle;
    return Place{{p.x(), p.y(), p.z(), R.w(), R.x(), R.y(), R.z()}, in_body.col(2)};
  }
  return std::nullopt;
}

}  // namespace firstcontact::detail
