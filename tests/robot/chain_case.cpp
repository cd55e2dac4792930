#include "robot/chain_case.h"

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

namespace firstcontact::test {
namespace {

using oracle::ExactCoordinate;
using oracle::ExactJoint;
using oracle::Wide;

oracle::Vector3<double> plain(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

std::vector<double> random_numbers(Random& random, std::size_t count, double size) {
  std::vector<double> numbers;
  for (std::size_t k = 0; k < count; ++k) {
    numbers.push_back(random.uniform(-size, size));
  }
  return numbers;
}

/// Whole turns that the shortest way leaves out.
int turns_between(double from, double to) {
  return static_cast<int>(std::lround((to - from) / (2.0 * std::numbers::pi)));
}

const ExactCoordinate& piece_at(const std::vector<ExactCoordinate>& pieces, double t) {
  for (const ExactCoordinate& piece : pieces) {
    if (t < piece.t_end) {
      return piece;
    }
  }
  return pieces.back();
}

/// Unit vectors along x and y, turned by the shortest rotation that takes z to n (Rodrigues).
std::vector<oracle::Vector3<Wide>> exact_directions(const Eigen::Vector3d& axis) {
  const oracle::Vector3<Wide> a = oracle::exact(plain(axis));
  const oracle::Vector3<Wide> n = (Wide(1.0) / norm(a)) * a;
  const oracle::Vector3<Wide> w{-n.y, n.x, Wide(0.0)};  // z x n: sine times the axis of rotation.
  std::vector<oracle::Vector3<Wide>> directions;
  for (const oracle::Vector3<double>& e : {oracle::Vector3<double>{1, 0, 0}, {0, 1, 0}}) {
    const oracle::Vector3<Wide> v = oracle::exact(e);
    directions.push_back(n.z * v + cross(w, v) + ((Wide(1.0) / (Wide(1.0) + n.z)) * dot(w, v)) * w);
  }
  return directions;
}

struct Draft {
  RobotDescription robot{.name = "chain", .links = {{"base", {}, {}}}, .joints = {}};
  std::map<std::string, JointMotion> motions;
};

/// A motion of constant velocity or a screw; a ball joint's leaves the origin where it is.
std::pair<Motion, oracle::MotionInput> random_motion(Random& random, bool at_origin) {
  const Eigen::Quaterniond R = random.rotation();
  const Eigen::Vector3d direction = random.direction();
  const double angle = random.uniform(0.1, 2.0);
  const auto vector = [&] {
    return at_origin ? Eigen::Vector3d(0.0 * random.direction()) : random.vector(0.1, 1.0);
  };
  const Eigen::Vector3d start = vector();
  const Eigen::Vector3d way = vector();
  oracle::MotionInput input;
  input.poses = {{plain(start), {R.w(), R.x(), R.y(), R.z()}}};
  if (!at_origin && random.chance(0.5)) {
    input.kind = oracle::MotionKind::screw;
    input.axis_point = plain(way);
    input.axis_direction = plain(direction);
    input.angle = angle;
    input.along = 0.3;
    return {Motion::screw({start, R}, way, direction, angle, 0.3), input};
  }
  const Eigen::Vector3d spin = angle * direction;
  input.kind = oracle::MotionKind::constant_velocity;
  input.translation = plain(way);
  input.rotation_vector = plain(spin);
  return {Motion::constant_velocity({start, R}, way, spin), input};
}

void add_joint(ChainCase& result, Draft& draft, Random& random, int index, JointType type) {
  const std::string name = "j" + std::to_string(index);
  Joint joint{.name = name,
              .type = type,
              .parent = draft.robot.links.back().name,
              .child = "l" + std::to_string(index)};
  const Eigen::Quaterniond R = random.rotation();
  joint.X_PJ = {random.vector(0.05, 0.4), R};
  joint.axis = random.vector(0.5, 2.0);
  joint.pitch = type == JointType::screw ? random.uniform(-0.1, 0.1) : 0.0;
  ExactJoint exact{.position = plain(joint.X_PJ.position),
                   .w = R.w(),
                   .x = R.x(),
                   .y = R.y(),
                   .z = R.z(),
                   .directions = {},
                   .slides = {},
                   .axis = plain(joint.axis),
                   .angle = {},
                   .pitch = joint.pitch,
                   .motion = {}};
  std::vector<std::vector<ExactCoordinate>> coordinates;
  std::vector<oracle::MotionPiece> motion;
  if (type == JointType::planar) {
    exact.directions = exact_directions(joint.axis);
    const CoordinateCase x = random_coordinate(random, 0.3, false);
    const CoordinateCase y = random_coordinate(random, 0.3, false);
    const CoordinateCase angle = random_coordinate(random, 2.0, false);
    draft.motions.emplace(name, PlanarPath{x.path, y.path, angle.path});
    coordinates = {x.exact, y.exact, angle.exact};
  } else if (type == JointType::ball || type == JointType::floating) {
    auto [path, input] = random_motion(random, type == JointType::ball);
    draft.motions.emplace(name, path);
    motion = oracle::motion_pieces(input, {0, 0, 0});
  } else if (type != JointType::fixed) {
    const double size = type == JointType::prismatic ? 0.3 : 2.0;
    const CoordinateCase q = random_coordinate(random, size, type == JointType::continuous);
    draft.motions.emplace(name, q.path);
    coordinates = {q.exact};
    if (type == JointType::prismatic) {
      const oracle::Vector3<Wide> a = oracle::exact(plain(joint.axis));
      exact.directions = {(Wide(1.0) / norm(a)) * a};
    }
  }
  draft.robot.links.push_back({joint.child, {}, {}});
  draft.robot.joints.push_back(std::move(joint));
  result.joints.push_back(std::move(exact));
  result.coordinates.push_back(std::move(coordinates));
  result.motions.push_back(std::move(motion));
}

/// A revolute joint that follows the first one of the chain.
void add_mimic(ChainCase& result, Draft& draft, Random& random, int index) {
  add_joint(result, draft, random, index, JointType::revolute);
  Joint& joint = draft.robot.joints.back();
  draft.motions.erase(joint.name);
  joint.mimic = Mimic{.joint = "j0", .multiplier = -0.7, .offset = 0.3};
  result.coordinates.back() = result.coordinates[1];
  for (ExactCoordinate& q : result.coordinates.back()[0]) {
    q.multiplier = -0.7;
    q.offset = 0.3;
  }
}

}  // namespace

CoordinateCase random_coordinate(Random& random, double size, bool may_wrap) {
  const std::vector<double> times = {0.0, random.uniform(0.2, 0.8), 1.0};
  const std::vector<double> q = random_numbers(random, 3, may_wrap ? 3.0 * size : size);
  const std::vector<double> v = random_numbers(random, 3, size);
  const std::vector<double> a = random_numbers(random, 3, 4.0 * size);
  const Turning turning = may_wrap ? Turning::shortest : Turning::as_given;
  const int kind = static_cast<int>(random.uniform(0.0, 4.0));
  if (kind == 3 && !may_wrap) {
    const std::vector<std::vector<double>> coefficients = {random_numbers(random, 6, 0.5 * size)};
    const std::array<double, 2> ends = {0.0, 1.0};
    ExactCoordinate exact;
    exact.coefficients = coefficients[0];
    return {CoordinatePath::polynomials(ends, coefficients), {exact}};
  }
  std::vector<ExactCoordinate> exact;
  const auto values = [&](std::size_t k) {
    std::vector<double> all = {q[k], v[k], a[k]};
    all.resize(static_cast<std::size_t>(kind % 3) + 1);
    return all;
  };
  int turns_before = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    ExactCoordinate piece;
    piece.t_begin = times[k];
    piece.t_end = times[k + 1];
    piece.begin = values(k);
    piece.end = values(k + 1);
    piece.turns_before = turns_before;
    piece.turns = may_wrap ? turns_between(q[k], q[k + 1]) : 0;
    turns_before += piece.turns;
    exact.push_back(piece);
  }
  return {kind % 3 == 0   ? CoordinatePath::linear(times, q, turning)
          : kind % 3 == 1 ? CoordinatePath::cubic(times, q, v, turning)
                          : CoordinatePath::quintic(times, q, v, a, turning),
          exact};
}

std::vector<ExactJoint> ChainCase::exact(double t, std::size_t first, bool from_world) const {
  std::vector<ExactJoint> chain;
  for (std::size_t k = from_world ? 0 : first + 1; k < joints.size(); ++k) {
    ExactJoint joint = joints[k];
    for (std::size_t c = 0; c < coordinates[k].size(); ++c) {
      const bool slides = c < joint.directions.size();
      (slides ? joint.slides : joint.angle).push_back(piece_at(coordinates[k][c], t));
    }
    if (!motions[k].empty()) {
      joint.motion = {motions[k][0]};
    }
    chain.push_back(std::move(joint));
  }
  return chain;
}

ChainCase random_chain(std::uint64_t seed, const ChainOptions& options) {
  Random random(seed);
  Draft draft;
  auto [base, input] = random_motion(random, false);
  const bool base_rests = options.turning_only;
  ChainCase result{
      RobotMotion(RobotModel({.name = "r", .links = {{"l", {}, {}}}, .joints = {}}), {}),
      {ExactJoint{}},
      {{}},
      {{}}};
  if (!base_rests) {
    result.motions[0] = oracle::motion_pieces(input, {0, 0, 0});
  }
  constexpr std::array<JointType, 8> kTypes = {
      JointType::revolute, JointType::continuous, JointType::prismatic, JointType::screw,
      JointType::planar,   JointType::floating,   JointType::ball,      JointType::fixed};
  for (int k = 0; k < options.joints; ++k) {
    const auto pick = static_cast<std::size_t>(random.uniform(0.0, 9.0));
    if (options.turning_only || k == 0) {
      add_joint(result, draft, random, k, JointType::revolute);
    } else if (pick == kTypes.size()) {
      add_mimic(result, draft, random, k);
    } else {
      add_joint(result, draft, random, k, kTypes[pick]);
    }
  }
  result.motion =
      RobotMotion(RobotModel(draft.robot), draft.motions, base_rests ? Motion::fixed() : base);
  return result;
}

}  // namespace firstcontact::test
