/// @file
/// Finds the contacts of two members of a haptic scene.

#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/haptics/contact_loop.h>
#include <firstcontact/moving_pairs/detail/box_front.h>
#include <firstcontact/query/detail/surface_neighbours.h>
#include <firstcontact/query/placed_shape.h>
#include <firstcontact/query/workspace.h>

namespace firstcontact::detail {

/// A member of a scene in the contact loop.
struct HapticMember {
  Shape shape;
  double reach = 0.0;     ///< [m]  Reach from the centre of its bounds.
  double friction = 0.0;  ///< [-]
  std::shared_ptr<const SurfaceNeighbours> neighbours = {};
  bool fills_hull = false;  ///< Whether its triangles bound their convex hull.
};

/// Finds contacts in memory of its own.
class ContactFinder {
 public:
  explicit ContactFinder(double contact_distance) : distance_(contact_distance) {}

  /// Appends the places where a tool touches another member. These are the contacts within the band
  /// at which both surfaces bulge towards each other, each once. Where none does so, all contacts
  /// are appended. The caller sets the numbers of the bodies, `way` and `surface_velocity`.
  ///
  /// @returns  [m]  the least distance of all features within the band; infinite where there are
  ///         none
  double find(const HapticMember& other, const PlacedShape& other_at, const HapticMember& tool,
              const PlacedShape& tool_at, BoxFront& front, std::vector<HapticTouch>& touches);

 private:
  void find_features(const HapticMember& other, const PlacedShape& other_at,
                     const HapticMember& tool, const PlacedShape& tool_at, double beside,
                     BoxFront& front);
  void choose(const HapticMember& other, const PlacedShape& other_at, const HapticMember& tool,
              const PlacedShape& tool_at);
  void keep_nearest_of_many(double width);

  double distance_;
  Workspace workspace_;
  std::vector<Contact> contacts_;
  std::vector<const Contact*> chosen_;
};

}  // namespace firstcontact::detail
