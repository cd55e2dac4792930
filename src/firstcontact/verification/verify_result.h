/// @file
/// Proves the result of a check a second time, by other code.

#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/scene/pair_counts.h>
#include <firstcontact/verification/proof_verdict.h>

namespace firstcontact {

struct ResultClaims;

/// The options of a second proof of a result.
struct VerifyResultOptions {
  /// Most tests of two boxes or triangles for one pair of shapes and one window of time.
  std::size_t work = 2'000'000'000;
  int threads = 0;            ///< At most; 0 for one on each core. The answer is the same.
  std::stop_token stop = {};  ///< Ends the proof with the verdict `not_proven`.
  std::function<void(double)> progress = {};  ///< Called with the normalised time that is done.
};

/// Two members over a stretch of time.
struct ProofMoment {
  std::array<std::string, 2> pair;
  double from = 0.0;  ///< [-]  Normalised to the duration of the scene.
  double to = 0.0;
  std::optional<double> distance = {};  ///< [m]  Upper bound of their distance, where it is known.
};

/// The answer of a second proof of a result.
struct ResultVerification {
  ProofVerdict verdict = ProofVerdict::not_proven;
  std::string problem;  ///< One sentence; empty where all is proven.
  std::optional<ProofMoment> problem_at = {};
  double t = 0.0;     ///< [-]  The claim: free before it.
  double time = 0.0;  ///< [s]
  /// [-]  The proof of freedom may end earlier than t by at most this: see verify_result().
  double left_open = 0.0;
  /// [m]  Where a contact is proven: an upper bound of the pair's distance at t.
  std::optional<double> contact_distance = {};
  double tolerance = 0.0;    ///< [m]  Tolerance of the contacts, as the result states it.
  std::size_t contacts = 0;  ///< Pairs that are proven to be in contact.
  bool has_digests = true;   ///< Without digests it is not known whether a file or the scene has
                             ///< changed.
  PairCounts pair_counts = {};
  std::vector<std::string> warnings = {};  ///< Warnings of reading the scene's files.
};

/// Proves a result again, with other code than that which checks.
///
/// The proof is about the exact motions that the numbers of the resolved scene define:
/// - Each tested pair is farther apart than its margin, strictly, on all of [0, t], the end
///   included. In results that answer each pair, that is until the t of the pair. With tracking
///   errors it holds for all motions within them.
/// - If a result is not free, and a pair is about to touch at t, the last moment before t may be
///   left open. It is shorter than the pair takes for 2^-38 of its size, and than 2^-30.
///   `left_open` has the longest.
/// - The pair of a contact is no farther apart at t than margin + tolerance, for the nominal
///   motion. With tracking errors their bound at t is added to the margin. The same holds for each
///   pair that the result states as in contact.
/// - No tested pair comes closer before t than the `clearance`, except for 2^-20 of it and
///   rounding. The same holds for each pair that has its own.
/// - The tested pairs are those of the scene, all of them, by an account of its own.
///
/// A tolerance_used beyond the tolerance of the scene has to be one that rounding explains, by the
/// sizes, places and speeds of the bodies. With a larger one nothing is proven.
///
/// A cylinder, cone or ellipsoid is proven as the exact convex set that it is, with its inside.
///
/// Some claims are not proven again. They are the bodies, features, points, normals and count of
/// contacts, intervals of contact and closest approaches. So are `t_upper` of undecided pairs,
/// counts of untested pairs, and sampling.
///
/// Method: as in verify_run(); the courses of joints and links have arithmetic of their own.
///
/// @throws std::invalid_argument if the scene was edited in the result, or one of its files has
///         changed, or the scene is not covered: bodies whose vertices move, and start_contacts
///         keep_half
/// @throws ParseError if a file cannot be loaded
[[nodiscard]] FIRSTCONTACT_API ResultVerification
verify_result(const ResultClaims& claims, const VerifyResultOptions& options = {});

}  // namespace firstcontact
