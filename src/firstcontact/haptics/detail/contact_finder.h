/// @file
/// Where two members of a haptic scene touch.

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

/// A member of a scene as the contact loop has it.
struct HapticMember {
  Shape shape;
  double reach = 0.0;     ///< [m]  From the centre of its bounds.
  double friction = 0.0;  ///< [-]
  std::shared_ptr<const SurfaceNeighbours> neighbours = {};
};

/// Finds contacts in memory of its own.
class ContactFinder {
 public:
  explicit ContactFinder(double contact_distance) : distance_(contact_distance) {}

  /// Appends the places where a tool touches another member: those within the band at which both
  /// surfaces bulge towards each other, each once; all of them where none does. The numbers of the
  /// bodies, `way` and `surface_velocity` are left to the caller.
  ///
  /// @returns  [m]  the least distance of all features within the band; infinite where none is
  double find(const HapticMember& other, const PlacedShape& other_at, const HapticMember& tool,
              const PlacedShape& tool_at, BoxFront& front, std::vector<HapticTouch>& touches);

 private:
  void choose(const HapticMember& other, const PlacedShape& other_at, const HapticMember& tool,
              const PlacedShape& tool_at);
  void keep_nearest_of_many(double width);

  double distance_;
  Workspace workspace_;
  std::vector<Contact> contacts_;
  std::vector<const Contact*> chosen_;
};

}  // namespace firstcontact::detail
