#include <firstcontact/scene/hold_contact_pairs.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/scene/detail/load_robots.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

/// [-]  Part of the distance of a contact pair by which a contact may exceed it.
constexpr double kToleranceOfContactPairs = 0.01;

/// The padding of a link, if the member is a link with padding.
struct Padding {
  SceneRobot* robot = nullptr;
  std::size_t link = 0;
  double width = 0.0;  // [m]
};

/// All members of a scene by their names.
class Members {
 public:
  explicit Members(Scene& scene) {
    for (const Body& body : scene.bodies) {
      add(body.name, {});
    }
    for (SceneRobot& robot : scene.robots) {
      for (std::size_t link = 0; link < robot.model.links().size(); ++link) {
        const auto found = robot.padding.find(link);
        add(robot.name + "/" + robot.model.links()[link].name,
            {&robot, link, found == robot.padding.end() ? 0.0 : found->second});
      }
    }
  }

  [[nodiscard]] BodyPair pair(const NamedContactPair& named) const {
    const auto a = numbers_.find(named.pair[0]);
    const auto b = numbers_.find(named.pair[1]);
    if (a == numbers_.end() || b == numbers_.end() || a->second == b->second) {
      throw std::invalid_argument("contact_pairs: expected two bodies or links of the scene, got " +
                                  detail::in_quotes(named.pair[0]) + " and " +
                                  detail::in_quotes(named.pair[1]));
    }
    return {std::min(a->second, b->second), std::max(a->second, b->second)};
  }

  [[nodiscard]] const Padding& padding(std::size_t member) const { return paddings_[member]; }
  [[nodiscard]] std::size_t size() const { return paddings_.size(); }

 private:
  void add(const std::string& name, const Padding& padding) {
    numbers_.emplace(name, paddings_.size());
    paddings_.push_back(padding);
  }

  std::map<std::string, std::size_t> numbers_;
  std::vector<Padding> paddings_;
};

}  // namespace

void hold_contact_pairs(std::span<const NamedContactPair> pairs, Scene& scene) {
  if (pairs.empty()) {
    return;
  }
  const Members members(scene);
  std::map<BodyPair, double> margins;
  std::set<std::size_t> bare;  // Links whose paddings move into margins.
  for (const NamedContactPair& named : pairs) {
    const BodyPair pair = members.pair(named);
    const auto [own, is_first] = margins.emplace(pair, named.distance);
    own->second = std::min(own->second, named.distance);  // One that opens at both ends.
    for (const std::size_t member : pair) {
      if (members.padding(member).width > 0.0) {
        bare.insert(member);
      }
    }
    scene.options.tolerance =
        std::min(scene.options.tolerance, kToleranceOfContactPairs * named.distance);
  }
  const PairRules rules = detail::rules_of(scene);
  for (const std::size_t member : bare) {
    for (std::size_t other = 0; other < members.size(); ++other) {
      const BodyPair pair = {std::min(member, other), std::max(member, other)};
      const std::optional<double> margin = other == member ? std::nullopt : rules.margin(pair);
      if (margin) {
        const double widths = members.padding(member).width +
                              (bare.contains(other) ? members.padding(other).width : 0.0);
        margins.emplace(pair, *margin + widths);
      }
    }
  }
  for (const std::size_t member : bare) {
    members.padding(member).robot->padding.erase(members.padding(member).link);
  }
  std::erase_if(scene.pair_margins,
                [&](const PairMargin& own) { return margins.contains(own.bodies); });
  for (const auto& [pair, margin] : margins) {
    scene.pair_margins.push_back({pair, margin});
  }
}

}  // namespace firstcontact
