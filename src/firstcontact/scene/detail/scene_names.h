/// @file
/// The meaning of the names in a scene's rules for pairs.

#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace firstcontact {
struct Scene;
}

namespace firstcontact::detail {

/// The thing that a name means: a body or link, a robot or a group.
struct Named {
  enum class Kind { member, robot, group };
  Kind kind = Kind::member;
  std::size_t index = 0;  ///< Index of the member, robot or group.
};

using SceneNames = std::map<std::string, Named, std::less<>>;

[[nodiscard]] SceneNames names_in(const Scene& scene);

[[nodiscard]] std::vector<std::size_t> members_of(const Scene& scene, const Named& named);

/// Suggests a known name: "; did you mean "x"?", or nothing.
[[nodiscard]] std::string hint(const SceneNames& names, std::string_view unknown);

}  // namespace firstcontact::detail
