#include <firstcontact/verification/detail/run_follower.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <firstcontact/scene/scene.h>

namespace firstcontact::detail {
namespace {

/// [-]  Rounding of a recorded pose, by its numbers: a dozen operations on coordinates, a
/// quaternion that was made of a matrix, and some room.
constexpr double kPoseRounding = 0x1p-44;

/// [-]  Rounding of the times of a run, which are sums of the durations of its steps.
constexpr double kTimeRounding = 0x1p-40;

std::string number(double x) {
  char text[32];
  (void)std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

}  // namespace

RunFollower::RunFollower(const std::vector<RunMember>& members, const Scene& scene,
                         double scripted_tolerance)
    : members_(members),
      duration_(scene.duration),
      scripted_tolerance_(scripted_tolerance),
      bend_tolerance_(scripted_tolerance) {
  if (scene.simulation) {
    step_length_ = scene.simulation->step;
    bend_tolerance_ += scene.simulation->contact_distance.value_or(0.0);
  }
  for (const RunMember& member : members) {
    poses_.push_back(member.start);
  }
  behind_.assign(members.size(), 0.0);
}

FollowedStep RunFollower::follow(const RunStep& step) {
  require_times(step);
  FollowedStep followed{step.index, time_, step.lasted, step.clearance, {}};
  followed.bodies.resize(members_.size());
  std::size_t next = 0;
  for (const RunBody& body : step.bodies) {
    if (body.body < next || body.body >= members_.size()) {
      throw BrokenRun("the bodies of the step are not in order");
    }
    next = body.body + 1;
    followed.bodies[body.body] = follow_body(step, body);
  }
  for (std::size_t b = 0; b < members_.size(); ++b) {
    std::vector<PieceMotion>& pieces = followed.bodies[b].pieces;
    if (pieces.empty()) {
      pieces.emplace_back(poses_[b], 0.0, step.lasted, members_[b].p_BC);
      require_scripted(b, pieces.back(), step);
    }
  }
  ++step_;
  time_ = step.time;
  return followed;
}

// Comparisons are negated, so that NaN is refused.
void RunFollower::require_times(const RunStep& step) const {
  if (step.index != step_ + 1) {
    throw BrokenRun("step " + std::to_string(step_ + 1) + " is missing");
  }
  if (!(step.lasted >= 0.0 && step.lasted < std::numeric_limits<double>::infinity())) {
    throw BrokenRun("the step lasted " + number(step.lasted) + " s");
  }
  const double end = time_ + step.lasted;
  if (!(std::abs(step.time - end) <= kTimeRounding * end)) {
    throw BrokenRun("the step ends at " + number(step.time) + " s, but " + number(step.lasted) +
                    " s after " + number(time_) + " s it is " + number(end) + " s");
  }
  const double whole = step.lasted + step.time_lost;
  if (step_length_ && !(std::abs(whole - *step_length_) <= kTimeRounding * *step_length_)) {
    throw BrokenRun("the step lasted " + number(step.lasted) + " s and lost " +
                    number(step.time_lost) + " s, but a step of the scene is one of " +
                    number(*step_length_) + " s");
  }
  if (!(step.clearance >= 0.0)) {
    throw BrokenRun("the clearance is " + number(step.clearance) + " m");
  }
}

FollowedBody RunFollower::follow_body(const RunStep& step, const RunBody& body) {
  const std::size_t b = body.body;
  const Eigen::Vector3d& p_BC = members_[b].p_BC;
  FollowedBody followed{.pieces = {}, .jump = 0.0, .moves = true};
  double from = 0.0;
  for (const RunPiece& piece : body.pieces) {
    if (step.lasted == 0.0 && piece.to == 0.0) {
      continue;  // In no time nothing moves.
    }
    if (!(piece.to > from)) {
      throw BrokenRun("\"" + members_[b].name + "\" goes back in time at " + number(time_ + from) +
                      " s");
    }
    followed.pieces.emplace_back(piece, from, p_BC);
    from = piece.to;
  }
  if (from != step.lasted) {
    throw BrokenRun("the pieces of \"" + members_[b].name + "\" do not fill the step");
  }
  const PieceMotion begin(poses_[b], 0.0, 0.0, p_BC);
  const PieceMotion end(body.X_WB, from, from, p_BC);
  const PieceMotion* last = &begin;
  const bool goes_on = body.behind == behind_[b];
  for (const PieceMotion& piece : followed.pieces) {
    followed.jump = std::max(followed.jump, jump(b, *last, last->to(), piece, piece.from()));
    last = &piece;
    if (goes_on) {
      require_scripted(b, piece, step);
    }
  }
  if (!goes_on) {
    require_behind(body, end, step);
  }
  followed.jump = std::max(followed.jump, jump(b, *last, last->to(), end, from));
  poses_[b] = body.X_WB;
  return followed;
}

double RunFollower::jump(std::size_t body, const PieceMotion& from, double from_time,
                         const PieceMotion& to, double to_time) {
  const RunMember& member = members_[body];
  const Eigen::Vector3d& origin = from.position();
  const double reach = member.tree.nodes[0].reach;
  const double deviation =
      deviation_bound(from.enclosure(from_time, origin), to.enclosure(to_time, origin), reach);
  const double turn = 1.0 + from.angle() + to.angle();  // Sines of large angles err by more.
  const double size = to.position().norm() + origin.norm() + turn * (member.p_BC.norm() + reach);
  if (!(deviation <= kPoseRounding * size)) {
    throw BrokenRun("\"" + member.name + "\" jumps by " + number(deviation) + " m at " +
                    number(time_ + to_time) + " s");
  }
  greatest_jump_ = std::max(greatest_jump_, deviation);
  return deviation;
}

ScriptDeviation RunFollower::deviation_of(std::size_t body, const PieceMotion& piece) const {
  const RunMember& member = members_[body];
  if (!member.uncertain.empty()) {
    throw UncertainMotion("the script of \"" + member.name + "\": " + member.uncertain);
  }
  return script_deviation(piece, time_ - behind_[body], member.script, duration_,
                          member.tree.nodes[0].reach);
}

/// Requires that a scripted body follows its script.
///
/// At its end a step is at the script's place. Within it, and where it ended early, it is within
/// the distance between a script and straight pieces.
void RunFollower::require_scripted(std::size_t body, const PieceMotion& piece,
                                   const RunStep& step) {
  if (members_[body].is_free) {
    return;
  }
  const ScriptDeviation deviation = deviation_of(body, piece);
  const bool ends_the_step = piece.to() == step.lasted && !(step.time_lost > 0.0);
  if (!(deviation.at_end <= (ends_the_step ? scripted_tolerance_ : bend_tolerance_)) ||
      !(deviation.within <= bend_tolerance_)) {
    throw BrokenRun("\"" + members_[body].name + "\" is up to " + number(deviation.within) +
                    " m from where its motion in the scene puts it until " +
                    number(time_ + piece.to()) + " s");
  }
  scripted_deviation_ = std::max(scripted_deviation_, deviation.within);
}

/// Requires that a body that waited in a step, or whose script came back to it, is near its script.
///
/// @param end  end of the step
void RunFollower::require_behind(const RunBody& body, const PieceMotion& end, const RunStep& step) {
  const RunMember& member = members_[body.body];
  behind_[body.body] = body.behind;
  const double most = time_ + step.lasted;
  if (member.is_free || !(body.behind >= 0.0 && body.behind <= (1.0 + kTimeRounding) * most)) {
    throw BrokenRun("\"" + member.name + "\" is said to be " + number(body.behind) +
                    " s behind its motion in the scene at " + number(most) + " s");
  }
  greatest_behind_ = std::max(greatest_behind_, body.behind);
  const double deviation = deviation_of(body.body, end).at_end;
  if (!(deviation <= bend_tolerance_)) {
    throw BrokenRun("\"" + member.name + "\" is " + number(deviation) +
                    " m from where its motion in the scene has it " + number(body.behind) +
                    " s before " + number(most) + " s");
  }
}

}  // namespace firstcontact::detail
