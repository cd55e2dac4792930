#include <firstcontact/foreign_scenes/detail/rigid_ipc_groups.h>

#include <map>
#include <set>
#include <utility>

#include <firstcontact/scene/scene.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

/// Finds a name that is not taken: this one, or one like it; takes it.
std::string free_name(std::string name, std::set<std::string>& taken) {
  while (!taken.insert(name).second) {
    name += "'";
  }
  return name;
}

/// Names the bodies. Returns the names.
std::set<std::string> name_bodies(const std::vector<RigidIpcOrigin>& origins, Scene& scene) {
  std::map<std::string, int> count;
  for (const RigidIpcOrigin& origin : origins) {
    ++count[origin.name];
  }
  std::set<std::string> taken;
  for (std::size_t k = 0; k < origins.size(); ++k) {
    std::string name = origins[k].name;
    if (count[name] > 1) {
      name += "-" + std::to_string(origins[k].number);
    }
    scene.bodies[k].name = free_name(std::move(name), taken);
  }
  return taken;
}

/// Groups the bodies. Those that do not move freely form one group, with all groups that they are
/// in.
void group_bodies(const std::vector<RigidIpcOrigin>& origins, std::set<std::string> names,
                  Scene& scene) {
  constexpr double kNone = -1.0;
  std::set<double> not_free;
  for (const RigidIpcOrigin& origin : origins) {
    if (!origin.is_free && origin.group >= 0.0) {
      not_free.insert(origin.group);
    }
  }
  std::map<double, std::vector<std::size_t>> groups;
  for (std::size_t k = 0; k < origins.size(); ++k) {
    const RigidIpcOrigin& origin = origins[k];
    if (!origin.is_free || not_free.contains(origin.group)) {
      groups[kNone].push_back(k);
    } else if (origin.group >= 0.0) {
      groups[origin.group].push_back(k);
    }
  }
  for (auto& [id, members] : groups) {
    if (members.size() < 2) {
      continue;
    }
    const std::string name = id == kNone ? "not free" : "group " + write_json(id);
    scene.ignored_groups.push_back({scene.groups.size(), scene.groups.size()});
    scene.groups.push_back({free_name(name, names), std::move(members)});
  }
}

}  // namespace

void name_and_group(const std::vector<RigidIpcOrigin>& origins, Scene& scene) {
  group_bodies(origins, name_bodies(origins, scene), scene);
}

}  // namespace firstcontact::detail
