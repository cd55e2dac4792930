/// @file
/// Follows a run from step to step, and reports contradictions of its record.

#pragma once

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/record/run_step.h>
#include <firstcontact/separation/detail/box_tree.h>
#include <firstcontact/separation/detail/convex_parts.h>
#include <firstcontact/verification/detail/piece_motion.h>
#include <firstcontact/verification/detail/rigid_motion.h>
#include <firstcontact/verification/detail/script_deviation.h>

namespace firstcontact {
struct Scene;
}

namespace firstcontact::detail {

/// A body of the scene, for the verifier.
struct RunMember {
  std::string name;
  Shape shape;
  Eigen::Vector3d p_BC = Eigen::Vector3d::Zero();  ///< [m]  The pivot.
  BoxTree tree;
  std::optional<RoundSet> round = {};  ///< From the pivot; only for a curved body.
  bool is_free = false;
  std::vector<RigidMotion> script = {};  ///< Motion by script_of(); only for a body that is not
                                         ///< free.
  /// The reason why the script is uncertain; empty where it is certain.
  std::string uncertain = {};
  Pose start;
};

/// The motion of a body in a step.
struct FollowedBody {
  std::vector<PieceMotion> pieces;  ///< Pieces from 0 to the end of the step.
  double jump = 0.0;  ///< [m]  The greatest jump from one piece to the next, or to a record.
  bool moves = false;
};

struct FollowedStep {
  std::size_t index = 0;
  double begin = 0.0;  ///< [s]  Begin since the run began.
  double lasted = 0.0;
  double clearance = 0.0;
  std::vector<FollowedBody> bodies;  ///< All bodies of the scene.
};

/// The error that a record cannot be one of a simulation. One sentence.
class BrokenRun : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class RunFollower {
 public:
  /// @param members             outlive the follower
  /// @param scripted_tolerance  [m]  within steps the contact distance is added
  RunFollower(const std::vector<RunMember>& members, const Scene& scene, double scripted_tolerance);

  /// Follows a step.
  ///
  /// @throws BrokenRun, UncertainMotion
  [[nodiscard]] FollowedStep follow(const RunStep& step);

  [[nodiscard]] double time() const { return time_; }                    ///< [s]
  [[nodiscard]] double greatest_jump() const { return greatest_jump_; }  ///< [m]
  [[nodiscard]] double scripted_deviation() const { return scripted_deviation_; }
  [[nodiscard]] double greatest_behind() const { return greatest_behind_; }  ///< [s]

 private:
  void require_times(const RunStep& step) const;
  [[nodiscard]] FollowedBody follow_body(const RunStep& step, const RunBody& body);
  [[nodiscard]] double jump(std::size_t body, const PieceMotion& from, double from_time,
                            const PieceMotion& to, double to_time);
  void require_scripted(std::size_t body, const PieceMotion& piece, const RunStep& step);
  void require_behind(const RunBody& body, const PieceMotion& end, const RunStep& step);
  [[nodiscard]] ScriptDeviation deviation_of(std::size_t body, const PieceMotion& piece) const;

  const std::vector<RunMember>& members_;
  double duration_;                         // [s]  Duration of the scene.
  std::optional<double> step_length_ = {};  // [s]  Only for a scene with a simulation.
  double scripted_tolerance_;
  double bend_tolerance_;       // [m]  Tolerance of scripts within steps.
  std::vector<Pose> poses_;     // Poses as last recorded.
  std::vector<double> behind_;  // [s]  Time by which scripts are behind, as last recorded.
  std::size_t step_ = 0;
  double time_ = 0.0;
  double greatest_jump_ = 0.0;
  double scripted_deviation_ = 0.0;
  double greatest_behind_ = 0.0;
};

}  // namespace firstcontact::detail
