/// @file
/// The verdict of a second proof of a file.

#pragma once

#include <array>

#include <firstcontact/math/export.h>

namespace firstcontact {

/// The verdict of a second proof.
enum class ProofVerdict {
  proven,      ///< All claims of the file are proven, as far as a second proof covers them.
  refuted,     ///< Proven: one of its claims is wrong, such as two bodies that come too close.
  broken,      ///< The file contradicts itself or its scene, such as by a body that jumps.
  not_proven,  ///< Neither; the open pair and times are named.
};

/// The words of ProofVerdict in files and in Python, in this order.
inline constexpr std::array<const char*, 4> kProofVerdictWords{"proven", "refuted", "broken",
                                                               "not_proven"};

}  // namespace firstcontact
