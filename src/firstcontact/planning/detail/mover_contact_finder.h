/// @file
/// The contacts of a mover at a place.

#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/planning/detail/tangent_space.h>
#include <firstcontact/query/contact.h>
#include <firstcontact/query/placed_shape.h>
#include <firstcontact/query/workspace.h>

namespace firstcontact::detail {

/// Two points that are near each other.
struct NearContact {
  BodyPair members = {};
  Eigen::Vector3d p_WP = Eigen::Vector3d::Zero();     ///< [m]  Point between the two.
  Eigen::Vector3d n_AB_W = Eigen::Vector3d::UnitX();  ///< [-]
  double gap = 0.0;  ///< [m]  Distance beyond the one that a search of edges calls blocked.
};

/// The contacts at a place, with the members that move there.
struct ContactsAt {
  std::vector<MovedMember> members;   ///< One for each member of the scene.
  std::vector<NearContact> contacts;  ///< The nearest first; contacts that are much alike appear
                                      ///< once.
};

/// Finds the contacts near a mover. For one thread; refers to the scene.
///
/// Where the mover has very many triangles, some of them stand for all: contacts only steer.
class MoverContactFinder {
 public:
  /// @param kept  [m]  distance that edges keep beyond the margins
  MoverContactFinder(const PlanScene& scene, const TangentSpace& tangents, double kept);

  /// Finds the contacts at a place.
  ///
  /// @param band  [m]  contacts that are farther are of no interest
  [[nodiscard]] ContactsAt near(const Configuration& q, double band);

 private:
  struct Pair {
    BodyPair members = {};
    double margin = 0.0;  // [m]  Margin with the distance that edges keep.
  };

  [[nodiscard]] std::vector<MovedMember> members_at(const Configuration& q);
  void take(const Pair& pair, const ContactsAt& at, double band, std::vector<NearContact>& found);
  [[nodiscard]] const PlacedShape& placed(std::size_t member, std::size_t geometry,
                                          const MovedMember& at,
                                          std::optional<PlacedShape>& moved) const;

  const PlanScene& plan_;
  const TangentSpace& tangents_;
  std::vector<Pair> pairs_;
  std::vector<bool> moves_;
  std::vector<std::vector<Shape>> moved_;          // Shapes of members that move; thinned out.
  std::vector<std::vector<PlacedShape>> resting_;  // Shapes of members that do not move.
  std::optional<RobotScene> posed_;                // Only for a robot with joints.
  Workspace workspace_;
  std::vector<Contact> contacts_;
};

}  // namespace firstcontact::detail
