#include <firstcontact/robot_check/detail/swept_ball.h>

#include <algorithm>

namespace firstcontact::detail {
namespace {

constexpr double kUp = 1.0 + 0x1p-40;

}  // namespace

SweptBall swept_ball(const RoundedBox& ball, const GeometryPath& path, const TimeWindow& window,
                     LinkScratch& scratch) {
  const double middle = 0.5 * (window.begin + window.end);
  const auto [pose, speed] = path.X_FS.swept(middle, window.begin, window.end, ball, scratch);
  SweptBall swept;
  swept.centre = pose.p_OL + pose.R_FL * ball.centre;
  const double sweep = speed * std::max(window.end - middle, middle - window.begin) * kUp;
  const double error = pose.position_error + pose.rotation_error * ball.centre.norm() +
                       0x1p-48 * swept.centre.norm();
  swept.radius = (ball.radius + sweep + error) * kUp;
  swept.tracking_error = path.tracking_bound(ball, window, scratch);
  return swept;
}

double gap_bound(const SweptBall& a, const SweptBall& b) {
  return (a.centre - b.centre).norm() * (1.0 - 0x1p-48) - (a.radius + b.radius) * kUp;
}

}  // namespace firstcontact::detail
