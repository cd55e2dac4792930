/// @file
/// The verifier's proof that all pairs of a scene stay apart, and that a pair is in contact.

#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <stop_token>
#include <vector>

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/separation/detail/pair_cover.h>
#include <firstcontact/verification/detail/proof_finding.h>
#include <firstcontact/verification/detail/time_span.h>

namespace firstcontact::detail {

class SceneCourses;
struct CourseGeometry;

struct SceneProofOptions {
  std::size_t work = 0;  ///< Most tests of two boxes or triangles for one pair of shapes and one
                         ///< window.
  int threads = 0;
  std::stop_token stop = {};
  std::function<void(double)> progress =
      {};  ///< Called with the share that is done, by any thread.
};

/// The claim of a clearance or of the margins.
struct FreeClaim {
  /// [-]  The time until which a pair of members is free, the end included.
  ///
  /// It is below 0 for a pair that the claim is not about.
  std::function<double(const BodyPair&)> until;
  double from = 0.0;  ///< [-]  Nothing is claimed before it, or after `last`.
  double last = 1.0;
  double extra = 0.0;  ///< [m]  Distance in addition to the margin.
  /// [m]  Pairs that strictly keep a distance of their own in place of their margin and `extra`.
  ///
  /// A claim of a clearance is not about them.
  std::map<BodyPair, double> held = {};
  /// [m]  A distance that pairs keep, in place of the margins or in addition to them.
  ///
  /// It is kept except for 2^-20 of it and twice the rounding.
  std::optional<double> clearance = {};
  /// [m]  Such distances of single pairs; the claim is then about no others.
  std::map<BodyPair, double> clearances = {};
  /// Whether the margins are claimed besides a clearance; a proof is then of both.
  bool has_margins = false;
  /// Whether the claim of a pair ends where the pair may touch.
  ///
  /// Then the last moment may be left open (ProofFinding::left_open).
  bool ends_in_contact = false;
};

class SceneProof {
 public:
  /// @param courses  outlives this
  SceneProof(const SceneCourses& courses, SceneProofOptions options);

  /// Proves that each tested pair is farther apart than its margin, or keeps the claimed clearance.
  ///
  /// It returns the first finding that contradicts it, else the first that leaves it open.
  [[nodiscard]] ProofFinding prove_free(const FreeClaim& claim) const;

  /// Proves that two members are no farther apart than margin + tolerance at a time, for their
  /// nominal motions. The bound of their tracking errors is added to the margin.
  [[nodiscard]] ProofFinding prove_contact(const BodyPair& members, double t,
                                           double tolerance) const;

  /// Proves that two members are no farther apart than a distance at a time, for their nominal
  /// motions. The bound of their tracking errors is added to the distance.
  [[nodiscard]] ProofFinding prove_within(const BodyPair& members, double t, double distance) const;

 private:
  struct Job {
    std::size_t a = 0;  // Geometries of the pair.
    std::size_t b = 0;
    TimeSpan window = {};
    double margin = 0.0;
    std::optional<double> exceeded = {};  // [m]  Distance in addition to a clearance.
    Promise promise = Promise::exceeded;
    bool is_last = false;  // Whether its window ends with the claim of the pair.
    ProofFinding finding = {};
  };

  [[nodiscard]] std::vector<TimeSpan> windows(const FreeClaim& claim) const;
  [[nodiscard]] std::vector<BodyPair> near(const TimeSpan& window, double reach) const;
  [[nodiscard]] double reach_of(const FreeClaim& claim) const;
  [[nodiscard]] static std::optional<double> clearance_of(const FreeClaim& claim,
                                                          const BodyPair& members);
  void add_jobs(const FreeClaim& claim, const TimeSpan& window, std::vector<Job>& jobs) const;
  [[nodiscard]] ProofFinding prove(const FreeClaim& claim, std::vector<Job>& jobs) const;
  [[nodiscard]] ProofFinding prove(const FreeClaim& claim, const Job& job) const;
  [[nodiscard]] double last_moment(const Job& job) const;
  [[nodiscard]] CoverResult cover(const CourseGeometry& A, const CourseGeometry& B,
                                  const TimeSpan& window, CoverOptions options) const;
  [[nodiscard]] ProofFinding prove_outside(const FreeClaim& claim) const;
  [[nodiscard]] std::optional<bool> are_nested(const CourseGeometry& A, const CourseGeometry& B,
                                               double t) const;
  [[nodiscard]] std::optional<bool> has_inside(const CourseGeometry& solid,
                                               const CourseGeometry& other, double t) const;
  [[nodiscard]] ProofFinding prove_contact(const CourseGeometry& A, const CourseGeometry& B,
                                           double t, double reach) const;

  const SceneCourses& courses_;
  SceneProofOptions options_;
};

}  // namespace firstcontact::detail
