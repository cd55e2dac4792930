#include <firstcontact/scene/detail/member_classes.h>

#include <map>
#include <set>
#include <utility>

namespace firstcontact::detail {
namespace {

using Groups = std::vector<std::size_t>;  // In order, each once.

/// The groups of each member that rules ignore.
std::vector<Groups> ignored_groups_of(const Scene& scene, std::size_t members) {
  std::set<std::size_t> used;
  for (const GroupPair& rule : scene.ignored_groups) {
    used.insert(rule.begin(), rule.end());
  }
  std::vector<Groups> groups_of(members);
  for (const std::size_t group : used) {
    for (const std::size_t member : scene.groups[group].bodies) {
      if (groups_of[member].empty() || groups_of[member].back() != group) {
        groups_of[member].push_back(group);
      }
    }
  }
  return groups_of;
}

}  // namespace

MemberClasses::MemberClasses(const Scene& scene, const std::vector<MemberKind>& kinds)
    : class_of_(kinds.size()) {
  const std::vector<Groups> groups_of = ignored_groups_of(scene, kinds.size());
  std::map<std::pair<Groups, MemberKind>, std::size_t> known;
  std::vector<std::vector<std::size_t>> classes_of(scene.groups.size());
  for (std::size_t member = 0; member < kinds.size(); ++member) {
    const auto [at, is_new] =
        known.try_emplace({groups_of[member], kinds[member]}, classes_.size());
    if (is_new) {
      classes_.emplace_back();
      for (const std::size_t group : groups_of[member]) {
        classes_of[group].push_back(at->second);
      }
    }
    class_of_[member] = at->second;
    classes_[at->second].push_back(member);
  }
  for (const GroupPair& rule : scene.ignored_groups) {
    for (const std::size_t a : classes_of[rule[0]]) {
      for (const std::size_t b : classes_of[rule[1]]) {
        ignored_.insert(code(ordered({a, b})));
      }
    }
  }
}

std::vector<BodyPair> MemberClasses::ignored() const {
  std::vector<BodyPair> pairs;
  for (const std::uint64_t pair : ignored_) {
    pairs.push_back({pair >> 32, pair & 0xffffffffu});
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace firstcontact::detail
