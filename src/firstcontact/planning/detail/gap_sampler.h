/// @file
/// Places of a body in the gaps of what surrounds it, from the geometry of both.

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
  Eigen::Vector3d second = Eigen::Vector3d::UnitY();  ///< [-]  Across; any where there is none.
  double width = 0.0;                                 ///< [m]  Along the first.
  std::optional<double> across = {};                  ///< [m]  Along the second.
};

/// Triangles with rays through them.
class RayTarget {
 public:
  void add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

  struct Hit {
    double distance = 0.0;                              // [m]
    Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  // As the triangle turns.
  };
  /// The first hit farther than a hair.
  [[nodiscard]] std::optional<Hit> cast(const Eigen::Vector3d& from,
                                        const Eigen::Vector3d& along) const;

  /// A gap that begins at a random point of the surface.
  ///
  /// @param side  1 outside of the surface, -1 inside
  /// @param most  [m]  wider ones are of no interest
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
  /// Moves a point to the middle between what is hit along both senses; the width.
  std::optional<double> centre(Eigen::Vector3d& point, const Eigen::Vector3d& along) const;

  std::vector<Triangle> triangles_;
  std::vector<double> areas_;  // [m^2]  Sums.
};

/// Draws places at which thin parts of a body stand in narrow gaps of what is at rest.
///
/// A gap is two surfaces that face each other; a thin part is the same within the body. The part
/// is put into the middle of a gap that is wider, its axes along those of the gap. Such places are
/// the tight ones of a passage, which samples of a space seldom hit. After X. Zhang, R. Belfer, P.
/// Kry, E. Vouga, "C-space tunnel discovery for puzzle path planning", ACM TOG 39 (2020), who match
/// features of curvature. All of it steers a search only.
class GapSampler {
 public:
  explicit GapSampler(const PlanScene& scene);

  /// Whether there is something to draw: a body, and surfaces at rest.
  [[nodiscard]] bool may_draw() const { return fixed_.size() > 0 && moved_.size() > 0; }

  /// A place and the direction along which the gap is open, in axes of the body [-].
  struct Place {
    Configuration q;
    Eigen::Vector3d open = Eigen::Vector3d::UnitX();
  };
  /// None where the tries found no gap that a part fits.
  [[nodiscard]] std::optional<Place> draw(RandomNumbers& random);

 private:
  const ConfigurationSpace& space_;
  RayTarget fixed_;
  RayTarget moved_;
  double most_ = 0.0;            // [m]  The body is nowhere thicker.
  std::vector<GapFrame> parts_;  // Thin parts that were found.
};

}  // namespace firstcontact::detail
