#include <firstcontact/motion/constant_rate_pair.h>

#include <algorithm>
#include <cstddef>
#include <span>

namespace firstcontact {
namespace {

/// The piece of a motion that contains t, the later one at a break.
std::size_t piece_at(const Motion& motion, double t) {
  const std::span<const double> breaks = motion.breaks();
  const auto after = std::upper_bound(breaks.begin() + 1, breaks.end() - 1, t);
  return static_cast<std::size_t>(after - breaks.begin()) - 1;
}

}  // namespace

ConstantRatePair::ConstantRatePair(const Motion& X_WA, const Motion& X_WB,
                                   const Eigen::Vector3d& p_AC, const Eigen::Vector3d& p_BC,
                                   double resolution)
    : X_WA_(X_WA), X_WB_(X_WB), p_AC_(p_AC), p_BC_(p_BC), resolution_(resolution) {}

double ConstantRatePair::enter(double t) {
  const std::size_t a = piece_at(X_WA_, t);
  const std::size_t b = piece_at(X_WB_, t);
  piece_.emplace(X_WA_.path(a, p_AC_), X_WB_.path(b, p_BC_), resolution_);
  return std::min(X_WA_.breaks()[a + 1], X_WB_.breaks()[b + 1]);
}

double ConstantRatePair::speed_bound(double radius_A, double radius_B) const {
  const ConstantRatePath& A = piece_->A();
  const ConstantRatePath& B = piece_->B();
  return (piece_->pivot_velocity().norm() + A.rate() * (A.lever_length() + radius_A) +
          B.rate() * (B.lever_length() + radius_B)) *
         (1.0 + 0x1p-40);
}

Eigen::Vector3d ConstantRatePair::origin(double t) const {
  const ConstantRatePath& path = piece_->A();
  return (path.pivot(t) + path.precise_lever(t)).value();
}

}  // namespace firstcontact
