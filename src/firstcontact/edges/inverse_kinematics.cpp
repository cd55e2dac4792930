#include <firstcontact/edges/inverse_kinematics.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <firstcontact/edges/detail/reach_search.h>
#include <firstcontact/math/float_environment.h>
#include <firstcontact/math/random_numbers.h>

namespace firstcontact {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;

constexpr int kIterations = 100;
constexpr int kPatience = 8;           // Iterations in which the error has to fall to
constexpr double kWorthwhile = 0.999;  // this fraction; else the search is at its nearest place.
constexpr double kLongestStep = 0.5;   // [rad or m]  Longest step of a coordinate in one iteration.
constexpr double kSame = 1e-3;        // Distance in the space's length at which two places are one.
constexpr double kOfTolerance = 0.9;  // Fraction of the tolerance at which the second search aims.
constexpr double kMoreTurns = 3.0;    // Where turns differ: this many times the span of samples.

void require_goal(bool condition, const char* what) {
  if (!condition) {
    throw std::invalid_argument(what);
  }
}

/// Whether a pose is a rigid transform: its quaternion may have any length that is not mere
/// rounding.
bool is_pose(const Pose& pose) {
  constexpr double kShortest = 1e-60;
  constexpr double kLongest = 1e60;
  const double length = pose.rotation.norm();
  return pose.position.allFinite() && length >= kShortest && length <= kLongest;
}

/// Computes the rotation vector of a rotation matrix; at most half a turn.
Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

}  // namespace

namespace detail {

/// The search from one place to a pose.
class PoseSearch {
 public:
  PoseSearch(const ConfigurationSpace& space, const LinkPoseGoal& goal)
      : space_(space),
        goal_(goal),
        count_(space.coordinates().size()),
        has_rotation_(goal.rotation_tolerance < std::numbers::pi),
        X_LT_(precise(goal.X_LT)),
        R_WT_(goal.X_WT.rotation.normalized().toRotationMatrix()) {}

  /// Searches from a place for the goal, and from its end for the tolerances alone.
  ReachedPose run(const Configuration& q) {
    const ReachedPose exact = approach(q);
    if (reaches(exact, goal_)) {
      return exact;
    }
    is_loose_ = true;
    ReachedPose loose = approach(exact.q);
    is_loose_ = false;
    return reaches(loose, goal_) ? loose : exact;
  }

  /// Searches from a place for the goal as long as that helps.
  ///
  /// @param is_patient  goes on where it helps little, too
  ReachedPose approach(Configuration q, bool is_patient = false) {
    for (std::size_t k = 0; k < count_; ++k) {
      q[k] = within_limits(k, q[k]);
    }
    double damping = 1e-3;
    Vector6 error = error_at(q);
    double size_before = error.norm();
    for (int k = 0; k < kIterations && !is_exact(error) && damping < 1e6; ++k) {
      if (!is_patient && k % kPatience == kPatience - 1) {
        if (error.norm() > kWorthwhile * size_before) {
          break;
        }
        size_before = error.norm();
      }
      const Configuration next = stepped(q, error, damping);
      const Vector6 error_there = error_at(next);
      if (error_there.norm() < error.norm()) {
        q = next;
        error = error_there;
        damping = std::max(0.2 * damping, 1e-12);
      } else {
        damping *= 8.0;
      }
    }
    return bounded(std::move(q));
  }

 private:
  /// Whether the errors are far within the tolerances, so that rounding does not decide.
  [[nodiscard]] bool is_exact(const Vector6& error) const {
    return error.head<3>().norm() <= 1e-3 * goal_.position_tolerance &&
           error.tail<3>().norm() <= 1e-3 * goal_.rotation_tolerance;
  }

  /// [m]  The error with a metre for a radian. In a loose search only the part beyond the
  /// tolerances.
  [[nodiscard]] Vector6 weighed(Vector6 error) const {
    if (!has_rotation_) {
      error.tail<3>().setZero();
    }
    if (is_loose_) {
      error.head<3>() *= share_beyond(error.head<3>().norm(), goal_.position_tolerance);
      error.tail<3>() *= share_beyond(error.tail<3>().norm(), goal_.rotation_tolerance);
    }
    return error;
  }

  /// [-]  The fraction of an error that is beyond the aim of a loose search.
  [[nodiscard]] static double share_beyond(double error, double tolerance) {
    const double kept = kOfTolerance * tolerance;
    return error > kept ? 1.0 - kept / error : 0.0;
  }

  [[nodiscard]] LinkPath path(const Configuration& from, const Configuration& to) const {
    return space_.motion(from, to, goal_.mover).path(goal_.link, 0.0).then(X_LT_);
  }

  [[nodiscard]] Vector6 error_at(const Configuration& q) const {
    const LinkPose pose = path(q, q).pose(0.0);
    Vector6 error;
    error << goal_.X_WT.position - pose.p_OL, rotation_vector(R_WT_ * pose.R_FL.transpose());
    return weighed(error);
  }

  /// Computes the rates of T along each coordinate, with all else at rest.
  [[nodiscard]] Jacobian jacobian(const Configuration& q) {
    Jacobian J(6, static_cast<Eigen::Index>(count_));
    for (std::size_t k = 0; k < count_; ++k) {
      Configuration to = q;
      to[k] += 1.0;
      const LinkState state = path(q, to).state(0.0, scratch_);
      J.col(static_cast<Eigen::Index>(k)) << state.velocity, state.spin;
    }
    if (!has_rotation_) {
      J.bottomRows<3>().setZero();
    }
    return J;
  }

  /// Makes a damped step. Coordinates that it would take beyond a limit stay there.
  Configuration stepped(const Configuration& q, const Vector6& error, double damping) {
    Jacobian J = jacobian(q);
    if (is_loose_) {  // Errors within their tolerance may change.
      J.topRows<3>() *= error.head<3>().isZero(0.0) ? 0.0 : 1.0;
      J.bottomRows<3>() *= error.tail<3>().isZero(0.0) ? 0.0 : 1.0;
    }
    Configuration next = q;
    std::vector<bool> is_held(count_, false);
    for (std::size_t round = 0; round <= count_; ++round) {
      Eigen::Matrix<double, 6, 6> A = J * J.transpose();
      A.diagonal().array() += damping;
      Eigen::VectorXd step = J.transpose() * A.ldlt().solve(error);
      const double longest = step.cwiseAbs().maxCoeff();
      step *= longest > kLongestStep ? kLongestStep / longest : 1.0;
      bool has_left = false;
      for (std::size_t k = 0; k < count_; ++k) {
        if (is_held[k]) {
          continue;
        }
        const auto column = static_cast<Eigen::Index>(k);
        const double wanted = q[k] + step[column];
        next[k] = within_limits(k, wanted);
        if (next[k] != wanted) {
          is_held[k] = has_left = true;
          J.col(column).setZero();
        }
      }
      if (!has_left) {
        break;
      }
    }
    return next;
  }

  [[nodiscard]] double within_limits(std::size_t k, double position) const {
    const SpaceCoordinate& coordinate = space_.coordinates()[k];
    return coordinate.has_limits ? std::clamp(position, coordinate.lower, coordinate.upper)
                                 : position;
  }

  /// Adds bounds of the errors: the computed errors plus the error of the pose.
  [[nodiscard]] ReachedPose bounded(Configuration q) const {
    constexpr double kRounding = 0x1p-44;  // Relative error of the few operations on the pose.
    const LinkPose pose = path(q, q).pose(0.0);
    const double size = pose.p_OL.norm() + goal_.X_WT.position.norm();
    ReachedPose reached{std::move(q), 0.0, 0.0};
    reached.position_error =
        (goal_.X_WT.position - pose.p_OL).norm() + pose.position_error + kRounding * size;
    reached.rotation_error = rotation_vector(R_WT_ * pose.R_FL.transpose()).norm() +
                             4.0 * (pose.rotation_error + kRounding);
    return reached;
  }

  const ConfigurationSpace& space_;
  const LinkPoseGoal& goal_;
  std::size_t count_;  // Of coordinates, which a search moves; poses stay.
  bool has_rotation_;
  bool is_loose_ = false;
  PreciseTransform X_LT_;
  Eigen::Matrix3d R_WT_;
  LinkScratch scratch_;
};

struct ReachSearch::Data {
  const ConfigurationSpace& space;
  LinkPoseGoal goal;
  Configuration start;
  ReachOptions options;
  PoseSearch search;
  RandomNumbers random;
  std::size_t tries = 0;
  std::vector<ReachedPose> found = {};
  std::optional<ReachedPose> nearest = {};  // Of those that do not reach the goal.
  bool is_reached = false;                  // By any place, accepted or not.

  Data(const ConfigurationSpace& in_space, const LinkPoseGoal& to, const Configuration& from,
       ReachOptions given)
      : space(in_space),
        goal(to),
        start(from),
        options(std::move(given)),
        search(space, goal),
        random(options.seed) {}

  /// Chooses the place from which the next try begins; the other movers stay at the start.
  Configuration next_begin() {
    const std::size_t k = tries++;
    Configuration from = k == 0 ? start : space.sample(random);
    std::copy(start.begin() + static_cast<std::ptrdiff_t>(space.coordinates().size()), start.end(),
              from.begin() + static_cast<std::ptrdiff_t>(space.coordinates().size()));
    for (std::size_t c = 0; c < space.coordinates().size(); ++c) {
      const SpaceCoordinate& coordinate = space.coordinates()[c];
      const bool may_turn_on = !coordinate.has_limits && !coordinate.slides &&
                               !coordinate.turns_short && k % 2 == 0 && k > 0;
      from[c] =
          coordinate.mover != goal.mover ? start[c] : (may_turn_on ? kMoreTurns : 1.0) * from[c];
    }
    return from;
  }

  /// Keeps a place that does not reach the goal if it is the nearest one.
  void keep_nearest(ReachedPose place) {
    const bool has_rotation = goal.rotation_tolerance < std::numbers::pi;
    const auto size = [&](const ReachedPose& p) {
      return p.position_error + (has_rotation ? p.rotation_error : 0.0);
    };
    if (!nearest || size(place) < size(*nearest)) {
      nearest = std::move(place);
    }
  }

  [[nodiscard]] bool is_known(const ReachedPose& place) const {
    return std::ranges::any_of(
        found, [&](const ReachedPose& other) { return space.distance(place.q, other.q) < kSame; });
  }
};

ReachSearch::ReachSearch(const ConfigurationSpace& space, const LinkPoseGoal& goal,
                         const Configuration& start, ReachOptions options) {
  require_goal(!space.coordinates().empty(),
               "expected a robot with joints: a body is at a pose without them");
  require_goal(
      goal.mover < space.mover_count() && goal.link < space.model(goal.mover).links().size(),
      "expected a link of the robot");
  require_goal(start.size() == space.size(), "expected a start with a number for each coordinate");
  require_goal(is_pose(goal.X_WT) && is_pose(goal.X_LT),
               "expected poses with finite numbers and quaternions that are not zero");
  require_goal(goal.position_tolerance > 0.0 && goal.rotation_tolerance > 0.0,
               "expected tolerances > 0");
  data_ = std::make_unique<Data>(space, goal, start, std::move(options));
}

ReachSearch::~ReachSearch() = default;
ReachSearch::ReachSearch(ReachSearch&&) noexcept = default;
ReachSearch& ReachSearch::operator=(ReachSearch&&) noexcept = default;

bool ReachSearch::try_once() {
  Data& data = *data_;
  ReachedPose place = data.search.run(data.next_begin());
  if (!reaches(place, data.goal)) {
    data.keep_nearest(std::move(place));
    return false;
  }
  data.is_reached = true;
  if (data.is_known(place) || (data.options.accepts && !data.options.accepts(place.q))) {
    return false;
  }
  data.found.push_back(std::move(place));
  return true;
}

std::size_t ReachSearch::size() const { return data_->found.size(); }

std::vector<ReachedPose> ReachSearch::places() {
  std::vector<ReachedPose> places = data_->found;
  std::ranges::stable_sort(places, {}, [&](const ReachedPose& place) {
    return data_->space.distance(data_->start, place.q);
  });
  if (!data_->is_reached && data_->nearest) {
    places.push_back(data_->search.approach(data_->nearest->q, true));
  }
  return places;
}

}  // namespace detail

bool reaches(const ReachedPose& place, const LinkPoseGoal& goal) {
  return place.position_error <= goal.position_tolerance &&
         (place.rotation_error <= goal.rotation_tolerance ||
          goal.rotation_tolerance >= std::numbers::pi);
}

std::vector<ReachedPose> reach_pose(const ConfigurationSpace& space, const LinkPoseGoal& goal,
                                    const Configuration& start, const ReachOptions& options) {
  const FloatEnvironmentGuard guard;
  detail::ReachSearch search(space, goal, start, options);
  for (std::size_t k = 0; k < options.tries && search.size() < options.places; ++k) {
    if (options.stop.stop_requested() ||
        (options.deadline && std::chrono::steady_clock::now() >= *options.deadline)) {
      break;
    }
    (void)search.try_once();
  }
  return search.places();
}

}  // namespace firstcontact
