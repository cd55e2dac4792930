#include <firstcontact/verification/detail/script_deviation.h>

#include <algorithm>
#include <functional>

#include <firstcontact/motion/motion.h>
#include <firstcontact/scene/body_motion.h>

namespace firstcontact::detail {

namespace {

/// [-]  Rounding of a bound, relative to it.
constexpr double kBoundRounding = 0x1p-46;

/// [-]  Longest run, by the duration of a scene.
constexpr double kForever = 1e100;

/// Compares a piece with a part of a script.
class Beside {
 public:
  Beside(const PieceMotion& piece, double begin, const RigidMotion& script, double duration,
         double reach)
      : piece_(piece), begin_(begin), script_(script), duration_(duration), reach_(reach) {}

  /// The bound from u to v [s], in which both are defined.
  [[nodiscard]] double bound(double u, double v) const {
    const double half = 0.5 * (v - u);
    const double middle = u + half;
    const BodyInstant a = piece_.around(in_piece(middle), 0.0, origin());
    const BodyInstant b = script_.around(in_script(middle), 0.0, origin());
    const double spin_a = a.spin.norm() + a.spin_error;
    const double spin_b = (b.spin.norm() + b.spin_error) / duration_;
    const double bend = (spin_a * spin_a * a.lever + spin_b * spin_b * b.lever) * half * half;
    const double turn =
        (a.spin - b.spin / duration_).norm() + a.spin_error + b.spin_error / duration_;
    const double sum = std::max(at(u), at(v)) + 0.5 * bend + reach_ * turn * half;
    return sum * (1.0 + kBoundRounding);
  }

  /// The distance at a time of both.
  [[nodiscard]] double at(double time) const {
    return deviation_bound(piece_.enclosure(in_piece(time), origin()),
                           script_.enclosure(in_script(time), origin()), reach_);
  }

 private:
  [[nodiscard]] const Eigen::Vector3d& origin() const { return piece_.position(); }
  [[nodiscard]] double in_piece(double time) const {
    return std::clamp(time - begin_, piece_.from(), piece_.to());
  }
  [[nodiscard]] double in_script(double time) const {
    return std::clamp(time / duration_, script_.from(), script_.to());
  }

  const PieceMotion& piece_;
  double begin_;
  const RigidMotion& script_;
  double duration_;
  double reach_;
};

}  // namespace

ScriptDeviation script_deviation(const PieceMotion& piece, double begin,
                                 const std::vector<RigidMotion>& script, double duration,
                                 double reach) {
  const double from = begin + piece.from();
  const double to = begin + piece.to();
  auto part =
      std::ranges::lower_bound(script, from / duration, std::less_equal<>(), &RigidMotion::to);
  ScriptDeviation deviation;
  for (; part != script.end() && part->from() * duration <= to; ++part) {
    const Beside both(piece, begin, *part, duration, reach);
    const double u = std::max(from, part->from() * duration);
    const double v = std::min(to, part->to() * duration);
    deviation.at_end = both.at(v);
    deviation.within = std::max(deviation.within, u < v ? both.bound(u, v) : deviation.at_end);
  }
  return deviation;
}

std::vector<RigidMotion> script_of(const BodyMotion& motion, double duration,
                                   const Eigen::Vector3d& p_BC) {
  std::vector<RigidMotion> script = rigid_motions(motion, duration, p_BC);
  const Pose end = normalised_motion(motion, duration).pose(1.0);
  script.emplace_back(1.0, kForever, end, OriginWay{}, Turn{}, p_BC);
  return script;
}

}  // namespace firstcontact::detail
