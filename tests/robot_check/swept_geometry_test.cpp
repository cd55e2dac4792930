// How far apart geometries stay over a window of time: a bound that holds at every time, and is
// tight in short windows.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/geometry/convex_hull.h>
#include <firstcontact/geometry/shape_bounds.h>
#include <firstcontact/robot/precise_transform.h>
#include <firstcontact/robot_check/detail/swept_geometry.h>
#include <firstcontact/robot_check/detail/tree_poses.h>

#include "robot/chain_case.h"
#include "support/convex_distance.h"
#include "support/random.h"
#include "support/rounds.h"

namespace firstcontact::test {
namespace {

using detail::SweptGap;
using detail::SweptGeometry;
using Eigen::Vector3d;
using oracle::Wide;

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

detail::BoundedGeometry geometry_of(const Shape& shape) {
  const ShapeBounds& bounds = shape.bounds();
  detail::BoundedGeometry geometry;
  geometry.shape = &shape;
  geometry.bounds = &bounds;
  geometry.box = {bounds.centre, bounds.axes, bounds.half_extents, shape.radius()};
  geometry.reach = bounds.reach + shape.radius();
  return geometry;
}

/// A geometry over a window that is the whole grid of its piece.
class Followed {
 public:
  /// The tip of the chain.
  Followed(const Shape& shape, const ChainCase& chain, const TimeWindow& window)
      : geometry_(geometry_of(shape)),
        course_(nodes_of(chain.motion, 0.5 * (window.begin + window.end)), {window}),
        track_(geometry_, mount_on_tip(chain.motion.model()), detail::TreePoses::kWorld) {
    const auto place = [&](int k) { return track_.place(k); };
    swept_ = track_.sweep(window, place(0), place(detail::TimeGrid::kMiddle),
                          place(detail::GridWindow::kSize));
  }

  /// At rest.
  Followed(const Shape& shape, const Vector3d& p_WB)
      : geometry_(geometry_of(shape)),
        path_(JointPath::rigid(precise(Pose{p_WB, Eigen::Quaterniond::Identity()}))),
        course_(path_, {{0.0, 1.0}}),
        track_(geometry_, detail::GeometryMount(geometry_, course_), detail::TreePoses::kWorld),
        swept_(track_.rest()) {}

  Followed(const Followed&) = delete;
  Followed& operator=(const Followed&) = delete;

  [[nodiscard]] const SweptGeometry& swept() const { return swept_; }

 private:
  static std::vector<detail::TreePoses::Node> nodes_of(const RobotMotion& motion, double t) {
    std::vector<detail::TreePoses::Node> nodes = {
        {detail::TreePoses::kWorld, &motion.base_path(t)}};
    const RobotModel& model = motion.model();
    for (const std::size_t joint : model.chain(model.root(), model.links().size() - 1)) {
      if (const JointPath* path = motion.joint_path(joint, t)) {
        nodes.push_back({nodes.size() - 1, path});
      }
    }
    return nodes;
  }

  detail::GeometryMount mount_on_tip(const RobotModel& model) {
    const std::size_t tip = model.links().size() - 1;
    return {geometry_, course_, course_.size() - 1,
            model.tail(tip) ? *model.tail(tip) : JointPath::rigid({})};
  }

  detail::BoundedGeometry geometry_;
  JointPath path_ = JointPath::rigid({});
  detail::TreePoses course_;
  detail::GeometryTrack track_;
  SweptGeometry swept_;
};

TEST(SweptGeometry, GapsHoldAtAllTimesOfTheWindow) {
  int proven = 0;
  for (std::uint64_t seed = 0; seed < test::rounds(300, 90); ++seed) {
    const Case c = Case::random(seed);
    if (!(c.window.begin < c.window.end)) {
      continue;
    }
    const Followed a(c.A, c.chain, c.window);
    const Followed b(c.B, c.p_WB);
    const SweptGap boxes = detail::gap_of_boxes(a.swept(), b.swept());
    const SweptGap middle = detail::gap_at_middle(a.swept(), b.swept(), 0.0, boxes.n);
    const SweptGap hulls = detail::gap_throughout(a.swept(), b.swept(), 0.0, middle.n);
    const SweptGap swapped = detail::gap_throughout(b.swept(), a.swept(), 0.0, -middle.n);
    for (const double share : {0.0, 0.1, 0.5, 0.77, 1.0}) {
      const double t = c.window.begin + share * (c.window.end - c.window.begin);
      const double distance = c.distance(std::clamp(t, c.window.begin, c.window.end)).upper + 1e-12;
      ASSERT_LE(boxes.bound, distance) << seed << " " << share;
      ASSERT_LE(hulls.bound, distance) << seed << " " << share;
      ASSERT_LE(swapped.bound, distance) << seed << " " << share;
      if (share == 0.5) {
        ASSERT_LE(middle.bound, distance) << seed;
      }
    }
    proven += hulls.bound > 0.0 ? 1 : 0;
  }
  EXPECT_GT(proven, test::rounds(100, 30));
}

/// The error due to a window's length falls with that length.
TEST(SweptGeometry, ShortWindowsAreTight) {
  int apart = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Case c = Case::random(seed);
    const double middle = 0.5 * (c.window.begin + c.window.end);
    c.window = {middle, std::nextafter(middle, 1.0)};
    const Followed a(c.A, c.chain, c.window);
    const Followed b(c.B, c.p_WB);
    const double distance = c.distance(middle).lower;
    if (distance > 0.01) {
      ++apart;
      const Vector3d n = (b.swept().middle.centre - a.swept().middle.centre).normalized();
      ASSERT_GT(detail::gap_at_middle(a.swept(), b.swept(), 0.0, n).bound, 0.8 * distance) << seed;
      ASSERT_GT(detail::gap_throughout(a.swept(), b.swept(), 0.8 * distance, n).bound,
                0.8 * distance)
          << seed;
    }
  }
  EXPECT_GT(apart, 20);
}

/// Two that a common frame carries: what it does cancels.
TEST(SweptGeometry, LinksAreSeenFromTheOneThatCarriesThem) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const ChainCase chain = random_chain(seed, {.joints = 2});
    const RobotMotion& motion = chain.motion;
    Random random(seed);
    const detail::TimeGrid grid{{motion.breaks()[0], motion.breaks()[1]}};
    const double middle = grid.at(detail::TimeGrid::kMiddle);
    const Shape shape = some_hull(random);
    const detail::BoundedGeometry geometry = geometry_of(shape);
    std::vector<detail::TreePoses::Node> nodes = {
        {detail::TreePoses::kWorld, &motion.base_path(middle)}};
    for (const std::size_t joint :
         motion.model().chain(motion.model().root(), motion.model().links().size() - 1)) {
      if (const JointPath* path = motion.joint_path(joint, middle)) {
        nodes.push_back({nodes.size() - 1, path});
      }
    }
    detail::TreePoses course(nodes, grid);
    const JointPath none = JointPath::rigid({});
    const std::size_t last = course.size() - 1;
    const detail::GeometryTrack carried(geometry, {geometry, course, last, none}, last);
    ASSERT_TRUE(carried.rests()) << seed;
    const detail::GeometryTrack in_frame(geometry, {geometry, course, last, none},
                                         course.parent(last));
    const detail::GeometryTrack in_world(geometry, {geometry, course, last, none},
                                         detail::TreePoses::kWorld);
    for (const int k : {0, 5, detail::GridWindow::kSize}) {
      const detail::FramePlace& F = course.place(course.parent(last), k);
      const detail::GeometryPlace near = in_frame.place(k);
      const detail::GeometryPlace far = in_world.place(k);
      ASSERT_LE((F.p + F.R * near.centre - far.centre).norm(), 1e-12) << seed;
      ASSERT_LE((F.R * near.R_FS - far.R_FS).norm(), 1e-12) << seed;
      ASSERT_LE(near.error, 1e-9) << seed;
    }
  }
}

}  // namespace
}  // namespace firstcontact::test
