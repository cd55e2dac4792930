/// @file
/// Puts what a proof found into words.

#pragma once

#include <optional>
#include <string>

#include <firstcontact/verification/detail/proof_finding.h>
#include <firstcontact/verification/verify_result.h>

namespace firstcontact {
struct Scene;
}

namespace firstcontact::detail {

/// One sentence, with the names of the pair.
[[nodiscard]] std::string describe(const ProofFinding& finding, const Scene& scene);

[[nodiscard]] std::optional<ProofMoment> moment_of(const ProofFinding& finding, const Scene& scene);

}  // namespace firstcontact::detail
