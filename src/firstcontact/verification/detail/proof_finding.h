/// @file
/// The finding of a proof about a pair.

#pragma once

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/verification/detail/time_span.h>
#include <firstcontact/verification/proof_verdict.h>

namespace firstcontact::detail {

/// The reason of a finding.
enum class ProofReason {
  none,
  closer,  ///< Closer than the margin.
  inside,  ///< One begins inside of the other.
  perhaps_inside,
  apart,           ///< At a contact: farther apart than the margin and the tolerance.
  perhaps_errors,  ///< At a contact: tracking errors may or may not explain it.
  too_close,       ///< Too close for the arithmetic to distinguish from apart, or from a contact.
  work,
  stopped,
};

/// The finding about a pair. By default nothing contradicts the claim.
struct ProofFinding {
  ProofVerdict verdict = ProofVerdict::proven;
  ProofReason reason = ProofReason::none;
  BodyPair members = {};
  TimeSpan when = {};     ///< [-]
  double distance = 0.0;  ///< [m]  For `closer` and for a contact: upper bound of the distance.
  /// [-]  The unproven time before the end of a pair's claim.
  ///
  /// In it the pair's two bodies move by less than 2^-38 of their size.
  double left_open = 0.0;
};

}  // namespace firstcontact::detail
