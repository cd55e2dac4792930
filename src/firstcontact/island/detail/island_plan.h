/// @file
/// How an island is to move over a span of time: Gauss' principle on the velocities at its end.

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

/// A touch of the motion ahead, and how it would be reached.
struct PredictedContact {
  ManifoldPoint touch;
  ContactPoint contact;  ///< With the arms of its time.
  double least = 0.0;    ///< [m/s]  Normal velocity that keeps the pair apart until the end.
};

/// A contact that acts when a plan begins, as the plan's two rules want it.
struct ActingContact {
  ContactPoint now = {};
  MovedContact halfway = {};
  /// [m/s]  How much the geometry changes a velocity from halfway to the end: of those of now, or
  /// on a curve of those that the last solution has at the end.
  Eigen::Vector3d change = Eigen::Vector3d::Zero();
  /// [m/s]  Where the plan ends, of the velocity at which it sticks.
  Eigen::Vector2d change_of_belt = Eigen::Vector2d::Zero();
  bool is_held = false;      ///< It presses, or bodies rest there: it goes on with them.
  double least = 0.0;        ///< [m/s]  Of the mean normal velocity over the plan.
  bool is_replaced = false;  ///< By a predicted contact of the same features.
  bool is_round = false;     ///< On a curved surface that it follows in the plan.
  int lifts = 0;             ///< [tolerances]  By so many it has to be farther apart.
};

/// The contact for a plan in which the mean of the velocities at both ends leads (the midpoint
/// rule; E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", 2006, II.1.1):
/// impulses act halfway. A held contact has J_end v_end = 0 at the end. Then the mean of the
/// velocities goes along the surface halfway. The solution finds J_half v_end; the rest of
/// J_end v_end is `change`.
[[nodiscard]] ContactPoint by_mean(const ActingContact& acting);

/// The contact for the way of a plan that one velocity leads from its begin to its end.
[[nodiscard]] ContactPoint along_way(const ActingContact& acting);

/// The motions of the bodies over the plan's span: the rest of the step, or less.
struct Plan {
  std::vector<Move> moves = {};  ///< Of each member.
  /// The velocities of each member at the end.
  ///
  /// Angular ones have the coordinates that they have in the body's axes at the end, but in its
  /// axes of now. So contacts do to its energy now what they do to it at the end.
  std::vector<ContactBody> at_end;
  std::vector<RobotPlan> robots = {};
  std::vector<TieTrackPiece> ties = {};  ///< Impulses over the plan.
  double residual = 0.0;                 ///< [m/s]
  bool is_limited = false;               ///< Velocities are shorter than contacts would have them.
  bool is_solved = true;                 ///< Contacts have a solution, and it was found.
  /// Forces of ties were found, and keep the energy that they do not take; those of a shorter plan
  /// may do.
  bool finds_ties = true;
  bool tears_ties = false;  ///< Joints are apart where it ends, or it leads nowhere.

  [[nodiscard]] bool keeps_contacts() const { return is_solved && !is_limited; }
};

/// How a member that is no link body moves, a share of a plan ahead.
[[nodiscard]] RigidState state_ahead(const IslandState& state, const Plan& plan, std::size_t member,
                                     double share);

/// Makes plans from where an island is now, each with more or tighter constraints than the one
/// before.
class IslandPlanner {
 public:
  /// Starts with what touches now, and the impulses of a whole step that it has.
  ///
  /// @param span  [s]
  IslandPlanner(IslandState& state, double span);

  /// Starts from the impulses of the plan before.
  [[nodiscard]] Plan plan();

  /// The pairs that the last plan holds apart, with its impulses.
  [[nodiscard]] std::vector<ManifoldPoint> touches() const;

  /// Makes a touch of the motion ahead a constraint. Where the same features have one there it
  /// takes its place: between two that say nearly the same impulses would only slowly go over.
  void add(const PredictedContact& ahead);

  /// Whether the last plan has the touch as one of the motion ahead: adding it changes little.
  [[nodiscard]] bool has(const PredictedContact& ahead) const;

 private:
  /// Velocities without contacts, as those of Plan, and how far they lead.
  struct FreeFlight {
    std::vector<ContactBody> at_end;
    std::vector<Eigen::Vector3d> rotation_vectors;
    std::vector<Eigen::Vector3d> torques;  ///< [N m]  Constant, without contacts.
  };

  /// Bodies that spin in contact: their flights have the angular impulses of contacts. Angular
  /// velocities of the problem are those of the world, at the end of the plan.
  struct Spins {
    /// [N m s]  Of contacts in the flight of each member; nothing: it is none of these bodies.
    std::vector<std::optional<Eigen::Vector3d>> impulses;
    double energy = 0.0;  // [J]  Of the bodies, where they fly without contacts.
  };

  /// Robots whose flights have the impulses of contacts.
  struct LoadsOfContacts {
    std::vector<LinkImpulse> on_links;
    std::vector<bool> acts;               // Of each robot.
    double energy = 0.0;                  // [J]  Of robots, where they fly without contacts.
    std::vector<OuterImpulse> in_flight;  // Of each robot, what its flight has.
  };

  /// How far a plan leads a contact from its curve.
  struct OffCurve {
    double missing = 0.0;  // [m]  So much farther apart it has to be.
    double most = 0.0;     // [m]  A displacement for it is no longer; 0: there is none.
  };

  [[nodiscard]] bool find_solution();
  [[nodiscard]] Plan plan_of_bodies(const std::vector<bool>& by_end);
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
  [[nodiscard]] bool follow_spins();
  [[nodiscard]] bool follow_loads();
  [[nodiscard]] std::vector<LinkImpulse> impulses_on_links() const;
  [[nodiscard]] std::vector<bool> loaded_robots(const std::vector<LinkImpulse>& impulses) const;
  [[nodiscard]] bool loads_change_much() const;
  void end_loads_by_rule();
  void take_loads();
  void forget_flights();
  void forget_loads();
  void take_from_flights(std::vector<OuterImpulse>& outer) const;
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
  ContactProblem problem_;                      // Its guesses are the impulses of the last plan.
  std::vector<ManifoldPoint> touches_;          // Of each contact of the problem.
  std::vector<ActingContact> acting_;           // Those of touches of now.
  std::optional<Spins> spins_ = {};             // Where bodies spin in contact.
  std::optional<LoadsOfContacts> loads_ = {};   // Where contacts act in flights of robots.
  bool by_end_ = false;                         // Velocities at the end lead the bodies in contact.
  bool laid_by_end_ = false;                    // They did when the rows of ties were made.
  std::size_t first_ahead_ = 0;                 // Those before it are in the order of their pairs.
  std::multimap<BodyPair, std::size_t> ahead_;  // The others.
  std::vector<RobotFlight> flights_;            // Of the robots,
  std::vector<bool> robots_by_end_;             // and which of them velocities at the end lead.
  std::optional<PlanSolution> last_ = {};
  /// [N s]  Of its contacts, in the world, as they acted: contacts may have turned since.
  std::vector<Eigen::Vector3d> impulses_ = {};
  std::vector<std::size_t> changed_ = {};     // Contacts, since the last plan.
  std::optional<ContactSolution> push_ = {};  // Of plans from now, until it is in the way.
};

/// [s]  A time, of a step of h, that is too short for anything to be done in it.
///
/// A search of the motion could not divide it.
inline double stall(double h) { return kStallOfStep * h; }

}  // namespace firstcontact::detail
