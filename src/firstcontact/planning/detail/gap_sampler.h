/// @file
/// Places of a body in the gaps of its environment, from the geometry of both.

#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/math/random_numbers.h>

namespace firstcontact::detail {

/// Two surfaces that face each other, and two more across, if there are such.
struct GapFrame {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();   ///< [m]
  Eigen::Vector3d first = Eigen::Vector3d::UnitX();   ///< [-]  From one surface to the other.
  Eigen::Vector3d second = Eigen::Vector3d::UnitY();  ///< [-]  Across; any direction where there
                                                      ///< are no such surfaces.
  double width = 0.0;                 ///< [m]  Distance of the surfaces along the first direction.
  std::optional<double> across = {};  ///< [m]  Distance of the other surfaces along the second
                                      ///< direction.
};

/// Triangles for rays.
class RayTarget {
 public:
  void add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

  struct Hit {
    double distance = 0.0;                              // [m]
    Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  // In the sense of the triangle's corners.
  };
  /// The first hit, farther than 1e-9 m.
  [[nodiscard]] std::optional<Hit> cast(const Eigen::Vector3d& from,
                                        const Eigen::Vector3d& along) const;

  /// A gap that begins at a random point of the surface.
  ///
  /// @param side  1 outside of the surface, -1 inside
  /// @param most  [m]  wider gaps are of no interest
  [[nodiscard]] std::optional<GapFrame> gap(double side, double most, RandomNumbers& random) const;

  [[nodiscard]] std::size_t size() const { return triangles_.size(); }

 private:
  struct Triangle {
    Eigen::Vector3d a;
    Eigen::Vector3d ab;
    Eigen::Vector3d ac;
    Eigen::Vector3d normal;
  };
  [[nodiscard]] std::size_t draw(RandomNumbers& random) const;
  /// Moves a point to the middle between the hits in both senses, and returns their distance.
  std::optional<double> centre(Eigen::Vector3d& point, const Eigen::Vector3d& along) const;

  std::vector<Triangle> triangles_;
  std::vector<double> areas_;  // [m^2]  Cumulative sums.
};

/// Draws places at which thin parts of a body stand in narrow gaps of bodies at rest.
///
/// A gap is two surfaces that face each other; a thin part is the same within the body. The part is
/// put into the middle of a gap that is wider, its axes along those of the gap. Such places are the
/// tight ones of a passage, which samples of a space seldom hit. All of it steers a search only.
///
/// Source: after X. Zhang, R. Belfer, P. Kry, E. Vouga, "C-space tunnel discovery for puzzle path
/// planning", ACM TOG 39 (2020), who match features of curvature.
class GapSampler {
 public:
  explicit GapSampler(const PlanScene& scene);

  /// Whether places can be drawn: there are a body and, as far as is known, surfaces at rest.
  [[nodiscard]] bool may_draw() const {
    return space_.is_body() && (!is_filled_ || (fixed_.size() > 0 && moved_.size() > 0));
  }

  /// A place and the direction along which the gap is open, in axes of the body [-].
  struct Place {
    Configuration q;
    Eigen::Vector3d open = Eigen::Vector3d::UnitX();
  };
  /// Draws a place; none where the tries found no gap that a part fits.
  [[nodiscard]] std::optional<Place> draw(RandomNumbers& random);

 private:
  void fill();

  const PlanScene& scene_;
  const ConfigurationSpace& space_;
  bool is_filled_ = false;  // Whether the triangles are there: easy questions need none.
  RayTarget fixed_;
  RayTarget moved_;
  double most_ = 0.0;            // [m]  Greatest thickness of the body.
  std::vector<GapFrame> parts_;  // Thin parts that were found.
};

}  // namespace firstcontact::detail
