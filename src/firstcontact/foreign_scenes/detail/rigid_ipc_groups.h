/// @file
/// Names the bodies of a fixture of Rigid IPC, and determines which of them may not touch.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace firstcontact {
struct Scene;
}

namespace firstcontact::detail {

/// The origin of a body in the file.
struct RigidIpcOrigin {
  std::string name;
  std::size_t number = 0;  ///< Number in the file.
  bool is_free = false;
  double group = -1.0;  ///< Negative: a group of its own.
};

/// Gives the scene's bodies unique names, and makes scene groups of bodies that do not touch each
/// other.
///
/// All bodies that are not free form one scene group. The groups of these bodies join it with all
/// of their members. The other groups stay.
///
/// @param origins  one for each body of the scene
void name_and_group(const std::vector<RigidIpcOrigin>& origins, Scene& scene);

}  // namespace firstcontact::detail
