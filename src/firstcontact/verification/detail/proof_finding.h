/// @file
/// What a proof found of a pair.

#pragma once

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/verification/detail/time_span.h>
#include <firstcontact/verification/proof_verdict.h>

namespace firstcontact::detail {

enum class ProofReason {
  none,
  closer,  ///< Than the margin.
  inside,  ///< One begins inside of the other.
  perhaps_inside,
  apart,      ///< At a contact: farther than the margin and the tolerance.
  enclosed,   ///< The triangles around a curved body come closer, the body perhaps not.
  too_close,  ///< To be told apart, or from a contact, by the arithmetic.
  work,
  stopped,
};

/// What was found of a pair. The default is that nothing contradicts the claim.
struct ProofFinding {
  ProofVerdict verdict = ProofVerdict::proven;
  ProofReason reason = ProofReason::none;
  BodyPair members = {};
  TimeSpan when = {};     ///< [-]
  double distance = 0.0;  ///< [m]  For closer and a contact: no farther apart than this.
  /// [-]  Proven is all but so much before the end of a pair's claim, in which its two bodies move
  /// by less than 2^-38 of their size.
  double left_open = 0.0;
};

}  // namespace firstcontact::detail
