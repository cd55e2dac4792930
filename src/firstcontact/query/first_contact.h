/// @file
/// First contact of two moving shapes: the question, its options and its answer.

#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stop_token>
#include <vector>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/export.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/query/contact.h>
#include <firstcontact/query/outcome.h>
#include <firstcontact/query/workspace.h>

namespace firstcontact {

/// A shape S and its motion X_WS(t) over the step, t in [0, 1].
struct MovingShape {
  const Shape& shape;
  const Motion& X_WS;
};

/// The limits of work at which a search ends with what is proven so far.
struct WorkBudget {
  std::uint64_t steps =
      std::numeric_limits<std::uint64_t>::max();  ///< Node groups + feature steps.
  std::size_t memory = std::size_t{1} << 30;      ///< [byte]  Size of the search queue.
  std::optional<std::chrono::steady_clock::time_point> deadline;
  std::stop_token stop;
};

/// The meaning of a start within margin + tolerance.
enum class StartContacts {
  report,  ///< A start within margin + tolerance is `contact_at_start`.
  /// A start there, but apart, holds the two bodies to half of their start distance d0.
  ///
  /// The half, to rounding, takes the place of the margin: d(t) > d0 / 2 before a contact. A
  /// contact is still within margin + tolerance. That holds for all features of both bodies,
  /// wherever they started: features that started farther apart than the margin are held to d0 / 2,
  /// too. So sliding, rolling and leaving go on however the surfaces are cut into triangles. As d0
  /// is above 0, nothing passes through anything. A start at distance 0 is `contact_at_start`.
  keep_half,
};

/// The choice of the feature pairs of two bodies, within the band at t, that are listed.
struct ContactState {
  enum class Kind { none, first, nearest, all };

  static constexpr std::size_t kUsual = 1000;

  Kind kind = Kind::nearest;
  std::size_t most = kUsual;  ///< No more are listed.

  static const ContactState none;   ///< None: only the time is computed.
  static const ContactState first;  ///< The feature pair that decided.
  static const ContactState all;    ///< All feature pairs, however many there are.

  /// Lists all as long as there are no more than `most`, else the nearest and some of every region.
  ///
  /// At most half of the listed pairs are the nearest in each cube of a grid around the bodies. The
  /// cubes are as small as this number allows. The others are the nearest of all
  /// (ContactSelection).
  ///
  /// Where there are more than `most` and more than 262,144 pairs, the search skips pairs that are
  /// far from being the nearest. It neither counts nor chooses them beyond that number.
  ///
  /// @param most  >= 1
  static constexpr ContactState nearest(std::size_t most = kUsual) { return {Kind::nearest, most}; }

  friend bool operator==(const ContactState&, const ContactState&) = default;
};

inline constexpr ContactState ContactState::none{Kind::none, 0};
inline constexpr ContactState ContactState::first{Kind::first, 1};
inline constexpr ContactState ContactState::all{Kind::all, std::numeric_limits<std::size_t>::max()};

/// The options of a first contact.
struct FirstContactOptions {
  double margin = 0.0;      ///< [m]  Closer than this counts as contact; >= 0.
  double tolerance = 1e-6;  ///< [m]  A reported contact is no farther than margin + tolerance; > 0.
  StartContacts start_contacts = StartContacts::report;
  ContactState contacts = ContactState::nearest();
  double contact_band = 0.0;  ///< [m]  Reports pairs within margin + tolerance + band; >= 0.
  WorkBudget budget = {};     ///< Beyond this much work the verdict is `undecided`, never a guess.
};

/// Work done, for budgets and benchmarks.
struct WorkCount {
  std::uint64_t node_groups = 0;     ///< Evaluations of up to 16 node pairs.
  std::uint64_t triangle_pairs = 0;  ///< Triangle pairs visited.
  std::uint64_t steps = 0;           ///< Certified steps of triangle pairs.

  [[nodiscard]] std::uint64_t total() const { return node_groups + triangle_pairs + steps; }

  WorkCount& operator+=(const WorkCount& other) {
    node_groups += other.node_groups;
    triangle_pairs += other.triangle_pairs;
    steps += other.steps;
    return *this;
  }
};

/// The outcome, the contacts at its time, and the work.
struct FirstContactResult : Outcome {
  std::vector<Contact> contacts;  ///< The contacts at t that were asked for, sorted by features.
  ContactCount contact_count;     ///< Number of contacts at t, those included that are not listed.
  WorkCount work;
};

/// Finds the first contact of A and B during the step.
///
/// Safe to act on whatever the verdict: before t the shapes are farther apart than the margin.
/// Holds for the exact motions that the input defines, in the arithmetic as executed
/// (docs/algorithm.md has the proof). Symmetric in A and B, and the same on every run.
///
/// A body inside a solid one at t = 0 is `contact_at_start`. Its contact is a vertex that lies
/// inside and a face of the solid, at distance 0. Nothing gets inside later without contact.
///
/// Thread-safe: the shapes and motions are only read; each thread brings its own workspace.
///
/// @throws std::invalid_argument if an option is outside its documented range.
[[nodiscard]] FIRSTCONTACT_API FirstContactResult
first_contact(const MovingShape& A, const MovingShape& B, Workspace& workspace,
              const FirstContactOptions& options = {});

/// Finds the first contact in the memory of `result`. With a warm workspace and result nothing is
/// allocated.
FIRSTCONTACT_API void first_contact(const MovingShape& A, const MovingShape& B,
                                    Workspace& workspace, const FirstContactOptions& options,
                                    FirstContactResult& result);

}  // namespace firstcontact
