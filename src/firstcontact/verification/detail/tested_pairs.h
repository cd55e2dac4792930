/// @file
/// The verifier's own account of the tested pairs of a scene, with their times and margins.

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/verification/detail/time_span.h>

namespace firstcontact {
struct Scene;
}

namespace firstcontact::detail {

/// The tested pairs. Members are numbered as those of the scene.
class TestedPairs {
 public:
  /// @param rests  for each body whether it never moves
  TestedPairs(const Scene& scene, const std::vector<bool>& rests);

  /// [m]  The margin with paddings; none where the pair is never tested.
  [[nodiscard]] std::optional<double> margin(const BodyPair& pair) const;

  /// [m]  The greatest margin of all pairs.
  [[nodiscard]] double greatest_margin() const { return greatest_margin_; }

  /// The pairs of a body and a link that holds it for a while.
  [[nodiscard]] std::vector<BodyPair> held_pairs() const;

  /// The spans of time in which a pair is tested, in order: those in which no link holds the body.
  [[nodiscard]] std::vector<TimeSpan> spans(const BodyPair& pair) const;

 private:
  struct LinkOf {
    std::size_t robot = 0;
    std::size_t link = 0;
    std::size_t rigid_root = 0;
  };

  void add_links(const Scene& scene);
  void add_attachments(const Scene& scene);
  void add_rules(const Scene& scene);
  [[nodiscard]] bool is_left_out(const BodyPair& pair) const;
  [[nodiscard]] static std::uint64_t key(std::size_t a, std::size_t b);

  bool has_robots_ = false;
  double margin_ = 0.0;
  double greatest_margin_ = 0.0;
  std::vector<bool> rests_;
  std::vector<std::optional<LinkOf>> links_;  // For each member.
  std::vector<double> paddings_;
  std::unordered_set<std::uint64_t> joined_;  // Pairs of links that one joint connects.
  std::unordered_set<std::uint64_t> ignored_;
  std::unordered_map<std::uint64_t, double> margins_;
  std::vector<std::vector<std::size_t>> groups_of_;  // For each member.
  std::unordered_set<std::uint64_t> ignored_groups_;
  std::unordered_map<std::uint64_t, double> group_margins_;
  std::map<BodyPair, std::vector<TimeSpan>> held_;
};

}  // namespace firstcontact::detail
