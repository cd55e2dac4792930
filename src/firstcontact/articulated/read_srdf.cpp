#include <firstcontact/articulated/read_srdf.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/read_text_file.h>
#include <firstcontact/text/xml_reader.h>

namespace firstcontact {
namespace {

using detail::XmlElement;
using detail::XmlReader;

struct Members {
  std::set<std::size_t> links;
  std::set<std::size_t> joints;
};

/// Walks one document.
class SrdfReader {
 public:
  SrdfReader(std::string_view text, const std::string& source, const RobotModel& robot)
      : xml_(text, source), robot_(robot), root_(xml_.root("robot")) {}

  RobotSemantics semantics() {
    result_.robot = xml_.text(root_, "name");
    if (result_.robot != robot_.name()) {
      warn(root_, "describes robot '" + result_.robot + "', the model is '" + robot_.name() + "'");
    }
    read_disabled();
    read_groups();
    for (const XmlElement* element : xml_.children(root_, "group_state")) {
      read_state(*element);
    }
    for (const XmlElement* element : xml_.children(root_, "end_effector")) {
      read_end_effector(*element);
    }
    return std::move(result_);
  }

 private:
  void warn(const XmlElement& where, const std::string& message) {
    try {
      xml_.fail(where, message);
    } catch (const ParseError& error) {
      result_.warnings.emplace_back(error.what());
    }
  }

  /// None, with a warning, if the robot has no such link.
  std::optional<std::size_t> link(const XmlElement& element, const char* attribute) {
    const std::string name = xml_.text(element, attribute);
    const std::optional<std::size_t> found = robot_.find_link(name);
    if (!found) {
      warn(element, "'" + name + "' is not a link of the robot");
    }
    return found;
  }

  std::optional<std::size_t> joint(const XmlElement& element, const char* attribute) {
    const std::string name = xml_.text(element, attribute);
    const std::optional<std::size_t> found = robot_.find_joint(name);
    if (!found) {
      warn(element, "'" + name + "' is not a joint of the robot");
    }
    return found;
  }

  void read_disabled() {
    for (const XmlElement* element : xml_.children(root_, "disable_default_collisions")) {
      if (const auto disabled = link(*element, "link")) {
        for (std::size_t other = 0; other < robot_.links().size(); ++other) {
          if (other != *disabled) {
            disabled_.emplace(std::minmax(*disabled, other), "Default");
          }
        }
      }
    }
    for (const XmlElement* element : xml_.children(root_, "enable_collisions")) {
      if (const auto pair = link_pair(*element)) {
        disabled_.erase(*pair);
      }
    }
    for (const XmlElement* element : xml_.children(root_, "disable_collisions")) {
      if (const auto pair = link_pair(*element)) {
        const char* reason = element->Attribute("reason");
        disabled_.emplace(*pair, reason != nullptr ? reason : "");
      }
    }
    for (const auto& [pair, reason] : disabled_) {
      result_.disabled.push_back({pair.first, pair.second, reason});
    }
  }

  std::optional<std::pair<std::size_t, std::size_t>> link_pair(const XmlElement& element) {
    xml_.expect_only(element, {"link1", "link2", "reason"}, {});
    const auto first = link(element, "link1");
    const auto second = link(element, "link2");
    if (!first || !second) {
      return {};
    }
    if (*first == *second) {
      xml_.fail(element,
                "expected two different links, got '" + xml_.text(element, "link1") + "' twice");
    }
    return std::minmax(*first, *second);
  }

  void read_groups() {
    for (const XmlElement* element : xml_.children(root_, "group")) {
      if (!group_elements_.emplace(xml_.text(*element, "name"), element).second) {
        xml_.fail(*element, "a second group of this name; rename one of them");
      }
    }
    for (const XmlElement* element : xml_.children(root_, "group")) {
      std::set<const XmlElement*> open;
      const Members& all = members(*element, open);
      result_.groups.push_back({xml_.text(*element, "name"),
                                {all.links.begin(), all.links.end()},
                                {all.joints.begin(), all.joints.end()}});
    }
  }

  void add_link(Members& members, std::size_t link) {
    members.links.insert(link);
    if (const auto joint = robot_.parent_joint(link)) {
      members.joints.insert(*joint);
    }
  }

  /// @param open  the groups that wait for this one
  const Members& members(const XmlElement& group, std::set<const XmlElement*>& open) {
    if (const auto known = members_.find(&group); known != members_.end()) {
      return known->second;
    }
    if (!open.insert(&group).second) {
      xml_.fail(group, "the group contains itself");
    }
    xml_.expect_only(group, {"name"}, {"link", "joint", "passive_joint", "chain", "group"});
    Members result;
    for (const XmlElement* element : xml_.children(group, "link")) {
      if (const auto found = link(*element, "name")) {
        add_link(result, *found);
      }
    }
    for (const char* kind : {"joint", "passive_joint"}) {
      for (const XmlElement* element : xml_.children(group, kind)) {
        if (const auto found = joint(*element, "name")) {
          result.joints.insert(*found);
          result.links.insert(robot_.child_link(*found));
        }
      }
    }
    for (const XmlElement* element : xml_.children(group, "chain")) {
      add_chain(result, *element);
    }
    for (const XmlElement* element : xml_.children(group, "group")) {
      const auto part = group_elements_.find(xml_.text(*element, "name"));
      if (part == group_elements_.end()) {
        warn(*element, "there is no group of this name");
        continue;
      }
      const Members& more = members(*part->second, open);
      result.links.insert(more.links.begin(), more.links.end());
      result.joints.insert(more.joints.begin(), more.joints.end());
    }
    open.erase(&group);
    return members_.emplace(&group, std::move(result)).first->second;
  }

  void add_chain(Members& members, const XmlElement& element) {
    xml_.expect_only(element, {"base_link", "tip_link"}, {});
    const auto base = link(element, "base_link");
    const auto tip = link(element, "tip_link");
    if (!base || !tip) {
      return;
    }
    if (robot_.last_common_ancestor(*base, *tip) != *base) {
      xml_.fail(element, "the tip link does not hang on the base link");
    }
    add_link(members, *base);
    for (const std::size_t joint : robot_.chain(*base, *tip)) {
      add_link(members, robot_.child_link(joint));
    }
  }

  void read_state(const XmlElement& element) {
    xml_.expect_only(element, {"name", "group"}, {"joint"});
    GroupState state{
        .name = xml_.text(element, "name"), .group = xml_.text(element, "group"), .values = {}};
    if (group_elements_.find(state.group) == group_elements_.end()) {
      warn(element, "there is no group '" + state.group + "'");
    }
    for (const XmlElement* value : xml_.children(element, "joint")) {
      xml_.expect_only(*value, {"name", "value"}, {});
      if (const auto found = joint(*value, "name")) {
        const std::vector<double> coordinates = xml_.numbers(*value, "value");
        const std::size_t count = coordinate_count(robot_.joints()[*found].type);
        if (coordinates.size() != count) {
          xml_.fail(*value, "expected as many numbers in 'value' as the joint has coordinates, " +
                                std::to_string(count) + ", got " +
                                std::to_string(coordinates.size()));
        }
        state.values.push_back({*found, coordinates});
      }
    }
    result_.states.push_back(std::move(state));
  }

  void read_end_effector(const XmlElement& element) {
    xml_.expect_only(element, {"name", "parent_link", "group", "parent_group"}, {});
    const std::string group = xml_.text(element, "group");
    if (group_elements_.find(group) == group_elements_.end()) {
      warn(element, "there is no group '" + group + "'");
      return;
    }
    if (const auto parent = link(element, "parent_link")) {
      result_.end_effectors.push_back({xml_.text(element, "name"), group, *parent});
    }
  }

  XmlReader xml_;
  const RobotModel& robot_;
  const XmlElement& root_;
  RobotSemantics result_;
  std::map<std::pair<std::size_t, std::size_t>, std::string> disabled_;
  std::map<std::string, const XmlElement*, std::less<>> group_elements_;
  std::map<const XmlElement*, Members> members_;
};

}  // namespace

bool RobotSemantics::is_disabled(std::size_t link, std::size_t other) const {
  const auto pair = std::minmax(link, other);
  const auto before = [](const DisabledPair& a, const std::pair<std::size_t, std::size_t>& b) {
    return std::tie(a.link, a.other) < std::tie(b.first, b.second);
  };
  const auto found = std::lower_bound(disabled.begin(), disabled.end(),
                                      std::pair(pair.first, pair.second), before);
  return found != disabled.end() && found->link == pair.first && found->other == pair.second;
}

RobotSemantics read_srdf(const std::filesystem::path& path, const RobotModel& robot) {
  return parse_srdf(detail::read_text_file(path), path.string(), robot);
}

RobotSemantics parse_srdf(std::string_view text, const std::string& source,
                          const RobotModel& robot) {
  return SrdfReader(text, source, robot).semantics();
}

}  // namespace firstcontact
