#include <firstcontact/separation/detail/convex_parts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/geometry/convex_set.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

constexpr int kMostSteps = 100;

/// [-]  Precision of the direction, by the gap that is left; and by the distance.
constexpr double kOfGap = 0x1p-6;
constexpr double kOfDistance = 0x1p-50;

/// The length of (x, y). Its square may underflow, by less than 2^-500.
double across(const Vector3d& m) { return std::sqrt(m.x() * m.x() + m.y() * m.y()); }

/// A difference of points of B and A, with both.
struct Difference {
  Vector3d on_A = Vector3d::Zero();
  Vector3d on_B = Vector3d::Zero();
  Vector3d d = Vector3d::Zero();
};

/// The differences whose hull is searched for its point closest to the origin.
class Simplex {
 public:
  void add(const Difference& one) { points_[count_++] = one; }

  /// Finds the closest point of the hull, and keeps only the differences that it is made of.
  Difference reduce() {
    best_ = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count_; ++i) {
      offer({i}, {1.0}, 1);
      for (std::size_t j = i + 1; j < count_; ++j) {
        offer_edge(i, j);
        for (std::size_t k = j + 1; k < count_; ++k) {
          offer_triangle(i, j, k);
        }
      }
    }
    if (count_ == 4) {
      offer_tetrahedron();
    }
    std::array<Difference, 4> kept;
    for (std::size_t k = 0; k < used_; ++k) {
      kept[k] = points_[chosen_[k]];
    }
    points_ = kept;
    count_ = used_;
    return closest_;
  }

  [[nodiscard]] bool is_full() const { return count_ == 4; }

  [[nodiscard]] bool has(const Vector3d& d) const {
    return std::any_of(points_.begin(), points_.begin() + static_cast<std::ptrdiff_t>(count_),
                       [&](const Difference& one) { return one.d == d; });
  }

 private:
  void offer(const std::array<std::size_t, 4>& which, const std::array<double, 4>& weights,
             std::size_t count) {
    Difference sum;
    for (std::size_t k = 0; k < count; ++k) {
      if (!(weights[k] >= 0.0)) {
        return;
      }
      sum.on_A += weights[k] * points_[which[k]].on_A;
      sum.on_B += weights[k] * points_[which[k]].on_B;
      sum.d += weights[k] * points_[which[k]].d;
    }
    if (sum.d.squaredNorm() < best_) {
      best_ = sum.d.squaredNorm();
      closest_ = sum;
      chosen_ = which;
      used_ = count;
    }
  }

  void offer_edge(std::size_t i, std::size_t j) {
    const Vector3d edge = points_[j].d - points_[i].d;
    const double s = -points_[i].d.dot(edge) / edge.squaredNorm();
    offer({i, j}, {1.0 - s, s}, 2);
  }

  void offer_triangle(std::size_t i, std::size_t j, std::size_t k) {
    const Vector3d u = points_[j].d - points_[i].d;
    const Vector3d v = points_[k].d - points_[i].d;
    const Vector3d w = -points_[i].d;
    const Vector3d normal = u.cross(v);
    const double area2 = normal.squaredNorm();
    const double a = w.cross(v).dot(normal) / area2;
    const double b = u.cross(w).dot(normal) / area2;
    offer({i, j, k}, {1.0 - a - b, a, b}, 3);
  }

  void offer_tetrahedron() {
    const Vector3d u = points_[1].d - points_[0].d;
    const Vector3d v = points_[2].d - points_[0].d;
    const Vector3d w = points_[3].d - points_[0].d;
    const Vector3d o = -points_[0].d;
    const double volume = u.dot(v.cross(w));
    const double a = o.dot(v.cross(w)) / volume;
    const double b = u.dot(o.cross(w)) / volume;
    const double c = u.dot(v.cross(o)) / volume;
    offer({0, 1, 2, 3}, {1.0 - a - b - c, a, b, c}, 4);
  }

  std::array<Difference, 4> points_;
  std::size_t count_ = 0;
  double best_ = 0.0;
  Difference closest_;
  std::array<std::size_t, 4> chosen_{};
  std::size_t used_ = 0;
};

Difference farthest(const ConvexPart& A, const ConvexPart& B, const Vector3d& n) {
  Difference one;
  one.on_A = A.body.position(A.farthest(A.body.now.R.transpose() * n));
  one.on_B = B.body.position(B.farthest(B.body.now.R.transpose() * -n));
  one.d = one.on_B - one.on_A;
  return one;
}

/// The directions n from A to B that are normals along a feature: n . axis = height.
struct NormalCircle {
  Vector3d axis = Vector3d::Zero();  ///< [-]  Unit up to rounding, or zero.
  double height = 0.0;

  /// The direction of the circle nearest to n.
  [[nodiscard]] Vector3d nearest(const Vector3d& n) const {
    const Vector3d across_axis = unit_or_zero(n - axis.dot(n) * axis);
    return unit_or_zero(height * axis + std::sqrt(1.0 - height * height) * across_axis);
  }
};

/// The directions that are normals of a part's flat and straight features.
struct Normals {
  std::vector<Vector3d> faces = {};
  std::vector<NormalCircle> circles = {};

  /// @param sign  1 for A, -1 for B, whose outward normals are -n
  Normals(const ConvexPart& part, double sign) {
    const Eigen::Matrix3d& R = part.body.now.R;
    if (const auto* triangle = std::get_if<const TrianglePoints*>(&part.form)) {
      const TrianglePoints& corners = **triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vector3d edge = corners[(k + 1) % 3] - corners[k];
        circles.push_back({unit_or_zero(R * edge), 0.0});
      }
      const Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
      add_face(R * normal);
    } else if (const auto* round = std::get_if<const RoundSet*>(&part.form)) {
      const Vector3d& size = (*round)->size;
      if ((*round)->kind == ConvexKind::cylinder) {
        circles.push_back({R.col(2), 0.0});
        add_face(R.col(2));
      } else if ((*round)->kind == ConvexKind::cone) {
        circles.push_back({R.col(2), sign * size.x() / std::hypot(size.x(), 2.0 * size.z())});
        add_face(R.col(2));
      }
    }
  }

 private:
  void add_face(const Vector3d& normal) {
    faces.push_back(unit_or_zero(normal));
    faces.emplace_back(-faces.back());
  }
};

/// The directions of two circles: x a + y b + z (a x b), with z of both signs.
std::array<Vector3d, 2> meeting(const NormalCircle& a, const NormalCircle& b) {
  const double cosine = a.axis.dot(b.axis);
  const Vector3d third = a.axis.cross(b.axis);
  const double sine2 = third.squaredNorm();
  const double x = (a.height - b.height * cosine) / sine2;
  const double y = (b.height - a.height * cosine) / sine2;
  const double z = std::sqrt(std::max(0.0, 1.0 - x * a.height - y * b.height) / sine2);
  const Vector3d plane = x * a.axis + y * b.axis;
  return {unit_or_zero(plane + z * third), unit_or_zero(plane - z * third)};
}

/// A direction near n with a wide gap, among all or those of a circle.
///
/// It takes steps along the slope, of the length |s|^2 / |s . y|: J. Barzilai, J. Borwein,
/// "Two-point step size gradient methods" (IMA J. Numerical Analysis 8, 1988).
Vector3d widest(const Vector3d& n, const ConvexPart& A, const ConvexPart& B,
                const NormalCircle* circle) {
  constexpr int kSteps = 40;
  const auto placed = [&](const Vector3d& v) {
    return circle != nullptr ? circle->nearest(v) : unit_or_zero(v);
  };
  Vector3d now = placed(n);
  Vector3d best = now;
  double most = -std::numeric_limits<double>::infinity();
  double step = 1.0 / (A.reach + B.reach);
  Vector3d before = now;
  Vector3d slope_before = Vector3d::Zero();
  for (int k = 0; k < kSteps && !now.isZero(0.0); ++k) {
    const Vector3d d = farthest(A, B, now).d;
    const double gap = now.dot(d);
    if (gap > most) {
      most = gap;
      best = now;
    }
    Vector3d slope = d - gap * now;
    if (circle != nullptr) {
      const Vector3d along = unit_or_zero(circle->axis.cross(now));
      slope = along.dot(d) * along;
    }
    if (k > 0) {
      const Vector3d s = now - before;
      const double bend = std::abs(s.dot(slope - slope_before));
      step = bend > 0.0 ? s.squaredNorm() / bend : step;
    }
    before = now;
    slope_before = slope;
    now = placed(now + step * slope);
  }
  return best;
}

}  // namespace

std::optional<RoundSet> round_set_of(const Shape& shape, const Vector3d& pivot) {
  if (!shape.is_curved()) {
    return std::nullopt;
  }
  const ConvexCore& core = shape.convex_set()->core();
  return RoundSet{.kind = core.kind, .size = core.size, .centre = core.origin - pivot};
}

double RoundSet::support(const Vector3d& m) const {
  const double shift = m.dot(centre);
  switch (kind) {
    case ConvexKind::cylinder:
      return shift + size.x() * across(m) + size.z() * std::abs(m.z());
    case ConvexKind::cone:
      return shift + std::max(size.x() * across(m) - size.z() * m.z(), size.z() * m.z());
    default:
      return shift + size.cwiseProduct(m).norm();
  }
}

Vector3d RoundSet::farthest(const Vector3d& m) const {
  const auto on_rim = [&](double z) -> Vector3d {
    const double length = std::hypot(m.x(), m.y());
    return length > 0.0 ? Vector3d(size.x() * (m.x() / length), size.x() * (m.y() / length), z)
                        : Vector3d(0.0, 0.0, z);
  };
  switch (kind) {
    case ConvexKind::cylinder:
      return centre + on_rim(m.z() < 0.0 ? -size.z() : size.z());
    case ConvexKind::cone:
      return centre + (size.x() * across(m) - size.z() * m.z() > size.z() * m.z()
                           ? on_rim(-size.z())
                           : Vector3d(0.0, 0.0, size.z()));
    default: {
      const Vector3d stretched = size.cwiseProduct(m);
      const double length = std::hypot(stretched.x(), stretched.y(), stretched.z());
      return length > 0.0 ? Vector3d(centre + size.cwiseProduct(stretched / length)) : centre;
    }
  }
}

double RoundSet::inner_radius() const {
  switch (kind) {
    case ConvexKind::cylinder:
      return 0.5 * std::min(size.x(), size.z());
    case ConvexKind::cone:
      // The inscribed circle of the triangle through the tip: area / half of the outline.
      return size.z() * size.x() / (size.x() + std::hypot(size.x(), 2.0 * size.z()));
    default:
      return 0.5 * size.minCoeff();
  }
}

Vector3d RoundSet::inner_centre() const {
  if (kind != ConvexKind::cone) {
    return centre;
  }
  return centre + Vector3d(0.0, 0.0, 2.0 * inner_radius() - size.z());
}

RoundSet RoundSet::shrunk(double share) const {
  const Vector3d fixed = inner_centre();
  return {.kind = kind,
          .size = (1.0 - share) * size,
          .centre = fixed + (1.0 - share) * (centre - fixed)};
}

double ConvexPart::support(const Vector3d& m) const {
  if (const auto* box = std::get_if<const BoxNode*>(&form)) {
    return m.dot((*box)->centre) + (*box)->extent.dot(m.cwiseAbs());
  }
  if (const auto* triangle = std::get_if<const TrianglePoints*>(&form)) {
    const TrianglePoints& corners = **triangle;
    return std::max({m.dot(corners[0]), m.dot(corners[1]), m.dot(corners[2])});
  }
  return std::get<const RoundSet*>(form)->support(m);
}

Vector3d ConvexPart::farthest(const Vector3d& m) const {
  if (const auto* box = std::get_if<const BoxNode*>(&form)) {
    Vector3d corner = (*box)->centre;
    for (int k = 0; k < 3; ++k) {
      corner[k] += std::copysign((*box)->extent[k], m[k]);
    }
    return corner;
  }
  if (const auto* triangle = std::get_if<const TrianglePoints*>(&form)) {
    return *std::max_element(
        (*triangle)->begin(), (*triangle)->end(),
        [&](const Vector3d& a, const Vector3d& b) { return m.dot(a) < m.dot(b); });
  }
  return std::get<const RoundSet*>(form)->farthest(m);
}

Vector3d ConvexPart::middle() const {
  if (const auto* box = std::get_if<const BoxNode*>(&form)) {
    return body.position((*box)->centre);
  }
  if (const auto* triangle = std::get_if<const TrianglePoints*>(&form)) {
    const TrianglePoints& corners = **triangle;
    return body.position((corners[0] + corners[1] + corners[2]) / 3.0);
  }
  return body.position(std::get<const RoundSet*>(form)->inner_centre());
}

GapBound convex_gap_along(const Vector3d& n, const ConvexPart& A, const ConvexPart& B,
                          double half) {
  const auto along = [&](const ConvexPart& part, double s, double sign) {
    const BodyInstant& now = part.body.now;
    const Vector3d m = n + s * n.cross(now.spin);
    return n.dot(now.pivot) + s * n.dot(now.velocity) +
           sign * part.support(now.R.transpose() * (sign * m));
  };
  const auto gap = [&](double s) { return along(B, s, -1.0) - along(A, s, 1.0); };
  const double bend = A.body.bend(n, A.reach) + B.body.bend(n, B.reach);
  const double middle = gap(0.0);
  if (half == 0.0) {
    return std::isnan(middle) ? GapBound{} : GapBound{middle, 0.0};
  }
  const double ends = std::min(gap(-half), gap(half)) - 0.5 * half * half * bend;
  // Negated, so that NaN is no bound.
  if (!(ends > -std::numeric_limits<double>::infinity()) || std::isnan(middle)) {
    return {};
  }
  return {middle, std::max(0.0, middle - ends)};
}

ConvexClosest closest_estimate(const ConvexPart& A, const ConvexPart& B, double taken) {
  ConvexClosest found;
  const Vector3d middle_A = A.middle();
  const Vector3d middle_B = B.middle();
  found.points = {middle_A, middle_B, (middle_B - middle_A).norm()};
  double widest = -std::numeric_limits<double>::infinity();
  Simplex simplex;
  for (int step = 0; step < kMostSteps; ++step) {
    const double distance = found.points.distance;
    const Vector3d n = unit_or_zero(found.points.on_B - found.points.on_A);
    const Difference next = farthest(A, B, step == 0 && n.isZero(0.0) ? Vector3d::UnitX() : n);
    const double gap = n.dot(next.d);
    if (gap > widest) {
      widest = gap;
      found.n = n;
    }
    const double precision = std::max(kOfGap * (distance - taken), kOfDistance * distance);
    if (step > 0 && (distance - widest <= precision || simplex.is_full() || simplex.has(next.d))) {
      break;
    }
    simplex.add(next);
    const Difference closest = simplex.reduce();
    const double reached = closest.d.norm();
    if (step > 0 && !(reached < distance)) {
      break;
    }
    found.points = {closest.on_A, closest.on_B, reached};
    if (reached == 0.0) {
      break;
    }
  }
  return found;
}

void offer_normals(const ConvexPart& A, const ConvexPart& B, const Vector3d& n,
                   const std::function<bool(const Vector3d&)>& accept) {
  const Normals of_A(A, 1.0);
  const Normals of_B(B, -1.0);
  for (const Normals* one : {&of_A, &of_B}) {
    if (std::ranges::any_of(one->faces, accept)) {
      return;
    }
  }
  for (const NormalCircle& a : of_A.circles) {
    for (const NormalCircle& b : of_B.circles) {
      if (std::ranges::any_of(meeting(a, b), accept)) {
        return;
      }
    }
  }
  if (accept(widest(n, A, B, nullptr))) {
    return;
  }
  for (const Normals* one : {&of_A, &of_B}) {
    for (const NormalCircle& circle : one->circles) {
      if (accept(widest(n, A, B, &circle))) {
        return;
      }
    }
  }
}

bool surely_overlap(const ConvexPart& A, const ConvexPart& B, double error, double thickness) {
  constexpr double kUp = 1.0 + 0x1p-40;
  const bool shrinks_A = std::holds_alternative<const RoundSet*>(A.form);
  const ConvexPart& round = shrinks_A ? A : B;
  if (!std::holds_alternative<const RoundSet*>(round.form)) {
    return false;
  }
  const RoundSet& core = *std::get<const RoundSet*>(round.form);
  for (const double share : {0x1p-10, 0x1p-20, 0x1p-30, 0x1p-40}) {
    const RoundSet smaller = core.shrunk(share);
    const ConvexPart inner{round.body, &smaller, round.reach};
    const double distance =
        closest_estimate(shrinks_A ? inner : A, shrinks_A ? B : inner, 0.0).points.distance;
    if (kUp * (distance + error) <= share * core.inner_radius() + thickness) {
      return true;
    }
  }
  return false;
}

}  // namespace firstcontact::detail
