#include <firstcontact/scene/detail/read_pairs.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/scene/detail/write_json.h>

namespace firstcontact::detail {
namespace {

/// A body or a group of bodies, by its index in the scene.
struct Named {
  std::size_t index = 0;
  bool is_group = false;
};

class PairsReader {
 public:
  PairsReader(Scene& scene, const JsonReader& read) : scene_(scene), read_(read) {
    for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
      names_[scene.bodies[k].name] = {k, false};
    }
  }

  void groups(const JsonValue& value) {
    const auto* groups = std::get_if<JsonObject>(&value.value);
    if (groups == nullptr) {
      read_.fail_expected("an object of groups, such as {\"fixtures\": [\"a\", \"b\"]}", value);
    }
    std::map<std::string_view, Named> names = names_;
    for (const auto& [name, members] : *groups) {
      BodyGroup group{name, {}};
      for (const JsonValue& member : read_.array(members, "an array of names of bodies")) {
        group.bodies.push_back(named(member, "the name of a body").index);
      }
      scene_.groups.push_back(std::move(group));
      const Named entry{scene_.groups.size() - 1, true};
      if (name.empty() || !names.insert({std::string_view(name), entry}).second) {
        read_.fail(members, "expected for the group a name that no body has");
      }
    }
    names_ = std::move(names);
  }

  void ignore(const JsonValue& value) {
    for (const JsonValue& element : read_.array(value, "an array of pairs of names")) {
      const auto [first, second] = sides(element, 2, "a pair of names, such as [\"a\", \"b\"]");
      if (first.is_group && second.is_group) {
        scene_.ignored_groups.push_back({first.index, second.index});
      } else {
        for_each_pair(first, second,
                      [&](const BodyPair& pair) { scene_.ignored_pairs.push_back(pair); });
      }
    }
  }

  void margin(const JsonValue& value) {
    std::set<BodyPair> own;
    for (const JsonValue& element : read_.array(value, "an array of pairs with their margins")) {
      const auto [first, second] =
          sides(element, 3, "two names and a margin, such as [\"a\", \"b\", 0.01]");
      const double margin = read_.not_negative(std::get<JsonArray>(element.value)[2]);
      if (first.is_group && second.is_group) {
        scene_.group_margins.push_back({{first.index, second.index}, margin});
        continue;
      }
      for_each_pair(first, second, [&](const BodyPair& pair) {
        if (!own.insert(pair).second) {
          read_.fail(element, "expected one margin for each pair, got a second one");
        }
        scene_.pair_margins.push_back({pair, margin});
      });
    }
  }

 private:
  Named named(const JsonValue& value, const std::string& what) const {
    const std::string& name = read_.string(value, what);
    const auto found = names_.find(name);
    if (found != names_.end()) {
      return found->second;
    }
    std::vector<std::string_view> known;
    for (const auto& entry : names_) {
      known.push_back(entry.first);
    }
    const std::string_view nearest = nearest_word(name, known);
    read_.fail(value, "expected " + what + ", got " + in_quotes(name) +
                          (nearest.empty() ? "" : "; did you mean " + in_quotes(nearest) + "?"));
  }

  /// The first two of `size` elements.
  std::pair<Named, Named> sides(const JsonValue& value, std::size_t size,
                                const std::string& expected) const {
    const JsonArray& elements = read_.array(value, expected);
    if (elements.size() != size) {
      read_.fail_expected(expected, value);
    }
    const std::string what =
        scene_.groups.empty() ? "the name of a body" : "the name of a body or group";
    const Named first = named(elements[0], what);
    const Named second = named(elements[1], what);
    if (!first.is_group && !second.is_group && first.index == second.index) {
      read_.fail(value, "expected two bodies, got one twice");
    }
    return {first, second};
  }

  /// A group beside a body stands for its pairs with that body.
  template <class Use>
  void for_each_pair(const Named& first, const Named& second, const Use& use) const {
    for (const std::size_t a : bodies_of(first)) {
      for (const std::size_t b : bodies_of(second)) {
        if (a != b) {
          use({std::min(a, b), std::max(a, b)});
        }
      }
    }
  }

  [[nodiscard]] std::vector<std::size_t> bodies_of(const Named& named) const {
    return named.is_group ? scene_.groups[named.index].bodies
                          : std::vector<std::size_t>{named.index};
  }

  Scene& scene_;
  const JsonReader& read_;
  std::map<std::string_view, Named> names_;
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
