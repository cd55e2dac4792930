/// @file
/// Classes of members of a scene: by their motion and the groups that they are in.

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <unordered_set>
#include <vector>

#include <firstcontact/scene/scene.h>

namespace firstcontact::detail {

/// The motion of a member, as far as it determines whether its pairs are tested.
enum class MemberKind : std::uint8_t { moved, scripted, rests, cannot_touch };

/// The same two members, the smaller number first.
[[nodiscard]] inline BodyPair ordered(const BodyPair& pair) {
  return {std::min(pair[0], pair[1]), std::max(pair[0], pair[1])};
}

/// A number for an ordered pair.
[[nodiscard]] inline std::uint64_t code(const BodyPair& pair) {
  return static_cast<std::uint64_t>(pair[0]) << 32 | static_cast<std::uint64_t>(pair[1]);
}

/// Classes of members: those of one kind that are in the same groups with rules.
///
/// With them pairs are counted without looking at each.
class MemberClasses {
 public:
  /// @param kinds  one for each member
  MemberClasses(const Scene& scene, const std::vector<MemberKind>& kinds);

  /// Whether a rule for groups ignores the pair.
  [[nodiscard]] bool is_ignored(const BodyPair& members) const {
    return !ignored_.empty() && ignored_.contains(class_pair(members));
  }

  /// A number for the two classes of two members.
  [[nodiscard]] std::uint64_t class_pair(const BodyPair& members) const {
    return code(ordered({class_of_[members[0]], class_of_[members[1]]}));
  }

  /// The pairs of classes that rules ignore, in order; the two may be one and the same.
  [[nodiscard]] std::vector<BodyPair> ignored() const;

  [[nodiscard]] const std::vector<std::size_t>& members(std::size_t of) const {
    return classes_[of];
  }

 private:
  std::vector<std::size_t> class_of_;  // For each member.
  std::vector<std::vector<std::size_t>> classes_;
  std::unordered_set<std::uint64_t> ignored_;  // By code().
};

}  // namespace firstcontact::detail
