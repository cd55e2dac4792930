/// @file
/// The pairs that a plan of an island brings into contact.

#pragma once

#include <array>
#include <map>
#include <unordered_map>
#include <vector>

#include <firstcontact/dynamics/detail/island_plan.h>
#include <firstcontact/dynamics/detail/swept_hull.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact::detail {

/// A pair that the plan brings into contact.
struct Hit {
  BodyPair bodies;
  double t = 0.0;  ///< [-]  Of the span.
  bool is_slight = false;
  std::vector<TouchAhead> ahead = {};
};

/// Asks the motions of plans for first contacts.
class HitSearch {
 public:
  /// @param span  [s]  of the plans
  HitSearch(IslandState& state, double span, Workspace& workspace)
      : state_(state), span_(span), workspace_(workspace) {}

  /// Asks all pairs that the plan may bring near each other.
  [[nodiscard]] std::vector<Hit> find(const Plan& plan);

  /// [m]  No pair comes closer in the plan that was asked last, until its first hit.
  [[nodiscard]] double clearance() const { return clearance_; }

 private:
  [[nodiscard]] Move move_of(std::size_t body, const Plan& plan) const;
  void ask(const BodyPair& pair, double margin, const std::array<Move, 2>& moves,
           std::vector<Hit>& hits);
  [[nodiscard]] bool cannot_reach(const BodyPair& pair, double distance,
                                  const std::array<Move, 2>& moves);
  [[nodiscard]] Hit hit_of(const BodyPair& pair, double margin, const std::array<Pose, 2>& poses,
                           const std::array<Move, 2>& moves);
  [[nodiscard]] double smaller_free_reach(const BodyPair& pair) const;
  [[nodiscard]] const SweptHull& hull_of(std::size_t body, const Move& move);
  [[nodiscard]] bool hulls_stay_apart(const BodyPair& pair, const std::array<Move, 2>& moves,
                                      double distance);
  [[nodiscard]] double gap_of(const BodyPair& pair) const;
  [[nodiscard]] bool moves_as_before(std::size_t body, const Plan& plan) const;

  IslandState& state_;
  double span_;
  Workspace& workspace_;
  std::unordered_map<std::size_t, SweptHull> hulls_ = {};  // Of this plan.
  std::vector<Move> moves_ = {};                           // Of the plan before.
  std::map<BodyPair, Hit> hits_ = {};                      // In it.
  FirstContactResult answer_;
  double clearance_ = 0.0;
};

}  // namespace firstcontact::detail
