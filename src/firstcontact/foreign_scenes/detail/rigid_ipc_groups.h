/// @file
/// Names the bodies of a fixture of Rigid IPC, and says which of them may not touch.

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

/// Gives the scene's bodies names that are unique, and the scene groups of those that do not touch
/// each other: bodies that are not free, with all of the groups that these are in; and the others
/// by their groups.
///
/// @param origins  of each body of the scene
void name_and_group(const std::vector<RigidIpcOrigin>& origins, Scene& scene);

}  // namespace firstcontact::detail
