/// @file
/// The verdict of a second proof of a file.

#pragma once

#include <array>

#include <firstcontact/math/export.h>

namespace firstcontact {

enum class ProofVerdict {
  proven,      ///< All that the file claims, as far as a second proof covers it.
  refuted,     ///< Proven: one of its claims is wrong, such as two bodies that come too close.
  broken,      ///< The file contradicts itself or its scene, such as by a body that jumps.
  not_proven,  ///< Neither; the pair and the times that are left open are named.
};

/// Its words in files and in Python, in this order.
inline constexpr std::array<const char*, 4> kProofVerdictWords{"proven", "refuted", "broken",
                                                               "not_proven"};

}  // namespace firstcontact
