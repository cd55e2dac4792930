#include <firstcontact/page/detail/path_look_json.h>

#include <utility>

#include <firstcontact/page/page_numbers.h>
#include <firstcontact/scene_files/detail/result_json.h>

namespace firstcontact::detail {
namespace {

constexpr int kCountSize = 4;  // [byte]  Size of a count of points.

/// The first place of all lines; numbers in single precision are relative to it.
Eigen::Vector3d origin_of(const TracedLines& traced) {
  for (const auto& line : traced.lines) {
    if (!line.empty()) {
      return line.front();
    }
  }
  return Eigen::Vector3d::Zero();
}

JsonValue traced_json(const TracedLines& traced) {
  const Eigen::Vector3d origin = origin_of(traced);
  PageNumbers points;
  PageNumbers until;
  std::size_t count = 0;
  for (const auto& line : traced.lines) {
    for (const Eigen::Vector3d& point : line) {
      for (const double coordinate : Eigen::Vector3d(point - origin)) {
        points.add(static_cast<float>(coordinate));
      }
    }
    count += line.size();
    until.add(count, kCountSize);
  }
  return {.value = JsonObject{{"name", to_json(traced.name)},
                              {"origin", to_json(origin)},
                              {"points", to_json(points.base64())},
                              {"until", to_json(until.base64())}}};
}

JsonValue all_traced_json(const std::vector<TracedLines>& movers) {
  JsonArray all;
  for (const TracedLines& traced : movers) {
    all.push_back(traced_json(traced));
  }
  return {.value = std::move(all)};
}

JsonValue edges_json(const std::vector<PathEdgeLook>& edges) {
  JsonArray all;
  for (const PathEdgeLook& edge : edges) {
    all.push_back(
        {.value = JsonObject{{"clearance", to_json(edge.clearance)},
                             {"t", {.value = JsonArray{to_json(edge.from), to_json(edge.to)}}}}});
  }
  return {.value = std::move(all)};
}

JsonValue trees_json(const std::vector<TreeLook>& trees) {
  JsonArray all;
  for (const TreeLook& tree : trees) {
    all.push_back({.value = JsonObject{{"kind", to_json(tree.kind)},
                                       {"places", to_json(tree.places)},
                                       {"edges", to_json(tree.edges)},
                                       {"movers", all_traced_json(tree.movers)}}});
  }
  return {.value = std::move(all)};
}

JsonValue blocked_json(const std::vector<NamedBlockingPair>& blocked) {
  JsonArray all;
  for (const NamedBlockingPair& one : blocked) {
    all.push_back({.value = JsonObject{
                       {"pair", {.value = JsonArray{to_json(one.pair[0]), to_json(one.pair[1])}}},
                       {"count", to_json(one.count)}}});
  }
  return {.value = std::move(all)};
}

JsonValue goal_json(const std::vector<GoalLook>& goal) {
  JsonArray all;
  for (const GoalLook& one : goal) {
    const Eigen::Quaterniond& q = one.X_WM.rotation;
    JsonArray rotation{to_json(q.w()), to_json(q.x()), to_json(q.y()), to_json(q.z())};
    all.push_back({.value = JsonObject{{"body", to_json(one.member)},
                                       {"position", to_json(one.X_WM.position)},
                                       {"quaternion_wxyz", {.value = std::move(rotation)}}}});
  }
  return {.value = std::move(all)};
}

}  // namespace

JsonValue path_look_json(const PathLook& look) {
  return {.value = JsonObject{{"verdict", to_json(look.verdict)},
                              {"edges", edges_json(look.edges)},
                              {"movers", all_traced_json(look.movers)},
                              {"trees", trees_json(look.trees)},
                              {"blocked", blocked_json(look.blocked)},
                              {"goal", goal_json(look.goal)}}};
}

}  // namespace firstcontact::detail
