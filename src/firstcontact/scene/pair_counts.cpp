#include <firstcontact/scene/pair_counts.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <variant>

#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/detail/member_classes.h>
#include <firstcontact/scene/loaded_scene.h>

namespace firstcontact {
namespace {

using detail::code;
using detail::MemberClasses;
using detail::ordered;
using Kind = detail::MemberKind;

constexpr std::size_t kKinds = 4;
constexpr std::size_t kReasons = 7;

/// Number of pairs whose names are kept.
constexpr std::size_t kNamed = 3;

/// Number of pairs after which the search for names ends.
constexpr std::size_t kLookedAt = 1'000'000;

std::size_t index(Kind kind) { return static_cast<std::size_t>(kind); }

std::size_t pairs_within(std::size_t n) { return n < 2 ? 0 : n * (n - 1) / 2; }

/// Counts each pair once, under the first reason that holds.
class PairCounter {
 public:
  /// @param kinds  one for each member
  PairCounter(const LoadedScene& loaded, std::vector<Kind> kinds)
      : loaded_(loaded),
        scene_(loaded.scene),
        kinds_(std::move(kinds)),
        classes_(scene_, kinds_),
        first_pairs_(kReasons) {}

  PairCounts count() {
    for (std::size_t robot = 0; robot < scene_.robots.size(); ++robot) {
      take_links(robot);
    }
    for (const BodyPair& pair : scene_.allowed_pairs) {
      take(pair, WhyUntested::allowed_collisions);
    }
    take_held();
    for (const BodyPair& pair : scene_.ignored_pairs) {
      take(pair, WhyUntested::rule);
    }
    take_groups();
    leave_out();
    return result();
  }

 private:
  [[nodiscard]] bool can_touch(std::size_t member) const {
    return kinds_[member] != Kind::cannot_touch;
  }

  /// Counts the pair of a rule for pairs.
  void take(const BodyPair& members, WhyUntested why) {
    const BodyPair pair = ordered(members);
    if (pair[0] != pair[1] && can_touch(pair[0]) && can_touch(pair[1]) &&
        taken_.insert(code(pair)).second) {
      already_[classes_.class_pair(pair)] += 1;
      add(why, kinds_[pair[0]], kinds_[pair[1]], 1);
      name(why, pair);
    }
  }

  void add(WhyUntested why, Kind a, Kind b, std::size_t count) {
    counts_[static_cast<std::size_t>(why)] += count;
    ignored_of_[std::min(index(a), index(b))][std::max(index(a), index(b))] += count;
  }

  void name(WhyUntested why, const BodyPair& pair) {
    auto& named = first_pairs_[static_cast<std::size_t>(why)];
    if (named.size() < kNamed) {
      named.push_back({member_name(scene_, pair[0]), member_name(scene_, pair[1])});
    }
  }

  void take_links(std::size_t robot) {
    const RobotModel& model = scene_.robots[robot].model;
    const std::size_t first = first_member(scene_, robot);
    for (std::size_t a = 0; a < model.links().size(); ++a) {
      for (std::size_t b = a + 1; b < model.links().size(); ++b) {
        if (model.are_adjacent(a, b) || model.rigid_root(a) == model.rigid_root(b)) {
          take({first + a, first + b}, WhyUntested::joined_links);
        }
      }
    }
    for (const DisabledPair& pair : scene_.robots[robot].semantics.disabled) {
      take({first + pair.link, first + pair.other}, WhyUntested::srdf);
    }
  }

  /// Counts the pairs of bodies that a link holds from the start to the end.
  void take_held() {
    const auto attachments =
        loaded_.robots ? loaded_.robots->attachments() : std::span<const Attachment>();
    for (const Attachment& attachment : attachments) {
      if (attachment.t_from > 0.0 || attachment.t_to < 1.0) {
        continue;
      }
      take({attachment.body, attachment.link}, WhyUntested::held);
      for (const std::size_t link : attachment.touch_links) {
        take({attachment.body, link}, WhyUntested::held);
      }
    }
  }

  /// Counts the pairs of rules for groups that are not counted yet.
  void take_groups() {
    for (const BodyPair& pair : classes_.ignored()) {
      const std::vector<std::size_t>& a = classes_.members(pair[0]);
      const std::vector<std::size_t>& b = classes_.members(pair[1]);
      if (!can_touch(a.front()) || !can_touch(b.front())) {
        continue;
      }
      const std::size_t all = pair[0] == pair[1] ? pairs_within(a.size()) : a.size() * b.size();
      const auto already = already_.find(code(pair));
      const std::size_t others = all - (already == already_.end() ? 0 : already->second);
      add(WhyUntested::rule, kinds_[a.front()], kinds_[b.front()], others);
      if (others > 0) {
        name_some(WhyUntested::rule, a, b,
                  [this](const BodyPair& members) { return !taken_.contains(code(members)); });
      }
    }
  }

  /// Keeps the names of some wanted pairs of two lists of members.
  template <class IsWanted>
  void name_some(WhyUntested why, const std::vector<std::size_t>& first,
                 const std::vector<std::size_t>& second, const IsWanted& is_wanted) {
    const auto& named = first_pairs_[static_cast<std::size_t>(why)];
    std::size_t looked_at = 0;
    for (const std::size_t a : first) {
      for (const std::size_t b : second) {
        if (named.size() == kNamed || ++looked_at > kLookedAt) {
          return;
        }
        const bool is_own = kinds_[a] == kinds_[b] && &first == &second;
        if (a != b && (!is_own || a < b) && is_wanted(ordered({a, b}))) {
          name(why, ordered({a, b}));
        }
      }
    }
  }

  [[nodiscard]] std::vector<std::size_t> members_of(Kind kind) const {
    std::vector<std::size_t> members;
    for (std::size_t k = 0; k < kinds_.size(); ++k) {
      if (kinds_[k] == kind) {
        members.push_back(k);
      }
    }
    return members;
  }

  void leave_out() {
    const std::vector<std::size_t> scripted = members_of(Kind::scripted);
    const std::vector<std::size_t> resting = members_of(Kind::rests);
    leave_out(WhyUntested::both_scripted, scripted, scripted);
    leave_out(WhyUntested::both_scripted, scripted, resting);
    leave_out(WhyUntested::both_rest, resting, resting);
  }

  /// Counts the pairs of two lists that no rule ignores.
  void leave_out(WhyUntested why, const std::vector<std::size_t>& first,
                 const std::vector<std::size_t>& second) {
    if (first.empty() || second.empty()) {
      return;
    }
    const bool is_own = &first == &second;
    const std::size_t all = is_own ? pairs_within(first.size()) : first.size() * second.size();
    const std::size_t a = index(kinds_[first.front()]);
    const std::size_t b = index(kinds_[second.front()]);
    const std::size_t count = all - ignored_of_[std::min(a, b)][std::max(a, b)];
    counts_[static_cast<std::size_t>(why)] += count;
    if (count > 0) {
      name_some(why, first, second, [this](const BodyPair& pair) {
        return !taken_.contains(code(pair)) && !classes_.is_ignored(pair);
      });
    }
  }

  [[nodiscard]] PairCounts result() const {
    PairCounts result;
    result.members = static_cast<std::size_t>(
        std::ranges::count_if(kinds_, [](Kind kind) { return kind != Kind::cannot_touch; }));
    result.tested = pairs_within(result.members);
    for (std::size_t why = 0; why < first_pairs_.size(); ++why) {
      if (counts_[why] > 0) {
        result.tested -= counts_[why];
        result.untested.push_back({static_cast<WhyUntested>(why), counts_[why], first_pairs_[why]});
      }
    }
    return result;
  }

  const LoadedScene& loaded_;
  const Scene& scene_;
  std::vector<Kind> kinds_;
  MemberClasses classes_;
  std::unordered_set<std::uint64_t> taken_;
  std::unordered_map<std::uint64_t, std::size_t> already_;            // By pair of classes.
  std::array<std::array<std::size_t, kKinds>, kKinds> ignored_of_{};  // By two kinds, in order.
  std::array<std::size_t, kReasons> counts_{};                        // By reason.
  std::vector<std::vector<std::array<std::string, 2>>> first_pairs_;  // By reason.
};

bool is_at_rest(const BodyMotion& motion) { return std::holds_alternative<FixedMotion>(motion); }

Kind kind_of_links(const SceneRobot& robot) {
  if (robot.dynamics) {
    return Kind::moved;
  }
  return robot.trajectory.points.size() > 1 || !is_at_rest(robot.base) ? Kind::scripted
                                                                       : Kind::rests;
}

/// Whether a member can touch: a link may have no geometry, a body has some.
bool has_geometry(const LoadedScene& loaded, std::size_t member) {
  return !loaded.robots || !loaded.robots->geometries(member).empty();
}

std::size_t count_members(const LoadedScene& loaded) {
  return loaded.robots ? loaded.robots->size() : loaded.scene.bodies.size();
}

std::size_t sum_of(const PairCounts& counts, bool ignored) {
  std::size_t sum = 0;
  for (const UntestedPairs& pairs : counts.untested) {
    sum += is_ignored(pairs.why) == ignored ? pairs.count : 0;
  }
  return sum;
}

}  // namespace

std::size_t PairCounts::ignored() const { return sum_of(*this, true); }

std::size_t PairCounts::left_out() const { return sum_of(*this, false); }

bool is_ignored(WhyUntested why) {
  return why != WhyUntested::both_rest && why != WhyUntested::both_scripted;
}

PairCounts count_checked_pairs(const LoadedScene& loaded) {
  std::vector<Kind> kinds;
  for (std::size_t member = 0; member < count_members(loaded); ++member) {
    const bool rests = loaded.robots && loaded.robots->rests(member);
    kinds.push_back(!has_geometry(loaded, member) ? Kind::cannot_touch
                    : rests                       ? Kind::rests
                                                  : Kind::moved);
  }
  return PairCounter(loaded, std::move(kinds)).count();
}

PairCounts count_simulated_pairs(const LoadedScene& loaded) {
  std::vector<Kind> kinds;
  for (const Body& body : loaded.scene.bodies) {
    kinds.push_back(body.free                 ? Kind::moved
                    : is_at_rest(body.motion) ? Kind::rests
                                              : Kind::scripted);
  }
  for (const SceneRobot& robot : loaded.scene.robots) {
    for (std::size_t link = 0; link < robot.model.links().size(); ++link) {
      kinds.push_back(has_geometry(loaded, kinds.size()) ? kind_of_links(robot)
                                                         : Kind::cannot_touch);
    }
  }
  return PairCounter(loaded, std::move(kinds)).count();
}

}  // namespace firstcontact
