/// @file
/// The pairs of a scene that an answer is about: how many are looked at, and which are not.

#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/math/export.h>

namespace firstcontact {

struct LoadedScene;

/// The reason why a pair is not looked at.
///
/// The first five come from the scene and its robots: the pair is ignored. The others come from the
/// kind of question: the pair is left out.
enum class WhyUntested {
  joined_links,        ///< Links of one robot that one joint, or fixed joints, connect.
  srdf,                ///< The robot's SRDF disables the pair.
  allowed_collisions,  ///< A planning scene allows it to touch.
  held,                ///< A link holds the body over the whole step, or may touch it meanwhile.
  rule,                ///< "pairs.ignore" of the scene.
  both_rest,           ///< Neither of the two moves.
  both_scripted,       ///< In a simulation: neither of the two is free, and one of them moves.
};

/// The words of WhyUntested in files and in Python, in this order.
inline constexpr std::array<const char*, 7> kWhyUntestedWords{
    "joined_links", "srdf", "allowed_collisions", "held", "rule", "both_rest", "both_scripted"};

/// Pairs that are not looked at for one reason.
struct UntestedPairs {
  WhyUntested why = WhyUntested::rule;
  std::size_t count = 0;
  std::vector<std::array<std::string, 2>> first = {};  ///< Names of the first few.
};

/// The counts of the pairs of a scene: each is tested, or is among the untested ones of one reason.
///
/// Members here are the bodies and those links of robots that have geometry. n members have n
/// (n - 1) / 2 pairs.
struct PairCounts {
  std::size_t members = 0;  ///< Number of members that can touch.
  std::size_t tested = 0;
  std::vector<UntestedPairs> untested = {};  ///< The untested pairs by reason, in the order of
                                             ///< reasons; no entry is empty.

  [[nodiscard]] FIRSTCONTACT_API std::size_t ignored() const;   ///< Number of pairs with one of the
                                                                ///< first five reasons.
  [[nodiscard]] FIRSTCONTACT_API std::size_t left_out() const;  ///< Number of pairs with one of the
                                                                ///< other reasons.
};

/// Whether pairs of this kind are ignored, or else left out.
[[nodiscard]] FIRSTCONTACT_API bool is_ignored(WhyUntested why);

/// Counts the pairs that a check of the scene tests.
///
/// The cost is O(n + rules) for n members, and O(m n) where m of them are links of robots.
[[nodiscard]] FIRSTCONTACT_API PairCounts count_checked_pairs(const LoadedScene& loaded);

/// Counts the pairs that a simulation of the scene holds apart and that verify_run() proves.
///
/// In each of them one member is a free body, or a link of a robot with dynamics. The cost is that
/// of count_checked_pairs().
[[nodiscard]] FIRSTCONTACT_API PairCounts count_simulated_pairs(const LoadedScene& loaded);

/// A number of pairs in words: "3 pairs", "no pair".
[[nodiscard]] FIRSTCONTACT_API std::string pairs_text(std::size_t count);

/// Describes untested pairs: "2 by the scene's rules: a and b, a and c".
[[nodiscard]] FIRSTCONTACT_API std::string describe(const UntestedPairs& pairs);

/// The warning where no pair is tested; empty where any is.
[[nodiscard]] FIRSTCONTACT_API std::string no_pair_warning(const PairCounts& counts);

/// The word of a reason in result files, such as "both_scripted".
[[nodiscard]] FIRSTCONTACT_API const char* word(WhyUntested why);

}  // namespace firstcontact
