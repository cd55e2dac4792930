#include <firstcontact/foreign_scenes/detail/allowed_collisions.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <firstcontact/text/write_json.h>
#include <firstcontact/trajectory_files/detail/joint_trajectory.h>
#include <firstcontact/trajectory_files/detail/ros_message.h>

namespace firstcontact {
namespace detail {
namespace {

bool read_flag(const JsonValue& value, const JsonReader& read) {
  const auto* number = std::get_if<double>(&value.value);
  if (number != nullptr && (*number == 0.0 || *number == 1.0)) {
    return *number == 1.0;
  }
  return read.boolean(value);
}

std::vector<std::string> read_names(const JsonValue& matrix, std::string_view key,
                                    const JsonReader& read) {
  std::vector<std::string> names;
  if (const JsonValue* list = find_filled(matrix, key)) {
    for (const JsonValue& name : read.array(*list, "an array of names")) {
      names.push_back(name_of(name, "a name", read));
    }
  }
  return names;
}

/// Reads the rows: one for each name, each as long as there are names: [true, false] or {enabled:
/// [...]}.
void read_entries(const JsonValue& matrix, AllowedCollisions& allowed, const JsonReader& read) {
  const std::vector<std::string> names = read_names(matrix, "entry_names", read);
  if (names.empty()) {
    return;
  }
  const JsonValue& values = read.member(matrix, "entry_values");
  const std::string expected = "a row of " + std::to_string(names.size()) + " for each of the " +
                               std::to_string(names.size()) + " entry_names";
  const JsonArray& rows = read.array(values, expected);
  if (rows.size() != names.size()) {
    read.fail(values, "expected " + expected + ", got " + std::to_string(rows.size()) + " rows");
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const JsonValue* enabled = find_filled(rows[i], "enabled");
    const JsonValue& list = enabled != nullptr ? *enabled : rows[i];
    const JsonArray& row = read.array(list, expected);
    if (row.size() != names.size()) {
      read.fail_expected(expected, list);
    }
    for (std::size_t j = 0; j < row.size(); ++j) {
      const bool flag = read_flag(row[j], read);
      if (names[i] == names[j]) {
        continue;
      }
      const auto [known, is_new] = allowed.entries.insert(
          {{std::min(names[i], names[j]), std::max(names[i], names[j])}, flag});
      if (!is_new && known->second != flag) {
        read.fail(row[j], "expected the same for " + in_quotes(names[i]) + " and " +
                              in_quotes(names[j]) + " as for them swapped");
      }
    }
  }
}

void read_defaults(const JsonValue& matrix, AllowedCollisions& allowed, const JsonReader& read) {
  const std::vector<std::string> names = read_names(matrix, "default_entry_names", read);
  if (names.empty()) {
    return;
  }
  const JsonValue& values = read.member(matrix, "default_entry_values");
  const JsonArray& flags = read.array(values, "an array of true and false");
  if (flags.size() != names.size()) {
    read.fail(values, "expected a value for each of the " + std::to_string(names.size()) +
                          " default_entry_names, got " + std::to_string(flags.size()));
  }
  for (std::size_t k = 0; k < names.size(); ++k) {
    allowed.defaults[names[k]] = read_flag(flags[k], read);
  }
}

}  // namespace

AllowedCollisions read_allowed_collisions(const JsonValue& matrix, const JsonReader& read) {
  (void)read.object(
      matrix, {{"entry_names", "entry_values", "default_entry_names", "default_entry_values"}});
  AllowedCollisions allowed;
  read_entries(matrix, allowed, read);
  read_defaults(matrix, allowed, read);
  return allowed;
}

}  // namespace detail

bool AllowedCollisions::allows(const std::string& name, const std::string& other) const {
  const auto entry = entries.find({std::min(name, other), std::max(name, other)});
  if (entry != entries.end()) {
    return entry->second;
  }
  const auto first = defaults.find(name);
  const auto second = defaults.find(other);
  if (first == defaults.end() && second == defaults.end()) {
    return false;
  }
  return (first == defaults.end() || first->second) && (second == defaults.end() || second->second);
}

}  // namespace firstcontact
