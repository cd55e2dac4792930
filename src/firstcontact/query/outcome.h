/// @file
/// The outcome of a question about contact: of two shapes, of a pair of members, of a scene.

#pragma once

#include <algorithm>
#include <limits>
#include <optional>

#include <firstcontact/math/export.h>

namespace firstcontact {

/// The answer to a question about contact.
enum class Verdict {
  free,              ///< Proven: farther apart than the margin on all of [0, 1].
  contact,           ///< Proven: so before t; at t no farther than margin + tolerance.
  contact_at_start,  ///< As `contact`, with t = 0.
  undecided,         ///< Proven so before t, nothing known after it; see `reason`.
};

/// The reason why a search ended undecided.
enum class UndecidedReason { none, work, deadline, memory, precision, cancelled };

/// The word of a verdict in result files, such as "contact_at_start".
[[nodiscard]] FIRSTCONTACT_API const char* to_string(Verdict verdict);
/// The word of a reason in result files, such as "deadline".
[[nodiscard]] FIRSTCONTACT_API const char* to_string(UndecidedReason reason);

/// Whether a contact was found, at the start or later.
[[nodiscard]] constexpr bool is_contact(Verdict verdict) {
  return verdict == Verdict::contact || verdict == Verdict::contact_at_start;
}

/// The verdict and the numbers that are proven with it. The default claims nothing.
struct Outcome {
  Verdict verdict = Verdict::undecided;
  UndecidedReason reason = UndecidedReason::none;
  double t = 0.0;  ///< [-]  Normalised step time; [0, t) is proven free of contact; 1 when free.
  /// [-]  For `contact` t; for `undecided` a later time proven to be in contact, if one is known.
  std::optional<double> t_upper = {};
  double clearance = 0.0;  ///< [m]  Proven lower bound of the distance before t.
  double tolerance_used =
      0.0;  ///< [m]  Holds in place of the asked one; larger only if f64 needs it.
  double enclosure_error = 0.0;  ///< [m]  Sum of both shapes: adds to the tolerance of a contact.
};

/// The outcome where no pair is tested: free, infinitely far apart.
///
/// @param tolerance  [m]  that was asked for
[[nodiscard]] inline Outcome outcome_of_no_pair(double tolerance) {
  return {.verdict = Verdict::free,
          .t = 1.0,
          .clearance = std::numeric_limits<double>::infinity(),
          .tolerance_used = tolerance};
}

/// Whether `a` rather than `b` decides the outcome of both.
///
/// That is the one that ends what is proven earlier, or a contact at the same time. Its claim holds
/// for both, as neither touches before that time.
[[nodiscard]] inline bool decides_before(const Outcome& a, const Outcome& b) {
  if (a.verdict == Verdict::free || b.verdict == Verdict::free) {
    return a.verdict != Verdict::free && b.verdict == Verdict::free;
  }
  return a.t < b.t || (a.t == b.t && is_contact(a.verdict) && !is_contact(b.verdict));
}

/// Merges one more outcome into the outcome of all.
///
/// If several decide alike, the first one counts.
inline void merge(const Outcome& more, Outcome& all) {
  if (decides_before(more, all)) {
    all.verdict = more.verdict;
    all.reason = more.reason;
    all.t = more.t;
  }
  if (more.t_upper) {
    all.t_upper = std::min(all.t_upper.value_or(1.0), *more.t_upper);
  }
  all.clearance = std::min(all.clearance, more.clearance);
  all.tolerance_used = std::max(all.tolerance_used, more.tolerance_used);
  all.enclosure_error = std::max(all.enclosure_error, more.enclosure_error);
}

}  // namespace firstcontact
