/// @file
/// The simplex of a search for the point nearest to the origin.

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace firstcontact::detail {

/// Up to four points; reduce() keeps those whose convex combination is nearest to the origin.
///
/// All numbers are plain doubles. Shares are >= 0 and sum up to 1 up to rounding, whatever the
/// points.
class DifferenceSimplex {
 public:
  struct Corner {
    std::size_t place = 0;  ///< As add() returned it.
    double share = 0.0;     ///< [-]  >= 0
  };

  /// Returns the place of the point, below 4.
  std::size_t add(const Eigen::Vector3d& p) {
    std::size_t place = 0;
    while ((used_ >> place & 1u) != 0) {
      ++place;
    }
    used_ |= 1u << place;
    points_[place] = p;
    corners_[count_++] = {place, 0.0};
    return place;
  }

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] const Corner& corner(std::size_t k) const { return corners_[k]; }
  [[nodiscard]] bool holds_origin() const { return holds_origin_; }

  /// The vector from the origin to the nearest point, or along the normal there; any length.
  [[nodiscard]] const Eigen::Vector3d& direction() const { return direction_; }

  void reduce() {
    if (count_ == 4) {
      of_tetrahedron();
      return;
    }
    Nearest best;
    const std::array<std::size_t, 3> all{corners_[0].place, corners_[1].place, corners_[2].place};
    if (count_ == 1) {
      best = of_point(all[0]);
    } else if (count_ == 2) {
      best = of_segment(all[0], all[1]);
    } else {
      best = of_triangle(all[0], all[1], all[2]);
    }
    take(best);
  }

 private:
  struct Nearest {
    std::array<Corner, 3> corners;
    std::size_t count = 0;
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    double square = std::numeric_limits<double>::infinity();  // Square of the distance.
  };

  void take(const Nearest& best) {
    used_ = 0;
    count_ = best.count;
    for (std::size_t k = 0; k < best.count; ++k) {
      corners_[k] = best.corners[k];
      used_ |= 1u << best.corners[k].place;
    }
    direction_ = best.direction;
  }

  [[nodiscard]] Nearest of_point(std::size_t a) const {
    Nearest nearest;
    nearest.corners[0] = {a, 1.0};
    nearest.count = 1;
    nearest.direction = points_[a];
    nearest.square = points_[a].squaredNorm();
    return nearest;
  }

  [[nodiscard]] Nearest of_segment(std::size_t i, std::size_t j) const {
    const Eigen::Vector3d& a = points_[i];
    const Eigen::Vector3d ab = points_[j] - a;
    const double along = -a.dot(ab);
    const double square = ab.squaredNorm();
    if (!(along > 0.0)) {
      return of_point(i);
    }
    if (!(along < square)) {
      return of_point(j);
    }
    const double share = along / square;
    Nearest nearest;
    nearest.corners[0] = {i, 1.0 - share};
    nearest.corners[1] = {j, share};
    nearest.count = 2;
    nearest.direction = a + share * ab;
    nearest.square = nearest.direction.squaredNorm();
    return nearest;
  }

  [[nodiscard]] static const Nearest& nearer(const Nearest& x, const Nearest& y) {
    return y.square < x.square ? y : x;
  }

  /// The nearest point by the signs of areas.
  ///
  /// Where the foot of the origin lies outside of an edge, that edge or an end of it is nearest.
  [[nodiscard]] Nearest of_triangle(std::size_t i, std::size_t j, std::size_t k) const {
    const Eigen::Vector3d& a = points_[i];
    const Eigen::Vector3d& b = points_[j];
    const Eigen::Vector3d& c = points_[k];
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    const double square = normal.squaredNorm();
    const double of_a = normal.dot(b.cross(c));
    const double of_b = normal.dot(c.cross(a));
    const double of_c = normal.dot(a.cross(b));
    const double sum = of_a + of_b + of_c;
    if (of_a > 0.0 && of_b > 0.0 && of_c > 0.0 && square > 0.0) {
      Nearest nearest;
      nearest.corners = {Corner{i, of_a / sum}, Corner{j, of_b / sum}, Corner{k, of_c / sum}};
      nearest.count = 3;
      nearest.direction = (normal.dot(a) / square) * normal;
      nearest.square = nearest.direction.squaredNorm();
      return nearest;
    }
    Nearest best;
    if (!(of_c > 0.0)) {
      best = nearer(best, of_segment(i, j));
    }
    if (!(of_a > 0.0)) {
      best = nearer(best, of_segment(j, k));
    }
    if (!(of_b > 0.0)) {
      best = nearer(best, of_segment(k, i));
    }
    if (best.count == 0) {  // Degenerate, or too small to be computed with.
      best = nearer(nearer(of_segment(i, j), of_segment(j, k)), of_segment(k, i));
    }
    return best;
  }

  void of_tetrahedron() {
    const std::array<std::size_t, 4> all{corners_[0].place, corners_[1].place, corners_[2].place,
                                         corners_[3].place};
    constexpr std::size_t kFaces[4][4] = {{1, 2, 3, 0}, {0, 2, 3, 1}, {0, 1, 3, 2}, {0, 1, 2, 3}};
    Nearest best;
    std::array<double, 4> volumes{};
    double sum = 0.0;
    bool inside = true;
    for (const auto& [i, j, k, opposite] : kFaces) {
      const Eigen::Vector3d& a = points_[all[i]];
      const Eigen::Vector3d normal = (points_[all[j]] - a).cross(points_[all[k]] - a);
      const double of_origin = -normal.dot(a);
      const double of_opposite = normal.dot(points_[all[opposite]] - a);
      if (of_origin * of_opposite > 0.0) {
        volumes[opposite] = of_origin / of_opposite;  // On the inner side of this face.
        sum += volumes[opposite];
        continue;
      }
      inside = false;
      best = nearer(best, of_triangle(all[i], all[j], all[k]));
    }
    Eigen::Vector3d combined = Eigen::Vector3d::Zero();
    double size2 = 0.0;
    for (std::size_t k = 0; inside && k < 4; ++k) {
      corners_[k] = {all[k], volumes[k] / sum};
      combined += corners_[k].share * points_[all[k]];
      size2 = std::max(size2, points_[all[k]].squaredNorm());
    }
    // Rounding may wrongly find the origin inside of a flat tetrahedron.
    constexpr double kNothing = 0x1p-80;
    if (inside && combined.squaredNorm() <= kNothing * size2) {
      holds_origin_ = true;
      direction_.setZero();
      return;
    }
    if (inside) {
      for (const auto& [i, j, k, opposite] : kFaces) {
        best = nearer(best, of_triangle(all[i], all[j], all[k]));
      }
    }
    take(best);
  }

  std::array<Eigen::Vector3d, 4> points_;
  std::array<Corner, 4> corners_;
  std::size_t count_ = 0;
  unsigned used_ = 0;
  bool holds_origin_ = false;
  Eigen::Vector3d direction_ = Eigen::Vector3d::Zero();
};

}  // namespace firstcontact::detail
