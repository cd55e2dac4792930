#include "path_scene.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <firstcontact/planning/plan_path.h>
#include <firstcontact/planning/plan_scene.h>
#include <firstcontact/scene/plan_question.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_planned_path.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::app {
namespace {

using nlohmann::json;

/// A key whose value is not the same in two files.
struct Difference {
  std::string key;
  std::string in_path;
  std::string in_scene;
};

std::string shortened(const json* value) {
  constexpr std::size_t kMost = 60;
  if (value == nullptr) {
    return "missing";
  }
  const std::string text = value->dump();
  return text.size() <= kMost ? text : text.substr(0, kMost) + " ...";
}

/// Whether two names are those of one file, seen from here.
bool is_same_file(const json& a, const json& b) {
  std::error_code error;
  return a.is_string() && b.is_string() &&
         std::filesystem::equivalent(a.get<std::string>(), b.get<std::string>(), error);
}

/// The first difference of two values, in the order of the path's keys.
std::optional<Difference> difference(const std::string& key, const json* in_path,
                                     const json* in_scene) {
  if (in_path == nullptr || in_scene == nullptr || in_path->type() != in_scene->type() ||
      !(in_path->is_object() || in_path->is_array())) {
    const bool is_same = in_path != nullptr && in_scene != nullptr &&
                         (*in_path == *in_scene || is_same_file(*in_path, *in_scene));
    return is_same ? std::nullopt
                   : std::optional(Difference{key, shortened(in_path), shortened(in_scene)});
  }
  if (in_path->is_array()) {
    if (in_path->size() != in_scene->size()) {
      return Difference{key, fmt::format("{} entries", in_path->size()),
                        fmt::format("{}", in_scene->size())};
    }
    for (std::size_t k = 0; k < in_path->size(); ++k) {
      if (auto found =
              difference(fmt::format("{}[{}]", key, k), &in_path->at(k), &in_scene->at(k))) {
        return found;
      }
    }
    return std::nullopt;
  }
  const auto member = [](const json& object, const std::string& name) {
    const auto found = object.find(name);
    return found == object.end() ? nullptr : &*found;
  };
  for (const json* one : {in_path, in_scene}) {
    for (const auto& [name, value] : one->items()) {
      const std::string below = key.empty() ? name : key + "." + name;
      if (auto found = difference(below, member(*in_path, name), member(*in_scene, name))) {
        return found;
      }
    }
  }
  return std::nullopt;
}

class PathScene {
 public:
  PathScene(const ProofArguments& arguments, const std::string& text, const PlannedPath& path)
      : arguments_(arguments), path_(path), written_(json::parse(text)), scene_(read()) {}

  std::vector<std::string> require() {
    const ScenePlan made = make();
    PlanOptions options = made.options;
    options.tolerance = path_.tolerance;
    const PlannedPath expected = [&] {
      PlanResult start;
      start.path = {made.start};
      return planned_path(made, options, start);
    }();
    const json now = json::parse(write_planned_path(expected));
    require_same("moves", &written_.at("moves"), &now.at("moves"));
    require_same("scene", &written_.at("scene"), &now.at("scene"));
    require_same("waypoints[0]", &written_.at("waypoints").at(0), &now.at("waypoints").at(0));
    require_goals(made, written_.at("goals"), now.at("goals"));
    require_contact_pairs(made);
    require_text();
    return warnings_;
  }

 private:
  Scene read() const {
    Scene scene = read_scene(arguments_.scene, {.lenient = arguments_.lenient});
    if (!scene.plan) {
      throw ParseError(arguments_.scene,
                       "expected \"plan\": what moves, and its goal; the scene has none, so no "
                       "path is of it");
    }
    return scene;
  }

  ScenePlan make() {
    Scene scene = scene_;
    PlanQuestion question = *scene.plan;
    const double margin = question.margin.value_or(scene.options.margin);
    warn_of("margin", path_.margin, margin);
    warn_of("tolerance", path_.tolerance, scene.options.tolerance);
    question.margin = path_.margin;
    scene.options.tolerance = path_.tolerance;
    std::stop_source ended;  // The inverse kinematics of goals that are poses is not repeated.
    ended.request_stop();
    ShapeCache cache;
    try {
      return make_scene_plan(std::move(scene), question, cache, ended.get_token());
    } catch (const std::invalid_argument& error) {
      throw ParseError(arguments_.scene, error.what());
    }
  }

  void warn_of(const char* what, double in_path, double in_scene) {
    if (in_path != in_scene) {
      warnings_.push_back(fmt::format("the {} of the path is {} m, that of {} is {} m", what,
                                      detail::write_json(in_path), arguments_.scene,
                                      detail::write_json(in_scene)));
    }
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw ParseError(arguments_.file, fmt::format("the path is not one of {} as it is now: {}; "
                                                  "plan it again",
                                                  arguments_.scene, what));
  }

  void require_same(const std::string& key, const json* in_path, const json* in_scene) const {
    if (const auto found = difference(key, in_path, in_scene)) {
      refuse(fmt::format("{} is {} in the path, {} by that file", found->key, found->in_path,
                         found->in_scene));
    }
  }

  /// A goal that is not free is left out of a path, and goals that are poses have many places.
  void require_goals(const ScenePlan& made, const json& in_path, const json& in_scene) const {
    if (!scene_.plan->link_goals.empty()) {
      return;
    }
    if (made.goals.size() == 1) {
      require_same("goals", &in_path, &in_scene);
    }
    for (std::size_t k = 0; k < in_path.size(); ++k) {
      if (std::ranges::find(in_scene, in_path.at(k)) == in_scene.end()) {
        refuse(fmt::format("goals[{}] of the path is none of its goals", k));
      }
    }
  }

  void require_contact_pairs(const ScenePlan& made) const {
    for (const NamedContactPair& one : path_.contact_pairs) {
      const bool is_asked =
          std::ranges::any_of(made.plan.contact_pairs, [&](const ContactPair& its) {
            const auto name = [&](std::size_t k) {
              return member_name(made.loaded.scene, its.members[k]);
            };
            const bool is_same = (one.pair[0] == name(0) && one.pair[1] == name(1)) ||
                                 (one.pair[0] == name(1) && one.pair[1] == name(0));
            return is_same && one.policy == its.policy && one.at == its.at;
          });
      if (!is_asked) {
        refuse(fmt::format("the contact pair \"{}\" and \"{}\" of the path is none of its pairs",
                           one.pair[0], one.pair[1]));
      }
    }
  }

  /// The scene is the same; its text may differ in what a path does not hold, such as a comment.
  void require_text() const {
    if (scene_.text_digest != path_.scene.text_digest) {
      refuse("its text has changed in what the path does not hold, such as the keys seed and time");
    }
  }

  const ProofArguments& arguments_;
  const PlannedPath& path_;
  json written_;
  Scene scene_;
  std::vector<std::string> warnings_;
};

}  // namespace

std::vector<std::string> require_scene_of_path(const ProofArguments& arguments,
                                               const std::string& text, const PlannedPath& path) {
  return PathScene(arguments, text, path).require();
}

}  // namespace firstcontact::app
