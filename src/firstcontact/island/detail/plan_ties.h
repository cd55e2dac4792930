/// @file
/// The ties of an island over a plan, and forces on its links.

#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/island/detail/island.h>
#include <firstcontact/island/detail/island_ties.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/simulation_model/detail/island_robots.h>
#include <firstcontact/simulation_model/detail/move.h>
#include <firstcontact/simulation_model/detail/sim_tie.h>

namespace firstcontact::detail {

class ProblemBodies;
struct IslandState;

/// The flights of all members, from which a contact problem starts.
struct IslandFlight {
  const std::vector<Move>& moves;  ///< For each member that is no link body.
  const std::vector<RobotFlight>& robots;
  /// Whether each body of the problem moves by the velocities at the end.
  const std::vector<bool>& by_end;
  /// The velocities of each body of the problem at the end.
  const std::vector<ContactBody>& at_end;
  /// Whether the angular velocity of each member at the end is in world axes.
  const std::vector<bool>& spins;
};

/// The ties of an island over a plan.
///
/// Impulses act in two parts. The predicted ones are constant forces in the flights of the bodies,
/// and act at the place of the tie halfway. The contact problem finds their changes. In it joints
/// and taut cables have velocity 0 where the flights end, and springs pull with the mean of both
/// ends. The flights take in the changes until these are small. So the rule is of second order, and
/// joints keep the energy. A plan needs nothing of the plan before.
class PlanTies {
 public:
  /// Finds the ties of an island.
  ///
  /// @param span  [s]
  PlanTies(IslandState& state, double span);

  /// Whether nothing is tied, and no force acts on a link.
  [[nodiscard]] bool empty() const { return acting_.empty() && link_forces_.empty(); }

  /// Adds predicted forces [N] and moments [N m] about the centre of mass of a member that is no
  /// link body.
  void add_to(std::size_t member, Eigen::Vector3d& force, Eigen::Vector3d& torque) const;

  /// Computes the displacement of a member beyond that by the mean of its velocities at both ends.
  /// Predicted forces of joints turn within the plan, and dampers change velocities before its
  /// middle.
  [[nodiscard]] Move shift(std::size_t member) const;

  /// Computes the like displacements of the coordinates of robots; empty where there are none.
  [[nodiscard]] std::vector<Eigen::VectorXd> shifts_of_robots(const ContactProblem& problem) const;

  /// Notes the changes of velocities in the flights, for these shifts.
  ///
  /// @param at_end  as in IslandFlight
  void take_changes(const ProblemBodies& now, const std::vector<ContactBody>& at_end);

  /// The predicted forces along the coordinates of robots, and those on their links; empty for
  /// none.
  [[nodiscard]] std::vector<Eigen::VectorXd> loads(const std::vector<RobotFlight>& flights) const;

  /// Makes the rows of a problem whose bodies have the velocities of the flights.
  ///
  /// @param now  the bodies with their motions when the plan begins
  void lay(const ProblemBodies& now, const IslandFlight& flight, ContactProblem& problem);

  /// [-]  The greatest change of an impulse in a solution, as a fraction of the greatest impulse.
  [[nodiscard]] double greatest_change(const std::vector<double>& changes) const;

  /// The predicted impulses [N s or N m s], in the order of the rows.
  [[nodiscard]] Eigen::VectorXd predicted() const;

  /// Sets the predicted impulses, in the order of the rows.
  void predict(const Eigen::VectorXd& impulses);

  /// Sets all predicted impulses to 0.
  void forget();

  /// Adds the changes of a solution to the impulses on robots.
  void add_changes(const std::vector<double>& changes, std::vector<OuterImpulse>& outer) const;

  /// Adds all impulses of ties and of forces on links to those on robots, the changes included.
  void add_all(const std::vector<double>& changes, std::vector<OuterImpulse>& outer) const;

  /// The impulses of all ties, the changes included.
  [[nodiscard]] std::vector<TieTrackPiece> impulses(const std::vector<double>& changes) const;

  /// Adds the rows of displacements that bring joints together, and cables back to their length,
  /// where a plan ends. Returns the greatest error that they correct [m or rad].
  ///
  /// @param at_end   poses of the members at the end of the plan
  /// @param changes  of the solution
  double add_settling(const std::vector<Pose>& at_end, const std::vector<double>& changes,
                      const ProblemBodies& now, ContactProblem& problem) const;

  /// A spring that leads bodies farther than the mean of their velocities, as stiff springs and
  /// dampers do.
  struct LedSpring {
    std::size_t acting = 0;                             ///< Index among the ties of the plan.
    Eigen::Vector3d between = Eigen::Vector3d::Zero();  ///< [m]  Vector between its points.
  };

  /// Finds these springs where a plan ends, the stiffest one first.
  [[nodiscard]] std::vector<LedSpring> led_springs(const std::vector<Pose>& at_end) const;

  /// Adds the rows of displacements that give springs these lengths, as far as the other rows and
  /// stiffer springs permit. Returns the greatest error that they correct [m].
  ///
  /// @param problem  with the rows of add_settling()
  double hold(const std::vector<LedSpring>& springs, const std::vector<Pose>& at_end,
              const ProblemBodies& now, ContactProblem& problem) const;

 private:
  /// A direction of a spring in the last rows.
  struct SpringInPlan {
    TieRow at_begin = {};       // At the motions when the plan begins,
    TieRow at_end = {};         // and when it ends.
    double weight = 0.5;        // [-]  Weight of the end.
    double inverse_mass = 0.0;  // [1/kg]
    /// [kg m]  Impulse along the direction that would move bodies as far as velocities change.
    double lead = 0.0;
  };
  /// A tie in the plan.
  struct Acting {
    const SimTie* tie = nullptr;
    std::size_t index = 0;                  // Index in the model.
    std::optional<std::size_t> lever = {};  // The end whose body turns most by impulses.
    TiePlace now = {};
    TiePlace end = {};  // At the end of the flights.
    std::array<Eigen::Vector3d, 2> centres_now = {};
    std::array<Eigen::Vector3d, 2> centres_end = {};
    Eigen::Vector3d turn = Eigen::Vector3d::Zero();  // [rad]  Turn of the lever's body in the plan.
    std::vector<TieDirection> halfway = {};          // Directions of predicted impulses,
    std::array<Eigen::Vector3d, 2> at = {};          // [m]  and their points.
    std::vector<TieDirection> changing = {};         // Directions of the problem's impulses,
    std::array<Eigen::Vector3d, 2> where = {};       // [m]  and their points.
    std::vector<double> predicted = {};              // [N s or N m s]
    std::vector<bool> is_redundant = {};             // For each direction of a joint.
    std::vector<SpringInPlan> springs = {};          // For each direction of a spring.
    bool by_end = false;
    std::size_t first_row = 0;

    /// [m]  Vector from the centre of mass of an end's body to the point of predicted impulses.
    [[nodiscard]] Eigen::Vector3d arm_halfway(std::size_t side) const {
      return at[side] - 0.5 * (centres_now[side] + centres_end[side]);
    }
    /// Whether the rows before imply that of a direction.
    [[nodiscard]] bool is_out(std::size_t direction) const;
  };
  /// A force on a link body, as the mean over the span.
  struct LinkForce {
    std::size_t member;
    Eigen::Vector3d force;
    Eigen::Vector3d torque;  // About the pivot.
  };

  void find_link_forces();
  void find_redundant_rows();
  [[nodiscard]] std::optional<std::size_t> lever_of(const Acting& acting) const;
  [[nodiscard]] Pose pose_at(std::size_t body, const std::vector<Pose>& at_end) const;
  [[nodiscard]] TiePlace place_at(const Acting& acting, const std::vector<Pose>& at_end) const;
  [[nodiscard]] std::array<TiedSide, 2> settled_sides(const Acting& acting, const TiePlace& place,
                                                      const std::vector<Pose>& at_end,
                                                      const ProblemBodies& now) const;
  [[nodiscard]] Pose pose_at_end(std::size_t body, const IslandFlight& flight) const;
  void follow(Acting& acting, const IslandFlight& flight) const;
  void turn_with_lever(Acting& acting) const;
  void set_directions(Acting& acting) const;
  [[nodiscard]] std::array<TiedSide, 2> sides_of(const Acting& acting, const ProblemBodies& now,
                                                 const IslandFlight& flight) const;
  [[nodiscard]] bool is_led_by_end(const Acting& acting, const ProblemBodies& now,
                                   const std::vector<bool>& by_end) const;
  void add_rows(Acting& acting, const ProblemBodies& now, const IslandFlight& flight,
                ContactProblem& problem) const;
  void add_spring(Acting& acting, std::size_t k, const ProblemBodies& now,
                  const std::array<TiedSide, 2>& sides, const std::vector<ContactBody>& flown,
                  ContactProblem& problem) const;
  [[nodiscard]] LinkLoad load_of(const LinkForce& force, const RobotFlight& flight) const;
  void add_outer(const Acting& acting, const std::vector<double>& impulses, bool predicted,
                 std::vector<OuterImpulse>& outer) const;
  [[nodiscard]] std::vector<double> part_of(const Acting& acting,
                                            const std::vector<double>& changes) const;

  IslandState& state_;
  double span_;
  std::vector<Acting> acting_ = {};
  std::vector<LinkForce> link_forces_ = {};
  std::vector<Eigen::VectorXd> shifts_of_robots_ = {};  // In the flights of the last rows.
};

}  // namespace firstcontact::detail
