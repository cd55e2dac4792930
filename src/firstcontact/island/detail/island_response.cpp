#include <firstcontact/island/detail/island_response.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

#include <firstcontact/contact_solver/detail/re_solve.h>
#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/island/detail/sequential_impacts.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/response.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// [m/s, rad/s]  The greatest component of any velocity.
double fastest(const ContactSolution& solution) {
  double greatest = 0.0;
  for (const ContactBody& body : solution.bodies) {
    greatest = std::max({greatest, body.v.cwiseAbs().maxCoeff(), body.w.cwiseAbs().maxCoeff()});
  }
  for (const Eigen::VectorXd& velocities : solution.mechanisms) {
    greatest = std::max(greatest, velocities.cwiseAbs().maxCoeff());
  }
  return greatest;
}

/// [m/s]  A fraction of what gravity adds in a step.
double of_gravity(const IslandState& state, double part) {
  return std::max(kLeastTolerance, part * state.model.gravity.norm() * state.start.h);
}

/// [J]  The energy of a member, by the inertia in the problem: that of now or, where it spins, that
/// of the end of the plan.
double energy_of(const IslandState& state, std::size_t k, const InverseInertia& inverse,
                 const ContactBody& moving) {
  const Inertia& inertia = state.member(k).inertia;
  if (is_locked(inertia)) {
    return kinetic_energy(inertia, {state.states[k].X_WB, moving.v, moving.w});
  }
  return 0.5 * inertia.mass * moving.v.squaredNorm() +
         0.5 * moving.w.dot(inverse.rotation.inverse() * moving.w);
}

/// [J]  The energy of the members and their robots.
double energy_of(const IslandState& state, const ContactProblem& problem,
                 const std::vector<ContactBody>& bodies,
                 const std::vector<Eigen::VectorXd>& mechanisms) {
  double sum = kinetic_energy(problem.mechanisms, mechanisms);
  for (std::size_t k = 0; k < state.size(); ++k) {
    if (!state.member(k).link_body) {
      sum += energy_of(state, k, problem.bodies[k].inverse_inertia, bodies[k]);
    }
  }
  return sum;
}

/// Makes the problem with motors that yield a little to contacts and limits that leave no room for
/// their target velocities. Nothing where no motor is stronger than any force.
std::optional<ContactProblem> with_yielding_motors(const ContactProblem& problem) {
  std::optional<ContactProblem> yielding;
  for (std::size_t k = 0; k < problem.drives.size(); ++k) {
    const JointDrive& drive = problem.drives[k];
    if (drive.compliance == 0.0 && std::isinf(drive.least) && std::isinf(drive.greatest)) {
      yielding = yielding ? std::move(yielding) : std::optional(problem);
      const auto c = static_cast<Eigen::Index>(drive.coordinate);
      yielding->drives[k].compliance =
          kYield * problem.mechanisms[drive.mechanism].inverse_mass(c, c);
    }
  }
  return yielding;
}

/// Whether scripts push an island. A script that waited in the step before does not count: the
/// bodies that it would push are jammed.
bool is_pushed(const IslandState& state, const ContactProblem& problem) {
  const auto around = problem.bodies.begin() + static_cast<std::ptrdiff_t>(state.size());
  return std::ranges::find(state.start.waited, true) == state.start.waited.end() &&
         std::any_of(around, problem.bodies.end(),
                     [](const ContactBody& body) { return body.v.any() || body.w.any(); });
}

/// Makes the problem with contacts that slip. Nothing where none has friction.
std::optional<ContactProblem> with_slippery_contacts(const ContactProblem& problem) {
  ContactProblem slippery = problem;
  bool has_friction = false;
  for (ContactPoint& contact : slippery.contacts) {
    has_friction = has_friction || contact.friction > 0.0;
    contact.friction *= kSlippery;
    contact.guess.setZero();
  }
  return has_friction ? std::optional(std::move(slippery)) : std::nullopt;
}

/// Whether no body outside acts on an island through contacts, and none of its bodies is held.
bool is_isolated(const IslandState& state, const ContactProblem& problem) {
  const auto is_set = [](bool lock) { return lock; };
  for (std::size_t k = 0; k < state.size(); ++k) {
    const Inertia& inertia = state.member(k).inertia;
    if (std::ranges::any_of(inertia.locked_translation, is_set) ||
        std::ranges::any_of(inertia.locked_rotation, is_set)) {
      return false;
    }
  }
  for (std::size_t r = 0; r < state.robots.size(); ++r) {
    if (!state.robots.free_base(r)) {
      return false;
    }
  }
  const bool is_tied = std::ranges::any_of(problem.ties, [&](const TieRow& tie) {
    return tie.sides.size() < 2 || std::ranges::any_of(tie.sides, [&](const TieSide& side) {
             return side.body >= state.size();
           });
  });
  return !is_tied && std::ranges::all_of(problem.contacts, [&](const ContactPoint& contact) {
    return contact.bodies[0] < state.size() && contact.bodies[1] < state.size();
  });
}

/// The sum of masses, moments and momenta, about the origin.
class Sum {
 public:
  /// @param inertia   (6, 6)  of (v, w) at a point, @param momentum  about the point
  void add(const Matrix6d& inertia, const Vector6d& momentum, const Vector3d& point) {
    Matrix6d to_point = Matrix6d::Identity();  // Velocities at the origin give those at the point.
    to_point.topRightCorner<3, 3>() << 0.0, point.z(), -point.y(), -point.z(), 0.0, point.x(),
        point.y(), -point.x(), 0.0;
    inertia_ += to_point.transpose() * inertia * to_point;
    momentum_ += to_point.transpose() * momentum;
  }

  /// The velocity of all of it as one rigid body with these momenta.
  [[nodiscard]] Vector6d velocity() const { return inertia_.ldlt().solve(momentum_); }

 private:
  Matrix6d inertia_ = Matrix6d::Zero();
  Vector6d momentum_ = Vector6d::Zero();
};

/// Makes the motion of an island as one rigid body with the momenta of a solution.
ContactSolution as_one_body(const IslandState& state, const ContactProblem& problem,
                            const ContactSolution& solution) {
  Sum sum;
  const auto centre = [&](std::size_t k) {
    return centre_of_mass(state.member(k).inertia, state.states[k].X_WB);
  };
  for (std::size_t k = 0; k < state.size(); ++k) {
    if (!state.member(k).link_body) {
      const Inertia& of_body = state.member(k).inertia;
      Matrix6d inertia = of_body.mass * Matrix6d::Identity();
      inertia.bottomRightCorner<3, 3>() = rotational_inertia(of_body, state.states[k].X_WB);
      Vector6d velocity;
      velocity << solution.bodies[k].v, solution.bodies[k].w;
      sum.add(inertia, inertia * velocity, centre(k));
    }
  }
  for (std::size_t r = 0; r < problem.mechanisms.size(); ++r) {
    const Eigen::MatrixXd& inverse = problem.mechanisms[r].inverse_mass;
    const Eigen::MatrixXd M =
        inverse.llt().solve(Eigen::MatrixXd::Identity(inverse.rows(), inverse.cols()));
    sum.add(M.topLeftCorner<6, 6>(), M.topRows<6>() * solution.mechanisms[r],
            *state.robots.free_base(r));
  }
  const Vector6d V = sum.velocity();
  const Vector3d w = V.tail<3>();
  ContactSolution one = solution;
  for (std::size_t k = 0; k < state.size(); ++k) {
    one.bodies[k].v = V.head<3>() + w.cross(centre(k));
    one.bodies[k].w = w;
  }
  for (std::size_t r = 0; r < problem.mechanisms.size(); ++r) {
    one.mechanisms[r].setZero();
    one.mechanisms[r].head<6>() << V.head<3>() + w.cross(*state.robots.free_base(r)), w;
  }
  return one;
}

/// Takes a share of the velocities of a solution, on top of those of another one.
void shorten(const ContactSolution& to, double share, std::size_t members,
             ContactSolution& solution) {
  for (std::size_t k = 0; k < members; ++k) {
    solution.bodies[k].v = to.bodies[k].v + share * (solution.bodies[k].v - to.bodies[k].v);
    solution.bodies[k].w = to.bodies[k].w + share * (solution.bodies[k].w - to.bodies[k].w);
  }
  for (std::size_t r = 0; r < solution.mechanisms.size(); ++r) {
    solution.mechanisms[r] = to.mechanisms[r] + share * (solution.mechanisms[r] - to.mechanisms[r]);
  }
}

/// Shortens the velocities of an isolated island relative to its motion as one body. So it keeps
/// its momenta and has the permitted energy [J].
void shorten_within(const IslandState& state, const ContactProblem& problem, double allowed,
                    ContactSolution& solution) {
  const ContactSolution one = as_one_body(state, problem, solution);
  const auto energy_at = [&](double share) {
    ContactSolution at = solution;
    shorten(one, share, state.size(), at);
    return energy_of(state, problem, at.bodies, at.mechanisms);
  };
  // a + b s + c s^2
  const double a = energy_at(0.0);
  const double whole = energy_at(1.0) - a;
  const double half = energy_at(0.5) - a;
  const double c = 2.0 * whole - 4.0 * half;
  const double b = whole - c;
  const double under = b * b + 4.0 * c * std::max(0.0, allowed - a);
  const double share = c > 0.0 ? (std::sqrt(std::max(0.0, under)) - b) / (2.0 * c) : 0.0;
  shorten(one, std::clamp(share, 0.0, 1.0), state.size(), solution);
}

/// Limits the energy of a solution: contacts add none. Without moving bodies around, rest meets all
/// contacts, so the projection on them makes no velocity longer in the kinetic metric. A scripted
/// body adds at most its own speed twice, and so does a belt. For a problem without solution, as
/// for a crushed body, the solver's answer is arbitrary: it is shortened to the energy before, or
/// to that of moving with the script. An isolated island keeps its momenta. Motors add what they
/// want, as long as there is a solution.
///
/// @param free  [J]  before; if nothing, that of the problem's velocities
/// @returns whether it was shortened
bool limit_energy(const IslandState& state, const ContactProblem& problem,
                  ContactSolution& solution, std::optional<double> free = std::nullopt) {
  const bool has_solution = is_solved(state, solution);
  if (has_solution && (state.robots.has_motors() || !problem.ties.empty())) {
    return false;
  }
  const double before = free ? *free : free_energy(state, problem);
  const double after = energy_of(state, problem, solution.bodies, solution.mechanisms);
  double mass = 0.0;
  for (std::size_t k = 0; k < state.size(); ++k) {
    mass += state.member(k).inertia.mass;
  }
  double speed = 0.0;
  for (const ContactPoint& contact : problem.contacts) {
    speed = std::max(speed, contact.sticking_velocity.norm());
    for (int side = 0; side < 2; ++side) {
      const ContactBody& body = problem.bodies[contact.bodies[side]];
      if (contact.bodies[side] >= state.size()) {
        const Vector3d& arm = side == 0 ? contact.arm_A : contact.arm_B;
        speed = std::max(speed, (body.v + body.w.cross(arm)).norm());
      }
    }
  }
  const double along = speed * std::sqrt(0.5 * mass);
  const double allowed =
      has_solution ? std::sqrt(before) + 2.0 * along : std::max(std::sqrt(before), along);
  if (std::sqrt(after) <= allowed * (1.0 + 1e-9)) {
    return false;
  }
  if (is_isolated(state, problem)) {
    shorten_within(state, problem, allowed * allowed, solution);
    return true;
  }
  const double share = allowed / std::sqrt(after);
  for (std::size_t k = 0; k < state.size(); ++k) {
    solution.bodies[k].v *= share;
    solution.bodies[k].w *= share;
  }
  for (Eigen::VectorXd& velocities : solution.mechanisms) {
    velocities *= share;
  }
  return true;
}

/// Whether sweeps alone would not converge.
bool has_many(const IslandState& state, std::size_t contacts) {
  return contacts >= kHeapContacts && state.size() >= kHeapBodies;
}

/// Whether no member moves faster than the residual of the solver.
bool stands(const IslandState& state) {
  const double slow = of_gravity(state, kStandsOfGravity);
  for (std::size_t k = 0; k < state.size(); ++k) {
    const RigidState& member = state.states[k];
    if (!(member.v_WC.norm() + state.member(k).reach * member.w_WB.norm() <= slow)) {
      return false;
    }
  }
  return true;
}

PlanSolution project_with_motors(const IslandState& state, const ContactProblem& problem,
                                 const ProjectionOptions& options, std::optional<double> free) {
  PlanSolution plan{project_on_contacts(problem, options)};
  if (!is_solved(state, plan.velocities)) {
    if (const std::optional<ContactProblem> yielding = with_yielding_motors(problem)) {
      plan.velocities = project_on_contacts(*yielding, options);
    }
  }
  plan.is_limited = limit_energy(state, problem, plan.velocities, free);
  return plan;
}

PlanSolution project_with(IslandState& state, const ContactProblem& problem,
                          const ProjectionOptions& options,
                          std::optional<double> free = std::nullopt) {
  if (problem.contacts.empty() && problem.drives.empty() && problem.ties.empty()) {
    return {unchanged(problem)};
  }
  PlanSolution plan = project_with_motors(state, problem, options, free);
  if (is_solved(state, plan.velocities) || state.slips >= kMostSlips ||
      !is_pushed(state, problem)) {
    return plan;
  }
  if (const std::optional<ContactProblem> slippery = with_slippery_contacts(problem)) {
    ++state.slips;
    PlanSolution slipping = project_with_motors(state, *slippery, options, free);
    if (is_solved(state, slipping.velocities)) {
      slipping.velocities.residual = contact_residual(problem, slipping.velocities);
      slipping.slips = true;
      return slipping;
    }
  }
  return plan;
}

}  // namespace

double free_energy(const IslandState& state, const ContactProblem& problem) {
  return energy_of(state, problem, problem.bodies, velocities_of(problem.mechanisms));
}

bool is_solved(const IslandState& state, const ContactSolution& solution) {
  const double left = state.robots.empty() ? solution.allowed : 0.0;
  return solution.residual <=
         std::max({left, of_gravity(state, kUnsolved), kUnsolvedOfSpeed * fastest(solution)});
}

double exact_tolerance(const IslandState& state) { return of_gravity(state, kExactTolerance); }

bool is_heap(const IslandState& state, std::size_t contacts) {
  return has_many(state, contacts) && !stands(state);
}

ProjectionOptions projection_options(const IslandState& state, const ContactProblem& problem) {
  const bool is_of_many = has_many(state, problem.contacts.size());
  ProjectionOptions options{.tolerance = exact_tolerance(state)};
  if (!is_of_many) {
    options.rounds = kRoundsOfMany;
  }
  const bool is_large = is_of_many || problem.contacts.size() >= kManyContactsOfIsland;
  if (!is_large || stands(state)) {
    return options;
  }
  options.tolerance = of_gravity(state, kHeapTolerance);
  options.rounds = kRoundsOfMany;
  if (is_of_many) {
    options.enough = of_gravity(state, kHeapEnough);
    options.sweeps = kHeapSweeps;
  }
  return options;
}

/// Chooses the options of a plan. Free bodies that meet within a plan need not be solved as exactly
/// as those that an impact parts.
ProjectionOptions plan_options(const IslandState& state, const ContactProblem& problem) {
  ProjectionOptions options = projection_options(state, problem);
  if (state.size() >= kSeveralBodies && state.robots.empty() && !state.model.gravity.isZero(0.0)) {
    options.of_hits = kPartOfHits;
    options.hit = of_gravity(state, kHitOfGravity);
  }
  return options;
}

PlanSolution project_plan(IslandState& state, const ContactProblem& problem,
                          std::optional<double> free) {
  return project_with(state, problem, plan_options(state, problem), free);
}

PlanSolution project_way(IslandState& state, const ContactProblem& problem, double span) {
  ProjectionOptions options = plan_options(state, problem);
  options.tolerance =
      std::max(options.tolerance, kToleranceOfWay * state.model.distances.least / span);
  options.space = ProjectionSpace::contact;
  options.sweeps = kSweepsOfWay;
  return project_with(state, problem, options);
}

std::optional<PlanSolution> project_plan_again(const IslandState& state,
                                               const ContactProblem& problem,
                                               const PlanSolution& before,
                                               const std::vector<std::size_t>& changed) {
  if (!is_heap(state, problem.contacts.size()) || !state.robots.empty() || before.is_limited ||
      !problem.ties.empty()) {
    return std::nullopt;
  }
  PlanSolution plan{
      re_solve(problem, before.velocities, changed,
               {.tolerance = of_gravity(state, kAroundTolerance), .sweeps = kAroundSweeps})};
  if (plan.velocities.residual > projection_options(state, problem).enough) {
    return std::nullopt;
  }
  plan.is_limited = limit_energy(state, problem, plan.velocities);
  return plan;
}

ContactSolution project_impact_of(const IslandState& state, const ContactProblem& problem,
                                  const std::vector<BodyPair>& pairs) {
  std::vector<double> restitution;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    restitution.push_back(restitution_of(state, pairs[k], problem.contacts[k], problem.bodies));
  }
  const bool bounces = std::ranges::any_of(restitution, [](double e) { return e > 0.0; });
  return bounces && state.model.impacts == ImpactLaw::sequential
             ? project_sequential_impacts(state, problem, pairs)
             : project_simultaneous_impact(state, problem, restitution);
}

double slowest_bounce(const IslandState& state) {
  return kStepsWithoutBounce * state.model.gravity.norm() * state.start.h;
}

double restitution_of(const IslandState& state, const BodyPair& pair, const ContactPoint& contact,
                      const std::vector<ContactBody>& bodies) {
  return state.bounces(pair, -normal_velocity(contact, bodies)) ? state.model.laws.restitution(pair)
                                                                : 0.0;
}

ContactSolution project_simultaneous_impact(const IslandState& state, const ContactProblem& problem,
                                            const std::vector<double>& restitution) {
  const auto project = [&](const ContactProblem& given) {
    return project_impact(
        given, restitution, state.size(),
        [&](const auto& moving, const auto& mechanisms) {
          return energy_of(state, given, moving, mechanisms);
        },
        projection_options(state, given));
  };
  ContactSolution solution = project(problem);
  if (!is_solved(state, solution)) {
    if (const std::optional<ContactProblem> yielding = with_yielding_motors(problem)) {
      solution = project(*yielding);
    }
  }
  limit_energy(state, problem, solution);
  return solution;
}

std::vector<OuterImpulse> outer_impulses(const ContactProblem& problem,
                                         const PlanSolution& solution, const ProblemBodies& bodies,
                                         std::size_t robots, double span) {
  std::vector<OuterImpulse> outer(robots);
  for (std::size_t k = 0; k < problem.contacts.size() && robots > 0; ++k) {
    const ContactPoint& contact = problem.contacts[k];
    const std::array<const std::optional<MechanismLink>*, 2> links{
        &problem.bodies[contact.bodies[0]].link, &problem.bodies[contact.bodies[1]].link};
    const Vector3d impulse = contact.frame.transpose() * solution.velocities.impulses[k];
    const bool is_inner =
        *links[0] && *links[1] && (*links[0])->mechanism == (*links[1])->mechanism;
    if (impulse.isZero(0.0)) {
      continue;
    }
    for (const auto* link : links) {
      if (*link) {
        outer[(*link)->mechanism].touches = true;
      }
    }
    if (is_inner) {
      continue;
    }
    const auto halfway = [&](int side) {
      const std::size_t place = contact.bodies[side];
      const Vector3d mean = 0.5 * (bodies.bodies()[place].v + solution.velocities.bodies[place].v);
      return Vector3d(bodies.centre(place) + 0.5 * span * mean +
                      (side == 0 ? contact.arm_A : contact.arm_B));
    };
    const std::array<Vector3d, 2> points{halfway(0), halfway(1)};
    const auto is_free = [&](int side) {
      return problem.bodies[contact.bodies[side]].inverse_inertia.mass.any();
    };
    for (int side = 0; side < 2; ++side) {
      if (*links[side]) {
        const Vector3d point = *links[1 - side] ? Vector3d(0.5 * (points[0] + points[1]))
                                                : points[is_free(1 - side) ? 1 - side : side];
        const Vector3d on = side == 0 ? Vector3d(-impulse) : impulse;
        OuterImpulse& sum = outer[(*links[side])->mechanism];
        sum.linear += on;
        sum.angular += point.cross(on);
        sum.acts = true;
        sum.is_known = !solution.is_limited;
      }
    }
  }
  return outer;
}

}  // namespace firstcontact::detail
