/// @file
/// Describes the findings of a proof.

#pragma once

#include <optional>
#include <string>

#include <firstcontact/verification/detail/proof_finding.h>
#include <firstcontact/verification/verify_result.h>

namespace firstcontact {
struct Scene;
}

namespace firstcontact::detail {

/// Describes a finding in one sentence, with the names of the pair.
[[nodiscard]] std::string describe(const ProofFinding& finding, const Scene& scene);

/// The pair and the times of a finding; none where it is about no pair.
[[nodiscard]] std::optional<ProofMoment> moment_of(const ProofFinding& finding, const Scene& scene);

}  // namespace firstcontact::detail
