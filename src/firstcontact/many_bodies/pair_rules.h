/// @file
/// Rules for pairs of bodies: which of them are tested, and how far apart they have to stay.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include <firstcontact/math/export.h>

namespace firstcontact {

/// Two bodies by their index, first < second.
using BodyPair = std::array<std::size_t, 2>;

/// Rules for pairs of bodies and for groups of them.
///
/// A pair that any rule ignores is not tested. The margin of a tested pair is its own; or else the
/// greatest that groups give it; or else the general one.
class FIRSTCONTACT_API PairRules {
 public:
  /// Makes rules that ignore no pair.
  ///
  /// @param margin  [m]  of every pair without another one; finite, >= 0
  /// @throws std::invalid_argument, as all functions here, on a margin outside its range, a pair of
  ///         a body with itself, or a group that does not exist
  explicit PairRules(double margin = 0.0);

  /// Ignores a pair.
  void ignore(const BodyPair& pair);
  void set_margin(const BodyPair& pair, double margin);  ///< Sets the margin of a pair [m].

  /// Adds a group and returns its number. A body may be in several groups.
  std::size_t add_group(std::vector<std::size_t> bodies);
  /// Ignores all pairs of a body of one group with a body of the other. For a group and itself it
  /// ignores all pairs in the group.
  void ignore_groups(std::size_t group, std::size_t other);
  /// Sets the margin of such pairs [m].
  void set_group_margin(std::size_t group, std::size_t other, double margin);

  /// [m]  The margin of a pair; none where the pair is not tested.
  [[nodiscard]] std::optional<double> margin(const BodyPair& pair) const;

  /// [m]  The greatest margin of any pair of each of n bodies, as an upper bound.
  [[nodiscard]] std::vector<double> greatest_margins(std::size_t n) const;

  /// [m]  A lower bound of all margins: no pair has a smaller one.
  [[nodiscard]] double least_margin() const { return least_; }

 private:
  struct Rule {
    std::optional<double> margin;  // None: ignored.
  };
  struct GroupRule {
    std::size_t group;
    std::size_t other;
    Rule rule;
  };
  [[nodiscard]] bool contains(std::size_t group, std::size_t body) const {
    return body < is_member_[group].size() && is_member_[group][body];
  }
  void add(std::size_t group, std::size_t other, const Rule& rule);
  double take(double margin);

  double margin_;
  double least_;
  std::unordered_map<std::uint64_t, Rule> pairs_;
  std::vector<std::vector<std::size_t>> groups_;
  std::vector<std::vector<bool>> is_member_;  // For each group and body.
  std::vector<GroupRule> group_rules_;
};

}  // namespace firstcontact
