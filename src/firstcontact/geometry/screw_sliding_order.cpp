#include <firstcontact/geometry/screw_sliding_order.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <map>
#include <numbers>
#include <tuple>

#include <Eigen/Geometry>

namespace firstcontact {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// A strip: triangles on one straight part of the profile, on all turns of the screw thread. It has
/// the index of the direction across, and the place along that direction.
using Strip = std::array<int, 2>;

/// [m]  Computes the lead of a turn along the axis; 0 for a surface of revolution, whose pitch is
/// rounding only.
double lead_of(const ScrewSliding& screw_sliding, double radius) {
  constexpr double kRounding = 1e-6;
  const double lead = 2.0 * std::numbers::pi * std::abs(screw_sliding.pitch);
  return lead > kRounding * radius ? lead : 0.0;
}

/// Finds the strips of triangles. A sliver lies on several; it goes with the one that has most.
class StripFinder {
 public:
  StripFinder(const ScrewSliding& screw_sliding, const Hierarchy& hierarchy)
      : screw_sliding_(screw_sliding),
        lead_(lead_of(screw_sliding, hierarchy.radius)),
        width_(std::max(kStripOfLead * lead_, kStripOfRadius * hierarchy.radius)) {
    for (const auto& t : hierarchy.triangles) {
      corners_.push_back(corners_of(t, hierarchy));
      area_.push_back((hierarchy.vertices[t[1]] - hierarchy.vertices[t[0]])
                          .cross(hierarchy.vertices[t[2]] - hierarchy.vertices[t[0]])
                          .norm());
    }
    for (std::size_t k = 0; k < corners_.size(); ++k) {
      std::size_t thinnest = 0;
      for (std::size_t direction = 1; direction < ScrewSliding::kDirections; ++direction) {
        thinnest = extent(k, direction) < extent(k, thinnest) ? direction : thinnest;
      }
      Share& share = shares_[strip(k, thinnest)];
      share.area += area_[k];
      share.phase += area_[k] * std::polar(1.0, phase(k));
    }
  }

  [[nodiscard]] Strip most_common(std::size_t triangle) const {
    Strip best{};
    double most = -1.0;
    for (std::size_t direction = 0; direction < ScrewSliding::kDirections; ++direction) {
      const Strip candidate = strip(triangle, direction);
      const auto found = shares_.find(candidate);
      const double area = extent(triangle, direction) < kThin * width_ && found != shares_.end()
                              ? found->second.area
                              : 0.0;
      if (area > most) {
        most = area;
        best = candidate;
      }
    }
    return best;
  }

  /// Whether a triangle comes near the axis or spans much of a turn. Its bounds would hide those of
  /// others.
  [[nodiscard]] bool is_wide(std::size_t triangle) const {
    const auto [a, b, c] = corners_[triangle];
    return !(std::min({a.x(), b.x(), c.x()}) > 2.05 * screw_sliding_.least_radius &&
             std::max({a.z(), b.z(), c.z()}) - std::min({a.z(), b.z(), c.z()}) < 0.5);
  }

  /// Finds the turn of the strip on which a triangle lies.
  [[nodiscard]] double turn(std::size_t triangle, const Strip& strip) const {
    const auto found = shares_.find(strip);
    const double mean = found == shares_.end() ? 0.0 : std::arg(found->second.phase);
    return std::round((phase(triangle) - mean) / (2.0 * std::numbers::pi));
  }

  [[nodiscard]] double angle(std::size_t triangle) const { return corners_[triangle][0].z(); }

 private:
  static constexpr double kStripOfLead = 0.05;
  static constexpr double kStripOfRadius = 0.004;
  static constexpr double kThin = 0.3;  // Fraction of a strip's width.

  /// The corners of a triangle in r, h and the angle.
  using Corners = std::array<Vector3d, 3>;

  [[nodiscard]] Corners corners_of(const std::array<std::uint32_t, 3>& t,
                                   const Hierarchy& hierarchy) const {
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d p = screw_sliding_.R_SB * (hierarchy.vertices[t[k]] - screw_sliding_.p_BS);
      double angle = std::atan2(p.y(), p.x());
      if (k > 0) {  // Near the first one, where angles jump.
        angle += 2.0 * std::numbers::pi *
                 std::round((corners[0].z() - angle) / (2.0 * std::numbers::pi));
      }
      corners[k] = {p.head<2>().norm(), p.z() - screw_sliding_.pitch * angle, angle};
    }
    return corners;
  }

  [[nodiscard]] Vector3d along(std::size_t triangle, std::size_t direction) const {
    const Vector2d& f = screw_sliding_.directions[direction];
    const Corners& c = corners_[triangle];
    return {f.dot(c[0].head<2>()), f.dot(c[1].head<2>()), f.dot(c[2].head<2>())};
  }

  [[nodiscard]] double extent(std::size_t triangle, std::size_t direction) const {
    const Vector3d f = along(triangle, direction);
    return f.maxCoeff() - f.minCoeff();
  }

  [[nodiscard]] Strip strip(std::size_t triangle, std::size_t direction) const {
    const double place = along(triangle, direction).mean() / width_;
    return {static_cast<int>(direction),
            static_cast<int>(std::clamp(std::round(place), -1e9, 1e9))};
  }

  /// [rad]  The phase of the height: one turn of the screw thread is a circle.
  [[nodiscard]] double phase(std::size_t triangle) const {
    const Corners& c = corners_[triangle];
    return lead_ > 0.0 ? 2.0 * std::numbers::pi * (c[0].y() + c[1].y() + c[2].y()) / (3.0 * lead_)
                       : 0.0;
  }

  struct Share {
    double area = 0.0;
    std::complex<double> phase = 0.0;  // Its direction is the mean.
  };

  const ScrewSliding& screw_sliding_;
  double lead_;   // [m]
  double width_;  // [m]
  std::vector<Corners> corners_;
  std::vector<double> area_;
  std::map<Strip, Share> shares_;
};

}  // namespace

std::vector<std::uint32_t> order_along(const ScrewSliding& screw_sliding,
                                       const Hierarchy& hierarchy) {
  const StripFinder strips(screw_sliding, hierarchy);
  std::vector<std::tuple<bool, Strip, double, double, std::uint32_t>> places;
  for (std::uint32_t k = 0; k < hierarchy.triangles.size(); ++k) {
    const Strip strip = strips.most_common(k);
    places.emplace_back(strips.is_wide(k), strip, strips.turn(k, strip), strips.angle(k), k);
  }
  std::ranges::sort(places);
  const auto same_turn = [](const auto& x, const auto& y) {
    return std::get<0>(x) == std::get<0>(y) && std::get<1>(x) == std::get<1>(y) &&
           std::get<2>(x) == std::get<2>(y);
  };
  std::vector<std::uint32_t> order;
  for (auto begin = places.begin(); begin != places.end();) {
    const auto end =
        std::find_if_not(begin, places.end(), [&](const auto& x) { return same_turn(x, *begin); });
    // Nodes should not hold the end of one turn and the begin of another, far from each other.
    const auto count = static_cast<std::size_t>(end - begin);
    const std::size_t block = count >= 64 ? 64 : count >= 16 ? 16 : 4;
    order.resize((order.size() + block - 1) / block * block, kNoTriangle);
    for (; begin != end; ++begin) {
      order.push_back(std::get<4>(*begin));
    }
  }
  return order;
}

}  // namespace firstcontact
