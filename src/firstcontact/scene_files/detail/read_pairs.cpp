#include <firstcontact/scene_files/detail/read_pairs.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/scene/detail/scene_names.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

class PairsReader {
 public:
  PairsReader(Scene& scene, const JsonReader& read)
      : scene_(scene), read_(read), names_(names_in(scene)) {}

  void groups(const JsonValue& value) {
    const auto* groups = std::get_if<JsonObject>(&value.value);
    if (groups == nullptr) {
      read_.fail_expected("an object of groups, such as {\"fixtures\": [\"a\", \"b\"]}", value);
    }
    SceneNames names = names_;
    for (const auto& [name, members] : *groups) {
      BodyGroup group{name, {}};
      for (const JsonValue& member : read_.array(members, "an array of names of bodies")) {
        const std::vector<std::size_t> meant =
            members_of(scene_, named(member, what_is_in_a_group()));
        group.bodies.insert(group.bodies.end(), meant.begin(), meant.end());
      }
      scene_.groups.push_back(std::move(group));
      const Named entry{Named::Kind::group, scene_.groups.size() - 1};
      if (name.empty() || !names.insert({name, entry}).second) {
        read_.fail(members, scene_.robots.empty()
                                ? "expected for the group a name that no body has"
                                : "expected for the group a name that no body, robot or link has");
      }
    }
    names_ = std::move(names);
  }

  void ignore(const JsonValue& value) {
    for (const JsonValue& element : read_.array(value, "an array of pairs of names")) {
      const auto [first, second] = sides(element, 2, "a pair of names, such as [\"a\", \"b\"]");
      if (are_groups(first, second)) {
        scene_.ignored_groups.push_back({first.index, second.index});
        continue;
      }
      const std::vector<BodyPair> pairs = pairs_of(first, second);
      scene_.ignored_pairs.insert(scene_.ignored_pairs.end(), pairs.begin(), pairs.end());
    }
  }

  void margin(const JsonValue& value) {
    std::map<BodyPair, Own> own;
    for (const JsonValue& element : read_.array(value, "an array of pairs with their margins")) {
      const auto [first, second] =
          sides(element, 3, "two names and a margin, such as [\"a\", \"b\", 0.01]");
      const double margin = read_.not_negative(std::get<JsonArray>(element.value)[2]);
      if (are_groups(first, second)) {
        scene_.group_margins.push_back({{first.index, second.index}, margin});
        continue;
      }
      for (const BodyPair& pair : pairs_of(first, second)) {
        take_margin({pair, margin}, exactness(first, second), element, own);
      }
    }
  }

 private:
  /// A margin of the scene. The margin of a link prevails over that of its robot.
  struct Own {
    std::size_t index;
    int exactness;
  };

  static bool are_groups(const Named& first, const Named& second) {
    return first.kind == Named::Kind::group && second.kind == Named::Kind::group;
  }

  static int exactness(const Named& first, const Named& second) {
    return (first.kind == Named::Kind::robot ? 0 : 1) + (second.kind == Named::Kind::robot ? 0 : 1);
  }

  void take_margin(const PairMargin& margin, int exactness, const JsonValue& element,
                   std::map<BodyPair, Own>& own) const {
    const auto [known, is_new] =
        own.insert({margin.bodies, {scene_.pair_margins.size(), exactness}});
    if (is_new) {
      scene_.pair_margins.push_back(margin);
    } else if (exactness == known->second.exactness) {
      read_.fail(element, "expected one margin for each pair, got a second one");
    } else if (exactness > known->second.exactness) {
      known->second.exactness = exactness;
      scene_.pair_margins[known->second.index] = margin;
    }
  }

  Named named(const JsonValue& value, const std::string& what) const {
    const std::string& name = read_.string(value, what);
    const auto found = names_.find(name);
    if (found != names_.end()) {
      return found->second;
    }
    read_.fail(value, "expected " + what + ", got " + in_quotes(name) + hint(names_, name));
  }

  [[nodiscard]] std::string what_is_in_a_group() const {
    return scene_.robots.empty() ? "the name of a body"
                                 : "the name of a body or robot, or robot/link";
  }

  [[nodiscard]] std::string what_is_named() const {
    std::string what = "the name of a body";
    if (!scene_.robots.empty()) {
      what +=
          scene_.groups.empty() ? " or robot, or robot/link" : ", robot or group, or robot/link";
    } else if (!scene_.groups.empty()) {
      what += " or group";
    }
    return what;
  }

  /// Reads the first two of `size` elements.
  std::pair<Named, Named> sides(const JsonValue& value, std::size_t size,
                                const std::string& expected) const {
    const JsonArray& elements = read_.array(value, expected);
    if (elements.size() != size) {
      read_.fail_expected(expected, value);
    }
    const std::string what = what_is_named();
    const Named first = named(elements[0], what);
    const Named second = named(elements[1], what);
    const auto is_member = [](const Named& side) { return side.kind == Named::Kind::member; };
    if (is_member(first) && is_member(second) && first.index == second.index) {
      read_.fail(value, "expected two bodies, got one twice");
    }
    return {first, second};
  }

  /// The pairs of two names: a group or robot stands for all its members.
  [[nodiscard]] std::vector<BodyPair> pairs_of(const Named& first, const Named& second) const {
    std::vector<BodyPair> pairs;
    std::set<BodyPair> seen;
    for (const std::size_t a : members_of(scene_, first)) {
      for (const std::size_t b : members_of(scene_, second)) {
        const BodyPair pair = {std::min(a, b), std::max(a, b)};
        if (a != b && seen.insert(pair).second) {
          pairs.push_back(pair);
        }
      }
    }
    return pairs;
  }

  Scene& scene_;
  const JsonReader& read_;
  SceneNames names_;
};

}  // namespace

void read_pairs(const JsonValue& value, Scene& scene, const JsonReader& read) {
  const JsonObject& object = read.object(value, {{"groups", "ignore", "margin"}});
  PairsReader pairs(scene, read);
  if (const JsonValue* groups = find(object, "groups")) {
    pairs.groups(*groups);
  }
  if (const JsonValue* ignore = find(object, "ignore")) {
    pairs.ignore(*ignore);
  }
  if (const JsonValue* margin = find(object, "margin")) {
    pairs.margin(*margin);
  }
}

}  // namespace firstcontact::detail
