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
  const std::vector<Move>& moves;  ///< Of each member that is no link body.
  const std::vector<RobotFlight>& robots;
  const std::vector<bool>& by_end;  ///< Of the problem's bodies: velocities at the end lead them.
  const std::vector<ContactBody>& at_end;  ///< Of the problem's bodies: as fast as they are there.
  const std::vector<bool>& spins;  ///< Of each member: its angular velocity there is the world's.
};

/// The ties of an island over a plan.
///
/// Impulses act in two parts. Those predicted are constant forces in the flights of the bodies, and
/// act where the tie is halfway. The contact problem finds how much they have to change: joints and
/// taut cables have no velocity where the flights end, and springs pull with the mean of both ends.
/// The changes are taken into the flights until they are small. So the rule is of second order, and
/// joints keep the energy. Nothing of a plan is needed for the next one.
class PlanTies {
 public:
  /// @param span  [s]
  PlanTies(IslandState& state, double span);

  /// Whether nothing is tied, and no force acts on a link.
  [[nodiscard]] bool empty() const { return acting_.empty() && link_forces_.empty(); }

  /// Adds predicted forces [N] and moments [N m] about the centre of mass of a member that is no
  /// link body.
  void add_to(std::size_t member, Eigen::Vector3d& force, Eigen::Vector3d& torque) const;

  /// How much farther a member gets than by the mean of its velocities at both ends: predicted
  /// forces of joints turn within the plan, and dampers change velocities before its middle.
  [[nodiscard]] Move shift(std::size_t member) const;

  /// Likewise the displacements of the coordinates of robots; empty: there are none.
  [[nodiscard]] std::vector<Eigen::VectorXd> shifts_of_robots(const ContactProblem& problem) const;

  /// Takes note of how much velocities change in the flights, for these shifts.
  ///
  /// @param at_end  as that of IslandFlight
  void take_changes(const ProblemBodies& now, const std::vector<ContactBody>& at_end);

  /// The predicted forces along the coordinates of robots, and those on their links; empty: none.
  [[nodiscard]] std::vector<Eigen::VectorXd> loads(const std::vector<RobotFlight>& flights) const;

  /// Makes the rows of a problem whose bodies have the velocities of the flights.
  ///
  /// @param now  the bodies as they move when the plan begins
  void lay(const ProblemBodies& now, const IslandFlight& flight, ContactProblem& problem);

  /// [-]  The greatest change of an impulse in a solution, as a part of the greatest impulse.
  [[nodiscard]] double greatest_change(const std::vector<double>& changes) const;

  /// The predicted impulses [N s or N m s], in the order of the rows.
  [[nodiscard]] Eigen::VectorXd predicted() const;

  /// Predicts with impulses in the order of the rows.
  void predict(const Eigen::VectorXd& impulses);

  /// Predicts that no tie acts.
  void forget();

  /// Adds what the changes of a solution do to robots.
  void add_changes(const std::vector<double>& changes, std::vector<OuterImpulse>& outer) const;

  /// Adds all that ties and forces on links do to robots, the changes included.
  void add_all(const std::vector<double>& changes, std::vector<OuterImpulse>& outer) const;

  /// The impulses of all ties, the changes included.
  [[nodiscard]] std::vector<TieTrackPiece> impulses(const std::vector<double>& changes) const;

  /// Adds the rows of displacements that bring joints together, and cables back to their length,
  /// where a plan ends. Returns by how much the farthest is off [m or rad].
  ///
  /// @param at_end   poses of the members there
  /// @param changes  of the solution
  double add_settling(const std::vector<Pose>& at_end, const std::vector<double>& changes,
                      const ProblemBodies& now, ContactProblem& problem) const;

 private:
  /// A direction of a spring, as the last rows have it.
  struct SpringInPlan {
    TieRow at_begin = {};       // As bodies move when the plan begins,
    TieRow at_end = {};         // and where it ends.
    double weight = 0.5;        // [-]  Of the end.
    double inverse_mass = 0.0;  // [1/kg]
    /// [kg m]  Along the direction, it leads bodies as far as velocities change.
    double lead = 0.0;
  };
  /// A tie in the plan.
  struct Acting {
    const SimTie* tie = nullptr;
    std::size_t index = 0;                  // Of the model.
    std::optional<std::size_t> lever = {};  // The end whose body impulses turn most.
    TiePlace now = {};
    TiePlace end = {};  // Where flights lead.
    std::array<Eigen::Vector3d, 2> centres_now = {};
    std::array<Eigen::Vector3d, 2> centres_end = {};
    Eigen::Vector3d turn = Eigen::Vector3d::Zero();  // [rad]  Of that body in the plan.
    std::vector<TieDirection> halfway = {};          // In which predicted impulses act,
    std::array<Eigen::Vector3d, 2> at = {};          // [m]  and where.
    std::vector<TieDirection> changing = {};         // In which those of the problem act,
    std::array<Eigen::Vector3d, 2> where = {};       // [m]  and where.
    std::vector<double> predicted = {};              // [N s or N m s]
    std::vector<bool> is_redundant = {};             // Of each direction of a joint.
    std::vector<SpringInPlan> springs = {};          // Of each direction of a spring.
    bool by_end = false;
    std::size_t first_row = 0;

    /// [m]  From the centre of mass of an end's body to where predicted impulses act.
    [[nodiscard]] Eigen::Vector3d arm_halfway(std::size_t side) const {
      return at[side] - 0.5 * (centres_now[side] + centres_end[side]);
    }
    /// Whether rows before that of a direction imply it.
    [[nodiscard]] bool is_out(std::size_t direction) const;
  };
  /// A force on a link body, of the mean over the span.
  struct LinkForce {
    std::size_t member;
    Eigen::Vector3d force;
    Eigen::Vector3d torque;  // About the pivot.
  };

  void find_link_forces();
  void find_redundant_rows();
  [[nodiscard]] std::optional<std::size_t> lever_of(const Acting& acting) const;
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
