#include <firstcontact/verification/detail/describe_finding.h>

#include <firstcontact/scene/scene.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {

std::string describe(const ProofFinding& finding, const Scene& scene) {
  const std::string names = in_quotes(member_name(scene, finding.members[0])) + " and " +
                            in_quotes(member_name(scene, finding.members[1]));
  switch (finding.reason) {
    case ProofReason::none:
      return finding.verdict == ProofVerdict::broken
                 ? names + " are in contact by the result, but are not tested then."
                 : "";
    case ProofReason::closer:
      return names + " are closer than the result claims.";
    case ProofReason::inside:
      return "One of " + names + " begins inside of the other.";
    case ProofReason::perhaps_inside:
      return "It could not be proven that none of " + names + " is inside of the other.";
    case ProofReason::apart:
      return names + " are in contact by the result, but are farther apart than it allows.";
    case ProofReason::perhaps_errors:
      return "It is open whether the tracking errors let " + names + " be in contact.";
    case ProofReason::too_close:
      return "Rounding leaves open whether " + names + " keep to what the result claims.";
    case ProofReason::work:
      return "The proof of " + names + " took more work than it was allowed.";
    case ProofReason::stopped:
      return "Stopped before the end of the proof.";
  }
  return "";
}

std::optional<ProofMoment> moment_of(const ProofFinding& finding, const Scene& scene) {
  if (finding.verdict == ProofVerdict::proven || finding.reason == ProofReason::stopped) {
    return std::nullopt;
  }
  ProofMoment moment{
      .pair = {member_name(scene, finding.members[0]), member_name(scene, finding.members[1])},
      .from = finding.when.from,
      .to = finding.when.to};
  if (finding.reason == ProofReason::closer) {
    moment.distance = finding.distance;
  }
  return moment;
}

}  // namespace firstcontact::detail
