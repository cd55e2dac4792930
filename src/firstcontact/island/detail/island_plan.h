/// @file
/// Plans the motion of an island over a span of time: Gauss' principle on the velocities at its
/// end.

#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/island/detail/island.h>
#include <firstcontact/island/detail/island_response.h>
#include <firstcontact/island/detail/plan_ties.h>
#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/island_robots.h>
#include <firstcontact/simulation_model/detail/manifold.h>
#include <firstcontact/simulation_model/detail/move.h>
#include <firstcontact/simulation_model/detail/moving_contact.h>
#include <firstcontact/simulation_model/detail/response.h>

namespace firstcontact::detail {

struct IslandState;

/// A predicted contact: a touch of the motion ahead, and the constraint that it gives.
struct PredictedContact {
  ManifoldPoint touch;
  ContactPoint contact;  ///< With the arms at its time.
  double least = 0.0;    ///< [m/s]  Normal velocity that keeps the pair apart until the end.
};

/// A contact that acts when a plan begins, for both rules of the plan.
struct ActingContact {
  ContactPoint now = {};
  MovedContact halfway = {};
  /// [m/s]  Change of a velocity by the geometry from halfway to the end. The velocity is that of
  /// now, or on a curve that of the last solution at the end.
  Eigen::Vector3d change = Eigen::Vector3d::Zero();
  /// [m/s]  Change of the velocity at which it sticks, to the end of the plan.
  Eigen::Vector2d change_of_belt = Eigen::Vector2d::Zero();
  bool is_held = false;  ///< Whether it presses, or its bodies rest there: it goes on with them.
  double least = 0.0;    ///< [m/s]  Least mean normal velocity over the plan.
  /// [m/s]  Slip when the plan begins, where it slides throughout; else 0.
  Eigen::Vector2d slip = Eigen::Vector2d::Zero();
  bool is_replaced = false;  ///< Whether a predicted contact of the same features replaces it.
  bool is_round = false;     ///< Whether it is on a curved surface that it follows in the plan.
  int lifts = 0;             ///< [tolerances]  Extra distance that it has to keep.
};

/// Makes the contact for a plan that moves bodies by the mean of the velocities at both ends (the
/// midpoint rule; E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", 2006,
/// II.1.1).
///
/// Impulses act halfway. A held contact has J_end v_end = 0 at the end. Then the mean of the
/// velocities goes along the surface halfway. The solution finds J_half v_end; the rest of J_end
/// v_end is `change`.
[[nodiscard]] ContactPoint by_mean(const ActingContact& acting);

/// Makes the contact for a plan that moves bodies by one velocity from its begin to its end.
[[nodiscard]] ContactPoint along_way(const ActingContact& acting);

/// The motions of the bodies over the plan's span: the rest of the step, or less.
struct Plan {
  std::vector<Move> moves = {};  ///< The motion of each member.
  /// The velocities of each member at the end.
  ///
  /// Angular velocities have the coordinates of the body's axes at the end, but in its axes of now.
  /// So contacts change its energy now as they do at the end.
  std::vector<ContactBody> at_end;
  std::vector<RobotPlan> robots = {};
  std::vector<TieTrackPiece> ties = {};  ///< Impulses over the plan.
  double residual = 0.0;                 ///< [m/s]
  bool is_limited = false;               ///< Whether velocities are shorter than contacts require.
  bool is_solved = true;                 ///< Whether contacts have a solution, and it was found.
  /// Whether forces of ties were found that keep the energy which they do not take. A shorter plan
  /// may have such forces.
  bool finds_ties = true;
  /// Whether contacts add no energy; in a shorter plan they add less, in a symmetric one none.
  bool keeps_energy = true;
  /// Whether it may not be followed: joints are apart where it ends, or a motion is not finite.
  bool is_refused = false;

  [[nodiscard]] bool keeps_contacts() const { return is_solved && !is_limited; }
};

/// Computes the state of a member that is no link body, a share of a plan ahead.
[[nodiscard]] RigidState state_ahead(const IslandState& state, const Plan& plan, std::size_t member,
                                     double share);

/// Makes plans for an island from its present state, each with more or tighter constraints than the
/// one before.
class IslandPlanner {
 public:
  /// Starts with the present touches, and their impulses for a whole step.
  ///
  /// @param span       [s]
  /// @param symmetric  whether contacts hold velocities in the place where their impulses act, as
  ///                   in heaps: of first order, but no contact adds energy
  IslandPlanner(IslandState& state, double span, bool symmetric);

  /// Starts from the impulses of the plan before.
  [[nodiscard]] Plan plan();

  /// The pairs that the last plan holds apart, with their impulses.
  [[nodiscard]] std::vector<ManifoldPoint> touches() const;

  /// Adds a predicted contact as a constraint. It replaces one of the same features, as impulses
  /// would move over only slowly between two almost equal constraints.
  void add(const PredictedContact& ahead);

  /// Whether the last plan has a predicted contact that is almost equal: adding it changes little.
  [[nodiscard]] bool has(const PredictedContact& ahead) const;

 private:
  /// The velocities without contacts, as those of Plan, and the motions that they give.
  struct FreeFlight {
    std::vector<ContactBody> at_end;
    std::vector<Eigen::Vector3d> rotation_vectors;
    std::vector<Eigen::Vector3d> torques;  ///< [N m]  Constant torques, without contacts.
  };

  /// Bodies that spin in contact: their flights have the angular impulses of contacts. Their
  /// angular velocities in the problem are in world axes, at the end of the plan.
  struct Spins {
    /// [N m s]  Impulses of contacts in the flight of each member; none for other bodies.
    std::vector<std::optional<Eigen::Vector3d>> impulses;
    double energy = 0.0;  // [J]  Energy of the bodies, where they fly without contacts.
  };

  /// Robots whose flights have the impulses of contacts.
  struct LoadsOfContacts {
    std::vector<LinkImpulse> on_links;
    std::vector<bool> acts;  // For each robot.
    double energy = 0.0;     // [J]  Energy of the robots, where they fly without contacts.
    // [N m s]  For each robot the moment in its flight of impulses between its links. It is not
    // quite 0, as both act at the places of their links halfway.
    std::vector<Eigen::Vector3d> of_inner;
  };

  /// The distance of a contact from its curve after a plan.
  struct OffCurve {
    double missing = 0.0;  // [m]  Distance by which it has to be farther apart.
    double most = 0.0;     // [m]  Greatest length of a displacement for it; 0 for none.
  };

  [[nodiscard]] bool find_solution();
  [[nodiscard]] Plan plan_of_bodies(const std::vector<bool>& by_end);
  [[nodiscard]] double work_of_contacts() const;
  [[nodiscard]] bool contacts_do_no_work() const;
  [[nodiscard]] std::vector<ContactBody> before_contacts() const;
  [[nodiscard]] Eigen::Vector2d mean_belt(std::size_t k) const;
  void settle(const std::vector<OuterImpulse>& outer, Plan& made);
  [[nodiscard]] FreeFlight free_flight() const;
  [[nodiscard]] bool acts(std::size_t k) const;
  [[nodiscard]] double slack_of_mean() const;
  [[nodiscard]] double least_of_mean(std::size_t k) const;
  [[nodiscard]] bool leaves(std::size_t robot) const;
  [[nodiscard]] double turn_of_links() const;
  [[nodiscard]] bool is_link_body(std::size_t place) const;
  void choose_rules();
  void fly_robots();
  [[nodiscard]] PlanSpan plan_span() const;
  void make_flights();
  void set_robots();
  [[nodiscard]] std::vector<Eigen::VectorXd> loads_on_robots();
  void fly_bodies();
  void lay_ties();
  void solve_where_flown();
  [[nodiscard]] bool follow_ties();
  [[nodiscard]] bool repeat_forces_of_ties();
  [[nodiscard]] bool mix_forces_of_ties();
  [[nodiscard]] bool turns_wildly() const;
  [[nodiscard]] Eigen::VectorXd changes_of_ties() const;
  [[nodiscard]] bool predict_ties(const Eigen::VectorXd& impulses, double most);
  void forget_ties();
  [[nodiscard]] bool leads_nowhere(const Plan& plan) const;
  void shift_robots(Plan& plan) const;
  [[nodiscard]] bool closes_gaps(const ContactSolution& way, double off) const;
  void settle_ties(Plan& plan) const;
  [[nodiscard]] bool lead_robots_by_end(const std::vector<bool>& by_end);
  void set_bodies();
  [[nodiscard]] ActingContact acting(const ManifoldPoint& touch, double least) const;
  [[nodiscard]] Eigen::Vector2d change_of_belt(const ManifoldPoint& touch, const ContactPoint& now,
                                               const std::array<ContactSide, 2>& sides,
                                               const Eigen::Matrix3d& frame) const;
  [[nodiscard]] ContactSide side_of(const ManifoldPoint& touch, std::size_t side) const;
  void append(const ManifoldPoint& touch, const ContactPoint& contact);
  [[nodiscard]] bool is_at(const PredictedContact& ahead, std::size_t contact) const;
  [[nodiscard]] std::optional<std::size_t> find(const PredictedContact& ahead) const;
  void solve();
  [[nodiscard]] double share_of_drift() const;
  [[nodiscard]] double drift_along(const BodyPair& pair, const ContactPoint& contact) const;
  [[nodiscard]] bool mean_is_allowed() const;
  [[nodiscard]] bool stops_early(std::size_t first, std::size_t end) const;
  [[nodiscard]] bool any_turns() const;
  [[nodiscard]] ContactSolution along_chords() const;
  [[nodiscard]] std::vector<bool> led_by_end() const;
  [[nodiscard]] std::vector<std::optional<std::size_t>> carriers() const;
  [[nodiscard]] Move move_of(std::size_t k, bool by_end, const Eigen::Vector3d& turning,
                             const ContactBody& after) const;
  [[nodiscard]] bool is_on_curve(std::size_t k) const;
  [[nodiscard]] double distance_of(const ManifoldPoint& touch) const;
  void displace(const ContactSolution& displacement, Plan& plan) const;
  [[nodiscard]] std::array<ContactSide, 2> mean_sides(std::size_t k,
                                                      const std::vector<ContactBody>& at_end) const;
  [[nodiscard]] bool follow_curves();
  [[nodiscard]] double least_speed() const;
  [[nodiscard]] double slip_of_rolling(std::size_t k) const;
  [[nodiscard]] Eigen::Vector2d slip_before(std::size_t k) const;
  [[nodiscard]] bool follow_slides();
  [[nodiscard]] bool follow_spins();
  [[nodiscard]] bool follow_loads();
  [[nodiscard]] bool is_inner(const ContactPoint& contact) const;
  [[nodiscard]] std::vector<LinkImpulse> impulses_on_links() const;
  [[nodiscard]] std::vector<bool> loaded_robots(const std::vector<LinkImpulse>& impulses) const;
  [[nodiscard]] bool loads_change_much() const;
  void end_loads_by_rule();
  void take_loads();
  void forget_flights();
  void forget_loads();
  [[nodiscard]] std::vector<OuterImpulse> changes_of(std::vector<OuterImpulse> outer) const;
  [[nodiscard]] bool may_spin(std::size_t k) const;
  [[nodiscard]] std::vector<Eigen::Vector3d> angular_impulses() const;
  [[nodiscard]] bool spins(std::size_t k) const;
  bool spin(std::size_t k, const Eigen::Vector3d& impulse, double tolerance);
  void take_spins();
  void forget_spins();
  void end_spins();
  void carry_back(Plan& plan) const;
  [[nodiscard]] bool lifts(const PredictedContact& ahead);
  void keep_on_curves(Plan& plan) const;
  [[nodiscard]] OffCurve off_curve(std::size_t k, const Plan& plan) const;
  [[nodiscard]] double most_from_curve(const MovedContact& there, std::size_t k,
                                       const std::array<ContactSide, 2>& sides) const;
  [[nodiscard]] double most_from_curve(std::size_t k, const std::vector<ContactBody>& at_end) const;
  void set_at_rest(ContactProblem& problem) const;
  void push_apart(Plan& plan);
  void limit_push(double most, ContactSolution& push) const;
  void keep_push_from(const ContactPoint& contact);
  [[nodiscard]] ContactSolution find_push() const;

  IslandState& state_;
  double span_;  // [s]
  ProblemBodies bodies_;
  PlanTies ties_;
  FreeFlight flight_;
  bool symmetric_;                             // Whether contacts hold where they act.
  ContactProblem problem_;                     // Its guesses are the impulses of the last plan.
  std::vector<ManifoldPoint> touches_;         // The touch of each contact of the problem.
  std::vector<ActingContact> acting_;          // For the present touches.
  std::optional<Spins> spins_ = {};            // Set where bodies spin in contact.
  std::optional<LoadsOfContacts> loads_ = {};  // Set where contacts act in flights of robots.
  bool by_end_ = false;          // Whether bodies in contact move by the velocities at the end.
  bool laid_by_end_ = false;     // Whether they did so when the rows of ties were made.
  std::size_t first_ahead_ = 0;  // Touches before it are sorted by their pairs.
  std::multimap<BodyPair, std::size_t> ahead_;  // The other touches.
  std::vector<RobotFlight> flights_;            // Flights of the robots,
  std::vector<bool> robots_by_end_;  // and whether they move by the velocities at the end.
  std::optional<PlanSolution> last_ = {};
  /// [N s]  Impulses of its contacts, in the world, as they acted: contacts may have turned since.
  std::vector<Eigen::Vector3d> impulses_ = {};
  std::vector<std::size_t> changed_ = {};  // Contacts that changed since the last plan.
  // Displacements of plans from now, until it is in the way.
  std::optional<ContactSolution> push_ = {};
};

/// [s]  Computes a time that is too short for any progress in a step of h. A search of the motion
/// could not divide it.
inline double stall(double h) { return kStallOfStep * h; }

}  // namespace firstcontact::detail
