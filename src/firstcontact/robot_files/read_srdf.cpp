#include <firstcontact/robot_files/read_srdf.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>

#include <firstcontact/robot_files/detail/srdf_names.h>
#include <firstcontact/text/brief_list.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/read_file.h>
#include <firstcontact/text/reading_log.h>
#include <firstcontact/text/xml_names.h>
#include <firstcontact/text/xml_reader.h>

namespace firstcontact {
namespace {

using detail::srdf_names;
using detail::XmlContents;
using detail::XmlElement;
using detail::XmlReader;

struct Members {
  std::set<std::size_t> links;
  std::set<std::size_t> joints;
};

/// Elements of one kind that name things which the robot does not have.
struct Strays {
  std::string kind;  ///< "links that the robot does not have"
  ParseError first;  ///< Error for a single one.
  std::size_t count;
  std::vector<std::string> names;  ///< Each once.
};

/// Walks one document.
class SrdfReader {
 public:
  SrdfReader(std::string_view text, const std::string& source, const RobotModel& robot,
             const ReadingOptions& options)
      : xml_(text, source),
        log_(source, "SRDF", options),
        names_(xml_, log_, srdf_names().telling),
        robot_(robot),
        root_(xml_.root("robot")) {}

  RobotSemantics semantics() {
    names_.check(root_, srdf_names().robot);
    attempt([&] { read_name(); });
    read_disabled();
    read_groups();
    for_each("group_state", srdf_names().state, [&](const XmlElement& e) { read_state(e); });
    for_each("end_effector", srdf_names().effector,
             [&](const XmlElement& e) { read_end_effector(e); });
    return finish();
  }

 private:
  /// Reads an element; its errors are reported together with all others.
  void attempt(const std::function<void()>& read) {
    try {
      read();
    } catch (const ParseError& error) {
      log_.add_error(error);
    }
  }

  void for_each(const char* name, const XmlContents& known,
                const std::function<void(const XmlElement&)>& read) {
    for (const XmlElement* element : xml_.children(root_, name)) {
      names_.check(*element, known);
      attempt([&] { read(*element); });
    }
  }

  RobotSemantics finish() {
    for (const Strays& strays : strays_) {
      log_.warn(strays.count == 1 ? strays.first : summary(strays));
    }
    log_.add_content("disabled pairs", result_.disabled.size());
    log_.add_content("groups", result_.groups.size());
    log_.add_content("states", result_.states.size());
    log_.add_content("end effectors", result_.end_effectors.size());
    result_.report = log_.finish();
    result_.warnings = result_.report.warnings;
    return std::move(result_);
  }

  static ParseError summary(const Strays& strays) {
    const std::string message = std::to_string(strays.count) + " elements name " + strays.kind +
                                ", and are left out there: " + detail::some_of(strays.names);
    return {strays.first.path(), strays.first.line().value_or(1), message};
  }

  /// Notes an element that names something which the robot does not have; it has no effect.
  void stray(const XmlElement& where, const char* kind, const std::string& name,
             const std::string& message) {
    auto known = std::find_if(strays_.begin(), strays_.end(),
                              [&](const Strays& entry) { return entry.kind == kind; });
    if (known == strays_.end()) {
      strays_.push_back({kind, xml_.error(where, message), 0, {}});
      known = strays_.end() - 1;
    }
    ++known->count;
    if (names_of_strays_.emplace(kind, name).second) {
      known->names.push_back(name);
    }
  }

  void read_name() {
    result_.robot = xml_.text(root_, "name");
    if (result_.robot != robot_.name()) {
      log_.warn(xml_.error(
          root_, "describes robot '" + result_.robot + "', the model is '" + robot_.name() + "'"));
    }
  }

  /// The link of an attribute; none, with a warning, if the robot has no such link.
  std::optional<std::size_t> link(const XmlElement& element, const char* attribute) {
    const std::string name = xml_.text(element, attribute);
    const std::optional<std::size_t> found = robot_.find_link(name);
    if (!found) {
      stray(element, "links that the robot does not have", name,
            "'" + name + "' is not a link of the robot");
    }
    return found;
  }

  std::optional<std::size_t> joint(const XmlElement& element, const char* attribute) {
    const std::string name = xml_.text(element, attribute);
    const std::optional<std::size_t> found = robot_.find_joint(name);
    if (!found) {
      stray(element, "joints that the robot does not have", name,
            "'" + name + "' is not a joint of the robot");
    }
    return found;
  }

  bool has_group(const XmlElement& element, const std::string& name) {
    const bool found = group_elements_.find(name) != group_elements_.end();
    if (!found) {
      stray(element, "groups that there are not", name, "there is no group '" + name + "'");
    }
    return found;
  }

  void read_disabled() {
    for_each("disable_default_collisions", srdf_names().link, [&](const XmlElement& element) {
      if (const auto disabled = link(element, "link")) {
        for (std::size_t other = 0; other < robot_.links().size(); ++other) {
          if (other != *disabled) {
            disabled_.emplace(std::minmax(*disabled, other), "Default");
          }
        }
      }
    });
    for_each("enable_collisions", srdf_names().pair, [&](const XmlElement& element) {
      if (const auto pair = link_pair(element)) {
        disabled_.erase(*pair);
      }
    });
    for_each("disable_collisions", srdf_names().pair, [&](const XmlElement& element) {
      if (const auto pair = link_pair(element)) {
        const char* reason = element.Attribute("reason");
        disabled_.emplace(*pair, reason != nullptr ? reason : "");
      }
    });
    for (const auto& [pair, reason] : disabled_) {
      result_.disabled.push_back({pair.first, pair.second, reason});
    }
  }

  std::optional<std::pair<std::size_t, std::size_t>> link_pair(const XmlElement& element) {
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
    for_each("group", srdf_names().group, [&](const XmlElement& element) {
      if (!group_elements_.emplace(xml_.text(element, "name"), &element).second) {
        xml_.fail(element, "a second group of this name; rename one of them");
      }
      groups_.push_back(&element);
    });
    for (const XmlElement* element : groups_) {
      if (broken_.contains(element)) {
        continue;
      }
      std::set<const XmlElement*> open;
      try {
        const Members& all = members(*element, open);
        result_.groups.push_back({xml_.text(*element, "name"),
                                  {all.links.begin(), all.links.end()},
                                  {all.joints.begin(), all.joints.end()}});
      } catch (const ParseError& error) {
        log_.add_error(error);
        broken_.insert(open.begin(), open.end());
      }
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
    constexpr std::size_t kDeepest = 100;  // Each level takes stack.
    if (const auto known = members_.find(&group); known != members_.end()) {
      return known->second;
    }
    if (broken_.contains(&group)) {
      xml_.fail(group, "the group is part of another one, but not right itself");
    }
    if (!open.insert(&group).second) {
      xml_.fail(group, "the group contains itself");
    }
    if (open.size() > kDeepest) {
      xml_.fail(group, "expected groups that contain each other at most " +
                           std::to_string(kDeepest) + " deep");
    }
    Members result;
    for (const XmlElement* element : member_elements(group, "link")) {
      if (const auto found = link(*element, "name")) {
        add_link(result, *found);
      }
    }
    for (const char* kind : {"joint", "passive_joint"}) {
      for (const XmlElement* element : member_elements(group, kind)) {
        if (const auto found = joint(*element, "name")) {
          result.joints.insert(*found);
          result.links.insert(robot_.child_link(*found));
        }
      }
    }
    for (const XmlElement* element : xml_.children(group, "chain")) {
      add_chain(result, *element);
    }
    add_groups(result, group, open);
    open.erase(&group);
    return members_.emplace(&group, std::move(result)).first->second;
  }

  std::vector<const XmlElement*> member_elements(const XmlElement& group, const char* kind) {
    std::vector<const XmlElement*> elements = xml_.children(group, kind);
    for (const XmlElement* element : elements) {
      names_.check(*element, srdf_names().member);
    }
    return elements;
  }

  void add_groups(Members& result, const XmlElement& group, std::set<const XmlElement*>& open) {
    for (const XmlElement* element : member_elements(group, "group")) {
      const std::string name = xml_.text(*element, "name");
      if (has_group(*element, name)) {
        const Members& more = members(*group_elements_.find(name)->second, open);
        result.links.insert(more.links.begin(), more.links.end());
        result.joints.insert(more.joints.begin(), more.joints.end());
      }
    }
  }

  void add_chain(Members& members, const XmlElement& element) {
    names_.check(element, srdf_names().chain);
    const auto base = link(element, "base_link");
    const auto tip = link(element, "tip_link");
    if (!base || !tip) {
      return;
    }
    // For two arms it is their torso.
    const std::size_t top = robot_.last_common_ancestor(*base, *tip);
    if (top == *base) {
      members.links.insert(top);  // As in MoveIt, without the joint above it.
    } else {
      add_link(members, top);
    }
    for (const std::size_t end : {*base, *tip}) {
      for (const std::size_t joint : robot_.chain(top, end)) {
        add_link(members, robot_.child_link(joint));
      }
    }
  }

  void read_state(const XmlElement& element) {
    GroupState state{
        .name = xml_.text(element, "name"), .group = xml_.text(element, "group"), .values = {}};
    has_group(element, state.group);
    if (!names_of_states_.emplace(state.group, state.name).second) {
      xml_.fail(element,
                "a second state of this name in group '" + state.group + "'; rename one of them");
    }
    for (const XmlElement* value : xml_.children(element, "joint")) {
      names_.check(*value, srdf_names().value);
      attempt([&] { read_value(*value, state); });
    }
    result_.states.push_back(std::move(state));
  }

  void read_value(const XmlElement& element, GroupState& state) {
    const auto found = joint(element, "name");
    if (!found) {
      return;
    }
    const std::vector<double> coordinates = xml_.numbers(element, "value");
    const Joint& known = robot_.joints()[*found];
    if (known.type == JointType::fixed) {
      stray(element, "joints of a state that are fixed", known.name,
            "the joint is fixed: its position in a state is left out");
      return;
    }
    const std::size_t count = known.type == JointType::floating ? 7 : coordinate_count(known.type);
    if (coordinates.size() != count) {
      xml_.fail(element, "expected as many numbers in 'value' as the joint has coordinates, " +
                             std::to_string(count) + ", got " + std::to_string(coordinates.size()));
    }
    if (known.type == JointType::floating) {
      require_unit_quaternion(element, coordinates);
    }
    const auto given = std::ranges::find(state.values, *found, &GroupState::JointValue::joint);
    if (given == state.values.end()) {
      state.values.push_back({*found, coordinates});
    } else if (given->coordinates != coordinates) {
      xml_.fail(element, "the state has another position of this joint; remove one of the two");
    }
  }

  void require_unit_quaternion(const XmlElement& element, const std::vector<double>& pose) const {
    constexpr double kSlack = 1e-6;
    const double length = std::hypot(std::hypot(pose[3], pose[4]), std::hypot(pose[5], pose[6]));
    if (!(std::abs(length - 1.0) <= kSlack)) {
      xml_.fail(element,
                "expected x, y, z and a quaternion x, y, z, w of length 1 in 'value', got one of "
                "length " +
                    std::to_string(length));
    }
  }

  void read_end_effector(const XmlElement& element) {
    const std::string group = xml_.text(element, "group");
    if (!has_group(element, group)) {
      return;
    }
    if (const auto parent = link(element, "parent_link")) {
      result_.end_effectors.push_back({xml_.text(element, "name"), group, *parent});
    }
  }

  XmlReader xml_;
  detail::ReadingLog log_;
  detail::XmlNameCheck names_;
  const RobotModel& robot_;
  const XmlElement& root_;
  RobotSemantics result_;
  std::vector<Strays> strays_;
  std::set<std::pair<std::string, std::string>> names_of_strays_;  // Names by kind.
  std::map<std::pair<std::size_t, std::size_t>, std::string> disabled_;
  std::map<std::string, const XmlElement*, std::less<>> group_elements_;
  std::vector<const XmlElement*> groups_;  // In the order of the file.
  std::map<const XmlElement*, Members> members_;
  std::set<const XmlElement*> broken_;  // Groups whose errors are reported.
  std::set<std::pair<std::string, std::string>> names_of_states_;  // Names by group.
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

RobotSemantics read_srdf(const std::filesystem::path& path, const RobotModel& robot,
                         const ReadingOptions& options) {
  return parse_srdf(detail::read_file(path, "an SRDF file"), path.string(), robot, options);
}

RobotSemantics parse_srdf(std::string_view text, const std::string& source, const RobotModel& robot,
                          const ReadingOptions& options) {
  return SrdfReader(text, source, robot, options).semantics();
}

}  // namespace firstcontact
