#include <firstcontact/retiming/executed_proof.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

#include <Eigen/Core>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/retiming/detail/held_stretches.h>
#include <firstcontact/robot/detail/given_motions.h>
#include <firstcontact/robot/rest.h>
#include <firstcontact/robot/robot_motion.h>
#include <firstcontact/robot/tracking_error.h>
#include <firstcontact/scene/trajectory.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/write_json.h>
#include <firstcontact/trajectory_files/read_trajectory.h>

namespace firstcontact {
namespace {

[[noreturn]] void refuse_moving(const std::string& what) {
  throw std::invalid_argument(what + " moves; retiming changes the time of the motion, so that " +
                              "all else has to rest");
}

void require_held_all_the_time(const RobotScene& scene) {
  for (std::size_t member = 0; member < scene.size(); ++member) {
    if (scene.robot_link(member)) {
      continue;
    }
    const auto stretches = scene.stretches(member);
    const bool is_carried =
        !stretches.empty() && std::holds_alternative<BodyStretch::Carried>(stretches.front().how);
    if (stretches.size() > 1) {
      refuse_moving("body " + detail::in_quotes(scene.name(member)) + " is taken or put down: it");
    }
    if (!is_carried && !scene.rests(member)) {
      refuse_moving("body " + detail::in_quotes(scene.name(member)));
    }
  }
}

/// [-]  Tolerance, by the distance that a pair is held to. A plan leaves at least twice as much.
constexpr double kToleranceOfHolds = 0x1p-7;

double start_of(const CoordinatePath& path) {
  return path.segments().front().state(0.0).value.value();
}

/// The coordinates of a robot at t = 0, by name.
JointPositions start_positions(const RobotMotion& motion) {
  JointPositions positions;
  for (std::size_t joint = 0; joint < motion.model().joints().size(); ++joint) {
    const std::optional<JointMotion> given = motion.given(joint);
    if (!given) {
      continue;
    }
    if (const auto* path = std::get_if<CoordinatePath>(&*given)) {
      positions[coordinate_name(motion.model(), {joint, 0})] = start_of(*path);
    } else if (const auto* planar = std::get_if<PlanarPath>(&*given)) {
      for (std::size_t k = 0; k < planar->size(); ++k) {
        positions[coordinate_name(motion.model(), {joint, k})] = start_of((*planar)[k]);
      }
    }
  }
  return positions;
}

/// [s]  Duration of the check: also a motion of one point takes a while.
double step_of(const TimedMotion& motion) { return std::max(motion.duration(), 1e-9); }

RobotMotion robot_motion_of(const TimedMotion& motion, const RobotMotion& before) {
  const RobotModel& model = before.model();
  for (const std::string& name : motion.joint_names) {
    if (model.joints()[find_coordinate(model, name).joint].type == JointType::floating) {
      throw std::invalid_argument("joint " + detail::in_quotes(name) +
                                  " is floating: no controller of joints executes its pose");
    }
  }
  TrajectoryMotion joints =
      joint_motions(model, trajectory_of(motion), start_positions(before), step_of(motion));
  for (std::size_t joint = 0; joint < model.joints().size(); ++joint) {
    const std::optional<JointMotion> given = before.given(joint);
    if (given && std::holds_alternative<Motion>(*given)) {
      joints.joints.insert_or_assign(model.joints()[joint].name, *given);
    }
  }
  return {model, std::move(joints.joints), before.base()};
}

/// Whether a coordinate stays in place, to the rounding that a proof allows for.
bool rests_nearly(std::span<const CoordinateSegment> segments) {
  double low = segments.front().a[0].hi;
  double high = low;
  for (const CoordinateSegment& segment : segments) {
    double way = 0.0;
    for (std::size_t j = 1; j < segment.count; ++j) {
      way += std::abs(segment.a[j].hi);
    }
    low = std::min(low, segment.a[0].hi - way);
    high = std::max(high, segment.a[0].hi + way);
  }
  return high - low <= kRoundingAllowance;
}

/// Narrows the positions of a joint.
void narrow(const PositionLimits& given, JointLimits& limits) {
  if (given.lower) {
    limits.lower = std::max(*given.lower, limits.lower.value_or(*given.lower));
  }
  if (given.upper) {
    limits.upper = std::min(*given.upper, limits.upper.value_or(*given.upper));
  }
}

/// The motion of a robot without geometry, whose joints have the narrower positions.
///
/// @param begin  before its joints in `positions`: "ROBOT/" where several robots move
RobotMotion within_positions(const RobotMotion& motion, const std::string& begin,
                             const std::map<std::string, PositionLimits>& positions) {
  const RobotModel& model = motion.model();
  RobotDescription robot{
      .name = model.name(), .links = {}, .joints = {model.joints().begin(), model.joints().end()}};
  for (const Link& link : model.links()) {
    robot.links.push_back({.name = link.name});
  }
  for (Joint& narrowed : robot.joints) {
    if (const auto found = positions.find(begin + narrowed.name); found != positions.end()) {
      narrow(found->second, narrowed.limits);
    }
  }
  return {RobotModel(std::move(robot)), detail::given_motions(motion), motion.base()};
}

/// The limits that a robot leaves and that retiming can change.
///
/// Left out are those that rate_report() reports, and those of joints that rest, also where the
/// path names them.
///
/// @param motion  its points, with the robot's own names
std::vector<LimitViolation> violations_of(const TimedMotion& motion, const RobotMotion& robot) {
  std::vector<LimitViolation> violations = limit_report(robot, step_of(motion));
  std::erase_if(violations, [&](const LimitViolation& violation) {
    const std::string& name = robot.model().joints()[violation.joint].name;
    const bool is_named = std::ranges::find(motion.joint_names, name) != motion.joint_names.end();
    return (is_named && violation.what == JointLimit::velocity) ||
           rests_nearly(robot.coordinate(violation.joint));
  });
  return violations;
}

/// Bounds how far a joint is off by the rounding of times, velocities and accelerations.
///
/// Derivation: u = 2^-53, and D is the duration. A quotient t / D is off by u at most. That moves
/// the time by u D and changes the length of a segment by 2 u D. A velocity or acceleration per
/// step is off by one or two units. V is the greatest velocity, A the greatest acceleration of a
/// point, and h the longest segment, h <= D. The position is off by u D (V + A h) for the times. It
/// is off by u V h for the velocity and by u A h^2 for the acceleration. Each counts a few times.
/// The sum is less than 16 u D (V + 2 A h).
double rounding_of(const TimedMotion& motion, const std::vector<RateUse>& rates) {
  double velocity = 0.0;
  for (const RateUse& use : rates) {
    velocity = use.what == JointRate::velocity ? std::max(velocity, use.bound) : velocity;
  }
  double acceleration = 0.0;
  for (const TimedPoint& point : motion.points) {
    for (const double a : point.accelerations) {
      acceleration = std::max(acceleration, std::abs(a));
    }
  }
  double longest = 0.0;  // [s]
  for (std::size_t k = 1; k < motion.points.size(); ++k) {
    longest = std::max(
        longest, 1e-9 * static_cast<double>(motion.points[k].time - motion.points[k - 1].time));
  }
  return 16.0 * 0x1p-53 * motion.duration() * (velocity + 2.0 * acceleration * longest);
}

void add_rounding_allowance(RobotScene& scene, std::size_t robot) {
  const std::vector<TrackingError> errors = scene.tracking_errors(robot);
  const RobotModel model = scene.robot_motion(robot).model();
  for (std::size_t joint = 0; joint < errors.size(); ++joint) {
    const Joint& what = model.joints()[joint];
    if (coordinate_count(what.type) == 0 || what.mimic) {
      continue;
    }
    TrackingError error = errors[joint];
    if (what.type != JointType::prismatic) {
      error.angle += kRoundingAllowance;
    }
    if (what.type == JointType::prismatic || what.type == JointType::planar) {
      error.distance += kRoundingAllowance;
    }
    scene.set_tracking_error(robot, what.name, error);
  }
}

/// The robots with positions beyond limits.
std::vector<SceneLimits> positions_beyond_limits(const TimedMotion& motion,
                                                 const RetimingScene& where) {
  std::vector<SceneLimits> all;
  const std::vector<TimedMotion> parts = split_motion(motion, where);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const std::size_t robot = where.robots[k];
    RobotMotion moved = robot_motion_of(parts[k], where.scene.robot_motion(robot));
    if (!where.positions.empty()) {
      const std::string begin = where.robots.size() == 1 ? "" : where.scene.robot_name(robot) + "/";
      moved = within_positions(moved, begin, where.positions);
    }
    std::vector<LimitViolation> violations = violations_of(parts[k], moved);
    if (!violations.empty()) {
      all.push_back({robot, std::move(violations)});
    }
  }
  return all;
}

/// Checks a stretch of a motion in which some pairs are held.
SceneResult check_stretch(const TimedMotion& motion, const std::vector<RetimingHold>& holds,
                          const RetimingScene& where, const ProofOptions& options) {
  RobotScene scene = where.scene;
  const std::vector<TimedMotion> parts = split_motion(motion, where);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const std::size_t robot = where.robots[k];
    scene.set_motion(robot, robot_motion_of(parts[k], scene.robot_motion(robot)));
    add_rounding_allowance(scene, robot);
  }
  double tolerance = options.tolerance;
  for (const RetimingHold& hold : holds) {
    scene.hold_pair(hold.members, hold.distance);
    tolerance = std::min(tolerance, kToleranceOfHolds * hold.distance);
  }
  return check_robots(scene, {.tolerance = tolerance,
                              .budget = options.budget,
                              .threads = options.threads,
                              .closest = options.closest});
}

/// Whether the reader found a point that stands twice; only its warning shows it.
bool takes_a_point_once(const Trajectory& trajectory) {
  return std::any_of(trajectory.warnings.begin(), trajectory.warnings.end(),
                     [](const std::string& warning) {
                       return warning.find("stands twice") != std::string::npos ||
                              warning.find("stand twice") != std::string::npos;
                     });
}

}  // namespace

void require_resting_surroundings(const RetimingScene& where) {
  const RobotScene& scene = where.scene;
  (void)joined_model(where);  // Refuses numbers that are no robots, and a robot that stands twice.
  require_held_all_the_time(scene);
  for (std::size_t robot = 0; robot < scene.robot_count(); ++robot) {
    const RobotMotion& motion = scene.robot_motion(robot);
    const bool is_moved = std::ranges::find(where.robots, robot) != where.robots.end();
    if (!rests(motion.base())) {
      refuse_moving("the base of robot " + detail::in_quotes(scene.robot_name(robot)));
    }
    for (std::size_t joint = 0; joint < motion.model().joints().size(); ++joint) {
      const std::optional<JointMotion> given = motion.given(joint);
      const bool may_move = is_moved && coordinate_count(motion.model().joints()[joint].type) > 0;
      if (given && !may_move && !rests(*given)) {
        refuse_moving("robot " + detail::in_quotes(scene.robot_name(robot)));
      }
    }
  }
}

ExecutedProof prove_motion(const TimedMotion& motion, const std::vector<RateLimits>& limits,
                           const RetimingScene& where, const ProofOptions& options) {
  require_resting_surroundings(where);
  const FloatEnvironmentGuard guard;
  ExecutedProof proof;
  proof.rates = rate_report(motion, limits);
  proof.duration = motion.duration();
  if (!(rounding_of(motion, proof.rates) <= kRoundingAllowance)) {
    throw std::invalid_argument("the motion lasts too long, or its rates are too high, to be " +
                                std::string("proven in double precision"));
  }
  proof.positions = positions_beyond_limits(motion, where);
  const detail::HeldStretches stretches(motion, where.holds);
  proof.held = stretches.times();
  for (std::size_t k = 0; k < stretches.size(); ++k) {
    detail::StretchResult found{
        stretches.begin(k), stretches.end(k),
        check_stretch(stretches.motion(k), stretches.holds(k), where, options)};
    detail::append_result(std::move(found), proof.duration, proof.contact);
    if (proof.contact.verdict != Verdict::free) {
      break;
    }
  }
  return proof;
}

TimedMotion parse_timed_motion(std::string_view text, const std::filesystem::path& source,
                               const RobotModel& robot) {
  const Trajectory trajectory = parse_trajectory(text, source, robot);
  if (takes_a_point_once(trajectory)) {
    throw ParseError(source.string(),
                     "expected times that increase strictly, got a point twice; a controller "
                     "refuses such a trajectory");
  }
  try {
    TimedMotion motion = timed_motion_of(trajectory);
    if (motion.points.front().time != 0) {
      throw std::invalid_argument("expected a first point at the time 0, where the robot rests");
    }
    return motion;
  } catch (const std::invalid_argument& error) {
    throw ParseError(source.string(), error.what());
  }
}

}  // namespace firstcontact
