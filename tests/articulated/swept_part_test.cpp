// How far apart parts stay over a window of time: a bound that holds at every time, and is tight in
// short windows.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <firstcontact/articulated/detail/swept_part.h>
#include <firstcontact/geometry/convex_hull.h>

#include "articulated/chain_case.h"
#include "support/convex_distance.h"
#include "support/random.h"

namespace firstcontact::test {
namespace {

using detail::SweptGap;
using detail::SweptPart;
using Eigen::Vector3d;
using oracle::Wide;

constexpr double kEverything = std::numeric_limits<double>::infinity();

Shape some_hull(Random& random) {
  std::vector<Vector3d> points;
  const Vector3d middle = random.vector(0.0, 0.3);
  const Vector3d stretch(random.uniform(0.05, 0.5), random.uniform(0.02, 0.3), 0.1);
  for (int i = 0; i < 12; ++i) {
    points.push_back(middle + stretch.cwiseProduct(random.vector(0.0, 1.0)));
  }
  return make_convex_hull(points, random.chance(0.5) ? 0.0 : random.uniform(0.0, 0.05));
}

/// The tip of a chain against a body at rest.
struct Case {
  ChainCase chain;
  Shape A;
  Shape B;
  Vector3d p_WB;
  TimeWindow window;

  static Case random(std::uint64_t seed) {
    Random random(seed + 900);
    ChainCase chain = random_chain(seed, {.joints = 1 + static_cast<int>(seed % 12)});
    const double begin = random.uniform(0.0, 0.9);
    const double length = random.logarithmic(1e-6, 0.1);
    const std::size_t tip = chain.motion.model().links().size() - 1;
    const LinkPath path = chain.motion.path(tip, begin + 0.5 * length);
    const TimeWindow window{std::max(begin, path.t_begin()),
                            std::min(begin + length, path.t_end())};
    const Vector3d near = path.pose(window.begin).p_OL;
    return {std::move(chain), some_hull(random), some_hull(random), near + random.vector(0.0, 2.5),
            window};
  }

  /// [m]  At a time of the window, from both sides.
  [[nodiscard]] oracle::ConvexDistance distance(double t) const {
    std::vector<Vector3d> moved;
    const auto exact = chain.exact(t);
    for (const Vector3d& v : A.mesh().vertices) {
      const auto p = oracle::exact_place(exact, Wide(t), exact_point(v));
      moved.push_back({p.x.nearest(), p.y.nearest(), p.z.nearest()});
    }
    const auto support = [](const std::vector<Vector3d>& points, const Vector3d& shift) {
      return [&points, shift](const Vector3d& n) -> Vector3d {
        return shift + *std::max_element(points.begin(), points.end(),
                                         [&](const Vector3d& p, const Vector3d& q) {
                                           return n.dot(p) < n.dot(q);
                                         });
      };
    };
    auto found =
        oracle::convex_distance(support(moved, Vector3d::Zero()), support(B.mesh().vertices, p_WB));
    found.lower -= A.radius() + B.radius();
    found.upper -= A.radius() + B.radius();
    return found;
  }
};

detail::Part part_of(const Shape& shape) {
  const ShapeBounds& bounds = shape.bounds();
  detail::Part part;
  part.shape = &shape;
  part.box = {bounds.centre, bounds.axes, bounds.half_extents, shape.radius()};
  part.reach = bounds.reach + shape.radius();
  return part;
}

TEST(SweptPart, GapsHoldAtAllTimesOfTheWindow) {
  int proven = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Case c = Case::random(seed);
    if (!(c.window.begin < c.window.end)) {
      continue;
    }
    const std::size_t tip = c.chain.motion.model().links().size() - 1;
    LinkScratch scratch;
    const detail::Part a = part_of(c.A);
    const detail::Part b = part_of(c.B);
    const double middle = 0.5 * (c.window.begin + c.window.end);
    const SweptPart A =
        detail::sweep(a, {c.chain.motion.path(tip, middle), {}, 0.0}, c.window, scratch);
    const LinkMotion rest(Motion::fixed({c.p_WB, Eigen::Quaterniond::Identity()}));
    const SweptPart B = detail::sweep(b, {rest.at(0.5), {}, 0.0}, {0.0, 1.0}, scratch);
    const SweptGap boxes = detail::gap_of_boxes(A, B, c.window, kEverything);
    const SweptGap balls = detail::gap_of_boxes(A, B, c.window, -kEverything);
    const SweptGap hulls = detail::gap_of_hulls(A, B, c.window, 0.0, boxes.n);
    for (const double share : {0.0, 0.1, 0.5, 0.77, 1.0}) {
      const double t = c.window.begin + share * (c.window.end - c.window.begin);
      const double distance = c.distance(std::clamp(t, c.window.begin, c.window.end)).upper + 1e-12;
      ASSERT_LE(balls.bound, distance) << seed << " " << share;
      ASSERT_LE(boxes.bound, distance) << seed << " " << share;
      ASSERT_LE(hulls.bound, distance) << seed << " " << share;
      if (share == 0.5) {
        ASSERT_LE(std::max({balls.middle, boxes.middle, hulls.middle}), distance) << seed;
      }
    }
    proven += hulls.bound > 0.0 ? 1 : 0;
    ASSERT_LE(hulls.bound, hulls.middle) << seed;
  }
  EXPECT_GT(proven, 60);
}

/// What a window's length costs falls with it.
TEST(SweptPart, ShortWindowsAreTight) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Case c = Case::random(seed);
    const std::size_t tip = c.chain.motion.model().links().size() - 1;
    const double middle = 0.5 * (c.window.begin + c.window.end);
    c.window = {middle, std::nextafter(middle, 1.0)};
    LinkScratch scratch;
    const detail::Part a = part_of(c.A);
    const detail::Part b = part_of(c.B);
    const SweptPart A =
        detail::sweep(a, {c.chain.motion.path(tip, middle), {}, 0.0}, c.window, scratch);
    const LinkMotion rest(Motion::fixed({c.p_WB, Eigen::Quaterniond::Identity()}));
    const SweptPart B = detail::sweep(b, {rest.at(0.5), {}, 0.0}, {0.0, 1.0}, scratch);
    const double distance = c.distance(middle).lower;
    if (distance > 0.01) {
      const Vector3d n = (B.centre - A.centre).normalized();
      ASSERT_GT(detail::gap_of_hulls(A, B, c.window, 0.8 * distance, n).bound, 0.8 * distance)
          << seed;
    }
  }
}

}  // namespace
}  // namespace firstcontact::test
