#include <firstcontact/verification/verify_path.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>
#include <variant>

#include <Eigen/Geometry>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/planned_path.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene/trajectory.h>
#include <firstcontact/scene_files/read_planned_path.h>
#include <firstcontact/text/write_json.h>
#include <firstcontact/verification/detail/describe_finding.h>
#include <firstcontact/verification/detail/rigid_motion.h>
#include <firstcontact/verification/detail/scene_courses.h>
#include <firstcontact/verification/detail/scene_proof.h>

namespace firstcontact {
namespace {

using detail::FreeClaim;
using detail::ProofFinding;

/// A path that contradicts itself or its scene. One sentence.
class BrokenPath : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// How far the length of a quaternion may be from 1, as in scenes.
constexpr double kUnit = 1e-6;

/// [rad or m]  How far joints may be beyond their limits, as in limit_report().
constexpr double kLimitTolerance = 1e-9;

/// A coordinate of a joint can turn the short way if nothing that mimics it shows whole turns.
void require_turning(const RobotModel& model, const std::string& name, Turning turning) {
  if (turning == Turning::shortest && !takes_short_way(model, find_coordinate(model, name))) {
    throw BrokenPath("The coordinate " + detail::in_quotes(name) + " cannot turn the short way.");
  }
}

/// Straight edges keep the limits that their ends keep, and so do joints that mimic.
void require_limits(const RobotModel& model, std::size_t joint, double position) {
  const Joint& moved = model.joints()[joint];
  const bool has_limits = moved.type == JointType::revolute || moved.type == JointType::prismatic ||
                          moved.type == JointType::screw;
  const double slack = kLimitTolerance * (1.0 + std::abs(position));
  if (has_limits && (position < moved.limits.lower.value_or(position) - slack ||
                     position > moved.limits.upper.value_or(position) + slack)) {
    throw BrokenPath("A waypoint has joint " + detail::in_quotes(moved.name) + " at " +
                     detail::write_json(position) + ", outside of its limits.");
  }
  for (std::size_t other = 0; other < model.joints().size(); ++other) {
    const std::optional<Mimic>& mimic = model.joints()[other].mimic;
    if (mimic && mimic->joint == moved.name) {
      require_limits(model, other, mimic->multiplier * position + mimic->offset);
    }
  }
}

/// [rad or m]  Where the scene has a joint of a robot at rest.
double position_in_scene(const SceneRobot& robot, const std::string& name) {
  const JointCoordinate which = find_coordinate(robot.model, name);
  const auto found = robot.state.find(coordinate_name(robot.model, which));
  return found != robot.state.end() ? found->second
                                    : default_position(robot.model.joints()[which.joint]);
}

/// The scene in which the mover runs through all waypoints: at their times, else one edge a second.
class MovingScene {
 public:
  explicit MovingScene(const PlannedPath& path) : path_(path), loaded_(load(path)) {
    require_unheld_motion(loaded_.scene);
    if (path.times.empty()) {
      require_at_rest(loaded_.scene);
      const std::size_t edges = path.waypoints.size() - 1;
      loaded_.scene.duration = static_cast<double>(std::max<std::size_t>(edges, 1));
    } else {
      require_times();
    }
    if (path.body.empty()) {
      move_robot();
    } else {
      move_body();
    }
  }

  [[nodiscard]] const LoadedScene& loaded() const { return loaded_; }
  [[nodiscard]] const std::map<std::size_t, detail::Turnings>& turnings() const {
    return turnings_;
  }

  /// The body that moves; none where a robot does.
  [[nodiscard]] std::optional<std::size_t> body() const { return body_; }

  /// Whether a member moves along edges.
  [[nodiscard]] bool moves(std::size_t member) const { return moves_.at(member); }

  /// [s]  Of a waypoint.
  [[nodiscard]] double time(std::size_t waypoint) const {
    return path_.times.empty() ? static_cast<double>(waypoint) : path_.times.at(waypoint);
  }

 private:
  static LoadedScene load(const PlannedPath& path) {
    ShapeCache cache;
    return load_scene_of(path, cache);
  }

  /// The file is about edges of the mover alone. A state of joints is a trajectory of one point.
  static void require_at_rest(const Scene& scene) {
    const auto rests = [](const BodyMotion& motion) {
      return std::holds_alternative<FixedMotion>(motion);
    };
    for (const Body& body : scene.bodies) {
      if (!rests(body.motion)) {
        throw BrokenPath("The body " + detail::in_quotes(body.name) + " moves by itself.");
      }
    }
    for (const SceneRobot& robot : scene.robots) {
      if (!rests(robot.base) || robot.trajectory.points.size() > 1) {
        throw BrokenPath("The robot " + detail::in_quotes(robot.name) + " moves by itself.");
      }
    }
  }

  static void require_unheld_motion(const Scene& scene) {
    for (const SceneRobot& robot : scene.robots) {
      for (const SceneAttachment& held : robot.attached) {
        if (held.from_time != 0.0 || held.to_time) {
          throw BrokenPath("The robot " + detail::in_quotes(robot.name) +
                           " holds a body for a part of the time.");
        }
      }
    }
  }

  void require_times() const {
    const std::vector<double>& times = path_.times;
    const bool increase =
        std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) == times.end();
    // What is proven divides by the duration: quotients that are one leave an edge of no length.
    const double duration = loaded_.scene.duration;
    for (std::size_t k = 0; k + 1 < times.size(); ++k) {
      if (!(times[k] / duration < times[k + 1] / duration)) {
        throw BrokenPath("The times of the path are so close that doubles do not tell them apart.");
      }
    }
    if (times.size() != path_.waypoints.size() || times.size() < 2 || !increase ||
        times.front() != 0.0 || times.back() != loaded_.scene.duration) {
      throw BrokenPath("The times of the path do not run from 0 to the duration of its scene.");
    }
  }

  /// The mover has no motion of its own.
  static void require_own_rest(bool rests, const std::string& name) {
    if (!rests) {
      throw BrokenPath("The mover " + detail::in_quotes(name) + " moves by itself.");
    }
  }

  void move_robot() {
    Scene& scene = loaded_.scene;
    const auto is_it = [&](const SceneRobot& robot) { return robot.name == path_.robot; };
    const auto found = std::find_if(scene.robots.begin(), scene.robots.end(), is_it);
    if (found == scene.robots.end()) {
      throw BrokenPath("The scene has no robot " + detail::in_quotes(path_.robot) + ".");
    }
    SceneRobot& robot = *found;
    require_own_rest(
        std::holds_alternative<FixedMotion>(robot.base) && robot.trajectory.joint_names.empty(),
        robot.name);
    const auto number = static_cast<std::size_t>(found - scene.robots.begin());
    robot.trajectory = Trajectory{.joint_names = path_.joints, .points = {}};
    for (std::size_t k = 0; k < path_.joints.size(); ++k) {
      const JointCoordinate which = find_coordinate(robot.model, path_.joints[k]);
      if (robot.model.joints()[which.joint].mimic) {
        throw BrokenPath("The joint " + detail::in_quotes(path_.joints[k]) + " mimics another.");
      }
      require_turning(robot.model, path_.joints[k], path_.turnings.at(k));
      if (path_.waypoints.front().at(k) != position_in_scene(robot, path_.joints[k])) {
        throw BrokenPath("The path does not begin where its scene has joint " +
                         detail::in_quotes(path_.joints[k]) + ".");
      }
      for (const std::vector<double>& waypoint : path_.waypoints) {
        require_limits(robot.model, which.joint, waypoint.at(k));
      }
      turnings_[number][path_.joints[k]] = path_.turnings.at(k);
    }
    for (std::size_t k = 0; k < path_.waypoints.size(); ++k) {
      robot.trajectory.points.push_back({.time = time(k), .positions = path_.waypoints[k]});
    }
    find_moving(robot, number);
  }

  void find_moving(const SceneRobot& robot, std::size_t number) {
    const Scene& scene = loaded_.scene;
    const std::size_t first = first_member(scene, number);
    moves_.assign(
        first_member(scene, scene.robots.size() - 1) + scene.robots.back().model.links().size(),
        false);
    for (std::size_t link = 0; link < robot.model.links().size(); ++link) {
      moves_[first + link] = !path_.times.empty();  // Others come near whatever rests.
      for (auto joint = robot.model.parent_joint(link); joint && !moves_[first + link];
           joint = robot.model.parent_joint(robot.model.parent_link(*joint))) {
        moves_[first + link] = is_planned(robot.model, *joint);
      }
    }
    for (const SceneAttachment& held : robot.attached) {
      moves_[held.body] = moves_[first + held.link];
    }
  }

  [[nodiscard]] bool is_planned(const RobotModel& model, std::size_t joint) const {
    while (model.joints()[joint].mimic) {
      joint = model.find_joint(model.joints()[joint].mimic->joint).value();
    }
    return std::any_of(path_.joints.begin(), path_.joints.end(), [&](const std::string& name) {
      return find_coordinate(model, name).joint == joint;
    });
  }

  void move_body() {
    Scene& scene = loaded_.scene;
    const auto is_it = [&](const Body& body) { return body.name == path_.body; };
    const auto body = std::find_if(scene.bodies.begin(), scene.bodies.end(), is_it);
    if (body == scene.bodies.end()) {
      throw BrokenPath("The scene has no body " + detail::in_quotes(path_.body) + ".");
    }
    const auto number = static_cast<std::size_t>(body - scene.bodies.begin());
    for (const SceneRobot& robot : scene.robots) {
      for (const SceneAttachment& held : robot.attached) {
        if (held.body == number) {
          throw BrokenPath("A robot holds the body " + detail::in_quotes(path_.body) + ".");
        }
      }
    }
    require_own_rest(std::holds_alternative<FixedMotion>(body->motion), body->name);
    require_begin(std::get<FixedMotion>(body->motion).pose);
    WaypointMotion motion;
    for (const std::vector<double>& q : path_.waypoints) {
      if (!(std::abs(std::hypot(std::hypot(q.at(3), q.at(4)), std::hypot(q.at(5), q.at(6))) -
                     1.0) <= kUnit)) {
        throw BrokenPath("A waypoint has a quaternion that is not of length 1.");
      }
      motion.times.push_back(time(motion.times.size()));
      motion.poses.push_back(
          {{q.at(0), q.at(1), q.at(2)}, Eigen::Quaterniond(q.at(3), q.at(4), q.at(5), q.at(6))});
    }
    body->motion = motion;
    std::size_t members = scene.bodies.size();
    for (const SceneRobot& robot : scene.robots) {
      members += robot.model.links().size();
    }
    moves_.assign(members, false);
    moves_[number] = true;
    body_ = number;
  }

  void require_begin(const Pose& pose) const {
    const std::vector<double>& q = path_.waypoints.front();
    const Eigen::Quaterniond& r = pose.rotation;
    if (Eigen::Vector3d(q.at(0), q.at(1), q.at(2)) != pose.position ||
        Eigen::Vector4d(q.at(3), q.at(4), q.at(5), q.at(6)) !=
            Eigen::Vector4d(r.w(), r.x(), r.y(), r.z())) {
      throw BrokenPath("The path does not begin where its scene has body " +
                       detail::in_quotes(path_.body) + ".");
    }
  }

  const PlannedPath& path_;
  LoadedScene loaded_;
  std::map<std::size_t, detail::Turnings> turnings_;
  std::vector<bool> moves_;  // Of each member.
  std::optional<std::size_t> body_ = {};
};

class PathProof {
 public:
  PathProof(const PlannedPath& path, const VerifyResultOptions& options)
      : path_(path),
        moving_(path),
        courses_(moving_.loaded(), moving_.turnings(), moving_.body()),
        proof_(courses_, {options.work, options.threads, options.stop, options.progress}) {}

  PathVerification run() {
    result_.warnings = moving_.loaded().warnings;
    count_pairs();
    if (result_.tested == 0) {
      result_.warnings.emplace_back("no pair is tested: the scene has nothing that can be touched");
    }
    require_goal();
    require_totals();
    result_.verdict = ProofVerdict::proven;
    const std::size_t edges = std::max<std::size_t>(path_.waypoints.size() - 1, 1);
    for (std::size_t edge = 0; edge < edges; ++edge) {
      prove(edge);
      if (result_.verdict == ProofVerdict::proven) {
        result_.edges = std::min(edge + 1, path_.waypoints.size() - 1);
      } else if (result_.verdict == ProofVerdict::refuted) {
        break;
      }
    }
    return result_;
  }

 private:
  void count_pairs() {
    for (std::size_t a = 0; a < courses_.member_count(); ++a) {
      for (std::size_t b = a + 1; b < courses_.member_count(); ++b) {
        const bool is_tested = (moving_.moves(a) || moving_.moves(b)) &&
                               courses_.pairs().margin({a, b}) &&
                               !courses_.pairs().spans({a, b}).empty() &&
                               !courses_.of_member(a).empty() && !courses_.of_member(b).empty();
        result_.tested += is_tested ? 1 : 0;
      }
    }
  }

  void require_goal() {
    result_.reaches_goal = path_.goal && *path_.goal < path_.goals.size() &&
                           path_.goals[*path_.goal] == path_.waypoints.back();
    if (path_.is_proven && !result_.reaches_goal) {
      throw BrokenPath("The path calls itself proven, but does not end at the goal that it names.");
    }
    const std::size_t edges = path_.waypoints.size() - 1;
    if (path_.clearances.size() != edges) {
      throw BrokenPath("The path has " + std::to_string(path_.clearances.size()) +
                       " edges between " + std::to_string(edges + 1) + " waypoints.");
    }
  }

  /// The numbers about the whole path are those of its scene and its edges.
  void require_totals() {
    if (!(path_.margin == moving_.loaded().scene.options.margin)) {
      throw BrokenPath("The margin of the path is not that of its scene.");
    }
    if (courses_.has_tracking_errors()) {
      result_.warnings.emplace_back("with tracking errors clearances are not proven again");
    }
    std::optional<double> least;
    for (const std::optional<double>& clearance : path_.clearances) {
      least = least && clearance ? std::min(*least, *clearance) : (least ? least : clearance);
    }
    if (!path_.clearances.empty() && path_.clearance != least) {
      throw BrokenPath("The clearance of the path is not the least of its edges.");
    }
  }

  void prove(std::size_t edge) {
    FreeClaim claim{.until =
                        [this](const BodyPair& pair) {
                          return moving_.moves(pair[0]) || moving_.moves(pair[1]) ? 1.0 : -1.0;
                        },
                    .extra = path_.extra_clearance};
    // As the pieces of the motion begin and end, bit for bit.
    const auto share = [&](std::size_t k) {
      return moving_.time(k) / moving_.loaded().scene.duration;
    };
    claim.from = share(edge);
    claim.last = share(edge + 1);
    take(proof_.prove_free(claim), edge, claim, "");
    const std::optional<double>& clearance =
        path_.clearances.empty() ? path_.clearance : path_.clearances[edge];
    if (!clearance) {
      if (result_.tested > 0) {
        throw BrokenPath("Edge " + std::to_string(edge) + " has no clearance.");
      }
      return;
    }
    if (!(*clearance >= 0.0)) {
      throw BrokenPath("The clearance of edge " + std::to_string(edge) + " is not a distance.");
    }
    if (result_.verdict == ProofVerdict::proven && !courses_.has_tracking_errors()) {
      claim.clearance = clearance;
      take(proof_.prove_free(claim), edge, claim, "The clearance of the edge does not hold. ");
    }
  }

  void take(const ProofFinding& found, std::size_t edge, const FreeClaim& claim,
            const std::string& before) {
    const bool decides =
        found.verdict != ProofVerdict::proven &&
        (result_.verdict == ProofVerdict::proven || found.verdict == ProofVerdict::refuted);
    if (!decides) {
      return;
    }
    const Scene& scene = moving_.loaded().scene;
    result_.verdict = found.verdict;
    result_.problem = before + detail::describe(found, scene);
    result_.problem_edge = edge;
    result_.problem_at = detail::moment_of(found, scene);
    if (result_.problem_at) {
      for (double* t : {&result_.problem_at->from, &result_.problem_at->to}) {
        *t = std::clamp((*t - claim.from) / (claim.last - claim.from), 0.0, 1.0);
      }
    }
  }

  const PlannedPath& path_;
  MovingScene moving_;
  detail::SceneCourses courses_;
  detail::SceneProof proof_;
  PathVerification result_;
};

}  // namespace

PathVerification verify_path(const PlannedPath& path, const VerifyResultOptions& options) {
  const FloatEnvironmentGuard guard;
  PathVerification result;
  try {
    return PathProof(path, options).run();
  } catch (const BrokenPath& error) {
    result.verdict = ProofVerdict::broken;
    result.problem = error.what();
  } catch (const detail::UncertainMotion& error) {
    result.problem = std::string("A motion of the path is not certain: ") + error.what() + ".";
  }
  return result;
}

}  // namespace firstcontact
