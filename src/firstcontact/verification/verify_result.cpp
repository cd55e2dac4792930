#include <firstcontact/verification/verify_result.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_claims.h>
#include <firstcontact/text/write_json.h>
#include <firstcontact/verification/detail/describe_finding.h>
#include <firstcontact/verification/detail/explained_tolerance.h>
#include <firstcontact/verification/detail/rigid_motion.h>
#include <firstcontact/verification/detail/scene_courses.h>
#include <firstcontact/verification/detail/scene_proof.h>

namespace firstcontact {
namespace {

using detail::ProofFinding;
using detail::SceneCourses;
using detail::SceneProof;

/// The error that a claim contradicts another one, or the scene. One sentence.
class BrokenResult : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

LoadedScene load(const ResultClaims& claims) {
  if (claims.has_own_scene == false) {
    throw std::invalid_argument(
        "scene: this is not the scene that was checked, it was edited in the result; check it "
        "again");
  }
  if (claims.scene.options.start_contacts == StartContacts::keep_half) {
    throw std::invalid_argument("scene.options.start_contacts: \"keep_half\" is not verified");
  }
  ShapeCache cache;
  LoadedScene loaded = load_scene(claims.scene, cache);
  const bool has_digests = claims.has_own_scene || !claims.scene.text_digest.empty();
  if (has_digests && loaded.input_digest != claims.input_digest) {
    throw std::invalid_argument(
        "input_digest: a mesh or robot file of the scene is not what it was when the result was "
        "made; restore the file, or check again");
  }
  return loaded;
}

class ResultProof {
 public:
  ResultProof(const ResultClaims& claims, const LoadedScene& loaded,
              const VerifyResultOptions& options)
      : claims_(claims),
        loaded_(loaded),
        courses_(loaded),
        proof_(courses_, {options.work, options.threads, options.stop, options.progress}) {
    for (std::size_t member = 0; member < courses_.member_count(); ++member) {
      members_[member_name(loaded.scene, member)] = member;
    }
    result_.t = claims.t;
    result_.time = claims.time;
    result_.tolerance = claims.tolerance_used;
    result_.has_digests = claims.has_own_scene.has_value();
    result_.pair_counts = loaded.pair_counts;
    result_.warnings = loaded.warnings;
  }

  ResultVerification run() {
    try {
      require_consistent();
      require_pairs();
    } catch (const BrokenResult& error) {
      result_.verdict = ProofVerdict::broken;
      result_.problem = error.what();
      return result_;
    }
    result_.verdict = ProofVerdict::proven;
    bound_tolerances();
    const ProofFinding free =
        proof_.prove_free({.until = [this](const BodyPair& pair) { return until(pair); },
                           .ends_in_contact = claims_.verdict != Verdict::free});
    take(free);
    result_.left_open = free.left_open;
    prove_clearances();
    for (const Contact& contact : contacts_) {
      prove(contact);
    }
    return result_;
  }

 private:
  struct Contact {
    BodyPair members = {};
    double t = 0.0;
    double tolerance = 0.0;
  };

  [[nodiscard]] double until(const BodyPair& pair) const {
    const auto own = until_.find(pair);
    return own == until_.end() ? claims_.t : own->second;
  }

  /// Requires a time in [0, 1]. Comparisons are negated, so that NaN is refused.
  static void require_time(Verdict verdict, double t, const std::string& what) {
    if (!(t >= 0.0 && t <= 1.0)) {
      throw BrokenResult(what + "t is not within 0 and 1.");
    }
    if (verdict == Verdict::free && t != 1.0) {
      throw BrokenResult(what + "The verdict is free, but t is not 1.");
    }
    if (verdict == Verdict::contact_at_start && t != 0.0) {
      throw BrokenResult(what + "The contact is one at the start, but t is not 0.");
    }
  }

  void require_consistent() const {
    require_time(claims_.verdict, claims_.t, "");
    if (!(claims_.time == claims_.t * loaded_.scene.duration)) {
      throw BrokenResult("The time is not t times the duration of the scene.");
    }
    if (!(claims_.clearance >= 0.0)) {
      throw BrokenResult("The clearance is not a distance.");
    }
    if (is_contact(claims_.verdict) && !claims_.pair) {
      throw BrokenResult("The verdict is a contact, but there is no pair.");
    }
  }

  void require_numbers(const PairClaim& claim, const BodyPair& pair, const std::string& what) {
    constexpr double kRounding = 0x1p-50;  // [-]  Relative to the sum of a margin and two paddings.
    const double margin = courses_.pairs().margin(pair).value();
    // That of a contact contains the effect of tracking errors, which is never less than 0.
    const bool may_exceed = courses_.has_tracking_errors() && claim.verdict != Verdict::free;
    const bool is_less = !(claim.margin >= margin - kRounding * margin);
    if (is_less || (!may_exceed && !(claim.margin <= margin + kRounding * margin))) {
      throw BrokenResult(what + "its margin is not that of the scene.");
    }
    if (!(claim.time == claim.t * loaded_.scene.duration)) {
      throw BrokenResult(what + "its time is not t times the duration of the scene.");
    }
    if (!(claim.clearance >= 0.0)) {
      throw BrokenResult(what + "its clearance is not a distance.");
    }
    if (std::isfinite(claim.clearance)) {
      clearances_.insert({pair, claim.clearance});
    } else if (is_tested(pair)) {
      throw BrokenResult(what + "its clearance is null, but it is tested.");
    }
  }

  [[nodiscard]] BodyPair members_of(const std::array<std::string, 2>& names) const {
    BodyPair pair{};
    for (std::size_t k = 0; k < 2; ++k) {
      const auto found = members_.find(names[k]);
      if (found == members_.end()) {
        throw BrokenResult("The scene has no " + detail::in_quotes(names[k]) + ".");
      }
      pair[k] = found->second;
    }
    std::sort(pair.begin(), pair.end());
    if (pair[0] == pair[1] || !courses_.pairs().margin(pair)) {
      throw BrokenResult("The pair of " + detail::in_quotes(names[0]) + " and " +
                         detail::in_quotes(names[1]) + " is not tested.");
    }
    return pair;
  }

  /// Requires that the count of tested pairs and their list are those of the scene.
  void require_pairs() {
    std::size_t tested = 0;
    for (std::size_t a = 0; a < courses_.member_count(); ++a) {
      for (std::size_t b = a + 1; b < courses_.member_count(); ++b) {
        tested += is_tested({a, b}) ? 1 : 0;
      }
    }
    if (tested != claims_.tested) {
      throw BrokenResult("The scene has " + std::to_string(tested) +
                         " tested pairs, the result is about " + std::to_string(claims_.tested) +
                         ".");
    }
    if (tested > 0 && !std::isfinite(claims_.clearance)) {
      throw BrokenResult("The clearance is null, but pairs are tested.");
    }
    for (const PairClaim& claim : claims_.pairs.value_or(std::vector<PairClaim>())) {
      const std::string what = "Pair of " + detail::in_quotes(claim.pair[0]) + " and " +
                               detail::in_quotes(claim.pair[1]) + ": ";
      require_time(claim.verdict, claim.t, what);
      const BodyPair pair = members_of(claim.pair);
      require_numbers(claim, pair, what);
      if (!until_.insert({pair, claim.t}).second) {
        throw BrokenResult(what + "it is there twice.");
      }
      if (claim.t < claims_.t) {
        throw BrokenResult(what + "its t is before that of the result.");
      }
      if (is_contact(claim.verdict)) {
        contacts_.push_back({pair, claim.t, claim.tolerance_used});
      }
    }
    // Pairs that are held over the whole step may be listed, too.
    const auto listed = static_cast<std::size_t>(
        std::count_if(until_.begin(), until_.end(),
                      [this](const auto& claim) { return is_tested(claim.first); }));
    if (claims_.pairs && listed != tested) {
      throw BrokenResult("The result lists " + std::to_string(listed) + " of " +
                         std::to_string(tested) + " tested pairs.");
    }
    if (claims_.verdict == Verdict::free && !contacts_.empty()) {
      throw BrokenResult("The verdict is free, but a pair is in contact.");
    }
    if (claims_.pair) {
      const BodyPair pair = members_of(*claims_.pair);
      if (is_contact(claims_.verdict)) {
        contacts_.push_back({pair, claims_.t, claims_.tolerance_used});
      }
    }
  }

  /// Whether a pair is tested; a pair that is held over the whole step never is.
  [[nodiscard]] bool is_tested(const BodyPair& pair) const {
    return courses_.pairs().margin(pair) && !courses_.of_member(pair[0]).empty() &&
           !courses_.of_member(pair[1]).empty() && !courses_.pairs().spans(pair).empty();
  }

  /// Requires that a larger tolerance than the asked one, which proves less, is explained by
  /// rounding.
  void bound_tolerances() {
    const double asked = claims_.scene.options.tolerance;
    double all = asked;  // That of the result is the greatest of its pairs.
    if (claims_.tolerance_used > asked) {
      for (std::size_t a = 0; a < courses_.member_count(); ++a) {
        all = std::max(all, 2.0 * detail::explained_tolerance(courses_, a));
      }
    }
    bound_tolerance(claims_.tolerance_used, all, "The");
    for (const PairClaim& claim : claims_.pairs.value_or(std::vector<PairClaim>())) {
      if (claim.tolerance_used > asked) {
        const BodyPair pair = members_of(claim.pair);
        bound_tolerance(claim.tolerance_used,
                        std::max(asked, detail::explained_tolerance(courses_, pair[0]) +
                                            detail::explained_tolerance(courses_, pair[1])),
                        "Pair of " + detail::in_quotes(claim.pair[0]) + " and " +
                            detail::in_quotes(claim.pair[1]) + ": the");
      }
    }
  }

  void bound_tolerance(double used, double most, const std::string& what) {
    if (!(used <= most) && result_.problem.empty()) {
      result_.verdict = ProofVerdict::not_proven;
      result_.problem = what + " tolerance_used is " + detail::write_json(used) +
                        " m; rounding explains no more than " + detail::write_json(most) + " m.";
    }
  }

  void prove_clearances() {
    if (courses_.has_tracking_errors()) {
      return;
    }
    const bool ends_in_contact = claims_.verdict != Verdict::free;
    if (result_.verdict != ProofVerdict::refuted && std::isfinite(claims_.clearance)) {
      take(proof_.prove_free({.until = [this](const BodyPair&) { return claims_.t; },
                              .clearance = claims_.clearance,
                              .ends_in_contact = ends_in_contact}),
           "The clearance of the result does not hold. ");
    }
    if (result_.verdict != ProofVerdict::refuted && !clearances_.empty()) {
      take(proof_.prove_free({.until = [this](const BodyPair& pair) { return until(pair); },
                              .clearances = clearances_,
                              .ends_in_contact = ends_in_contact}),
           "The clearance of the pair does not hold. ");
    }
  }

  void prove(const Contact& contact) {
    if (result_.verdict == ProofVerdict::refuted) {
      return;
    }
    const ProofFinding found = proof_.prove_contact(contact.members, contact.t, contact.tolerance);
    take(found);
    if (found.verdict == ProofVerdict::proven) {
      ++result_.contacts;
      result_.contact_distance = found.distance;
    }
  }

  void take(const ProofFinding& found, const std::string& before = "") {
    const bool decides =
        found.verdict != ProofVerdict::proven &&
        (result_.verdict == ProofVerdict::proven || (result_.verdict == ProofVerdict::not_proven &&
                                                     found.verdict != ProofVerdict::not_proven));
    if (!decides) {
      return;
    }
    result_.verdict = found.verdict;
    result_.problem = before + detail::describe(found, loaded_.scene);
    result_.problem_at = detail::moment_of(found, loaded_.scene);
  }

  const ResultClaims& claims_;
  const LoadedScene& loaded_;
  SceneCourses courses_;
  SceneProof proof_;
  std::map<std::string, std::size_t> members_;
  std::map<BodyPair, double> until_;
  std::map<BodyPair, double> clearances_;
  std::vector<Contact> contacts_;
  ResultVerification result_;
};

}  // namespace

ResultVerification verify_result(const ResultClaims& claims, const VerifyResultOptions& options) {
  const FloatEnvironmentGuard guard;
  const LoadedScene loaded = load(claims);
  try {
    return ResultProof(claims, loaded, options).run();
  } catch (const detail::UncertainMotion& error) {
    ResultVerification result;
    result.problem = std::string("A motion of the scene is not certain: ") + error.what() + ".";
    return result;
  }
}

}  // namespace firstcontact
