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

/// Where a body comes from.
struct RigidIpcOrigin {
  std::string name;
  std::size_t number = 0;  ///< In the file.
  bool is_free = false;
  double group = -1.0;  ///< Negative: a group of its own.
};

/// Gives the scene's bodies unique names, and the scene groups of bodies that do not touch each
/// other.
///
/// Bodies that are not free are of one scene group, with all of the groups that these are in. The
/// others keep their groups.
///
/// @param origins  of each body of the scene
void name_and_group(const std::vector<RigidIpcOrigin>& origins, Scene& scene);

}  // namespace firstcontact::detail
