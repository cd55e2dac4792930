/// @file
/// The verdict of a second proof of a file.

#pragma once

#include <array>

#include <firstcontact/math/export.h>

namespace firstcontact {

enum class ProofVerdict {
  proven,      ///< All that the file claims, as far as a second proof covers it.
  refuted,     ///< Proven: one of its claims is wrong.
  broken,      ///< The file contradicts itself or its scene.
  not_proven,  ///< Neither; the pair and the times that are left open are named.
};

/// Its words in files, in this order.
inline constexpr std::array<const char*, 4> kProofVerdictWords{"proven", "refuted", "broken",
                                                               "not_proven"};

}  // namespace firstcontact
