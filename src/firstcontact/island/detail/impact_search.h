/// @file
/// The pairs that a plan of an island brings into contact.

#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <unordered_map>
#include <vector>

#include <firstcontact/island/detail/island_plan.h>
#include <firstcontact/island/detail/seams.h>
#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/query/workspace.h>
#include <firstcontact/simulation_model/detail/manifold.h>
#include <firstcontact/simulation_model/detail/move.h>
#include <firstcontact/simulation_model/detail/swept_hull.h>

namespace firstcontact::detail {

struct IslandState;

/// A pair that the plan brings into contact.
struct Impact {
  BodyPair bodies;
  double t = 0.0;  ///< [-]  Time in the span.
  bool is_slight = false;
  std::vector<PredictedContact> ahead = {};
};

/// The search for first contacts in the motions of plans.
///
/// After the first plan, only those pairs are searched of which a body moves otherwise than in the
/// plan before.
class ImpactSearch {
 public:
  /// Prepares a search.
  ///
  /// @param span  [s]  of the plans
  ImpactSearch(IslandState& state, double span, Workspace& workspace)
      : state_(state), span_(span), workspace_(workspace) {}

  /// Searches all pairs that the plan may bring near each other.
  [[nodiscard]] std::vector<Impact> find(const Plan& plan);

  /// [m]  Proven bound of the distance of all pairs in the last plan, until its first impact.
  [[nodiscard]] double clearance() const { return clearance_; }

 private:
  /// A member, or a body around the island, in the plan.
  struct Mover {
    std::size_t body;
    Move move = {};
    Eigen::AlignedBox3d box = {};   // [m]  Box around the motion.
    Eigen::AlignedBox3d room = {};  // [m]  While the box stays in it, no other pairs come near.
    bool is_changed = true;         // Whether it moves otherwise than in the plan before.
    std::optional<SweptHull> hull = {};  // Computed where needed.
  };
  /// A plane between two bodies.
  struct Plane {
    Eigen::Vector3d n;  // [-]  From the first body to the second, when the plan begins.
    bool is_of_second;  // Whether it moves with the second body.
  };
  /// Two bodies that may come near each other.
  struct Candidate {
    std::array<std::size_t, 2> movers;
    double margin;             // [m]
    const Manifold* manifold;  // Null beyond the band.
    bool is_near = false;      // Whether the boxes of the plan are near each other.
    std::optional<Impact> hit = {};
    std::optional<Plane> plane = {};  // The plane that kept them apart in the plan before.
  };

  void follow(const Plan& plan);
  void look_around();
  [[nodiscard]] std::size_t mover_of(std::size_t body);
  [[nodiscard]] const Mover& mover(const Candidate& pair, int side) const {
    return movers_[pair.movers[side]];
  }
  [[nodiscard]] BodyPair bodies_of(const Candidate& pair) const {
    return {mover(pair, 0).body, mover(pair, 1).body};
  }
  [[nodiscard]] std::optional<Impact> ask(Candidate& pair);
  [[nodiscard]] bool cannot_reach(const Candidate& pair, double distance);
  [[nodiscard]] std::vector<ManifoldPoint> touches_at(const Candidate& pair,
                                                      const std::array<Pose, 2>& poses);
  [[nodiscard]] Impact hit_of(const Candidate& pair, const std::array<Pose, 2>& poses);
  [[nodiscard]] Pose pose_at(std::size_t body, double t);
  [[nodiscard]] double smaller_free_reach(const BodyPair& pair) const;
  [[nodiscard]] SweptHull hull_of(std::size_t mover, double from, double to);
  [[nodiscard]] const SweptHull& whole_hull_of(std::size_t mover);
  [[nodiscard]] Plane likely_plane(const Candidate& pair) const;
  [[nodiscard]] static std::optional<Plane> plane_of(const SweptHull& A, const SweptHull& B,
                                                     double distance, const Plane& likely);
  [[nodiscard]] bool hulls_stay_apart(Candidate& pair, double distance);
  [[nodiscard]] bool parts_stay_apart(const Candidate& pair, double distance,
                                      const std::array<double, 3>& times, int splits,
                                      const Plane& likely);

  IslandState& state_;
  double span_;
  Workspace& workspace_;
  std::vector<Mover> movers_ = {};  // The members, then bodies around the island.
  std::unordered_map<std::size_t, std::size_t> around_ = {};  // Indices of these among the movers.
  std::vector<Candidate> candidates_ = {};
  std::optional<SeamFinder> seams_ = {};  // Made at the first impact,
  double seam_time_ = 0.0;                // [-]  for this time of the plan.
  FirstContactResult answer_;
  double clearance_ = 0.0;
};

}  // namespace firstcontact::detail
