/// @file
/// A body of a simulation, and the laws of its pairs.

#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/scene/simulation.h>
#include <firstcontact/simulation_model/detail/round_ellipsoid.h>

namespace firstcontact {
struct LinksAsBodies;
struct LoadedScene;
struct Scene;
}  // namespace firstcontact

namespace firstcontact::detail {

enum class BodyKind {
  fixed,     ///< Rests at its place in the scene.
  scripted,  ///< Follows its motion in the scene.
  free,      ///< Moves under forces and contacts, by itself or as a link of a robot.
};

/// A geometry of a link as a body of its own.
struct LinkBody {
  std::size_t robot = 0;  ///< Index in the simulation model.
  std::size_t link = 0;
  Pose X_LB = {};
};

struct SimBody {
  BodyKind kind = BodyKind::fixed;
  Shape shape;
  /// Triangles with the features of contacts: those of the shape, or inscribed_triangles().
  Shape surface;
  std::optional<RoundEllipsoid> ellipsoid = {};  ///< Ellipsoid that the shape is.
  /// The inertia of a free body; of another, or of a link body, only p_BC, its pivot.
  Inertia inertia = {};
  std::optional<LinkBody> link_body = {};
  double reach = 0.0;              ///< [m]  From C to the farthest point of the thickened surface.
  Eigen::AlignedBox3d box_B = {};  ///< [m]  Box around the surface, in the body frame.
  std::vector<TimedForce> forces = {};
};

/// Whether forces move a body in every direction, by itself.
[[nodiscard]] bool moves_freely(const SimBody& body);

/// The mean of the given forces on a body over a time.
struct MeanForce {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< [N m]
};

/// The mean of the given forces on a body over a span.
///
/// @param from  [s]  of the simulation
/// @param span  [s]
[[nodiscard]] MeanForce mean_force(const SimBody& body, double from, double span);

/// The bodies of a scene that has a simulation, link bodies included.
///
/// @param scene  the scene of which `linked` was made
/// @throws std::invalid_argument  names the body whose mass cannot be found, and the mend
[[nodiscard]] std::vector<SimBody> make_sim_bodies(const Scene& scene, const LinksAsBodies& linked);

/// [m]  The contact distance of the scene, or 1e-3 of the radius of the smallest free body.
///
/// Where there are links only, it is 5e-4 of the radius of the smallest of them.
[[nodiscard]] double contact_distance_of(const Simulation& simulation,
                                         const std::vector<SimBody>& bodies);

/// The warnings about a contact distance: it is large for the smallest free body, or so small that
/// steps take long.
///
/// @throws std::invalid_argument  with the mend, if it is larger than that body, or so small that
///         coordinates round by too much of it for a proof
[[nodiscard]] std::vector<std::string> check_contact_distance(double contact_distance,
                                                              const LoadedScene& linked,
                                                              const std::vector<SimBody>& bodies);

/// Friction, restitution and separation of pairs.
class PairLaws {
 public:
  explicit PairLaws(const LoadedScene& loaded);

  /// The margin of a pair; none where the pair does not touch.
  [[nodiscard]] std::optional<double> margin(const BodyPair& pair) const {
    return rules_->margin(pair);
  }
  /// [m]  The greatest margin of all pairs.
  [[nodiscard]] double greatest_margin() const { return greatest_margin_; }
  [[nodiscard]] double friction(const BodyPair& pair) const;
  [[nodiscard]] double restitution(const BodyPair& pair) const;
  /// [m/s]  The velocity at which the surface of a body runs along it; axes of the body frame.
  [[nodiscard]] const Eigen::Vector3d& belt(std::size_t body) const { return belts_[body]; }
  [[nodiscard]] bool has_belts() const {
    return std::ranges::any_of(belts_, [](const Eigen::Vector3d& belt) { return belt.any(); });
  }

  /// Changes the given values of a body's surface.
  void set_surface(std::size_t body, const Surface& surface);
  /// Changes the given values of a pair's surface.
  void set_pair_surface(const BodyPair& pair, const Surface& surface);

 private:
  [[nodiscard]] const Surface* of_pair(const BodyPair& pair) const;

  const PairRules* rules_;
  double greatest_margin_ = 0.0;
  std::vector<double> friction_;     // One for each body.
  std::vector<double> restitution_;  // One for each body.
  std::vector<Eigen::Vector3d> belts_;
  std::unordered_map<std::uint64_t, Surface> pairs_;
};

}  // namespace firstcontact::detail
