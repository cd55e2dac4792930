/// @file
/// How an island is to move over a span of time: Gauss' principle on the velocities at its end.

#pragma once

#include <optional>
#include <vector>

#include <firstcontact/dynamics/detail/island_state.h>

namespace firstcontact::detail {

/// A touch of the motion ahead, and how it would be reached.
struct TouchAhead {
  Touch touch;
  ContactPoint contact;  ///< With the arms of its time.
  double least = 0.0;    ///< [m/s]  Normal velocity that keeps the pair apart until the end.
};

/// What the bodies do over its span: the rest of the step, or less.
struct Plan {
  std::vector<Move> moves = {};     ///< Of each member.
  std::vector<ContactBody> at_end;  ///< Velocities of each member.
  std::vector<RobotPlan> robots = {};
  std::vector<Touch> touches = {};  ///< With their impulses.
  double residual = 0.0;            ///< [m/s]
};

/// Makes plans from where an island is now, each with more constraints than the one before.
class IslandPlanner {
 public:
  /// @param span  [s]
  IslandPlanner(IslandState& state, double span) : state_(state), span_(span) {}

  /// Starts from the impulses of the touches, which are those of a whole step, and leaves those
  /// that it finds there.
  ///
  /// @param ahead  touches that are to be constraints besides those of now
  [[nodiscard]] Plan plan(std::vector<TouchAhead>& ahead);

 private:
  struct FreeFlight;

  [[nodiscard]] FreeFlight free_flight(const std::vector<ContactBody>& bodies) const;
  [[nodiscard]] double drift_along(const BodyPair& pair, const ContactPoint& contact) const;
  [[nodiscard]] std::vector<bool> led_by_end(const ContactProblem& problem,
                                             const std::vector<ContactBody>& before,
                                             const ContactSolution& solution) const;
  void set_moves(const std::vector<ContactBody>& before, const FreeFlight& flight,
                 const ContactSolution& solution, const std::vector<bool>& by_end,
                 Plan& plan) const;
  void push_apart(Plan& plan);
  [[nodiscard]] ContactSolution find_push();

  IslandState& state_;
  double span_;                               // [s]
  std::optional<ContactSolution> push_ = {};  // Of all plans from now.
};

/// [s]  Too short a time, of a step of h, for anything to be done in it: who looks at the motion
/// could not divide it.
inline double stall(double h) { return 1e-9 * h; }

}  // namespace firstcontact::detail
